// SPDX-License-Identifier: Apache-2.0
// A virtual focimeter. The unknown lens is a real one, designed and certified, and what the stop
// meets of it is read by rays: off its centre the lens is a prism and moves the target, prism that
// was ground stays at the centre, the segment of a bifocal has its own power. A line of the target is
// sharp when the drum matches the lens across the line and the line lies in a principal meridian.

import { SLOT, type Engine, type Reading } from "../app/engine";
import { rxText, signed } from "../app/format";
import { LIMITS } from "../app/order";
import { t, type TextKey } from "../app/texts";
import {
  KINDS, SEGMENT, judge, lineBlur, orderOf, randomLens, type Answer, type Kind, type Unknown,
} from "../app/unknown_lens";
import { h, s, setText, uniqueId } from "../ui/dom";
import { numberField } from "../ui/field";

const BLUR_PER_DIOPTER = 3.2;
const SHARP_D = 0.07;
const NEARLY_D = 0.4;
const TICK = 10; // of the scope for one prism dioptre
const FIELDS = ["sphere", "cylinder", "axis", "prismIn", "prismUp", "add"] as const;
const WANTED: Record<Kind, readonly (typeof FIELDS)[number][]> = {
  sphere: ["sphere"],
  cylinder: ["sphere", "cylinder", "axis"],
  prism: ["sphere", "cylinder", "axis", "prismIn", "prismUp"],
  bifocal: ["sphere", "cylinder", "axis", "add"],
};

interface Wheel {
  root: HTMLElement;
  set(value: number): void;
}

function wheel(
  key: TextKey, min: number, max: number, step: number, show: (v: number) => string,
  take: (v: number) => void,
): Wheel {
  const id = uniqueId("wheel");
  const out = h("output", { for: id });
  const input = h("input", { id, type: "range", min, max, step, oninput: () => {
    tell();
    take(Number(input.value));
  } });
  function tell(): void {
    setText(out, show(Number(input.value)));
    input.setAttribute("aria-valuetext", show(Number(input.value)));
  }
  return {
    root: h("div", { class: "field wheel" }, h("label", { for: id }, t(key)), input, out),
    set(value) {
      input.value = String(value);
      tell();
    },
  };
}

// The eyepiece: two sets of lines that turn with the wheel, blur with the drum and wander with prism.
function eyepiece(): {
  root: SVGElement;
  show(reading: Reading | null, drum: number, axis: number): [number, number];
} {
  const families = (["sphere", "cylinder"] as const).map((family) => {
    const id = uniqueId(`blur-${family}`);
    const blur = s("feGaussianBlur", { stdDeviation: 0 });
    const filter = s("filter", { id, x: -100, y: -100, width: 200, height: 200,
      filterUnits: "userSpaceOnUse" }, blur);
    const offsets = family === "sphere" ? [-2.5, 0, 2.5] : [-14, 0, 14];
    const lines = s("g", { class: `target-${family}`, filter: `url(#${id})` },
      ...offsets.map((y) => s("line", { x1: -46, x2: 46, y1: y, y2: y })));
    return { blur, filter, lines };
  });
  const target = s("g", {}, ...families.map((f) => f.lines));
  const clip = uniqueId("scope");
  const root = s("svg", { viewBox: "-64 -64 128 128", role: "img", class: "scope" },
    s("defs", {}, ...families.map((f) => f.filter),
      s("clipPath", { id: clip }, s("circle", { r: 62 }))),
    s("circle", { class: "scope-field", r: 62 }),
    s("g", { class: "scope-scale" },
      ...[1, 2, 3, 4, 5].map((k) => s("circle", { r: k * TICK })),
      s("path", { d: "M-62 0H62M0-62V62" }),
      ...Array.from({ length: 36 }, (_, i) => {
        const a = (i * Math.PI) / 18;
        return s("line", { x1: 57 * Math.cos(a), y1: 57 * Math.sin(a), x2: 62 * Math.cos(a),
          y2: 62 * Math.sin(a) });
      })),
    s("g", { "clip-path": `url(#${clip})` }, target));
  return {
    root,
    show(reading, drum, axis) {
      target.toggleAttribute("hidden", reading === null);
      if (!reading) return [NaN, NaN];
      // The viewer faces the wearer: the lens frame's +x lies at the left.
      const [px, py] = reading.prism;
      target.setAttribute("transform",
        `translate(${(-px * TICK).toFixed(2)} ${(-py * TICK).toFixed(2)})`);
      return families.map((f, i) => {
        const angle = axis + 90 * i;
        const blur = lineBlur(reading, drum, angle);
        f.blur.setAttribute("stdDeviation", Math.min(14, BLUR_PER_DIOPTER * blur).toFixed(2));
        f.lines.setAttribute("transform", `rotate(${-angle})`);
        return blur;
      }) as [number, number];
    },
  };
}

export function practiceSection(engine: Engine): HTMLElement {
  let kind: Kind = "cylinder";
  let lens: Unknown = randomLens(kind);
  let drum = 0;
  let axis = 180;
  let [x, y] = [0, 0];
  let lensesRead = 0;
  const scope = eyepiece();
  const told = h("p", { class: "told", role: "status", "aria-live": "polite" });
  const verdict = h("p", { class: "verdict-line", role: "status" });
  const say = (right: boolean, text: string): void => {
    verdict.className = `verdict-line ${right ? "right" : "wrong"}`;
    verdict.textContent = text;
  };

  const drumWheel = wheel("practice.drum", -14, 14, 0.125, (v) => `${signed(v, 3)} D`, (v) => {
    drum = v;
    draw();
  });
  const axisWheel = wheel("practice.wheel", 1, 180, 1, (v) => `${v}°`, (v) => {
    axis = v;
    draw();
  });
  const sideways = wheel("practice.sideways", -12, 12, 0.5, (v) => `${signed(v, 1)} mm`, (v) => {
    x = -v;
    draw();
  });
  const upward = wheel("practice.upward", -14, 14, 0.5, (v) => `${signed(v, 1)} mm`, (v) => {
    y = v;
    draw();
  });
  const turned = h("input", { type: "checkbox", onchange: () => draw() });
  const turnedLabel = h("label", { class: "check" }, turned, t("practice.turned"));
  const toSegment = h("button", { type: "button", class: "quiet", onclick: () => {
    [x, y] = [SEGMENT.x, SEGMENT.y];
    place();
    draw();
  } }, t("practice.toSegment"));
  const kindBox = h("select", { id: uniqueId("kind"), onchange: () => {
    kind = kindBox.value as Kind;
    next();
  } }, ...KINDS.map((k) =>
    h("option", { value: k, selected: k === kind }, t(`practice.kind.${k}` as TextKey))));

  const answer: Answer = {
    sphere: null, cylinder: null, axis: null, prismIn: null, prismUp: null, add: null };
  const fields = FIELDS.map((name) =>
    numberField({ label: t(`rx.${name}`), name: t(`rx.${name}.long`), limit: LIMITS[name],
      unit: name === "axis" ? "°" : name.startsWith("prism") ? "Δ" : "D",
      showSign: name !== "axis", empty: true, startAt: name === "axis" ? 180 : 0,
      onValue: (v) => { answer[name] = v; } }));
  const hint = h("p", { class: "hint" });

  // What the instrument meets; a lens turned round is seen in a mirror.
  function reading(): Reading | null {
    const r = engine.focimeter(SLOT.practice, x, y, turned.checked);
    if (!r || !turned.checked) return r;
    return { ...r, j45: -r.j45, prism: [-r.prism[0], r.prism[1]] };
  }
  function draw(): void {
    const r = reading();
    const [narrow, wide] = scope.show(r, drum, axis);
    const sharp = (b: number): string =>
      t(b < SHARP_D ? "practice.sharp" : b < NEARLY_D ? "practice.nearly" : "practice.blurred");
    const where = (value: number, plus: TextKey, minus: TextKey): string =>
      `${Math.abs(value).toFixed(1)} Δ ${t(value < 0 ? minus : plus)}`;
    setText(told, r === null ? t("practice.off") : t("practice.told", {
      sphere: sharp(narrow), cylinder: sharp(wide),
      across: where(-r.prism[0], "practice.toRight", "practice.toLeft"),
      up: where(r.prism[1], "practice.above", "practice.below") }));
    scope.root.setAttribute("aria-label", told.textContent ?? "");
  }
  function place(): void {
    sideways.set(-x);
    upward.set(y);
  }
  function check(event: Event): void {
    event.preventDefault();
    if (answer.sphere === null) return say(false, t("practice.wantSphere"));
    if (answer.cylinder && answer.axis === null) return say(false, t("error.axisWanted"));
    const result = judge(lens, answer);
    if (result !== "right") return say(false, t(`practice.wrong.${result}`));
    lensesRead += 1;
    say(true, t("practice.right", { lens: written(), count: lensesRead }));
  }
  const written = (): string => [
    rxText(lens),
    lens.add ? t("practice.add", { add: signed(lens.add) }) : "",
    lens.prismIn || lens.prismUp
      ? t("practice.prism", { inward: signed(lens.prismIn), up: signed(lens.prismUp) }) : "",
  ].filter(Boolean).join(", ");

  function next(): void {
    // A lens that cannot be made is drawn again; the ranges are such that this hardly happens.
    do lens = randomLens(kind);
    while (!engine.design(SLOT.practice, orderOf(lens)).ok);
    [drum, axis, x, y] = [0, 180, lens.x, lens.y];
    drumWheel.set(drum);
    axisWheel.set(axis);
    place();
    turned.checked = false;
    turnedLabel.hidden = toSegment.hidden = kind !== "bifocal";
    FIELDS.forEach((name, i) => {
      answer[name] = null;
      fields[i].set(null);
      fields[i].root.hidden = !WANTED[kind].includes(name);
    });
    setText(hint, t(`practice.how.${kind}`));
    say(true, "");
    draw();
  }
  next();
  return h("section", { class: "card practice" },
    h("div", { class: "card-head" }, h("h2", {}, t("practice.title")),
      h("div", { class: "field" }, h("label", { for: kindBox.id }, t("practice.kind")), kindBox)),
    h("p", {}, t("practice.intro")), hint,
    h("div", { class: "bench" },
      scope.root,
      h("div", {},
        h("div", { class: "row2" }, drumWheel.root, axisWheel.root),
        h("div", { class: "row2" }, sideways.root, upward.root),
        h("div", { class: "buttons" }, toSegment, turnedLabel), told,
        h("form", { onsubmit: check },
          h("div", { class: "row3" }, ...fields.map((f) => f.root)),
          h("div", { class: "buttons" },
            h("button", { type: "submit", class: "strong" }, t("lessons.check")),
            h("button", { type: "button", class: "quiet", onclick: () =>
              say(false, t("practice.shown", { lens: written() })) }, t("practice.show")),
            h("button", { type: "button", class: "quiet", onclick: next }, t("practice.next")))),
        verdict)));
}
