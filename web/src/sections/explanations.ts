// SPDX-License-Identifier: Apache-2.0
// What stands behind each number of the sheet: formula, the same with the order's own values, and
// the validation cases that back it.

import { type Measurement, type Sheet, type Worn } from "../app/engine";
import { fixed, rxText, signed } from "../app/format";
import { MEDIA } from "../app/media";
import { meanOf, type Order } from "../app/order";
import { leanOf, martin, thinTilted } from "../app/tilt";
import { t } from "../app/texts";
import { view } from "../app/view";
import { h } from "../ui/dom";
import { formula } from "../ui/formula";

// Numbers of the cases in validation/cases, by the number that they back.
export const CASES: Record<string, string[]> = {
  backVertex: ["V001", "V002", "V003", "V041", "V042", "V105"],
  frontVertex: ["V003", "V041"],
  equivalent: ["V003", "V041", "V034"],
  frontSurface: ["V022"],
  backSurface: ["V013", "V020", "V021"],
  radii: ["V013"],
  centre: ["V046"],
  edge: ["V014", "V045"],
  mass: ["V045"],
  blank: [],
  light: ["V024"],
  wearer: ["V004", "V005"],
  observer: ["V043", "V048"],
  worn: ["V012", "V049", "V051", "V006", "V011"],
  made: ["V105", "V012", "V049"],
  certificate: ["V105", "V026", "V033"],
};

export interface Explanation {
  key: string;
  value: string;
  steps: string[]; // formulas, symbols first, then the order's values
  extra?: HTMLElement;
}

// How the values enter: the meridian along the axis, and the other where it differs.
interface Values {
  name: string;
  f1: number;
  f2: number;
  r1: number | null;
  r2: number | null;
  fv: number;
  fn: number;
  fe: number;
  paper: number;
  paperError: number;
  shape: number;
  power: number;
  wearer: number;
}

function meridians(sheet: Sheet): Values[] {
  const of = (i: 0 | 1): Values => ({
    name: t(i === 0 ? "why.along" : "why.across"),
    f1: sheet.front_power_D[i],
    f2: sheet.back_power_D[i],
    r1: sheet.radius_front_mm[i],
    r2: sheet.radii_back_mm[i],
    fv: sheet.back_vertex_power_D[i],
    fn: sheet.front_vertex_power_D[i],
    fe: sheet.equivalent_power_D[i],
    paper: sheet.paper_power_D[i],
    paperError: sheet.paper_power_error_D[i],
    shape: sheet.shape_factor[i],
    power: sheet.power_factor[i],
    wearer: sheet.spectacle_magnification[i],
  });
  const [a, b] = [of(0), of(1)];
  return Math.abs(a.fv - b.fv) < 1e-9 ? [{ ...a, name: "" }] : [a, b];
}

export function explanations(order: Order, sheet: Sheet, worn: Worn): Explanation[] {
  const all = meridians(sheet);
  const n = sheet.index_d;
  const mm = sheet.center_thickness_mm;
  const tau = mm / 1000 / n;
  const tauText = fixed(tau, 6);
  const pair = (get: (v: Values) => string): string => all.map(get).join(" / ");
  const each = (make: (v: Values) => string[]): string[] =>
    all.flatMap((v) => make(v).map((line, i) => (i === 0 && v.name ? `${v.name}: ${line}` : line)));
  const p = (v: number): string => signed(v, 4);
  const mean = meanOf(order.compensate ? sheet.target : order[view.eye]);
  const d = sheet.pupil_mm / 1000;
  const camera = order.camera / 1000;
  const z = (order.vertex + 3.05) / 1000;
  const byRule = order.base === null;
  const medium = MEDIA[order.medium];

  return [
    {
      key: "backVertex",
      value: pair((v) => `${signed(v.fv, 2)} D`),
      steps: [
        "F′{v} = F{1} / (1 − τ F{1}) + F{2},   τ = t / n",
        `τ = ${fixed(mm / 1000, 6)} m / ${n} = ${tauText} m`,
        ...each((v) => [
          `F′{v} = ${p(v.f1)} / (1 − ${tauText} · ${p(v.f1)}) + (${p(v.f2)}) = ${signed(v.fv, 6)} D`,
        ]),
      ],
      extra: h("div", { class: "beside" },
        h("h4", {}, t("why.paper")),
        formula("P = F + B + τ F^2^   (F = F{1}, B = F{2})"),
        ...all.flatMap((v) => [
          formula(`${v.name ? `${v.name}: ` : ""}P = ${signed(v.paper, 6)} D`, "formula values"),
          formula(`F′{v} − P = τ^2^ F^3^ / (1 − τ F) = ${signed(v.paperError, 6)} D`, "formula values"),
        ]),
        h("p", {}, t(Math.abs(all[0].paperError) > 0.12 ? "why.paperMatters" : "why.paperFine"))),
    },
    {
      key: "frontVertex",
      value: pair((v) => `${signed(v.fn, 2)} D`),
      steps: [
        "F{n} = F{2} / (1 − τ F{2}) + F{1}",
        ...each((v) => [
          `F{n} = ${p(v.f2)} / (1 − ${tauText} · (${p(v.f2)})) + (${p(v.f1)}) = ${signed(v.fn, 6)} D`,
        ]),
      ],
    },
    {
      key: "equivalent",
      value: pair((v) => `${signed(v.fe, 2)} D`),
      steps: [
        "F{e} = F{1} + F{2} − τ F{1} F{2}",
        ...each((v) => [
          `F{e} = ${p(v.f1)} + (${p(v.f2)}) − ${tauText} · ${p(v.f1)} · (${p(v.f2)}) = ${signed(v.fe, 6)} D`,
        ]),
      ],
    },
    {
      key: "frontSurface",
      value: `${signed(all[0].f1, 2)} D`,
      steps: byRule
        ? [
            mean >= 0 ? "F{1} = M + 6,   M = S + C/2" : "F{1} = M/2 + 6,   M = S + C/2",
            `M = ${signed(mean, 3)} D,   F{1} = ${p(all[0].f1)} D`,
          ]
        : [`F{1} = ${p(all[0].f1)} D`],
    },
    {
      key: "backSurface",
      value: pair((v) => `${signed(v.f2, 2)} D`),
      steps: [
        "F{2} = F′{v} − F{1} / (1 − τ F{1})",
        ...each((v) => [
          `F{2} = ${signed(v.fv, 2)} − ${p(v.f1)} / (1 − ${tauText} · ${p(v.f1)}) = ${p(v.f2)} D`,
        ]),
      ],
    },
    {
      key: "radii",
      value: `${fixed(all[0].r1, 1)}; ${pair((v) => fixed(v.r2, 1))} mm`,
      steps: [
        "r{1} = 1000 (n − 1) / F{1},   r{2} = 1000 (1 − n) / F{2}",
        `r{1} = 1000 · ${fixed(n - 1, 3)} / ${p(all[0].f1)} = ${fixed(all[0].r1, 4)} mm`,
        ...each((v) => [
          `r{2} = 1000 · (${fixed(1 - n, 3)}) / (${p(v.f2)}) = ${fixed(v.r2, 4)} mm`,
        ]),
      ],
    },
    {
      key: "centre",
      value: `${fixed(mm, 2)} mm`,
      steps: [
        order.centre === null
          ? `t{c} ≥ ${fixed(order.minCentre, 1)} mm,   t{e} ≥ ${fixed(order.minEdge, 1)} mm`
          : `t{c} = ${fixed(order.centre, 2)} mm`,
        `t{c} = ${fixed(mm, 4)} mm`,
      ],
    },
    {
      key: "edge",
      value: `${fixed(sheet.edge_thickness_mm[0], 2)} … ${fixed(sheet.edge_thickness_mm[1], 2)} mm`,
      steps: [
        "t(x, y) = t{c} + s{2}(x, y) − s{1}(x, y),   s = c h^2^ / (1 + √(1 − c^2^ h^2^)),   c = 1/r",
        `${fixed(sheet.edge_thickness_mm[0], 4)} mm ≤ t ≤ ${fixed(sheet.edge_thickness_mm[1], 4)} mm`,
      ],
    },
    {
      key: "mass",
      value: `${fixed(sheet.mass_g, 1)} g`,
      steps: [
        "m = ρ ∫ t(x, y) dx dy",
        `m = ${medium.density_g_cm3} g/cm³ · ${fixed(sheet.mass_g / medium.density_g_cm3, 3)} cm³ = ${fixed(sheet.mass_g, 3)} g`,
      ],
    },
    {
      key: "blank",
      value: `${fixed(sheet.min_blank_mm, 1)} mm`,
      steps: [
        "D = 2 max √(x^2^ + y^2^) + 2 mm",
        `D = 2 · ${fixed(sheet.min_blank_mm / 2 - 1, 2)} + 2 = ${fixed(sheet.min_blank_mm, 2)} mm`,
      ],
    },
    {
      key: "light",
      value: `${fixed(100 * sheet.luminous_transmittance, 1)} %`,
      steps: [
        "R = ((n − 1) / (n + 1))^2^,   T = 2 n / (n^2^ + 1)",
        `R = ${fixed(100 * ((n - 1) / (n + 1)) ** 2, 3)} %,   T = ${fixed((200 * n) / (n * n + 1), 3)} %`,
        `${t("why.withCoat")} ${fixed(100 * sheet.luminous_transmittance, 3)} %` +
          (sheet.filter_category === null ? "" : `, ${t("why.category")} ${sheet.filter_category}`),
      ],
    },
    {
      key: "wearer",
      value: pair((v) => `${signed(100 * (v.wearer - 1), 2)} %`),
      steps: [
        "SM = 1 / (1 − τ F{1}) · 1 / (1 − d F′{v})",
        `d = ${fixed(order.vertex, 1)} + 3.05 mm = ${fixed(d, 5)} m`,
        ...each((v) => [
          `SM = ${fixed(v.shape, 6)} · ${fixed(v.power, 6)} = ${fixed(v.wearer, 6)}`,
        ]),
      ],
    },
    {
      key: "observer",
      value: `${signed(100 * (sheet.observer_magnification_paraxial - 1), 2)} %`,
      steps: [
        "M = (L + t + z) / J,   J = L (1 − τ F{1}) + τ + z [(1 − τ F{2}) − L F{e}]",
        `L = ${fixed(camera, 3)} m,   t = ${fixed(mm / 1000, 5)} m,   z = ${fixed(z, 5)} m`,
        ...(all.length === 1
          ? [`J = ${fixed((camera + mm / 1000 + z) / sheet.observer_magnification_paraxial, 6)} m`]
          : []),
        `M = ${fixed(sheet.observer_magnification_paraxial, 6)}`,
        `${t("why.exactRay")} ${fixed(sheet.observer_magnification_exact, 6)}`,
        `${t("why.thin")} M = 1 / (1 − z L F / (L + z)) = ${fixed(sheet.observer_magnification_thin, 6)}`,
      ],
    },
    wornExplanation(order, sheet, worn),
    {
      key: "made",
      value: rxText(sheet.made),
      steps: [
        `${t("why.asked")} ${rxText(sheet.target, 4)}`,
        `${t("why.made")} ${rxText(sheet.made, 4)}`,
        `${t("why.asWorn")} ${rxText(sheet.worn, 4)}`,
      ],
    },
    {
      key: "certificate",
      value: t("numbers.passed", {
        passed: sheet.certificate.filter((m) => m.passed).length,
        all: sheet.certificate.length,
      }),
      steps: [],
      extra: certificateTable(sheet.certificate),
    },
  ];
}

// As worn: moved from where the eyes were tested, and tilted; thin lens, Martin's rule, rays.
function wornExplanation(order: Order, sheet: Sheet, worn: Worn): Explanation {
  const from = order.refraction ?? order.vertex;
  const lean = leanOf(worn);
  const theta = (lean.degrees * Math.PI) / 180;
  const n = sheet.index_d;
  const inside = Math.asin(Math.sin(theta) / n);
  const gain = (n * Math.cos(inside) - Math.cos(theta)) / (n - 1);
  const rule = martin(meanOf(sheet.made), lean, n);
  return {
    key: "worn",
    value: rxText(sheet.worn),
    steps: [
      "F{worn} = G C^−1^ F C^−1^,   C = diag(1, cos θ),   G = (n cos θ′ − cos θ) / (n − 1),   sin θ′ = sin θ / n",
      `${t("why.asked")} F / (1 − d F),   d = ${fixed(from, 1)} − ${fixed(order.vertex, 1)} mm:   ${rxText(sheet.target, 4)}`,
      `θ = ${fixed(lean.degrees, 2)}°,   ${t("why.tiltAxis")} ${fixed(lean.axis, 1)}°,   G = ${fixed(gain, 6)},   1 / cos θ = ${fixed(1 / Math.cos(theta), 6)}`,
      `${t("why.thin")} ${rxText(thinTilted(sheet.made, lean, n), 4)}`,
      `${t("why.martin")} S (1 + sin^2^ θ / 2 n), S tan^2^ θ:   ${rxText(rule, 4)}`,
      `${t("why.byRays")} ${rxText(sheet.worn, 4)};   ${t("why.prismAsWorn", {
        inward: signed(sheet.worn.prism_in, 3), up: signed(sheet.worn.prism_up, 3) })}`,
    ],
  };
}

function certificateTable(tests: Measurement[]): HTMLElement {
  const places = (m: Measurement): number => (m.unit === "1" ? 6 : m.unit === "deg" ? 2 : 4);
  return h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": t("number.certificate") },
    h("table", { class: "certificate" },
      h("thead", {}, h("tr", {},
        ...(["quantity", "ordered", "measured", "tolerance", "error"] as const).map((k) =>
          h("th", { scope: "col" }, t(`certificate.${k}`))))),
      h("tbody", {}, ...tests.map((m) =>
        h("tr", { title: m.source },
          h("th", { scope: "row" }, m.quantity, h("span", { class: "unit" }, m.unit === "1" ? "" : ` ${m.unit}`)),
          h("td", {}, fixed(m.ordered, places(m))),
          h("td", {}, fixed(m.measured, places(m))),
          h("td", {}, `± ${m.tolerance < 1e-3 ? m.tolerance.toExponential(0) : fixed(m.tolerance, 3)}`),
          h("td", {}, m.numerical_error.toExponential(0)))))));
}
