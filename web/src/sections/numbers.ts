// SPDX-License-Identifier: Apache-2.0
// The numbers of both lenses; each row leads to where it is explained.

import type { Pair, Sheet } from "../app/engine";
import { fixed, rxText, signed } from "../app/format";
import { EYES, wornOtherwise, type Order } from "../app/order";
import type { Store } from "../app/store";
import { t, type TextKey } from "../app/texts";
import { h, setText } from "../ui/dom";

const same = (pair: readonly (number | null)[]): boolean =>
  pair[0] === pair[1] || Math.abs((pair[0] ?? 0) - (pair[1] ?? 0)) < 1e-9;
const both = (pair: readonly (number | null)[], show: (v: number | null) => string): string =>
  same(pair) ? show(pair[0]) : `${show(pair[0])} / ${show(pair[1])}`;
const powers = (pair: Pair): string => both(pair, (v) => signed(v, 2));

interface Row {
  key: string; // explained under why.<key>
  unit: string;
  show(sheet: Sheet): string;
  shown?(order: Order): boolean; // always where it does not say
}

const ROWS: Row[] = [
  { key: "made", unit: "D", show: (s) => rxText(s.made), shown: (order) => order.compensate },
  { key: "worn", unit: "D", show: (s) => rxText(s.worn), shown: wornOtherwise },
  { key: "backVertex", unit: "D", show: (s) => powers(s.back_vertex_power_D) },
  { key: "frontVertex", unit: "D", show: (s) => powers(s.front_vertex_power_D) },
  { key: "equivalent", unit: "D", show: (s) => powers(s.equivalent_power_D) },
  { key: "frontSurface", unit: "D", show: (s) => powers(s.front_power_D) },
  { key: "backSurface", unit: "D", show: (s) => powers(s.back_power_D) },
  { key: "radii", unit: "mm", show: (s) =>
      `${both(s.radius_front_mm, (v) => fixed(v, 1))}; ${both(s.radii_back_mm, (v) => fixed(v, 1))}` },
  { key: "centre", unit: "mm", show: (s) => fixed(s.center_thickness_mm, 2) },
  { key: "edge", unit: "mm", show: (s) =>
      `${fixed(s.edge_thickness_mm[0], 2)} … ${fixed(s.edge_thickness_mm[1], 2)}` },
  { key: "mass", unit: "g", show: (s) => fixed(s.mass_g, 1) },
  { key: "blank", unit: "mm", show: (s) => fixed(s.min_blank_mm, 0) },
  { key: "light", unit: "%", show: (s) => fixed(100 * s.luminous_transmittance, 1) },
  { key: "wearer", unit: "%", show: (s) =>
      both(s.spectacle_magnification, (v) => signed(100 * ((v ?? 1) - 1), 2)) },
  { key: "observer", unit: "%", show: (s) =>
      signed(100 * (s.observer_magnification_paraxial - 1), 2) },
];

export function numbersSection(
  store: Store,
  wanted: () => boolean,
  explain: (key: string) => void,
): HTMLElement {
  const cells = new Map<string, HTMLElement>();
  const lines = ROWS.map((row) => {
    const values = EYES.map((eye) => {
      const cell = h("td", { "data-number": `${row.key}-${eye}` });
      cells.set(`${row.key}-${eye}`, cell);
      return cell;
    });
    return h("tr", {},
      h("th", { scope: "row" },
        h("button", { type: "button", class: "why-link", onclick: () => explain(row.key) },
          t(`number.${row.key}` as TextKey), h("span", { class: "unit" }, ` ${row.unit}`))),
      ...values);
  });
  const verdicts = EYES.map(() => h("td", { class: "verdict" }));
  const root = h("section", { class: "card numbers" },
    h("h2", {}, t("numbers.title")),
    h("table", {},
      h("thead", {}, h("tr", {}, h("td", {}),
        ...EYES.map((eye) => h("th", { scope: "col" }, t(`eye.${eye}` as TextKey))))),
      h("tbody", {}, ...lines,
        h("tr", {}, h("th", { scope: "row" },
          h("button", { type: "button", class: "why-link", onclick: () => explain("certificate") },
            t("number.certificate"))), ...verdicts))),
    h("p", { class: "hint" }, t("numbers.hint")));

  store.onLenses(({ order, sheet }) => {
    ROWS.forEach((row, i) => {
      lines[i].hidden = !(row.shown?.(order) ?? true);
    });
    EYES.forEach((eye, i) => {
      for (const row of ROWS) setText(cells.get(`${row.key}-${eye}`)!, row.show(sheet[eye]));
      const tests = sheet[eye].certificate;
      setText(verdicts[i], t("numbers.passed", {
        passed: tests.filter((m) => m.passed).length,
        all: tests.length,
      }));
    });
  }, wanted);
  return root;
}
