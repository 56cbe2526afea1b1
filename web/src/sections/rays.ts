// SPDX-License-Identifier: Apache-2.0
// Object, lens, eye: exact rays that bend as the order changes, for the wearer and for an observer.

import { SLOT, type FanRay, type Sheet, type Worn } from "../app/engine";
import { fixed } from "../app/format";
import { contourOf, reach } from "../app/frames";
import { PUPIL_DEPTH_MM } from "../app/eye_picture";
import { IRIS_RADIUS_MM, meridiansOf, type Order } from "../app/order";
import type { Store } from "../app/store";
import { t, type TextKey } from "../app/texts";
import { view } from "../app/view";
import { direct, straight } from "../app/worn";
import { h, s, setText, uniqueId } from "../ui/dom";
import { eyeSwitch } from "../ui/eye_switch";

const EYE_RADIUS_MM = 12;
const FAN = 9;
const BODY_POINTS = 60;
const OBSERVER_FAN = 401;

type Mode = "wearer" | "far" | "observer";

interface Frame {
  z0: number;
  z1: number;
  half: number; // height shown, mm
}

const H = 400;
// As in style.css: a narrow drawing is a taller one.
const narrow = matchMedia("(max-width: 480px)");

export function raysSection(store: Store, wanted: () => boolean): HTMLElement {
  let mode: Mode = "wearer";
  const drawing = s("svg", { role: "img", class: "rays-drawing" });
  const told = h("p", { class: "told", role: "status", "aria-live": "polite" });
  const slider = (
    key: string, min: number, max: number, step: number, value: number, show: (v: number) => string,
  ): { root: HTMLElement; value: () => number } => {
    const id = uniqueId("rays");
    const out = h("output", { for: id }, show(value));
    const input = h("input", { id, type: "range", min, max, step, value, oninput: () => {
      setText(out, show(Number(input.value)));
      input.setAttribute("aria-valuetext", show(Number(input.value)));
      draw();
    } });
    return {
      root: h("div", { class: "field" }, h("label", { for: id }, t(`rays.${key}` as TextKey)), input, out),
      value: () => Number(input.value),
    };
  };
  const vergence = slider("object", -4, 0, 0.25, 0, (v) =>
    v === 0 ? "∞" : `${fixed(-1000 / v, 0)} mm`);
  const field = slider("field", -30, 30, 1, 0, (v) => `${fixed(v, 0)}°`);
  const meridian = h("select", { id: uniqueId("meridian"), onchange: () => draw() },
    ...(["along", "across"] as const).map((m) => h("option", { value: m }, t(`why.${m}`))),
    ...(["vertical", "horizontal"] as const).map((m) => h("option", { value: m }, t(`rays.${m}`))));
  const name = uniqueId("rays-mode");
  const modes = (["wearer", "far", "observer"] as Mode[]).map((m) =>
    h("label", {}, h("input", { type: "radio", name, value: m, checked: m === mode, onchange: () => {
      mode = m;
      draw();
    } }), t(`rays.${m}` as TextKey)));
  const controls = h("div", { class: "ray-controls" }, vergence.root, field.root,
    h("div", { class: "field" }, h("label", { for: meridian.id }, t("rays.meridian")), meridian));
  const root = h("section", { class: "card rays" },
    h("div", { class: "card-head" }, h("h2", {}, t("rays.title")), eyeSwitch()),
    h("fieldset", { class: "switch modes" }, h("legend", { class: "visually-hidden" }, t("rays.mode")),
      ...modes),
    drawing, told, controls, h("p", { class: "hint" }, t("rays.hint")));

  // The meridian shown, and its place in pairs of the sheet; null where it is no principal one.
  function meridianShown(sheet: Sheet): { degrees: number; which: 0 | 1 | null } {
    const [along, across] = meridiansOf(sheet);
    if (meridian.value === "along") return { degrees: along, which: 0 };
    if (meridian.value === "across") return { degrees: across, which: 1 };
    const degrees = meridian.value === "vertical" ? 90 : 180;
    const round = Math.abs(sheet.made.cylinder) < 1e-9;
    return { degrees, which: round || degrees === along ? 0 : degrees === across ? 1 : null };
  }

  function draw(): void {
    const { order, sheet: sheets } = store.lenses;
    const { engine } = store;
    const { eye } = view;
    const slot = SLOT[eye];
    const sheet = sheets[eye];
    const { degrees, which } = meridianShown(sheet);
    const worn = engine.worn(slot);
    const a = (degrees * Math.PI) / 180;
    const [ux, uy] = [-Math.cos(a), Math.sin(a)];
    const [low, high] = reach(contourOf(order, eye), ux, uy);
    const thick = sheet.center_thickness_mm;
    const cornea = thick + order.vertex;
    const cardinal = which === null ? null : sheet.cardinal[which];
    const focus = cardinal?.back_focal_mm ?? null; // from the back vertex
    controls.classList.toggle("observing", mode === "observer");

    const far = Math.min(1500, Math.max(80, Math.abs(focus ?? 1500) * 1.15));
    // The whole lens, and in the wearer's view heights and lengths to one scale.
    const half = Math.max(27, 1.06 * high, -1.06 * low);
    const W = narrow.matches ? 560 : 920;
    drawing.setAttribute("viewBox", `0 0 ${W} ${H}`);
    const long = (half * W) / H;
    const eyesEnd = cornea + 2 * EYE_RADIUS_MM + 2;
    const before = narrow.matches ? 0.7 : 1; // the eye behind the lens has to be in sight
    const frame: Frame =
      mode === "wearer"
        ? { z0: -before * long, z1: (2 - before) * long, half }
        : mode === "far"
          ? { z0: -far, z1: (focus ?? -1) > 0 ? far : Math.max(0.35 * far, eyesEnd), half }
          : { z0: -Math.min(order.camera, 120) - 6, z1: eyesEnd, half };
    const x = (z: number): number => ((z - frame.z0) / (frame.z1 - frame.z0)) * W;
    const y = (height: number): number => H / 2 - (height / frame.half) * (H / 2);
    const at = (height: number, z: number): string => `${x(z).toFixed(2)} ${y(height).toFixed(2)}`;
    const parts: SVGElement[] = [];
    const line = (points: [number, number][], className: string): void => {
      parts.push(s("path", { class: className, d: `M${points.map((p) => at(p[0], p[1])).join("L")}` }));
    };
    const label = (height: number, z: number, text: string, anchor = "middle"): void => {
      parts.push(s("text", { x: x(z), y: y(height), "text-anchor": anchor }, text));
    };

    line([[0, frame.z0], [0, frame.z1]], "axis");
    drawEyeball(parts, x, y, cornea);
    drawBody(parts, at, slot, worn, low, high, ux, uy);
    // Points of the lens's own axis, (height, z) in the drawing.
    const onAxis = (z: number): [number, number] => {
      const [px, py, pz] = straight(worn, [0, 0, z]);
      return [px * ux + py * uy, pz];
    };
    if (onAxis(-1)[0] !== 0) line([onAxis(frame.z0), onAxis(frame.z1)], "axis");

    if (mode === "observer") drawObserver(slot, degrees, cornea, order, frame.z1, line, label);
    else drawFan(slot, degrees, low, high, frame, line);

    const mark = (z: number | null | undefined, text: string): void => {
      if (z === null || z === undefined || z < frame.z0 || z > frame.z1) return;
      const [height, along] = onAxis(z);
      parts.push(s("circle", { class: "focal", cx: x(along), cy: y(height), r: 4 }));
      label(height - 2.2, along, text);
    };
    mark(cardinal?.front_focal_mm, "F");
    mark(focus === null ? null : thick + focus, "F′");
    for (const [z, text, lift] of [
      [cardinal?.front_principal_mm, "H", 1], [cardinal ? thick + (cardinal.back_principal_mm ?? 0) : null, "H′", -1],
    ] as const) {
      if (z === null || z === undefined || mode === "far" || Math.abs(z) > 40) continue;
      const [height, along] = onAxis(z);
      const [tx, ty, tz] = direct(worn, [ux, uy, 0]);
      const up = tx * ux + ty * uy;
      line([[height - 5 * up, along - 5 * tz], [height + 5 * up, along + 5 * tz]], "plane");
      label(height + (lift > 0 ? 5.6 : -6.6), along + (lift > 0 ? 5.6 : -6.6) * tz, text);
    }
    drawing.replaceChildren(...parts);
    drawing.setAttribute("aria-label", told.textContent ?? "");

    function drawFan(
      lens: number, angle: number, from: number, to: number, f: Frame,
      stroke: (points: [number, number][], className: string) => void,
    ): void {
      const v = vergence.value();
      const object = v === 0 ? 0 : -1000 / v;
      const half = 0.92 * Math.min(-from, to, 24);
      const tilt = field.value();
      const height = -object * Math.tan((tilt * Math.PI) / 180);
      const rays = engine.fan(lens, angle, half, FAN, tilt, object, height);
      for (const ray of rays) {
        if (!ray.ok) {
          if (ray.front[1] || ray.front[0]) stroke([ray.start, ray.front], "ray lost");
          continue;
        }
        const slope = ray.direction[0] / ray.direction[1];
        const before = Math.max(ray.start[1], f.z0);
        const inSlope = (ray.front[0] - ray.start[0]) / (ray.front[1] - ray.start[1]);
        // Rays that came from infinity go on to the drawing's edge.
        const startZ = object === 0 ? f.z0 : before;
        const end = mode === "wearer" ? cornea + PUPIL_DEPTH_MM : f.z1;
        stroke([
          [ray.front[0] + inSlope * (startZ - ray.front[1]), startZ],
          ray.front,
          ray.back,
          [ray.back[0] + slope * (end - ray.back[1]), end],
        ], "ray");
        stroke([ray.back, [ray.back[0] + slope * (f.z0 - ray.back[1]), f.z0]], "ray back");
      }
      const text = which === null ? t("rays.toldSkew") : focus === null
        ? t("rays.toldAfocal")
        : t(focus < 0 ? "rays.toldMinus" : "rays.toldPlus", { mm: fixed(Math.abs(focus), 0) });
      setText(told, text);
    }
  }

  function drawEyeball(
    parts: SVGElement[], x: (z: number) => number, y: (h: number) => number, cornea: number,
  ): void {
    const rx = x(cornea + EYE_RADIUS_MM) - x(cornea);
    const ry = y(0) - y(EYE_RADIUS_MM);
    const iris = cornea + PUPIL_DEPTH_MM;
    parts.push(
      s("ellipse", { class: "eyeball", cx: x(cornea + EYE_RADIUS_MM), cy: y(0), rx, ry }),
      s("path", { class: "iris-line", d:
        `M${x(iris)} ${y(IRIS_RADIUS_MM)}L${x(iris)} ${y(2)}M${x(iris)} ${y(-2)}L${x(iris)} ${y(-IRIS_RADIUS_MM)}` }),
      s("circle", { class: "rotation", cx: x(cornea + 13.5), cy: y(0), r: 2.5 }),
    );
  }

  function drawBody(
    parts: SVGElement[], at: (height: number, z: number) => string, slot: number, worn: Worn,
    low: number, high: number, ux: number, uy: number,
  ): void {
    const heights = Array.from({ length: BODY_POINTS + 1 }, (_, i) => low + ((high - low) * i) / BODY_POINTS);
    const z = store.engine.surfaces(slot, heights.flatMap((r) => [r * ux, r * uy]));
    const placed = (r: number, depth: number): string => {
      const [px, py, pz] = straight(worn, [r * ux, r * uy, depth]);
      return at(px * ux + py * uy, pz);
    };
    const front = heights.map((r, i) => placed(r, z[2 * i]));
    const back = heights.map((r, i) => placed(r, z[2 * i + 1])).reverse();
    parts.push(s("path", { class: "lens-body", d: `M${front.join("L")}L${back.join("L")}Z` }));
  }

  // The ray from the camera to the iris' edge, and where the edge therefore seems to be.
  function drawObserver(
    slot: number, degrees: number, cornea: number, order: Order, end: number,
    line: (points: [number, number][], className: string) => void,
    label: (height: number, z: number, text: string, anchor?: string) => void,
  ): void {
    const rays = store.engine.fan(slot, degrees, 12, OBSERVER_FAN, 0, order.camera, 0);
    const iris = cornea + PUPIL_DEPTH_MM;
    const heightAt = (ray: FanRay): number =>
      ray.back[0] + ((iris - ray.back[1]) * ray.direction[0]) / ray.direction[1];
    for (const target of [IRIS_RADIUS_MM, -IRIS_RADIUS_MM]) {
      const i = rays.findIndex((ray, k) =>
        k > 0 && ray.ok && rays[k - 1].ok &&
        (heightAt(rays[k - 1]) - target) * (heightAt(ray) - target) <= 0);
      if (i < 1) continue;
      const [p, q] = [rays[i - 1], rays[i]];
      const f = (target - heightAt(p)) / (heightAt(q) - heightAt(p));
      const mix = (u: [number, number], v: [number, number]): [number, number] => [
        u[0] + f * (v[0] - u[0]), u[1] + f * (v[1] - u[1])];
      const front = mix(p.front, q.front);
      const tangent = front[0] / (order.camera + front[1]);
      const apparent = tangent * (order.camera + iris);
      line([[0, -order.camera], front, mix(p.back, q.back), [target, iris]], "ray");
      line([front, [apparent, iris]], "ray back");
      line([[apparent - 0.35 * Math.sign(target), iris], [apparent + 0.35 * Math.sign(target), iris]], "apparent");
      if (target > 0) {
        const ratio = apparent / target;
        label(EYE_RADIUS_MM + 2, end - 1, t(ratio > 1 ? "rays.larger" : "rays.smaller"), "end");
        setText(told, t("rays.toldObserver", {
          mm: fixed(apparent, 2), bare: fixed(target, 2), ratio: fixed(ratio, 4),
        }));
      }
    }
    label(2, -Math.min(order.camera, 120), t("rays.toCamera", { mm: fixed(order.camera, 0) }), "start");
  }

  store.onLenses(draw, wanted);
  const again = (): void => {
    if (wanted()) draw();
  };
  view.onChange(again);
  narrow.addEventListener("change", again);
  return root;
}
