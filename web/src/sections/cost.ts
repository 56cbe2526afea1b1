// SPDX-License-Identifier: Apache-2.0
// What accuracy costs: time across, error up, both logarithmic. The front is a line; every point can
// be reached by pointer, by arrow keys and as a row of the table.

import {
  errorOf, fastestWithin, frontIn, loadCost, nameOf, type CostPoint, type CostReport,
} from "../app/cost";
import { t } from "../app/texts";
import { view } from "../app/view";
import { h, s, setText, uniqueId } from "../ui/dom";

const H = 420;
// As in style.css, where a narrow plot has larger letters.
const narrow = matchMedia("(max-width: 480px)");
const WIDE = { W: 720, PAD: { left: 74, right: 24, top: 18, bottom: 48 }, below: 18 };
const NARROW = { W: 500, PAD: { left: 112, right: 20, top: 18, bottom: 62 }, below: 24 };
const ZERO_BELOW = 0.5; // decades under the least error that is not 0: where 0 is drawn

// 3 significant digits without exponent where that is short.
export function short(value: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(1).replace("-", "−").replace("e+", "e");
  return String(Number(value.toPrecision(3)));
}

const decades = (low: number, high: number): number[] => {
  const all: number[] = [];
  for (let k = Math.ceil(low - 1e-9); k <= high + 1e-9; ++k) all.push(k);
  const every = Math.ceil(all.length / 8);
  return all.filter((k) => k % every === 0);
};

export function costSection(wanted: () => boolean): HTMLElement {
  let report: CostReport | null = null;
  let asked = false;
  let chosen = 0; // index into the points by rising time
  const status = h("p", { class: "hint", role: "status" });
  const study = h("select", { id: uniqueId("cost"), onchange: () => chooseStudy() });
  // The box cuts a long title where the page is narrow: there it stands in full below.
  const whole = h("p", { class: "cost-study" });
  const unit = h("select", { id: uniqueId("cost"), onchange: () => draw() });
  const budget = h("input", { id: uniqueId("cost"), type: "range", min: 0, max: 100, value: 50,
    oninput: () => draw() });
  const budgetOut = h("output", { for: budget.id });
  const advice = h("p", { class: "told", role: "status" });
  const plot = s("svg", { class: "cost-plot", role: "application", tabindex: 0 });
  const told = h("p", { class: "told", role: "status", "aria-live": "polite" });
  const rows = h("tbody");
  const headUnit = h("th", { scope: "col" });
  const headTime = h("th", { scope: "col" });
  const table = h("div", { class: "scroll", tabindex: 0, role: "region",
    "aria-label": t("cost.table") },
  h("table", { class: "cost-table" },
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, t("cost.method")), headTime, headUnit,
      h("th", { scope: "col" }, t("cost.front")))),
    rows));
  const labelled = (key: "cost.study" | "cost.unit", box: HTMLSelectElement,
    ...below: HTMLElement[]): HTMLElement =>
    h("div", { class: "field" }, h("label", { for: box.id }, t(key)), box, ...below);
  const body = h("div", { class: "cost-body", hidden: true },
    h("div", { class: "compare-controls" }, labelled("cost.study", study, whole),
      labelled("cost.unit", unit),
      h("div", { class: "field" }, h("label", { for: budget.id }, t("cost.budget")), budget, budgetOut)),
    advice, plot, told, table);
  const root = h("section", { class: "card cost" }, h("h2", {}, t("cost.title")),
    h("p", {}, t("cost.intro")), body, status);

  const current = () => report!.studies[study.selectedIndex];
  const sorted = (): CostPoint[] => [...current().points].sort((a, b) => a.time - b.time);

  function chooseStudy(): void {
    const { title, error_units, error_descriptions } = current();
    setText(whole, title);
    unit.replaceChildren(...error_units.map((u, i) => h("option", { value: u },
      error_descriptions?.[i] ? `${u}: ${error_descriptions[i]}` : u)));
    chosen = Math.max(0, sorted().findIndex((p) => p.front));
    draw();
  }

  function draw(): void {
    const one = current();
    const { W, PAD, below } = narrow.matches ? NARROW : WIDE;
    plot.setAttribute("viewBox", `0 0 ${W} ${H}`);
    const name = unit.value;
    const points = sorted();
    const timed = points.filter((p) => p.time > 0).map((p) => Math.log10(p.time));
    const wrong = points.map((p) => errorOf(p, name)).filter((e) => e > 0).map(Math.log10);
    const x0 = Math.floor(Math.min(...timed, 0) * 2 - 0.4) / 2;
    const x1 = Math.ceil(Math.max(...timed, x0 + 1) * 2 + 0.4) / 2;
    const floor = Math.min(...wrong, Math.max(...wrong, 0) - 1);
    const exact = points.some((p) => errorOf(p, name) === 0);
    const y0 = floor - (exact ? 2 * ZERO_BELOW : 0.3);
    const y1 = Math.max(...wrong, floor + 1) + 0.3;
    const x = (time: number): number =>
      PAD.left + ((Math.log10(Math.max(time, 10 ** x0)) - x0) / (x1 - x0)) * (W - PAD.left - PAD.right);
    const y = (error: number): number => {
      const at = error > 0 ? Math.log10(error) : floor - ZERO_BELOW;
      return H - PAD.bottom - ((at - y0) / (y1 - y0)) * (H - PAD.top - PAD.bottom);
    };
    const limit = 10 ** (floor + (Number(budget.value) / 100) * (Math.max(...wrong, floor) - floor));
    const best = fastestWithin(one, name, limit * (1 + 1e-9));

    const grid = [
      ...decades(x0, x1).flatMap((k) => [
        s("line", { class: "grid", x1: x(10 ** k), x2: x(10 ** k), y1: PAD.top, y2: H - PAD.bottom }),
        s("text", { x: x(10 ** k), y: H - PAD.bottom + below, "text-anchor": "middle" }, short(10 ** k))]),
      ...decades(floor, y1).flatMap((k) => [
        s("line", { class: "grid", x1: PAD.left, x2: W - PAD.right, y1: y(10 ** k), y2: y(10 ** k) }),
        s("text", { x: PAD.left - 8, y: y(10 ** k) + 5, "text-anchor": "end" }, short(10 ** k))]),
      exact ? s("text", { x: PAD.left - 8, y: y(0) + 5, "text-anchor": "end" }, "≈ 0") : null,
      s("text", { x: (PAD.left + W - PAD.right) / 2, y: H - 8, "text-anchor": "middle" },
        t("cost.time", { unit: one.time_unit })),
      s("text", { x: below, y: H / 2, "text-anchor": "middle", transform: `rotate(-90 ${below} ${H / 2})` },
        t("cost.error", { unit: name })),
      s("line", { class: "budget", x1: PAD.left, x2: W - PAD.right, y1: y(limit), y2: y(limit) }),
    ];
    // From a point of the front straight on until a better one is fast enough.
    const front = frontIn(one, name);
    const stairs = front.map((p, i) =>
      i === 0 ? `M${x(p.time)} ${y(errorOf(p, name))}`
        : `H${x(p.time)}V${y(errorOf(p, name))}`).join("");
    const marks = points.map((p, i) => {
      const [px, py] = [x(p.time), y(errorOf(p, name))];
      const half = Math.min(p.time_spread / 2, 0.9 * p.time);
      return s("g", { class: `point${p.front ? " front" : ""}${i === chosen ? " chosen" : ""}${
        p === best ? " best" : ""}`, onpointerenter: () => choose(i), onclick: () => choose(i) },
      s("line", { class: "spread", x1: x(p.time - half), x2: x(p.time + half), y1: py, y2: py }),
      p === best ? s("circle", { class: "halo", cx: px, cy: py, r: 12 }) : null,
      s("circle", { class: "hit", cx: px, cy: py, r: 12 }),
      s("circle", { class: "dot", cx: px, cy: py, r: p.front ? 6 : 4.5 }));
    });
    plot.replaceChildren(...grid.filter((g): g is SVGElement => g !== null),
      s("path", { class: "stairs", d: stairs }), ...marks);
    plot.setAttribute("aria-label", t("cost.alt", { title: one.title, unit: name,
      count: points.length, front: front.length }));
    setText(budgetOut, `${short(limit)} ${name}`);
    setText(advice, best ? t("cost.advice", { error: `${short(limit)} ${name}`, method: nameOf(best),
      time: `${short(best.time)} ${one.time_unit}` }) : t("cost.noAdvice"));
    setText(headTime, one.time_unit);
    setText(headUnit, name);
    rows.replaceChildren(...points.map((p, i) =>
      h("tr", { class: i === chosen ? "chosen" : null, onpointerenter: () => choose(i) },
        h("th", { scope: "row" }, nameOf(p),
          p.preset ? h("span", { class: "unit" }, ` --quality ${p.preset}`) : null,
          p.note ? h("span", { class: "unit" }, ` ${p.note}`) : null),
        h("td", {}, short(p.time),
          h("span", { class: "spread" }, ` ± ${short(p.time_spread / 2)}`)),
        h("td", {}, short(p.errors[name])),
        h("td", {}, p.front ? t("cost.onFront") : ""))));
    tell(points);
  }

  function tell(points: CostPoint[]): void {
    const p = points[chosen];
    if (!p) return;
    const one = current();
    setText(told, t("cost.point", { method: nameOf(p), time: `${short(p.time)} ${one.time_unit}`,
      error: `${short(p.errors[unit.value])} ${unit.value}`,
      front: p.front ? t("cost.pointFront") : t("cost.pointBeaten") }));
  }
  function choose(i: number): void {
    if (i === chosen) return;
    chosen = i;
    [...plot.querySelectorAll(".point")].forEach((g, k) => g.classList.toggle("chosen", k === i));
    [...rows.children].forEach((row, k) => row.classList.toggle("chosen", k === i));
    tell(sorted());
  }
  plot.addEventListener("keydown", (event) => {
    if (!report) return;
    const last = current().points.length - 1;
    const to: Record<string, number> = { ArrowRight: chosen + 1, ArrowDown: chosen + 1,
      ArrowLeft: chosen - 1, ArrowUp: chosen - 1, Home: 0, End: last };
    const key = (event as KeyboardEvent).key;
    if (!(key in to)) return;
    event.preventDefault();
    choose(Math.min(last, Math.max(0, to[key])));
  });

  async function load(): Promise<void> {
    if (asked) return;
    asked = true;
    try {
      report = await loadCost();
    } catch {
      report = null;
    }
    if (!report || report.studies.length === 0) {
      setText(status, t("cost.none"));
      return;
    }
    study.replaceChildren(...report.studies.map((one) => h("option", { value: one.name }, one.title)));
    setText(status, t("cost.machine", {
      machine: Object.entries(report.machine).map(([k, v]) => k === "threads" ? t("cost.threads", { count: v }) : v).join(", "), scene: report.scene ?? "",
      calibration: short(report.calibration_ns) }));
    body.hidden = false;
    chooseStudy();
  }
  view.onChange(() => {
    if (wanted()) void load();
  });
  narrow.addEventListener("change", () => {
    if (report) draw();
  });
  if (wanted()) void load();
  return root;
}
