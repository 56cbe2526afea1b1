// SPDX-License-Identifier: Apache-2.0
// The lenses that the focimeter's practice asks about, and when an answer is right.

import type { LensOrder, Reading } from "./engine";

export const KINDS = ["sphere", "cylinder", "prism", "bifocal"] as const;
export type Kind = (typeof KINDS)[number];

export interface Unknown {
  kind: Kind;
  sphere: number;
  cylinder: number; // minus form
  axis: number;
  prismIn: number;
  prismUp: number;
  add: number;
  // Where the lens lies on the stop before it is moved: the stop's place in the lens, mm.
  x: number;
  y: number;
}

export interface Answer {
  sphere: number | null;
  cylinder: number | null;
  axis: number | null;
  prismIn: number | null;
  prismUp: number | null;
  add: number | null;
}

const POWER_TOLERANCE_D = 0.125;
const PRISM_TOLERANCE = 0.33; // ANSI Z80.1-2015
// Middle of the segment of the bifocal below and inside the optical centre (a right lens).
export const SEGMENT = { x: -2, y: -10 };

export function randomLens(kind: Kind, random: () => number = Math.random): Unknown {
  const steps = (low: number, high: number, step: number): number =>
    low + step * Math.floor(random() * ((high - low) / step + 1));
  const toric = kind !== "sphere" && random() < 0.8;
  return {
    kind,
    sphere: steps(kind === "bifocal" ? -4 : -6, kind === "bifocal" ? 4 : 5, 0.25),
    cylinder: toric ? steps(-3, -0.5, 0.25) : 0,
    axis: toric ? steps(5, 180, 5) : 180,
    prismIn: kind === "prism" ? steps(-3, 3, 0.5) : 0,
    prismUp: kind === "prism" ? steps(-2, 2, 0.5) : 0,
    add: kind === "bifocal" ? steps(1, 3, 0.25) : 0,
    // A lens with prism lies on its marked point, where the prism is read.
    x: kind === "prism" ? 0 : steps(-5, 5, 1),
    y: kind === "prism" ? 0 : steps(-4, 4, 1),
  };
}

export const orderOf = (lens: Unknown): LensOrder => ({
  eye: "right",
  sphere: lens.sphere,
  cylinder: lens.cylinder,
  axis: lens.axis,
  add: lens.add,
  prism_in: lens.prismIn,
  prism_up: lens.prismUp,
  medium: { name: "CR-39", index_d: 1.498, abbe: 58, density_g_cm3: 1.32 },
  min_center_thickness_mm: 1.8,
  min_edge_thickness_mm: 1,
  diameter_mm: 60,
  vertex_distance_mm: 13,
  pantoscopic_deg: 0,
  face_form_deg: 0,
  refraction_vertex_mm: 13,
  compensate: false,
  camera_mm: 600,
  depth_mm: 16.05,
  feature_height_mm: 5.85,
  feature_meridian_deg: 180,
  design: lens.kind === "bifocal" ? "flat28" : "single",
  corridor_mm: 14,
  coat: "none",
  tint: 0,
});

// Blur of the target's lines at `angle` degrees, whose normal n is at angle + 90: |(F - d I) n|.
export function lineBlur(reading: Reading, drum: number, angle: number): number {
  const n = ((angle + 90) * Math.PI) / 180;
  const [x, y] = [Math.cos(n), Math.sin(n)];
  const m = reading.mean - drum;
  return Math.hypot(
    (m + reading.j0) * x + reading.j45 * y, reading.j45 * x + (m - reading.j0) * y);
}

// Of the axis, by cylinder: ANSI Z80.1-2015.
function axisTolerance(cylinder: number): number {
  const c = Math.abs(cylinder);
  return c <= 0.25 ? 14 : c <= 0.5 ? 7 : c <= 0.75 ? 5 : c <= 1.5 ? 3 : 2;
}

export type Verdict = "right" | "power" | "axis" | "prism" | "add";

export function judge(lens: Unknown, answer: Answer): Verdict {
  let sphere = answer.sphere ?? 0;
  let cylinder = answer.cylinder ?? 0;
  let axis = answer.axis ?? 180;
  if (cylinder > 0) {
    sphere += cylinder;
    cylinder = -cylinder;
    axis += 90;
  }
  if (Math.abs(sphere - lens.sphere) > POWER_TOLERANCE_D) return "power";
  if (Math.abs(cylinder - lens.cylinder) > POWER_TOLERANCE_D) return "power";
  const turn = Math.abs(((((axis - lens.axis + 90) % 180) + 180) % 180) - 90);
  if (lens.cylinder !== 0 && turn > axisTolerance(lens.cylinder)) return "axis";
  const off = Math.hypot((answer.prismIn ?? 0) - lens.prismIn, (answer.prismUp ?? 0) - lens.prismUp);
  if (lens.kind === "prism" && off > PRISM_TOLERANCE) return "prism";
  if (Math.abs((answer.add ?? 0) - lens.add) > POWER_TOLERANCE_D) return "add";
  return "right";
}
