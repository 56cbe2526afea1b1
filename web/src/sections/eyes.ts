// SPDX-License-Identifier: Apache-2.0
// The wearer's eyes behind the lenses, as a camera sees them, with the size of the iris measured in
// that picture beside three predictions.

import { type Sheet } from "../app/engine";
import {
  measuredIris, outlineOf, pupilsOf, renderLens, type PixelBox, type Shown,
} from "../app/eye_picture";
import { HEIGHT, PX_PER_MM, WIDTH, WINDOW, drawFace, drawFrame, drawPhoto } from "../app/face";
import { fixed } from "../app/format";
import { EYES, type EyeName } from "../app/order";
import type { Store } from "../app/store";
import { t, type TextKey } from "../app/texts";
import { h, setText } from "../ui/dom";
import { photoMarks, type PhotoMarks } from "./photo";

const SHADOW_SHRINK = 4;

const canvasOf = (width: number, height: number): [HTMLCanvasElement, CanvasRenderingContext2D] => {
  const canvas = h("canvas", { width, height });
  return [canvas, canvas.getContext("2d", { willReadFrequently: true })!];
};

// A lens as it was last painted, and what it was painted of.
interface Painted {
  sheet: Sheet;
  key: string;
  canvas: HTMLCanvasElement;
  box: PixelBox;
}

export function eyesSection(
  store: Store,
  wanted: () => boolean,
  explain: (key: string) => void,
): HTMLElement {
  const [canvas, ctx] = canvasOf(WIDTH, HEIGHT);
  canvas.className = "face";
  canvas.setAttribute("role", "img");
  const [, base] = canvasOf(WIDTH, HEIGHT);
  const readout = h("table", { class: "iris" });
  const bare = h("input", { type: "checkbox", onchange: () => draw() });
  const rings = h("input", { type: "checkbox", onchange: () => draw() });
  const mirrored = h("input", { type: "checkbox", onchange: () => draw() });
  const noFrame = h("input", { type: "checkbox", onchange: () => draw() });
  let photo: PhotoMarks | null = null;
  let baseKey = "";
  let source: ImageData | null = null;

  const photos = photoMarks((marks) => {
    photo = marks;
    baseKey = "";
    draw();
  });
  const prismHint = h("p", { class: "hint" }, t("eyes.prismHint"));
  const root = h("section", { class: "card eyes" },
    h("div", { class: "card-head" }, h("h2", {}, t("eyes.title")),
      h("div", { class: "checks" },
        h("label", {}, bare, t("eyes.bare")),
        h("label", {}, noFrame, t("eyes.noFrame")),
        h("label", {}, mirrored, t("eyes.mirrored")),
        h("label", {}, rings, t("eyes.rings")))),
    canvas, photos, readout, prismHint, h("p", { class: "hint" }, t("eyes.hint")));

  const cell = new Map<string, HTMLElement>();
  const line = (key: TextKey, name: string): HTMLElement =>
    h("tr", {}, h("th", { scope: "row" },
      h("button", { type: "button", class: "why-link", onclick: () => explain("observer") }, t(key))),
    ...EYES.map((eye) => {
      const td = h("td", { "data-iris": `${name}-${eye}` });
      cell.set(`${name}-${eye}`, td);
      return td;
    }));
  readout.append(
    h("thead", {}, h("tr", {}, h("td", {}),
      ...EYES.map((eye) => h("th", { scope: "col" }, t(`eye.${eye}` as TextKey))))),
    h("tbody", {}, line("eyes.measured", "measured"), line("eyes.exact", "exact"),
      line("eyes.paraxial", "paraxial"), line("eyes.thin", "thin")));

  const painted: Partial<Record<EyeName, Painted>> = {};
  // The face with the frame's shadow on it.
  const [behind, behindContext] = canvasOf(WIDTH, HEIGHT);
  let drawnBehind = "";
  const shortened = ([x, y]: [number, number]): string => `${x.toFixed(2)} ${y.toFixed(2)}`;

  function draw(): void {
    const { order, sheet } = store.lenses;
    const pupils = pupilsOf(order);
    const key = JSON.stringify([pupils, photo?.version ?? 0]);
    if (key !== baseKey || !source) {
      baseKey = key;
      if (photo) drawPhoto(base, photo.image, photo.marks, pupils);
      else drawFace(base, pupils);
      source = base.getImageData(0, 0, WIDTH, HEIGHT);
    }
    const outlines = EYES.map((eye) => outlineOf(store.engine, order, eye));
    const shaded = !bare.checked && !noFrame.checked;
    // A blur of the whole picture is dear, and no power changes it.
    const behindKey = `${key} ${shaded ? outlines.map((o) => o.map(shortened)) : ""}`;
    if (behindKey !== drawnBehind) {
      drawnBehind = behindKey;
      behindContext.putImageData(source, 0, 0);
      if (shaded) shadow(behindContext, outlines);
    }
    ctx.drawImage(behind, 0, 0);
    if (!bare.checked) {
      EYES.forEach((eye, i) => paintLens(eye, outlines[i]));
      if (!noFrame.checked) drawFrame(ctx, outlines, "#23262b");
    }
    prismHint.hidden = EYES.every((eye) => order[eye].prismIn === 0 && order[eye].prismUp === 0);
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
    const shown: Shown = { rings: rings.checked, mirrored: mirrored.checked };
    const key = JSON.stringify([baseKey, shown]);
    let lens = painted[eye];
    if (!lens || lens.sheet !== sheet[eye] || lens.key !== key) {
      const box = { px: Math.floor(Math.min(...px)), py: Math.floor(Math.min(...py)), w: 0, h: 0 };
      box.w = Math.ceil(Math.max(...px)) - box.px;
      box.h = Math.ceil(Math.max(...py)) - box.py;
      const [canvas, context] = canvasOf(box.w, box.h);
      const image = context.createImageData(box.w, box.h);
      renderLens(store.engine, order, sheet[eye], eye, source!, box, image, shown);
      context.putImageData(image, 0, 0);
      lens = painted[eye] = { sheet: sheet[eye], key, canvas, box };
    }
    ctx.save();
    ctx.beginPath();
    px.forEach((x, i) => (i ? ctx.lineTo(x, py[i]) : ctx.moveTo(x, py[i])));
    ctx.closePath();
    ctx.clip();
    ctx.drawImage(lens.canvas, lens.box.px, lens.box.py);
    ctx.restore();
  }
  store.onLenses(draw, wanted);
  return root;
}

// A soft shadow of the rim on the skin below it. Drawn and blurred small, since a blur of the whole
// picture in software was a quarter of the time to the first view.
function shadow(ctx: CanvasRenderingContext2D, outlines: [number, number][][]): void {
  const [sharp, sharpContext] = canvasOf(WIDTH / SHADOW_SHRINK, HEIGHT / SHADOW_SHRINK);
  const lower = outlines.map((o) => o.map(([x, y]): [number, number] => [x, y - 3]));
  drawFrame(sharpContext, lower, "#000", PX_PER_MM / SHADOW_SHRINK);
  const [soft, softContext] = canvasOf(sharp.width, sharp.height);
  softContext.filter = `blur(${7 / SHADOW_SHRINK}px)`;
  softContext.drawImage(sharp, 0, 0);
  ctx.save();
  ctx.globalAlpha = 0.22;
  ctx.drawImage(soft, 0, 0, WIDTH, HEIGHT);
  ctx.restore();
}
