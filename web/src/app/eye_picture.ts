// SPDX-License-Identifier: Apache-2.0
// The picture behind a lens: every point of the lens is looked up where the exact ray from the
// camera through that point meets the face, as the camera would see that point without the lens.

import { MIRRORED_ROW, SLOT, type Engine, type Sheet, type View } from "./engine";
import { PX_PER_MM, WINDOW } from "./face";
import { contourOf } from "./frames";
import { IRIS_RADIUS_MM, type EyeName, type Order } from "./order";
import { roomAt, type Light } from "./room";
import { straight } from "./worn";

// One exact ray every so many pixels, linear between them; sharp borders want it finer.
const GRID_PX = 3;
const FINE_GRID_PX = 1.5;
const IRIS_SAMPLES = 241;
const LOST = 60; // the grey of a place that no light of the face reaches
const EDGE_LIGHT = 0.8; // of a ground edge in the room's light, white being 1
const RINGS_SHOWN = 4; // times as bright, and said so: real ones are faint but before a lamp
// The face is drawn once for a lens this thick; another one shifts the camera by the difference.
const DRAWN_CENTRE_MM = 2;

export const PUPIL_DEPTH_MM = 3.05; // entrance pupil behind the cornea

export interface Shown {
  rings: boolean;
  mirrored: boolean;
}

// +x of the lens frame is the wearer's right: the viewer's left.
export const side = (eye: EyeName): 1 | -1 => (eye === "right" ? 1 : -1);

type Box = Pick<View, "x0" | "x1" | "y0" | "y1">;
const viewOf = (order: Order, eye: EyeName, box: Box, shown: Shown): View => ({
  ...box,
  ...shown,
  camera_mm: order.camera,
  cx: -side(eye) * order[eye].pd, // before the middle of the face
  cy: 0,
  depth_mm: order.vertex + PUPIL_DEPTH_MM,
  face_x_mm: side(eye) * order[eye].pd,
});

// Size at which the camera sees the plane of the irises without a lens, at the plane of the lens.
const scaleAt = (order: Order, centreMm: number): number =>
  order.camera / (order.camera + centreMm + order.vertex + PUPIL_DEPTH_MM);

export interface Pupils {
  right: { x: number; y: number };
  left: { x: number; y: number };
  iris: number; // radius
}

// In the drawn face, mm of the picture.
export function pupilsOf(order: Order): Pupils {
  const scale = scaleAt(order, DRAWN_CENTRE_MM);
  const at = (eye: EyeName): { x: number; y: number } => ({
    x: -side(eye) * order[eye].pd * scale,
    y: 0,
  });
  return { right: at("right"), left: at("left"), iris: IRIS_RADIUS_MM * scale };
}

// The cut outline of the worn lens as the camera sees it: viewer's x from the middle of the face, y.
export function outlineOf(engine: Engine, order: Order, eye: EyeName): [number, number][] {
  const worn = engine.worn(SLOT[eye]);
  const middle = side(eye) * order[eye].pd;
  return contourOf(order, eye).map(([x, y]) => {
    const p = straight(worn, [x, y, 0]);
    const scale = order.camera / (order.camera + p[2]);
    return [-(p[0] + middle) * scale, p[1] * scale];
  });
}

// Width of the iris in the picture over that without lenses, along the horizontal through it.
export function measuredIris(engine: Engine, order: Order, sheet: Sheet, eye: EyeName): number | null {
  const pd = side(eye) * order[eye].pd;
  const reach = 4 * IRIS_RADIUS_MM;
  const box = { x0: -reach, x1: reach, y0: -1e-6, y1: 1e-6 };
  const map = engine.view(SLOT[eye],
    viewOf(order, eye, box, { rings: false, mirrored: false }), IRIS_SAMPLES, 1);
  const scale = scaleAt(order, sheet.center_thickness_mm);
  const at = (i: number): number => -reach + (2 * reach * (i + 0.5)) / IRIS_SAMPLES;
  const edge = (offset: number): number | null => {
    const target = (pd + offset) * scale;
    for (let i = 0; i + 1 < IRIS_SAMPLES; ++i) {
      if (map[4 * i] !== 0 || map[4 * i + 4] !== 0) continue;
      const [a, b] = [map[4 * i + 1], map[4 * i + 5]];
      if ((a - target) * (b - target) > 0 || a === b) continue;
      return at(i) + ((target - a) / (b - a)) * (at(i + 1) - at(i));
    }
    return null;
  };
  const low = edge(-IRIS_RADIUS_MM);
  const high = edge(IRIS_RADIUS_MM);
  if (low === null || high === null) return null;
  return (high - low) / (2 * IRIS_RADIUS_MM * scale);
}

export interface PixelBox {
  px: number;
  py: number;
  w: number;
  h: number;
}

const encode = (linear: number): number => 255 * Math.pow(linear, 1 / 2.2);

// Fills `out` (the lens's box in the picture, w x h pixels from px, py) from `source`.
export function renderLens(
  engine: Engine,
  order: Order,
  sheet: Sheet,
  eye: EyeName,
  source: ImageData,
  box: PixelBox,
  out: ImageData,
  shown: Shown,
): void {
  const grid = shown.rings || shown.mirrored ? FINE_GRID_PX : GRID_PX;
  const gw = Math.ceil(box.w / grid) + 1;
  const gh = Math.ceil(box.h / grid) + 1;
  // Grid points sit at multiples of `grid`; the optics counts the middles of its cells.
  const toLens = (px: number): number =>
    -(WINDOW.left + px / PX_PER_MM) - side(eye) * order[eye].pd;
  const half = grid / 2;
  const view = viewOf(order, eye, {
    x0: toLens(box.px - half),
    x1: toLens(box.px + gw * grid - half),
    y1: WINDOW.top - (box.py - half) / PX_PER_MM,
    y0: WINDOW.top - (box.py + gh * grid - half) / PX_PER_MM,
  }, shown);
  const map = engine.view(SLOT[eye], view, gw, gh);
  const rings = shown.rings ? engine.rings(gw * gh) : null;
  const mirrored = shown.mirrored ? engine.mirrored(gw * gh) : null;
  const drawn = scaleAt(order, DRAWN_CENTRE_MM) / scaleAt(order, sheet.center_thickness_mm);
  // To pixels of the source.
  for (let k = 0; k < gw * gh; ++k) {
    map[4 * k + 1] = (-map[4 * k + 1] * drawn - WINDOW.left) * PX_PER_MM;
    map[4 * k + 2] = (WINDOW.top - map[4 * k + 2] * drawn) * PX_PER_MM;
  }
  const ringLight = RINGS_SHOWN * EDGE_LIGHT * (1 - order.tint / 100) ** 2;
  const from = source.data;
  const to = out.data;
  const { width, height } = source;
  const room: Light = [0, 0, 0];
  const extra: Light = [0, 0, 0];
  for (let j = 0; j < box.h; ++j) {
    const gj = Math.floor((j + 0.5) / grid);
    const fj = (j + 0.5) / grid - gj;
    for (let i = 0; i < box.w; ++i) {
      const gi = Math.floor((i + 0.5) / grid);
      const fi = (i + 0.5) / grid - gi;
      const q = gj * gw + gi;
      const k = 4 * q;
      const kd = k + 4 * gw;
      const o = 4 * (j * box.w + i);
      to[o + 3] = 255;
      const w00 = (1 - fi) * (1 - fj);
      const w10 = fi * (1 - fj);
      const w01 = (1 - fi) * fj;
      const w11 = fi * fj;
      const lost = map[k] + map[k + 4] + map[kd] + map[kd + 4] !== 0;
      // Where the face's light ends between the rays, it fades over that width.
      const v00 = lost && map[k] !== 0 ? 0 : w00;
      const v10 = lost && map[k + 4] !== 0 ? 0 : w10;
      const v01 = lost && map[kd] !== 0 ? 0 : w01;
      const v11 = lost && map[kd + 4] !== 0 ? 0 : w11;
      const seen = v00 + v10 + v01 + v11;
      if (seen < 1e-6) {
        to[o] = to[o + 1] = to[o + 2] = LOST; // no light of the face comes here
      } else {
        const mixed = (slot: number): number => (v00 * map[k + slot] + v10 * map[k + 4 + slot] +
          v01 * map[kd + slot] + v11 * map[kd + 4 + slot]) / seen;
        const x = mixed(1) - 0.5;
        const y = mixed(2) - 0.5;
        const kept = mixed(3);
        const cx = Math.min(width - 1.001, Math.max(0, x));
        const cy = Math.min(height - 1.001, Math.max(0, y));
        const ix = Math.floor(cx);
        const iy = Math.floor(cy);
        const fx = cx - ix;
        const fy = cy - iy;
        const s = 4 * (iy * width + ix);
        const sd = s + 4 * width;
        // The share of light applies to linear light; 1/2.2 is its exponent in the encoded picture.
        const gain = Math.pow(kept, 1 / 2.2);
        for (let c = 0; c < 3; ++c) {
          const top = from[s + c] + fx * (from[s + 4 + c] - from[s + c]);
          const low = from[sd + c] + fx * (from[sd + 4 + c] - from[sd + c]);
          to[o + c] = LOST + seen * (gain * (top + fy * (low - top)) - LOST);
        }
      }
      if (!rings && !mirrored) continue;
      extra[0] = extra[1] = extra[2] = 0;
      if (rings) {
        const ring = ringLight *
          (w00 * rings[q] + w10 * rings[q + 1] + w01 * rings[q + gw] + w11 * rings[q + gw + 1]);
        for (let c = 0; c < 3; ++c) extra[c] += ring;
      }
      if (mirrored) {
        const r = MIRRORED_ROW;
        const mix = (slot: number): number =>
          w00 * mirrored[r * q + slot] + w10 * mirrored[r * (q + 1) + slot] +
          w01 * mirrored[r * (q + gw) + slot] + w11 * mirrored[r * (q + gw + 1) + slot];
        for (const face of [0, 5]) {
          roomAt(mix(face), mix(face + 1), room);
          for (let c = 0; c < 3; ++c) extra[c] += room[c] * mix(face + 2 + c);
        }
      }
      for (let c = 0; c < 3; ++c) {
        if (extra[c] > 0.001) to[o + c] = encode(Math.pow(to[o + c] / 255, 2.2) + extra[c]);
      }
    }
  }
}
