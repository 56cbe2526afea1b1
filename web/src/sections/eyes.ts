// SPDX-License-Identifier: Apache-2.0
// The wearer's eyes behind the lenses, as a camera sees them: every point of a lens is looked up
// where the exact ray from the camera through that point meets the face.

import { SLOT, type Engine, type Sheet, type View } from "../app/engine";
import {
  FACE_SHAPE, HEIGHT, PX_PER_MM, WIDTH, WINDOW, drawFace, drawFrame, drawPhoto, type Pupils,
} from "../app/face";
import { fixed } from "../app/format";
import { contourOf } from "../app/frames";
import { EYES, IRIS_RADIUS_MM, type EyeName, type Order } from "../app/order";
import type { Store } from "../app/store";
import { t, type TextKey } from "../app/texts";
import { h, setText } from "../ui/dom";
import { photoMarks, type PhotoMarks } from "./photo";

// One exact ray every so many pixels, linear between them; the rings' sharp borders want it finer.
const GRID_PX = 3;
const GRID_WITH_RINGS_PX = 1.5;
const IRIS_SAMPLES = 241;
const EDGE_LIGHT = 0.8; // of a ground edge in the room's light, white being 1
const RINGS_SHOWN = 4; // times as bright, and said so: real ones are faint but before a lamp

// +x of the lens frame is the wearer's right: the viewer's left.
const side = (eye: EyeName): 1 | -1 => (eye === "right" ? 1 : -1);

function viewOf(order: Order, eye: EyeName): Omit<View, "x0" | "x1" | "y0" | "y1" | "rings"> {
  const pd = order[eye].pd;
  return {
    camera_mm: order.camera,
    cx: -side(eye) * pd,
    cy: 0,
    depth_mm: order.vertex + 3.05,
    face_x_mm: side(eye) * pd,
    ...FACE_SHAPE,
  };
}

// Where the camera sees a point of the face without the lens, in the plane of the lens.
function bareScale(order: Order, sheet: Sheet, faceX: number): number {
  const beyond = Math.max(0, Math.abs(faceX) - FACE_SHAPE.flat_mm);
  const depth = order.vertex + 3.05 + (FACE_SHAPE.curve * beyond * beyond) / 100;
  return order.camera / (order.camera + sheet.center_thickness_mm + depth);
}

export function pupilsOf(order: Order, sheet: Record<EyeName, Sheet>): Pupils {
  const at = (eye: EyeName): { x: number; y: number } => ({
    x: -side(eye) * order[eye].pd * bareScale(order, sheet[eye], order[eye].pd),
    y: 0,
  });
  return { right: at("right"), left: at("left") };
}

// Width of the iris in the picture over that without lenses, along the horizontal through it.
export function measuredIris(engine: Engine, order: Order, sheet: Sheet, eye: EyeName): number | null {
  const pd = order[eye].pd;
  const reach = 4 * IRIS_RADIUS_MM;
  const map = engine.view(SLOT[eye],
    { ...viewOf(order, eye), x0: -reach, x1: reach, y0: -1e-6, y1: 1e-6, rings: false }, IRIS_SAMPLES, 1);
  const at = (i: number): number => -reach + (2 * reach * (i + 0.5)) / IRIS_SAMPLES;
  const edge = (target: number): number | null => {
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
  return (high - low) / (2 * IRIS_RADIUS_MM * bareScale(order, sheet, pd));
}

// Fills `out` (the lens's box in the picture, w x h pixels from px, py) from `source`.
function renderLens(
  engine: Engine,
  order: Order,
  sheet: Sheet,
  eye: EyeName,
  source: ImageData,
  box: { px: number; py: number; w: number; h: number },
  out: ImageData,
  withRings: boolean,
): void {
  const grid = withRings ? GRID_WITH_RINGS_PX : GRID_PX;
  const pd = order[eye].pd;
  const gw = Math.ceil(box.w / grid) + 1;
  const gh = Math.ceil(box.h / grid) + 1;
  // Grid points sit at multiples of `grid`; the optics counts the middles of its cells.
  const toLens = (px: number): number => -(WINDOW.left + px / PX_PER_MM) - side(eye) * pd;
  const half = grid / 2;
  const view: View = {
    ...viewOf(order, eye),
    x0: toLens(box.px - half),
    x1: toLens(box.px + gw * grid - half),
    y1: WINDOW.top - (box.py - half) / PX_PER_MM,
    y0: WINDOW.top - (box.py + gh * grid - half) / PX_PER_MM,
    rings: withRings,
  };
  const map = engine.view(SLOT[eye], view, gw, gh);
  const rings = withRings ? engine.rings(gw * gh) : new Float32Array(0);
  // From points of the face to pixels of the source; the light kept stays as it is.
  for (let k = 0; k < gw * gh; ++k) {
    if (map[4 * k] !== 0) continue;
    const faceX = map[4 * k + 1] + side(eye) * pd;
    const scale = bareScale(order, sheet, faceX);
    map[4 * k + 1] = (-faceX * scale - WINDOW.left) * PX_PER_MM;
    map[4 * k + 2] = (WINDOW.top - map[4 * k + 2] * scale) * PX_PER_MM;
  }
  // The map's light is that of bare surfaces by angle; coat and tint enter as they do straight on.
  const bare = (1 - ((sheet.index_d - 1) / (sheet.index_d + 1)) ** 2) ** 2;
  const filter = sheet.luminous_transmittance / bare;
  // A coat takes from the rings what it takes from the reflections of a bare lens.
  const untinted = sheet.luminous_transmittance / (1 - order.tint / 100);
  const ringLight = (RINGS_SHOWN * EDGE_LIGHT * Math.max(0, 1 - untinted)) /
    (1 - (2 * sheet.index_d) / (sheet.index_d ** 2 + 1));
  const from = source.data;
  const to = out.data;
  const { width, height } = source;
  for (let j = 0; j < box.h; ++j) {
    const gj = Math.floor((j + 0.5) / grid);
    const fj = (j + 0.5) / grid - gj;
    for (let i = 0; i < box.w; ++i) {
      const gi = Math.floor((i + 0.5) / grid);
      const fi = (i + 0.5) / grid - gi;
      const k = 4 * (gj * gw + gi);
      const kd = k + 4 * gw;
      const o = 4 * (j * box.w + i);
      to[o + 3] = 255;
      if (map[k] !== 0 || map[k + 4] !== 0 || map[kd] !== 0 || map[kd + 4] !== 0) {
        to[o] = to[o + 1] = to[o + 2] = 60;
        continue;
      }
      const w00 = (1 - fi) * (1 - fj);
      const w10 = fi * (1 - fj);
      const w01 = (1 - fi) * fj;
      const w11 = fi * fj;
      const x = w00 * map[k + 1] + w10 * map[k + 5] + w01 * map[kd + 1] + w11 * map[kd + 5] - 0.5;
      const y = w00 * map[k + 2] + w10 * map[k + 6] + w01 * map[kd + 2] + w11 * map[kd + 6] - 0.5;
      const kept = filter * (w00 * map[k + 3] + w10 * map[k + 7] + w01 * map[kd + 3] + w11 * map[kd + 7]);
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
        to[o + c] = gain * (top + fy * (low - top));
      }
      const q = gj * gw + gi;
      const ring = !withRings ? 0 : ringLight *
        (w00 * rings[q] + w10 * rings[q + 1] + w01 * rings[q + gw] + w11 * rings[q + gw + 1]);
      if (ring > 0.002) {
        for (let c = 0; c < 3; ++c) {
          to[o + c] = 255 * Math.pow(Math.pow(to[o + c] / 255, 2.2) + ring, 1 / 2.2);
        }
      }
    }
  }
}

const canvasOf = (width: number, height: number): [HTMLCanvasElement, CanvasRenderingContext2D] => {
  const canvas = h("canvas", { width, height });
  return [canvas, canvas.getContext("2d", { willReadFrequently: true })!];
};

export function eyesSection(store: Store, wanted: () => boolean): HTMLElement {
  const [canvas, ctx] = canvasOf(WIDTH, HEIGHT);
  canvas.className = "face";
  canvas.setAttribute("role", "img");
  const [, base] = canvasOf(WIDTH, HEIGHT);
  const readout = h("table", { class: "iris" });
  const bare = h("input", { type: "checkbox", onchange: () => draw() });
  const rings = h("input", { type: "checkbox", onchange: () => draw() });
  const noFrame = h("input", { type: "checkbox", onchange: () => draw() });
  let photo: PhotoMarks | null = null;
  let baseKey = "";
  let source: ImageData | null = null;

  const photos = photoMarks((marks) => {
    photo = marks;
    baseKey = "";
    draw();
  });
  const root = h("section", { class: "card eyes" },
    h("div", { class: "card-head" }, h("h2", {}, t("eyes.title")),
      h("div", { class: "checks" },
        h("label", {}, bare, t("eyes.bare")),
        h("label", {}, noFrame, t("eyes.noFrame")),
        h("label", {}, rings, t("eyes.rings")))),
    canvas, photos, readout, h("p", { class: "hint" }, t("eyes.hint")));

  const cell = new Map<string, HTMLElement>();
  const line = (key: TextKey, name: string): HTMLElement =>
    h("tr", {}, h("th", { scope: "row" }, t(key)), ...EYES.map((eye) => {
      const td = h("td", { "data-iris": `${name}-${eye}` });
      cell.set(`${name}-${eye}`, td);
      return td;
    }));
  readout.append(
    h("thead", {}, h("tr", {}, h("td", {}),
      ...EYES.map((eye) => h("th", { scope: "col" }, t(`eye.${eye}` as TextKey))))),
    h("tbody", {}, line("eyes.measured", "measured"), line("eyes.exact", "exact"),
      line("eyes.paraxial", "paraxial"), line("eyes.thin", "thin")));

  function draw(): void {
    const { order, sheet } = store.lenses;
    const pupils = pupilsOf(order, sheet);
    const irisRadius = IRIS_RADIUS_MM * bareScale(order, sheet.right, order.right.pd);
    const key = JSON.stringify([pupils, irisRadius, photo?.version ?? 0]);
    if (key !== baseKey || !source) {
      baseKey = key;
      if (photo) drawPhoto(base, photo.image, photo.marks, pupils);
      else drawFace(base, pupils, irisRadius);
      source = base.getImageData(0, 0, WIDTH, HEIGHT);
    }
    ctx.putImageData(source, 0, 0);
    const outlines = EYES.map((eye) =>
      contourOf(order, eye).map(([x, y]): [number, number] => [-x - side(eye) * order[eye].pd, y]));
    if (!bare.checked) {
      if (!noFrame.checked) shadow(ctx, outlines);
      EYES.forEach((eye, i) => paintLens(eye, outlines[i]));
      if (!noFrame.checked) drawFrame(ctx, outlines, "#23262b");
    }
    const iris = { right: 1, left: 1 };
    for (const eye of EYES) {
      const s = sheet[eye];
      const measured = measuredIris(store.engine, order, s, eye);
      iris[eye] = measured ?? 1;
      setText(cell.get(`measured-${eye}`)!, measured === null ? "–" : fixed(measured, 4));
      setText(cell.get(`exact-${eye}`)!,
        s.observer_magnification_exact === null ? "–" : fixed(s.observer_magnification_exact, 4));
      setText(cell.get(`paraxial-${eye}`)!, fixed(s.observer_magnification_paraxial, 4));
      setText(cell.get(`thin-${eye}`)!, fixed(s.observer_magnification_thin, 4));
    }
    canvas.setAttribute("aria-label", t("eyes.alt", {
      right: fixed(100 * iris.right, 1),
      left: fixed(100 * iris.left, 1),
    }));
  }

  function paintLens(eye: EyeName, outline: [number, number][]): void {
    const { order, sheet } = store.lenses;
    const px = outline.map(([x]) => (x - WINDOW.left) * PX_PER_MM);
    const py = outline.map(([, y]) => (WINDOW.top - y) * PX_PER_MM);
    const box = { px: Math.floor(Math.min(...px)), py: Math.floor(Math.min(...py)), w: 0, h: 0 };
    box.w = Math.ceil(Math.max(...px)) - box.px;
    box.h = Math.ceil(Math.max(...py)) - box.py;
    const [lens, lensContext] = canvasOf(box.w, box.h);
    const image = lensContext.createImageData(box.w, box.h);
    renderLens(store.engine, order, sheet[eye], eye, source!, box, image, rings.checked);
    lensContext.putImageData(image, 0, 0);
    ctx.save();
    ctx.beginPath();
    px.forEach((x, i) => (i ? ctx.lineTo(x, py[i]) : ctx.moveTo(x, py[i])));
    ctx.closePath();
    ctx.clip();
    ctx.drawImage(lens, box.px, box.py);
    ctx.restore();
  }
  store.onLenses(draw, wanted);
  return root;
}

// A soft shadow of the rim on the skin below it.
function shadow(ctx: CanvasRenderingContext2D, outlines: [number, number][][]): void {
  ctx.save();
  ctx.filter = "blur(7px)";
  ctx.globalAlpha = 0.22;
  drawFrame(ctx, outlines.map((o) => o.map(([x, y]): [number, number] => [x, y - 3])), "#000");
  ctx.restore();
}
