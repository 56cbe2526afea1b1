// SPDX-License-Identifier: Apache-2.0
// The optics, compiled from the same C++ as the program (web/wasm/page_api.h). Every number that
// the page shows of a lens comes from here.

import create, { type OpticsModule } from "../wasm/optics.mjs";
import type { Medium } from "./media";

export type Pair = [number, number]; // along the cylinder axis, across it
type MaybePair = [number | null, number | null]; // null: infinite

export interface Measurement {
  quantity: string;
  unit: string;
  ordered: number;
  measured: number;
  tolerance: number;
  numerical_error: number;
  source: string;
  passed: boolean;
}

export interface Cardinal {
  front_focal_mm: number | null;
  back_focal_mm: number | null;
  front_principal_mm: number | null;
  back_principal_mm: number | null;
}

export interface Form {
  sphere: number;
  cylinder: number;
  axis: number;
}

export interface Sheet {
  ok: true;
  index_d: number;
  front_power_D: Pair;
  back_power_D: Pair;
  radius_front_mm: MaybePair;
  radii_back_mm: MaybePair;
  back_vertex_power_D: Pair;
  front_vertex_power_D: Pair;
  equivalent_power_D: Pair;
  paper_power_D: Pair;
  paper_power_error_D: Pair;
  cardinal: [Cardinal | null, Cardinal | null];
  center_thickness_mm: number;
  edge_thickness_mm: Pair; // least, greatest
  mass_g: number;
  min_blank_mm: number;
  luminous_transmittance: number;
  filter_category: number | null;
  pupil_mm: number;
  shape_factor: Pair;
  power_factor: Pair;
  spectacle_magnification: Pair;
  observer_magnification_thin: number;
  observer_magnification_paraxial: number;
  observer_magnification_exact: number | null;
  made: Form; // as ground
  target: Form; // what the eye is to meet at the back vertex as worn
  worn: Form & { prism_in: number; prism_up: number }; // what it meets, by rays
  certificate: Measurement[];
}

export interface Refusal {
  ok: false;
  error: string;
}

export interface ReadEye {
  sphere: number;
  cylinder: number;
  axis: number;
  add: number;
  prism_in: number;
  prism_up: number;
}

export interface ReadPrescription {
  ok: true;
  OD: ReadEye;
  OS: ReadEye;
  PD: { right: number; left: number } | null; // null: the file does not say
  vertex_distance: number | null;
}

export interface LensOrder {
  eye: "right" | "left";
  sphere: number;
  cylinder: number;
  axis: number;
  add: number;
  prism_in: number;
  prism_up: number;
  medium: Omit<Medium, "min_center_mm" | "min_edge_mm">;
  base_curve_D?: number;
  center_thickness_mm?: number;
  min_center_thickness_mm: number;
  min_edge_thickness_mm: number;
  diameter_mm?: number;
  contour_mm?: number[];
  vertex_distance_mm: number;
  pantoscopic_deg: number;
  face_form_deg: number;
  refraction_vertex_mm: number;
  compensate: boolean;
  camera_mm: number;
  depth_mm: number;
  feature_height_mm: number;
  feature_meridian_deg: number;
  design: string;
  corridor_mm: number;
  coat: string;
  tint: number; // share of light taken
}

// See PageView in web/wasm/page_api.h.
export interface View {
  camera_mm: number;
  cx: number;
  cy: number;
  x0: number;
  y0: number;
  x1: number;
  y1: number;
  depth_mm: number;
  face_x_mm: number;
  rings: boolean;
  mirrored: boolean;
}

// From the lens frame to the straight frame, in which camera and face stand still.
export interface Worn {
  turn: number[]; // a rotation, row by row
  origin: [number, number, number]; // of the lens frame
}

export interface Reading {
  mean: number;
  j0: number;
  j45: number;
  prism: [number, number]; // toward the lens frame's x and y
  rest: number; // what no sphere and cylinder explains, D
}

export interface FanRay {
  ok: boolean;
  start: [number, number]; // height, z
  front: [number, number];
  back: [number, number];
  direction: [number, number];
}

// Status, mean, J0, J45, prism x, prism y, tangents of the object (x, y) and of the gaze (x, y).
export const GAZE_ROW = 10;
export const MIRRORED_ROW = 10; // see lg_mirrored in web/wasm/page_api.h

export const SLOT = { right: 0, left: 1, compare: 2, practice: 3 } as const;

export class Engine {
  private readonly last = new Map<number, { order: string; sheet: Sheet }>();
  private constructor(private readonly module: OpticsModule) {}

  static async load(): Promise<Engine> {
    return new Engine(await create());
  }

  // The sheet of the certified lens, or why there is none; the slot keeps its last good lens. The
  // very same order gives the very same sheet.
  design(slot: number, order: LensOrder): Sheet | Refusal {
    const text = JSON.stringify(order);
    const last = this.last.get(slot);
    if (last?.order === text) return last.sheet;
    const answer: Sheet | Refusal = JSON.parse(
      this.withText(text, (p) => this.module._lg_design(slot, p)),
    );
    if (answer.ok) this.last.set(slot, { order: text, sheet: answer });
    return answer;
  }

  readPrescription(text: string, name: string): ReadPrescription | Refusal {
    return JSON.parse(
      this.withText(text, (p) =>
        this.withPointer(name, (n) => this.module._lg_read_prescription(p, n)),
      ),
    );
  }

  media(): Medium[] {
    return JSON.parse(this.module.UTF8ToString(this.module._lg_media()));
  }

  // FHIR's text of a prescription in our JSON.
  writeFhir(ours: string, date: string): { ok: true; fhir: string } | Refusal {
    return JSON.parse(
      this.withText(ours, (p) => this.withPointer(date, (d) => this.module._lg_write_fhir(p, d))),
    );
  }

  // What the turning eye meets: GAZE_ROW numbers for each of n x m gazes, rows downwards.
  gazeMap(slot: number, stop: number, halfX: number, halfY: number, n: number, m: number): Float64Array {
    const at = this.module._lg_gaze_map(slot, stop, halfX, halfY, n, m) / 8;
    return this.module.HEAPF64.slice(at, at + GAZE_ROW * n * m);
  }

  // Rows of (degrees, sagittal error, tangential error).
  gazeLine(slot: number, stop: number, meridian: number, max: number, n: number): Float64Array {
    const at = this.module._lg_gaze_line(slot, stop, meridian, max, n) / 8;
    return this.module.HEAPF64.slice(at, at + 3 * (n + 1));
  }

  // Pairs of (mean power, astigmatism) of a progressive front surface.
  progressiveMap(
    far: number, add: number, corridor: number, index: number, soft: boolean, half: number, n: number,
  ): Float64Array {
    const at = this.module._lg_progressive_map(far, add, corridor, index, Number(soft), half, n) / 8;
    return this.module.HEAPF64.slice(at, at + 2 * n * n);
  }

  // Front and back z over points (x, y): two numbers a point, NaN where a surface ends.
  surfaces(slot: number, points: ArrayLike<number>): Float64Array {
    const n = points.length / 2;
    const at = this.module._malloc(8 * points.length);
    this.module.HEAPF64.set(points, at / 8);
    const out = this.module._lg_surfaces(slot, at, n);
    this.module._free(at);
    return this.module.HEAPF64.slice(out / 8, out / 8 + 2 * n);
  }

  fan(
    slot: number,
    meridian: number,
    half: number,
    count: number,
    field: number,
    object: number,
    height: number,
  ): FanRay[] {
    const at = this.module._lg_fan(slot, meridian, half, count, field, object, height) / 8;
    const rays: FanRay[] = [];
    for (let i = 0; i < count; ++i) {
      const r = this.module.HEAPF64.subarray(at + 9 * i, at + 9 * i + 9);
      rays.push({
        ok: r[0] === 0,
        start: [r[1], r[2]],
        front: [r[3], r[4]],
        back: [r[5], r[6]],
        direction: [r[7], r[8]],
      });
    }
    return rays;
  }

  worn(slot: number): Worn {
    const at = this.module._lg_worn(slot) / 8;
    const [...all] = this.module.HEAPF64.slice(at, at + 12);
    return { turn: all.slice(0, 9), origin: [all[9], all[10], all[11]] };
  }

  // A focimeter's reading at (x, y) of the lens; null where nothing can be read.
  focimeter(slot: number, x: number, y: number, turned: boolean): Reading | null {
    const at = this.module._lg_focimeter(slot, x, y, Number(turned)) / 8;
    const [mean, j0, j45, px, py, rest] = this.module.HEAPF64.slice(at, at + 6);
    return Number.isNaN(mean) ? null : { mean, j0, j45, prism: [px, py], rest };
  }

  // Four numbers a pixel: status (0 ok), where the camera sees that point of the face without the
  // lens (x from the middle of the face, y; mm in the plane of the lens), light kept.
  view(slot: number, view: View, width: number, height: number): Float32Array {
    const fields = [
      view.camera_mm, view.cx, view.cy, view.x0, view.y0, view.x1, view.y1,
      view.depth_mm, view.face_x_mm, Number(view.rings), Number(view.mirrored),
    ];
    const at = this.module._malloc(8 * fields.length);
    this.module.HEAPF64.set(fields, at / 8);
    const out = this.module._lg_view(slot, at, width, height);
    this.module._free(at);
    return this.module.HEAPF32.slice(out / 4, out / 4 + 4 * width * height);
  }

  // Beside the last view that asked for them, of this many pixels: share of the edge wall's light.
  rings(count: number): Float32Array {
    const at = this.module._lg_rings() / 4;
    return this.module.HEAPF32.slice(at, at + count);
  }

  // Beside the last view that asked for it: MIRRORED_ROW numbers a pixel.
  mirrored(count: number): Float32Array {
    const at = this.module._lg_mirrored() / 4;
    return this.module.HEAPF32.slice(at, at + MIRRORED_ROW * count);
  }

  private withPointer(text: string, call: (pointer: number) => number): number {
    const size = this.module.lengthBytesUTF8(text) + 1;
    const at = this.module._malloc(size);
    this.module.stringToUTF8(text, at, size);
    const out = call(at);
    this.module._free(at);
    return out;
  }

  private withText(text: string, call: (pointer: number) => number): string {
    return this.module.UTF8ToString(this.withPointer(text, call));
  }
}
