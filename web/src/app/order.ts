// SPDX-License-Identifier: Apache-2.0
// The order as the page keeps it, its check, and the link that carries the whole of it.

import { contourOf, type FrameShape } from "./frames";
import { MEDIA } from "./media";
import type { LensOrder, Sheet } from "./engine";
import type { TextKey } from "./texts";

export type EyeName = "right" | "left";
export const EYES: EyeName[] = ["right", "left"];

export interface EyeRx {
  sphere: number;
  cylinder: number;
  axis: number | null; // null where there is no cylinder
  add: number;
  prismIn: number; // base in positive
  prismUp: number; // base up positive
  pd: number; // monocular, mm
}

export interface Order {
  right: EyeRx;
  left: EyeRx;
  medium: string; // a name of MEDIA
  design: string; // of DESIGNS
  corridor: number; // mm, of a progressive
  coat: string; // of COATS
  base: number | null; // D; null: by rule
  centre: number | null; // mm; null: by rule
  minCentre: number;
  minEdge: number;
  shape: FrameShape;
  a: number; // boxing, mm
  b: number;
  dbl: number;
  vertex: number; // mm, back vertex to cornea as worn
  refraction: number | null; // mm, the same when the eyes were tested; null: as worn
  panto: number; // degrees, lower edge toward the cheek positive
  wrap: number; // degrees of face form, temporal edge toward the head positive
  compensate: boolean; // make the lens so that as worn it does what the prescription asks
  camera: number; // mm before the lens
  tint: number; // per cent of light that an even dip tint takes
  trace: number[] | null; // radii of a traced shape, mm, from an OMA file; replaces `shape`
}

const plainEye = (sphere: number, cylinder: number, axis: number | null): EyeRx => ({
  sphere,
  cylinder,
  axis,
  add: 0,
  prismIn: 0,
  prismUp: 0,
  pd: 32,
});

// Table I of the paper, right eye -4.25 -0.75 x 160, left -4.50, PD 64.
export const DEFAULT_ORDER: Order = {
  right: plainEye(-4.25, -0.75, 160),
  left: plainEye(-4.5, 0, null),
  medium: "1.60",
  design: "single",
  corridor: 14,
  coat: "none",
  base: null,
  centre: null,
  minCentre: 1.5,
  minEdge: 1,
  shape: "panto",
  a: 50,
  b: 41,
  dbl: 19,
  vertex: 13,
  refraction: null,
  panto: 0,
  wrap: 0,
  compensate: false,
  camera: 600,
  tint: 0,
  trace: null,
};

export interface Limit {
  min: number;
  max: number;
  step: number;
  places: number;
}
export const LIMITS = {
  sphere: { min: -40, max: 40, step: 0.25, places: 2 },
  cylinder: { min: -15, max: 15, step: 0.25, places: 2 },
  axis: { min: 0, max: 180, step: 1, places: 0 },
  add: { min: 0, max: 6, step: 0.25, places: 2 },
  prismIn: { min: -20, max: 20, step: 0.25, places: 2 },
  prismUp: { min: -20, max: 20, step: 0.25, places: 2 },
  pd: { min: 20, max: 42.5, step: 0.5, places: 1 },
  base: { min: 0, max: 16, step: 0.25, places: 2 },
  centre: { min: 0.8, max: 25, step: 0.1, places: 1 },
  minCentre: { min: 0.8, max: 4, step: 0.1, places: 1 },
  minEdge: { min: 0.3, max: 4, step: 0.1, places: 1 },
  a: { min: 30, max: 70, step: 1, places: 0 },
  b: { min: 18, max: 65, step: 1, places: 0 },
  dbl: { min: 8, max: 30, step: 1, places: 0 },
  vertex: { min: 5, max: 25, step: 0.5, places: 1 },
  refraction: { min: 5, max: 25, step: 0.5, places: 1 },
  panto: { min: -5, max: 30, step: 1, places: 0 },
  wrap: { min: -5, max: 30, step: 1, places: 0 },
  camera: { min: 200, max: 4000, step: 50, places: 0 },
  corridor: { min: 8, max: 24, step: 1, places: 0 },
  tint: { min: 0, max: 90, step: 5, places: 0 },
} satisfies Record<string, Limit>;
export type LimitName = keyof typeof LIMITS;

// What stops an eye's prescription from being one, and in which field.
export function rxProblem(rx: EyeRx): { field: "axis" | "cylinder"; text: TextKey } | null {
  if (rx.cylinder !== 0 && rx.axis === null) return { field: "axis", text: "error.axisWanted" };
  if (rx.cylinder === 0 && rx.axis !== null) {
    return { field: "cylinder", text: "error.axisWithoutCylinder" };
  }
  return null;
}

// The same lens in the other sign of cylinder.
export function transposed(rx: EyeRx): { sphere: number; cylinder: number; axis: number } | null {
  if (rx.cylinder === 0 || rx.axis === null) return null;
  return {
    sphere: rx.sphere + rx.cylinder,
    cylinder: -rx.cylinder,
    axis: rx.axis > 90 ? rx.axis - 90 : rx.axis + 90,
  };
}

export const meanOf = (form: { sphere: number; cylinder: number }): number =>
  form.sphere + form.cylinder / 2;

// Whether the lens is worn otherwise than the eyes were tested.
export const wornOtherwise = (order: Order): boolean =>
  order.panto !== 0 || order.wrap !== 0 || (order.refraction ?? order.vertex) !== order.vertex;

// The lens's principal meridians, along its cylinder axis and across it, degrees.
export function meridiansOf(sheet: Sheet): [number, number] {
  const { cylinder, axis } = sheet.made;
  const along = Math.abs(cylinder) < 1e-9 ? 180 : axis || 180;
  return [along, along > 90 ? along - 90 : along + 90];
}

// Position of the optical centre in the boxed lens: toward the nose positive, mm.
export const decentration = (order: Order, eye: EyeName): number =>
  (order.a + order.dbl) / 2 - order[eye].pd;

export function lensOrder(order: Order, eye: EyeName, change: Partial<Order> = {}): LensOrder {
  const o = { ...order, ...change };
  const rx = o[eye];
  const { name, index_d, abbe, density_g_cm3 } = MEDIA[o.medium];
  return {
    eye,
    sphere: rx.sphere,
    cylinder: rx.cylinder,
    axis: rx.axis ?? 180,
    add: rx.add,
    prism_in: rx.prismIn,
    prism_up: rx.prismUp,
    medium: { name, index_d, abbe, density_g_cm3 },
    ...(o.base === null ? {} : { base_curve_D: o.base }),
    ...(o.centre === null ? {} : { center_thickness_mm: o.centre }),
    min_center_thickness_mm: o.minCentre,
    min_edge_thickness_mm: o.minEdge,
    contour_mm: contourOf(o, eye).flat(),
    vertex_distance_mm: o.vertex,
    pantoscopic_deg: o.panto,
    face_form_deg: o.wrap,
    refraction_vertex_mm: o.refraction ?? o.vertex,
    compensate: o.compensate,
    camera_mm: o.camera,
    depth_mm: o.vertex + 3.05,
    feature_height_mm: IRIS_RADIUS_MM,
    feature_meridian_deg: 180,
    design: o.design,
    corridor_mm: o.corridor,
    coat: o.coat,
    tint: o.tint / 100,
  };
}

// Half the visible iris diameter of an average adult eye.
export const IRIS_RADIUS_MM = 5.85;

const EYE_FIELDS = ["sphere", "cylinder", "axis", "add", "prismIn", "prismUp", "pd"] as const;
const NUMBER_FIELDS = [
  "base", "centre", "minCentre", "minEdge", "a", "b", "dbl", "vertex", "refraction", "panto",
  "wrap", "camera", "tint", "corridor",
] as const;

// The order as the part of a link after "#".
export function toLink(order: Order): string {
  const q = new URLSearchParams();
  for (const eye of EYES) {
    q.set(eye[0], EYE_FIELDS.map((f) => order[eye][f] ?? "").join("_"));
  }
  q.set("m", order.medium);
  q.set("f", order.shape);
  q.set("d", order.design);
  q.set("c", order.coat);
  for (const f of NUMBER_FIELDS) if (order[f] !== null) q.set(f, String(order[f]));
  if (order.compensate) q.set("compensate", "1");
  if (order.trace) q.set("t", order.trace.map((r) => Math.round(r * 100)).join("_"));
  return q.toString();
}

const within = (name: LimitName, text: string | null): number | undefined => {
  if (text === null || text === "") return undefined;
  const value = Number(text);
  const { min, max } = LIMITS[name];
  return Number.isFinite(value) && value >= min && value <= max ? value : undefined;
};

// The order of a link; whatever it does not say, or says wrongly, keeps its default.
export function fromLink(link: string): Order {
  const q = new URLSearchParams(link.replace(/^#/, ""));
  const order = structuredClone(DEFAULT_ORDER);
  for (const eye of EYES) {
    const parts = q.get(eye[0])?.split("_");
    if (!parts || parts.length !== EYE_FIELDS.length) continue;
    const rx = structuredClone(order[eye]);
    EYE_FIELDS.forEach((f, i) => {
      if (f === "axis") rx.axis = within(f, parts[i]) ?? null;
      else rx[f] = within(f, parts[i]) ?? rx[f];
    });
    if (!rxProblem(rx)) order[eye] = rx;
  }
  const medium = q.get("m");
  if (medium && medium in MEDIA) order.medium = medium;
  const design = q.get("d");
  if (design && DESIGNS.includes(design)) order.design = design;
  const coat = q.get("c");
  if (coat && COATS.includes(coat)) order.coat = coat;
  const shape = q.get("f");
  if (shape && SHAPES.includes(shape as FrameShape)) order.shape = shape as FrameShape;
  for (const f of NUMBER_FIELDS) {
    const value = within(f, q.get(f));
    if (value !== undefined) order[f] = value;
  }
  order.compensate = q.get("compensate") === "1";
  const trace = q.get("t")?.split("_").map((r) => Number(r) / 100);
  if (trace && trace.length >= 12 && trace.every((r) => r >= 5 && r <= 60)) order.trace = trace;
  return order;
}

export const DESIGNS = ["single", "round", "flat28", "flat35", "executive", "progressive", "soft"];
export const COATS = ["none", "single", "v", "broadband"];
export const SHAPES: FrameShape[] = ["panto", "round", "oval", "rect"];
