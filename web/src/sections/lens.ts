// SPDX-License-Identifier: Apache-2.0
// The lens drawn to scale: cross-sections in both principal meridians as cut to the frame, edge
// thickness around the outline, and another medium or base curve beside it.

import { SLOT, type Engine, type Sheet } from "../app/engine";
import { fixed, signed } from "../app/format";
import { contourOf, reach } from "../app/frames";
import { MEDIA } from "../app/media";
import { LIMITS, decentration, lensOrder, meridiansOf, type Order } from "../app/order";
import type { Store } from "../app/store";
import { t } from "../app/texts";
import { view } from "../app/view";
import { h, s, setText, uniqueId } from "../ui/dom";
import { eyeSwitch } from "../ui/eye_switch";
import { numberField } from "../ui/field";

const SECTION_POINTS = 96;

interface Section {
  body: string; // SVG path
  low: number; // reach of the cut lens along the meridian, mm
  high: number;
  edge: [number, number]; // axial thickness at low and at high
  z: [number, number, number, number]; // front and back z at low, front and back z at high
  center: number;
}

// TABO meridian A runs along (-cos A, sin A) of the lens frame.
function sectionOf(engine: Engine, slot: number, order: Order, meridian: number): Section {
  const a = (meridian * Math.PI) / 180;
  const [ux, uy] = [-Math.cos(a), Math.sin(a)];
  const [low, high] = reach(contourOf(order, view.eye), ux, uy);
  const heights = Array.from(
    { length: SECTION_POINTS + 1 },
    (_, i) => low + ((high - low) * i) / SECTION_POINTS,
  );
  const z = engine.surfaces(slot, [...heights, 0].flatMap((r) => [r * ux, r * uy]));
  const front = heights.map((r, i) => `${z[2 * i].toFixed(3)} ${(-r).toFixed(3)}`);
  const back = heights.map((r, i) => `${z[2 * i + 1].toFixed(3)} ${(-r).toFixed(3)}`).reverse();
  const n = SECTION_POINTS;
  return {
    body: `M${front.join("L")}L${back.join("L")}Z`,
    low,
    high,
    edge: [z[1] - z[0], z[2 * n + 1] - z[2 * n]],
    z: [z[0], z[1], z[2 * n], z[2 * n + 1]],
    center: z[2 * n + 3] - z[2 * n + 2],
  };
}

const BOX = { left: -13, right: 25, top: -37, bottom: 37 };

// One cross-section with its dimensions; +height upwards, light from the left.
function drawSection(
  section: Section,
  other: Section | null,
  sheet: Sheet,
  which: 0 | 1,
  title: string,
): SVGElement {
  const { low, high, z, center } = section;
  const text = (x: number, y: number, value: string, props: Record<string, unknown> = {}): SVGElement =>
    s("text", { x, y, ...props }, value);
  const cardinal = sheet.cardinal[which];
  // The back surface's z near a height, whose reach from the axis is what its own radius makes it.
  const radius = sheet.radii_back_mm[which];
  const backAt = (height: number): number =>
    radius === null ? center
      : center + radius - Math.sign(radius) * Math.sqrt(Math.max(0, radius * radius - height * height));
  const planes: SVGElement[] = [];
  // H's reaches higher, H′'s lower: each has its name there, behind the lens.
  const plane = (at: number | null | undefined, name: "H" | "H′"): void => {
    if (at === null || at === undefined || at < BOX.left || at > BOX.right) return;
    const [top, bottom] = name === "H" ? [-10, 7] : [-7, 10];
    planes.push(s("line", { class: "plane", x1: at, x2: at, y1: top, y2: bottom }));
    const back = Math.max(at, backAt(name === "H" ? -top : -bottom));
    planes.push(text(back + 1.2, name === "H" ? -7.6 : 9.4, name, { class: "value" }));
  };
  plane(cardinal?.front_principal_mm, "H");
  const backPrincipal = cardinal?.back_principal_mm;
  plane(
    backPrincipal === null || backPrincipal === undefined ? null : center + backPrincipal,
    "H′",
  );
  const edgeMark = (height: number, z0: number, z1: number, outward: number): SVGElement[] => [
    s("line", { class: "dimension", x1: z0, x2: z0, y1: -height, y2: -height - outward * 2.6 }),
    s("line", { class: "dimension", x1: z1, x2: z1, y1: -height, y2: -height - outward * 2.6 }),
    text((z0 + z1) / 2, -height - outward * 3 + (outward > 0 ? -0.6 : 2.4), fixed(z1 - z0, 2), {
      class: "value",
      "text-anchor": "middle",
    }),
  ];
  return s("svg", {
    viewBox: `${BOX.left} ${BOX.top} ${BOX.right - BOX.left} ${BOX.bottom - BOX.top}`,
    role: "img",
    "aria-label": title,
    class: "section-drawing",
  },
    s("line", { class: "axis", x1: BOX.left, x2: BOX.right, y1: 0, y2: 0 }),
    other ? s("path", { class: "lens-other", d: other.body }) : null,
    s("path", { class: "lens-body", d: section.body }),
    ...planes,
    s("circle", { class: "vertex", cx: 0, cy: 0, r: 0.55 }),
    s("circle", { class: "vertex", cx: center, cy: 0, r: 0.55 }),
    ...edgeMark(high, z[2], z[3], 1),
    ...edgeMark(low, z[0], z[1], -1),
    text(-1.4, 3.4, `F₁ ${signed(sheet.front_power_D[which])}`, { class: "value", "text-anchor": "end" }),
    text(center + 2.2, 3.4, `F₂ ${signed(sheet.back_power_D[which])}`, { class: "value" }),
    text(center + 2.2, -1.6, `t ${fixed(center, 2)}`, { class: "value" }),
  );
}

// Cool to warm over [0, 1].
const heat = (f: number): string =>
  `color-mix(in oklab, #2f7fbf ${Math.round(100 * (1 - Math.min(1, Math.max(0, f))))}%, #d2691e)`;

function drawOutline(engine: Engine, slot: number, order: Order): SVGElement {
  const contour = contourOf(order, view.eye);
  const z = engine.surfaces(slot, contour.flat());
  const edge = contour.map((_, i) => z[2 * i + 1] - z[2 * i]);
  const least = Math.min(...edge);
  const most = Math.max(...edge);
  // The viewer faces the wearer: the lens frame's +x lies on the viewer's left.
  const at = contour.map(([x, y]): [number, number] => [-x, -y]);
  const marks = [edge.indexOf(least), edge.indexOf(most)];
  const xs = at.map(([x]) => x);
  const ys = at.map(([, y]) => y);
  const pad = 9;
  const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const middle = (x0 + x1) / 2;
  return s("svg", {
    viewBox: `${x0 - pad} ${y0 - pad} ${x1 - x0 + 2 * pad} ${y1 - y0 + 2 * pad}`,
    role: "img",
    "aria-label": t("lens.outlineAlt", { least: fixed(least, 2), most: fixed(most, 2) }),
    class: "outline-drawing",
  },
    s("path", { class: "outline-fill", d: `M${at.map((p) => p.join(" ")).join("L")}Z` }),
    ...at.map((p, i) => {
      const q = at[(i + 1) % at.length];
      const f = most - least < 0.005 ? 0.5 : (edge[i] - least) / (most - least);
      return s("line", { x1: p[0], y1: p[1], x2: q[0], y2: q[1], class: "edge",
        style: `stroke:${heat(f)}` });
    }),
    s("path", { class: "cross", d: "M-2.5 0H2.5M0-2.5V2.5" }),
    s("circle", { class: "box-centre", cx: middle, cy: (y0 + y1) / 2, r: 0.6 }),
    ...marks.flatMap((i) => {
      const [x, y] = at[i];
      const r = Math.hypot(x, y);
      return [
        s("circle", { class: "mark", cx: x, cy: y, r: 1.1 }),
        s("text", { class: "value", x: x - (x / r) * 6, y: y - (y / r) * 4 + 1, "text-anchor": "middle" },
          fixed(edge[i], 2)),
      ];
    }));
}

export function lensSection(store: Store, wanted: () => boolean): HTMLElement {
  const drawings = h("div", { class: "drawings" });
  const caption = h("p", { class: "hint" });
  const comparison = h("div", { class: "comparison" });
  const compareMedium = h("select", { id: uniqueId("compare"), onchange: () => draw() },
    h("option", { value: "" }, t("lens.compareNone")),
    ...Object.entries(MEDIA).map(([key, m]) => h("option", { value: key }, m.name)));
  let compareBase: number | null = null;
  const base = numberField({
    label: t("lens.compareBase"),
    limit: LIMITS.base,
    unit: "D",
    empty: true,
    startAt: 4,
    onValue: (value) => {
      compareBase = value;
      draw();
    },
  });
  base.set(null);
  base.setPlaceholder(t("field.byRule"));

  const root = h("section", { class: "card lens" },
    h("div", { class: "card-head" }, h("h2", {}, t("lens.title")), eyeSwitch()),
    drawings,
    caption,
    h("div", { class: "compare-controls" },
      h("div", { class: "field" }, h("label", { for: compareMedium.id }, t("lens.compareWith")),
        compareMedium),
      base.root),
    comparison);

  function draw(): void {
    const { order, sheet } = store.lenses;
    const { eye } = view;
    const { engine } = store;
    let other: Sheet | null = null;
    let problem: string | null = null;
    const changed = { medium: compareMedium.value || order.medium, base: compareBase ?? order.base };
    if (compareMedium.value || compareBase !== null) {
      const answer = engine.design(SLOT.compare, lensOrder(order, eye, changed));
      if (answer.ok) other = answer;
      else problem = answer.error;
    }
    drawings.replaceChildren(
      ...meridiansOf(sheet[eye]).map((meridian, which) => {
        const title = t(which === 0 ? "lens.along" : "lens.across",
          { meridian: fixed(meridian, Number.isInteger(meridian) ? 0 : 1) });
        return h("figure", {},
          drawSection(
            sectionOf(engine, SLOT[eye], order, meridian),
            other ? sectionOf(engine, SLOT.compare, order, meridian) : null,
            sheet[eye],
            which as 0 | 1,
            title,
          ),
          h("figcaption", {}, title));
      }),
      h("figure", { class: "wide" }, drawOutline(engine, SLOT[eye], order),
        h("figcaption", {}, t("lens.outline"))),
    );
    const shift = decentration(order, eye);
    setText(caption, t(shift >= 0 ? "lens.decenteredIn" : "lens.decenteredOut", {
      mm: fixed(Math.abs(shift), 1),
    }));
    if (other) {
      const mine = sheet[eye];
      const row = (name: string, a: string, b: string): HTMLElement =>
        h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, a), h("td", {}, b));
      const percent = (m: number): string => `${signed(100 * (m - 1), 2)} %`;
      comparison.replaceChildren(h("table", {},
        h("thead", {}, h("tr", {}, h("td", {}),
          h("th", { scope: "col" }, MEDIA[order.medium].name),
          h("th", { scope: "col" }, MEDIA[changed.medium].name))),
        h("tbody", {},
          row(t("number.frontSurface"), `${signed(mine.front_power_D[0])} D`,
            `${signed(other.front_power_D[0])} D`),
          row(t("number.centre"), `${fixed(mine.center_thickness_mm, 2)} mm`,
            `${fixed(other.center_thickness_mm, 2)} mm`),
          row(t("lens.thickest"), `${fixed(mine.edge_thickness_mm[1], 2)} mm`,
            `${fixed(other.edge_thickness_mm[1], 2)} mm`),
          row(t("number.mass"), `${fixed(mine.mass_g, 1)} g`, `${fixed(other.mass_g, 1)} g`),
          row(t("number.wearer"), percent(mine.spectacle_magnification[0]),
            percent(other.spectacle_magnification[0])))));
    } else {
      comparison.replaceChildren(...(problem ? [h("p", { class: "status bad" }, problem)] : []));
    }
  }
  store.onLenses(draw, wanted);
  view.onChange(() => {
    if (wanted()) draw();
  });
  return root;
}
