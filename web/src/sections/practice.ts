// SPDX-License-Identifier: Apache-2.0
// A virtual focimeter: an unknown lens, a power drum and an axis wheel. A line of the target is sharp
// when the drum matches the lens in the meridian across the line and the line lies in a principal
// meridian: the blur across a line with normal n is |(F - d I) n|.

import { signed } from "../app/format";
import { LIMITS } from "../app/order";
import { t } from "../app/texts";
import { h, s, setText, uniqueId } from "../ui/dom";
import { numberField } from "../ui/field";

interface Lens {
  sphere: number;
  cylinder: number; // minus form
  axis: number;
}

const BLUR_PER_DIOPTER = 3.2;
const POWER_TOLERANCE_D = 0.125;

// Of the axis, by cylinder: ANSI Z80.1-2015.
function axisTolerance(cylinder: number): number {
  const c = Math.abs(cylinder);
  return c <= 0.25 ? 14 : c <= 0.5 ? 7 : c <= 0.75 ? 5 : c <= 1.5 ? 3 : 2;
}

function randomLens(): Lens {
  const quarter = (low: number, high: number): number =>
    (Math.floor(Math.random() * ((high - low) * 4 + 1)) + low * 4) / 4;
  return {
    sphere: quarter(-6, 5),
    cylinder: Math.random() < 0.2 ? 0 : quarter(-3, -0.5),
    axis: 5 * (1 + Math.floor(Math.random() * 36)),
  };
}

// |(F - d I) n| for a line at `angle` degrees, whose normal is at angle + 90.
export function lineBlur(lens: Lens, drum: number, angle: number): number {
  const a = (2 * lens.axis * Math.PI) / 180;
  const m = lens.sphere + lens.cylinder / 2 - drum;
  const j0 = -(lens.cylinder / 2) * Math.cos(a);
  const j45 = -(lens.cylinder / 2) * Math.sin(a);
  const n = ((angle + 90) * Math.PI) / 180;
  const [x, y] = [Math.cos(n), Math.sin(n)];
  return Math.hypot((m + j0) * x + j45 * y, j45 * x + (m - j0) * y);
}

function inMinusForm(lens: Lens): Lens {
  if (lens.cylinder <= 0) return lens;
  return {
    sphere: lens.sphere + lens.cylinder,
    cylinder: -lens.cylinder,
    axis: lens.axis > 90 ? lens.axis - 90 : lens.axis + 90,
  };
}

export function practiceSection(): HTMLElement {
  let lens = randomLens();
  let drum = 0;
  let wheel = 180;
  let lensesRead = 0;

  const blurs = ["sphere", "cylinder"].map((family) => {
    const blur = s("feGaussianBlur", { stdDeviation: 0 });
    const filter = s("filter", { id: `blur-${family}`, x: "-50%", y: "-50%", width: "200%",
      height: "200%", filterUnits: "userSpaceOnUse" }, blur);
    filter.setAttribute("x", "-100");
    filter.setAttribute("y", "-100");
    filter.setAttribute("width", "200");
    filter.setAttribute("height", "200");
    return { blur, filter };
  });
  const lines = (offsets: number[], family: string): SVGElement =>
    s("g", { class: `target-${family}`, filter: `url(#blur-${family})` },
      ...offsets.map((y) => s("line", { x1: -46, x2: 46, y1: y, y2: y })));
  // Sphere lines run along the wheel's angle; the cylinder's, wider apart, across it.
  const sphereLines = lines([-2.5, 0, 2.5], "sphere");
  const cylinderLines = lines([-14, 0, 14], "cylinder");
  const scope = s("svg", { viewBox: "-64 -64 128 128", role: "img", class: "scope" },
    s("defs", {}, ...blurs.map((b) => b.filter)),
    s("circle", { class: "scope-field", r: 62 }),
    s("g", { class: "scope-scale" },
      ...[10, 20, 30].map((r) => s("circle", { r })),
      ...Array.from({ length: 36 }, (_, i) => {
        const a = (i * Math.PI) / 18;
        return s("line", { x1: 56 * Math.cos(a), y1: 56 * Math.sin(a), x2: 61 * Math.cos(a), y2: 61 * Math.sin(a) });
      })),
    sphereLines, cylinderLines);
  const told = h("p", { class: "told", role: "status", "aria-live": "polite" });

  const wheelFor = (
    label: string, min: number, max: number, step: number, value: number,
    show: (v: number) => string, take: (v: number) => void,
  ): [HTMLElement, HTMLInputElement] => {
    const id = uniqueId("wheel");
    const out = h("output", { for: id }, show(value));
    const input = h("input", { id, type: "range", min, max, step, value, oninput: () => {
      take(Number(input.value));
      setText(out, show(Number(input.value)));
      input.setAttribute("aria-valuetext", show(Number(input.value)));
      draw();
    } });
    return [h("div", { class: "field wheel" }, h("label", { for: id }, label), input, out), input];
  };
  const [drumField, drumInput] = wheelFor(t("practice.drum"), -12, 12, 0.125, 0,
    (v) => `${signed(v, 3)} D`, (v) => { drum = v; });
  const [axisField, axisInput] = wheelFor(t("practice.wheel"), 1, 180, 1, 180, (v) => `${v}°`,
    (v) => { wheel = v; });

  function draw(): void {
    const sphere = lineBlur(lens, drum, wheel);
    const cylinder = lineBlur(lens, drum, wheel + 90);
    [sphere, cylinder].forEach((blur, i) => {
      blurs[i].blur.setAttribute("stdDeviation", Math.min(14, BLUR_PER_DIOPTER * blur).toFixed(2));
    });
    sphereLines.setAttribute("transform", `rotate(${-wheel})`);
    cylinderLines.setAttribute("transform", `rotate(${-wheel - 90})`);
    const sharp = (b: number): string =>
      t(b < 0.07 ? "practice.sharp" : b < 0.4 ? "practice.nearly" : "practice.blurred");
    setText(told, t("practice.told", { sphere: sharp(sphere), cylinder: sharp(cylinder) }));
    scope.setAttribute("aria-label", told.textContent ?? "");
  }

  const answer: { sphere: number | null; cylinder: number | null; axis: number | null } = {
    sphere: null, cylinder: null, axis: null };
  const fields = (["sphere", "cylinder", "axis"] as const).map((name) =>
    numberField({ label: t(`rx.${name}`), name: t(`rx.${name}.long`), limit: LIMITS[name],
      unit: name === "axis" ? "°" : "D", showSign: name !== "axis", empty: true,
      startAt: name === "axis" ? 180 : 0, onValue: (v) => { answer[name] = v; } }));
  fields.forEach((f) => f.set(null));
  const verdict = h("p", { class: "verdict-line", role: "status" });
  const written = (l: Lens): string => l.cylinder === 0 ? signed(l.sphere)
    : `${signed(l.sphere)} ${signed(l.cylinder)} × ${l.axis}`;
  const say = (right: boolean, text: string): void => {
    verdict.className = `verdict-line ${right ? "right" : "wrong"}`;
    verdict.textContent = text;
  };

  function check(event: Event): void {
    event.preventDefault();
    if (answer.sphere === null) return say(false, t("practice.wantSphere"));
    if (answer.cylinder && answer.axis === null) return say(false, t("error.axisWanted"));
    const given = inMinusForm({ sphere: answer.sphere, cylinder: answer.cylinder ?? 0,
      axis: answer.axis ?? 180 });
    const turn = Math.abs(((given.axis - lens.axis + 270) % 180) - 90);
    const powers = Math.abs(given.sphere - lens.sphere) <= POWER_TOLERANCE_D &&
      Math.abs(given.cylinder - lens.cylinder) <= POWER_TOLERANCE_D;
    const axis = lens.cylinder === 0 || turn <= axisTolerance(lens.cylinder);
    if (powers && axis) {
      lensesRead += 1;
      say(true, t("practice.right", { lens: written(lens), count: lensesRead }));
    } else {
      say(false, t(powers ? "practice.axisWrong" : "practice.powerWrong"));
    }
  }
  function next(): void {
    lens = randomLens();
    fields.forEach((f) => f.set(null));
    answer.sphere = answer.cylinder = answer.axis = null;
    [drumInput, axisInput].forEach((input, i) => {
      input.value = i === 0 ? "0" : "180";
      input.dispatchEvent(new Event("input"));
    });
    say(true, "");
    draw();
  }
  draw();
  return h("section", { class: "card practice" },
    h("h2", {}, t("practice.title")), h("p", {}, t("practice.intro")),
    h("div", { class: "bench" },
      scope,
      h("div", {}, drumField, axisField, told,
        h("form", { onsubmit: check },
          h("div", { class: "row3" }, ...fields.map((f) => f.root)),
          h("div", { class: "buttons" },
            h("button", { type: "submit", class: "strong" }, t("lessons.check")),
            h("button", { type: "button", class: "quiet", onclick: () =>
              say(false, t("practice.shown", { lens: written(lens) })) }, t("practice.show")),
            h("button", { type: "button", class: "quiet", onclick: next }, t("practice.next")))),
        verdict)));
}
