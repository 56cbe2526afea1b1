// SPDX-License-Identifier: Apache-2.0
// Power, astigmatism, prism and distortion over the lens as the turning eye meets them, and the
// front surface of a progressive lens with Minkwitz' law.

import { GAZE_ROW, SLOT } from "../app/engine";
import { fixed, signed } from "../app/format";
import { contourOf } from "../app/frames";
import { meridiansOf } from "../app/order";
import type { Store } from "../app/store";
import { t, type TextKey } from "../app/texts";
import { view } from "../app/view";
import { chart } from "../ui/chart";
import { aroundZero, heatPicture, isoLine, rising, roundLevels, type Grid } from "../ui/contour";
import { h, s, setText, uniqueId } from "../ui/dom";
import { eyeSwitch } from "../ui/eye_switch";

const STOP_MM = 27; // back vertex to the centre of rotation of the eye
const COLUMNS = 49;
const ROWS = 41;
const LINE_STEPS = 40;
const LINE_MAX_DEG = 40;
const LABEL_MM = [8, 3.4]; // room for a label of a line
// Lines lie a hair above their level: a zone that is flat at a round power has no line through it.
const ABOVE = 1e-6;
const PROGRESSIVE_GRID = 61;
const COLOURED = 0.97; // share of the lens whose values the colours span
const PROGRESSIVE_HALF_MM = 28;

const KINDS = ["power", "astigmatism", "prism", "distortion", "progPower", "progAstigmatism"] as const;
type Kind = (typeof KINDS)[number];

interface Field {
  grid: Grid;
  halfX: number;
  halfY: number;
  outline: [number, number][]; // viewer's x, y downwards
  unit: string;
  signed: boolean;
}

export type MapKind = Kind;
export interface MapsSection {
  root: HTMLElement;
  choose(kind: MapKind): void;
}

export function mapsSection(store: Store, wanted: () => boolean): MapsSection {
  let kind: Kind = "astigmatism";
  let field: Field | null = null;
  const select = h("select", { id: uniqueId("map"), onchange: () => {
    kind = select.value as Kind;
    draw();
  } }, ...KINDS.map((k) => h("option", { value: k, selected: k === kind }, t(`maps.${k}` as TextKey))));
  const drawing = s("svg", { class: "map-drawing", role: "application", tabindex: 0 });
  const probe = s("circle", { class: "probe", r: 1.1, visibility: "hidden" });
  let probed: [number, number] | null = null; // column and row
  const readout = h("p", { class: "told", role: "status", "aria-live": "polite" });
  const summary = h("p", { class: "hint" });
  const text = h("p", { class: "hint" });
  const legend = h("div", { class: "legend" });
  const gazeChart = chart(t("maps.gaze"), t("maps.error"), [
    { label: t("maps.sagittal"), colour: "--accent" },
    { label: t("maps.tangential"), colour: "--ray" },
  ]);
  const minkwitzChart = chart(t("maps.beside"), t("maps.astigmatismD"), [
    { label: t("maps.surface"), colour: "--accent" },
    { label: t("maps.minkwitz"), colour: "--ray", dash: [6, 4] },
  ]);
  const gazeFigure = h("figure", {}, h("figcaption", {}, t("maps.gazeTitle")), gazeChart.root);
  const minkwitzFigure = h("figure", {}, h("figcaption", {}, t("maps.minkwitzTitle")), minkwitzChart.root);

  const root = h("section", { class: "card maps" },
    h("div", { class: "card-head" }, h("h2", {}, t("maps.title")), eyeSwitch()),
    h("div", { class: "compare-controls" },
      h("div", { class: "field" }, h("label", { for: select.id }, t("maps.show")), select)),
    h("div", { class: "map-columns" },
      h("div", { class: "map-main" }, drawing, legend, readout, summary),
      h("div", {}, gazeFigure, minkwitzFigure)),
    text);

  function gazeField(): Field {
    const { order } = store.lenses;
    const contour = contourOf(order, view.eye);
    const halfX = Math.max(...contour.map(([x]) => Math.abs(x)));
    const halfY = Math.max(...contour.map(([, y]) => Math.abs(y)));
    const rows = store.engine.gazeMap(SLOT[view.eye], STOP_MM, halfX, halfY, COLUMNS, ROWS);
    const values = new Float64Array(COLUMNS * ROWS);
    for (let k = 0; k < values.length; ++k) {
      const r = rows.subarray(GAZE_ROW * k, GAZE_ROW * (k + 1));
      // The lens frame's +x is on the viewer's left.
      const mirrored = Math.floor(k / COLUMNS) * COLUMNS + (COLUMNS - 1 - (k % COLUMNS));
      values[mirrored] = r[0] !== 0 ? Number.NaN
        : kind === "power" ? r[1]
        : kind === "astigmatism" ? 2 * Math.hypot(r[2], r[3])
        : kind === "prism" ? Math.hypot(r[4], r[5])
        : 100 * (Math.hypot(r[6], r[7]) / Math.hypot(r[8], r[9]) - 1);
    }
    // In the very middle the ratio of two zeros stands for its limit beside it.
    const middle = (ROWS >> 1) * COLUMNS + (COLUMNS >> 1);
    if (kind === "distortion") values[middle] = values[middle + 1];
    return {
      grid: { n: COLUMNS, m: ROWS, values },
      halfX,
      halfY,
      outline: contour.map(([x, y]): [number, number] => [-x, -y]),
      unit: kind === "prism" ? "Δ" : kind === "distortion" ? "%" : "D",
      signed: kind === "power" || kind === "distortion",
    };
  }

  function progressiveField(): Field {
    const { order, sheet } = store.lenses;
    const { corridor } = order;
    const add = order[view.eye].add;
    const n = PROGRESSIVE_GRID;
    const pairs = store.engine.progressiveMap(sheet[view.eye].front_power_D[0], add, corridor,
      sheet[view.eye].index_d, order.design === "soft", PROGRESSIVE_HALF_MM, n);
    const which = kind === "progPower" ? 0 : 1;
    const values = Float64Array.from({ length: n * n }, (_, k) => pairs[2 * k + which]);
    const half = PROGRESSIVE_HALF_MM;
    const middle = Math.round(((corridor / 2 + half) / (2 * half)) * (n - 1));
    const xs: number[] = [];
    const cyl: number[] = [];
    const law: number[] = [];
    // The law starts from the slope of power at the very row of the grid.
    const y = half * (1 - (2 * middle) / (n - 1));
    const u = -y / corridor;
    const slope = (add / corridor) * (30 * u * u - 60 * u ** 3 + 30 * u ** 4);
    for (let i = n >> 1; i < n; ++i) {
      const x = half * ((2 * i) / (n - 1) - 1);
      if (x > 12) break;
      xs.push(x);
      cyl.push(pairs[2 * (middle * n + i) + 1]);
      law.push(2 * slope * x);
    }
    minkwitzChart.set([xs, cyl, law]);
    return {
      grid: { n, m: n, values },
      halfX: half,
      halfY: half,
      outline: Array.from({ length: 90 }, (_, k): [number, number] => [
        half * Math.cos((k * Math.PI) / 45), half * Math.sin((k * Math.PI) / 45)]),
      unit: "D",
      signed: kind === "progPower",
    };
  }

  const inside = (x: number, y: number, outline: [number, number][]): boolean => {
    let within = false;
    for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
      const [xi, yi] = outline[i];
      const [xj, yj] = outline[j];
      if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) within = !within;
    }
    return within;
  };
  const show = (f: Field, value: number): string =>
    `${f.signed ? signed(value, 2) : fixed(value, 2)} ${f.unit}`;

  function draw(): void {
    const progressive = kind === "progPower" || kind === "progAstigmatism";
    if (field && progressive !== (field.grid.n === PROGRESSIVE_GRID)) probed = null;
    minkwitzFigure.hidden = !progressive;
    gazeFigure.hidden = progressive;
    const { order } = store.lenses;
    setText(text, progressive && order[view.eye].add === 0 ? t("maps.noAdd")
      : t(progressive ? "maps.hintProgressive" : "maps.hintGaze"));
    field = progressive ? progressiveField() : gazeField();
    if (!progressive) drawLine();
    const f = field;
    const { n, m, values } = f.grid;
    const at = (i: number, j: number): [number, number] => [
      f.halfX * ((2 * i) / (n - 1) - 1), f.halfY * ((2 * j) / (m - 1) - 1)];
    const shown = [...values].filter((v, k) =>
      !Number.isNaN(v) && inside(...at(k % n, Math.floor(k / n)), f.outline)).sort((a, b) => a - b);
    const low = shown[0] ?? 0;
    const high = shown[shown.length - 1] ?? 0;
    // Colours and lines leave out the last of the steep corners of a progressive.
    const share = (q: number): number => shown[Math.round(q * (shown.length - 1))] ?? 0;
    const [bottom, top] = [share(1 - COLOURED), share(COLOURED)];
    const centred = f.signed && kind !== "progPower";
    const reach = Math.max(Math.abs(bottom), Math.abs(top), 0.05);
    const colour = centred
      ? (v: number) => aroundZero(0.5 + v / (2 * reach))
      : kind === "progPower"
        ? (v: number) => rising((v - bottom) / Math.max(0.05, top - bottom))
        : (v: number) => rising(v / Math.max(top, 0.25));
    const levels = top - bottom < 0.01 ? []
      : roundLevels(bottom, top).filter((level) => f.signed || level > 0);
    const clip = uniqueId("clip");
    const dx = f.halfX / (n - 1);
    const dy = f.halfY / (m - 1);
    const path = `M${f.outline.map((p) => p.map((v) => v.toFixed(2)).join(" ")).join("L")}Z`;
    const labels: SVGElement[] = [];
    // Each level's label at its line, a sixth of a turn on from the last, clear of the others.
    const placed: [number, number][] = [];
    const clear = ([x, y]: [number, number]): boolean =>
      placed.every(([a, b]) => Math.abs(x - a) > LABEL_MM[0] || Math.abs(y - b) > LABEL_MM[1]);
    const lines = levels.map((level, turn) => {
      const toward = -0.7 - (turn * Math.PI) / 3;
      const off = ([x, y]: [number, number]): number => -Math.cos(Math.atan2(y, x) - toward);
      const segments = isoLine(f.grid, level + ABOVE);
      const spot = segments
        .map(([a, b, c, d]) => at((a + c) / 2, (b + d) / 2))
        .filter(([x, y]) => [-1, 1].every((side) =>
          inside(x + (side * LABEL_MM[0]) / 2, y * 1.12, f.outline)))
        .sort((p, q) => off(p) - off(q))
        .find(clear);
      if (spot) {
        placed.push(spot);
        labels.push(s("text", { x: spot[0], y: spot[1] + 0.8, "text-anchor": "middle" },
          f.signed ? signed(level, 2) : fixed(level, 2)));
      }
      return s("path", { class: "iso", d: segments.map(([a, b, c, d]) =>
        `M${at(a, b).map((v) => v.toFixed(2)).join(" ")}L${at(c, d).map((v) => v.toFixed(2)).join(" ")}`).join("") });
    });
    drawing.setAttribute("viewBox",
      `${-f.halfX - 2} ${-f.halfY - 2} ${2 * f.halfX + 4} ${2 * f.halfY + 4}`);
    drawing.replaceChildren(
      s("defs", {}, s("clipPath", { id: clip }, s("path", { d: path }))),
      s("g", { "clip-path": `url(#${clip})` },
        s("image", { href: heatPicture(f.grid, colour), preserveAspectRatio: "none",
          x: -f.halfX - dx, y: -f.halfY - dy, width: 2 * (f.halfX + dx), height: 2 * (f.halfY + dy) }),
        ...lines, ...(kind === "distortion" ? gridLines(f, at) : [])),
      s("path", { class: "map-rim", d: path }),
      s("path", { class: "cross", d: "M-1.5 0H1.5M0-1.5V1.5" }),
      ...labels, probe);
    const title = t("maps.summary", { what: t(`maps.${kind}` as TextKey),
      low: show(f, low), high: show(f, high) });
    setText(summary, title);
    drawing.setAttribute("aria-label", `${title} ${t("maps.keys")}`);
    legend.replaceChildren(
      h("span", {}, show(f, centred ? -reach : kind === "progPower" ? bottom : 0)),
      h("span", { class: "legend-bar", style: `background:linear-gradient(to right,${Array.from(
        { length: 9 }, (_, i) => `rgb(${(centred ? aroundZero : rising)(i / 8).map(Math.round).join(" ")})`).join(",")})` }),
      h("span", {}, show(f, centred ? reach : kind === "progPower" ? top : Math.max(top, 0.25))));
    if (!probed || !tell(...probed)) {
      probe.setAttribute("visibility", "hidden");
      setText(readout, t("maps.point"));
    }
  }

  // The value at a point of the grid; false where that lies off the lens.
  function tell(i: number, j: number): boolean {
    if (!field) return false;
    const { n, m, values } = field.grid;
    const x = field.halfX * ((2 * i) / (n - 1) - 1);
    const y = field.halfY * ((2 * j) / (m - 1) - 1);
    if (i < 0 || j < 0 || i >= n || j >= m || !inside(x, y, field.outline)) return false;
    probed = [i, j];
    const value = values[j * n + i];
    probe.setAttribute("cx", String(x));
    probe.setAttribute("cy", String(y));
    probe.setAttribute("visibility", "visible");
    setText(readout, t("maps.here", {
      x: signed(x, 1), y: signed(-y, 1), value: Number.isNaN(value) ? "–" : show(field, value),
    }));
    return true;
  }

  // The straight lines of a grid far away, as gaze meets them through the lens.
  function gridLines(f: Field, at: (i: number, j: number) => [number, number]): SVGElement[] {
    const rows = store.engine.gazeMap(SLOT[view.eye], STOP_MM, f.halfX, f.halfY, COLUMNS, ROWS);
    return [6, 7].flatMap((part) => {
      const values = new Float64Array(COLUMNS * ROWS);
      for (let k = 0; k < values.length; ++k) {
        const mirrored = Math.floor(k / COLUMNS) * COLUMNS + (COLUMNS - 1 - (k % COLUMNS));
        values[mirrored] = rows[GAZE_ROW * k] !== 0 ? Number.NaN : rows[GAZE_ROW * k + part];
      }
      const grid: Grid = { n: COLUMNS, m: ROWS, values };
      return Array.from({ length: 21 }, (_, i) => (i - 10) * 0.125).map((level) =>
        s("path", { class: "seen-grid", d: isoLine(grid, level + 1e-9).map(([a, b, c, d]) =>
          `M${at(a, b).map((v) => v.toFixed(2)).join(" ")}L${at(c, d).map((v) => v.toFixed(2)).join(" ")}`).join("") }));
    });
  }

  function drawLine(): void {
    const [axis] = meridiansOf(store.lenses.sheet[view.eye]);
    const rows = store.engine.gazeLine(SLOT[view.eye], STOP_MM, axis, LINE_MAX_DEG, LINE_STEPS);
    const column = (c: number): (number | null)[] => Array.from({ length: LINE_STEPS + 1 }, (_, i) =>
      Number.isNaN(rows[3 * i + c]) ? null : rows[3 * i + c]);
    gazeChart.set([column(0), column(1), column(2)]);
  }

  drawing.addEventListener("pointermove", (event) => {
    if (!field) return;
    const matrix = (drawing as SVGSVGElement).getScreenCTM();
    if (!matrix) return;
    const p = new DOMPoint((event as PointerEvent).clientX, (event as PointerEvent).clientY)
      .matrixTransform(matrix.inverse());
    const { n, m } = field.grid;
    tell(Math.round(((p.x / field.halfX + 1) / 2) * (n - 1)),
      Math.round(((p.y / field.halfY + 1) / 2) * (m - 1)));
  });
  drawing.addEventListener("keydown", (event) => {
    const moves: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
    };
    const { key } = event as KeyboardEvent;
    if (!field || !(key in moves || key === "Home")) return;
    event.preventDefault();
    const middle: [number, number] = [field.grid.n >> 1, field.grid.m >> 1];
    const [i, j] = key === "Home" ? middle : (probed ?? middle);
    const [di, dj] = moves[key] ?? [0, 0];
    tell(i + di, j + dj);
  });
  store.onLenses(draw, wanted);
  view.onChange(() => {
    if (wanted()) draw();
  });
  return {
    root,
    choose(next) {
      kind = next;
      select.value = next;
      if (wanted()) draw();
    },
  };
}
