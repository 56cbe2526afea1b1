// SPDX-License-Identifier: Apache-2.0
// The order form: both eyes, frame, lens, how they are worn; files and the link.

import { MEDIA } from "../app/media";
import {
  COATS, DESIGNS, EYES, LIMITS, SHAPES, rxProblem, transposed,
  type EyeName, type EyeRx, type LimitName, type Order,
} from "../app/order";
import { fixed, signed } from "../app/format";
import type { Store } from "../app/store";
import { t, type TextKey } from "../app/texts";
import { axisDial } from "../ui/dial";
import { h, setText, uniqueId } from "../ui/dom";
import { numberField, type NumberField } from "../ui/field";
import { filesCard } from "./files";

interface EyeCard {
  root: HTMLElement;
  show(rx: EyeRx): void;
  setImpossible(why: string | null): void;
}

function eyeCard(store: Store, eye: EyeName): EyeCard {
  const change = (part: Partial<EyeRx>): void => {
    const rx = { ...draft, ...part };
    draft = rx;
    const problem = rxProblem(rx);
    fields.axis.setProblem(null);
    fields.cylinder.setProblem(null);
    if (problem) fields[problem.field].setProblem(t(problem.text));
    else store.set({ [eye]: rx });
    follow();
  };
  let draft: EyeRx = store.order[eye];
  const of = (name: string): string => `${t(`eye.${eye}` as TextKey)}, ${name}`;

  const field = (name: keyof EyeRx & LimitName, unit: string, sign: boolean): NumberField =>
    numberField({
      label: t(`rx.${name}` as TextKey),
      name: of(t(`rx.${name}.long` as TextKey)),
      limit: LIMITS[name],
      unit,
      showSign: sign,
      empty: name === "axis",
      startAt: 180,
      onValue: (value, how) => {
        if (name === "cylinder" && how === "stepped") return changeCylinder(value ?? 0);
        change({ [name]: value });
      },
    });
  // By slider and by step the axis follows the cylinder; what is typed is taken at its word.
  function changeCylinder(cylinder: number): void {
    const axis = cylinder === 0 ? null : (draft.axis ?? 180);
    change({ cylinder, axis });
    fields.axis.set(axis);
  }
  const fields: Record<keyof EyeRx, NumberField> = {
    sphere: field("sphere", "D", true),
    cylinder: field("cylinder", "D", true),
    axis: field("axis", "°", false),
    add: field("add", "D", true),
    prismIn: field("prismIn", "Δ", true),
    prismUp: field("prismUp", "Δ", true),
    pd: field("pd", "mm", false),
  };
  const slider = (name: "sphere" | "cylinder", min: number, max: number): HTMLInputElement =>
    h("input", {
      type: "range",
      min,
      max,
      step: 0.25,
      "aria-label": of(t(`rx.${name}.long` as TextKey)),
      oninput: (event: Event) => {
        const value = Number((event.target as HTMLInputElement).value);
        if (name === "cylinder") changeCylinder(value);
        else change({ sphere: value });
        fields[name].set(value);
      },
    });
  const sphereSlider = slider("sphere", -12, 12);
  const cylinderSlider = slider("cylinder", -6, 6);
  const dial = axisDial(of(t("rx.axis.long")), (axis) => {
    if (draft.cylinder === 0) {
      dial.set(null);
      fields.cylinder.setProblem(t("error.axisWithoutCylinder"));
      return;
    }
    change({ axis });
    fields.axis.set(axis);
  });
  const otherForm = h("p", { class: "transposed" });

  function follow(): void {
    sphereSlider.value = String(draft.sphere);
    cylinderSlider.value = String(draft.cylinder);
    dial.set(draft.cylinder === 0 ? null : draft.axis);
    const other = transposed(draft);
    setText(
      otherForm,
      other
        ? t("rx.transposed", {
            form: `${signed(other.sphere)} ${signed(other.cylinder)} × ${other.axis}`,
          })
        : t("rx.spherical"),
    );
  }
  let impossible = false;
  const reason = h("p", { class: "field-problem", hidden: true });
  const heading = uniqueId("eye");
  const root = h("section", { class: `card eye eye-${eye}`, "aria-labelledby": heading },
    h("h3", { id: heading }, t(`eye.${eye}` as TextKey),
      h("abbr", { title: t(`eye.${eye}.latin` as TextKey) }, eye === "right" ? "OD" : "OS")),
    h("div", { class: "row3" }, fields.sphere.root, fields.cylinder.root, fields.axis.root),
    reason,
    h("div", { class: "sliders" },
      h("div", {}, h("span", { class: "slider-name" }, t("rx.sphere")), sphereSlider,
        h("span", { class: "slider-name" }, t("rx.cylinder")), cylinderSlider),
      dial.root),
    otherForm,
    h("details", {},
      h("summary", {}, t("order.more")),
      h("div", { class: "row2" }, fields.add.root, fields.pd.root),
      h("div", { class: "row2" }, fields.prismIn.root, fields.prismUp.root)),
  );
  return {
    root,
    show(rx) {
      draft = rx;
      for (const [name, f] of Object.entries(fields)) f.set(rx[name as keyof EyeRx]);
      follow();
    },
    // Says it at the power too: the alert above the form may be out of sight.
    setImpossible(why) {
      const now = why !== null;
      if (now || impossible) fields.sphere.setProblem(now ? t("error.impossibleHere") : null);
      impossible = now;
      reason.hidden = !now;
      setText(reason, why ?? "");
    },
  };
}

type PlainField = Exclude<LimitName, keyof EyeRx>;

export function orderForm(store: Store): HTMLElement {
  const eyes = Object.fromEntries(EYES.map((eye) => [eye, eyeCard(store, eye)])) as Record<
    EyeName,
    EyeCard
  >;
  const plain: Partial<Record<PlainField, NumberField>> = {};
  const field = (name: PlainField, unit: string, empty = false, startAt = 0): HTMLElement => {
    const f = numberField({
      label: t(`order.${name}` as TextKey),
      limit: LIMITS[name],
      unit,
      empty,
      startAt,
      onValue: (value) => store.set({ [name]: value } as Partial<Order>),
    });
    plain[name] = f;
    return f.root;
  };
  const select = (
    label: string,
    options: [string, string][],
    onValue: (value: string) => void,
  ): [HTMLElement, HTMLSelectElement] => {
    const id = uniqueId("select");
    const box = h("select", { id, onchange: () => onValue(box.value) },
      ...options.map(([value, text]) => h("option", { value }, text)));
    return [h("div", { class: "field" }, h("label", { for: id }, label), box), box];
  };
  const [mediumField, medium] = select(
    t("order.medium"),
    Object.entries(MEDIA).map(([key, m]) => [key, `${m.name}, n ${m.index_d}`]),
    (value) => store.set({ medium: value }),
  );
  const [designField, design] = select(
    t("order.design"),
    DESIGNS.map((d) => [d, t(`design.${d}` as TextKey)]),
    (value) => {
      store.set({ design: value });
      showDesign();
    },
  );
  const [coatField, coat] = select(
    t("order.coat"),
    COATS.map((c) => [c, t(`coat.${c}` as TextKey)]),
    (value) => store.set({ coat: value }),
  );
  const designHint = h("p", { class: "hint" }, t("order.wantAdd"));
  const corridor = field("corridor", "mm");
  const [shapeField, shape] = select(
    t("order.shape"),
    [...SHAPES.map((s): [string, string] => [s, t(`shape.${s}` as TextKey)]),
      ["traced", t("shape.traced")]],
    (value) => {
      if (value !== "traced") store.set({ shape: value as Order["shape"], trace: null });
      showOrder();
    },
  );
  const compensate = h("input", { type: "checkbox", onchange: () =>
    store.set({ compensate: compensate.checked }) });
  const problem = h("div", { class: "problem", role: "alert", hidden: true });

  // Beside the drawings the whole form is open; above them, on a narrow screen, it would hide them.
  const wide = matchMedia("(min-width: 900px)");
  const rest = h("details", { class: "rest", open: wide.matches },
    h("summary", {}, t("order.rest")),
    h("section", { class: "card" },
      h("h3", {}, t("order.lens")),
      mediumField,
      designField, designHint, corridor,
      h("div", { class: "row2" }, field("base", "D", true, 4), field("centre", "mm", true, 2)),
      h("div", { class: "row2" }, field("minCentre", "mm"), field("minEdge", "mm")),
      coatField,
      h("div", { class: "row2" }, field("tint", "%"))),
    h("section", { class: "card" },
      h("h3", {}, t("order.frame")),
      shapeField,
      h("div", { class: "row3" }, field("a", "mm"), field("b", "mm"), field("dbl", "mm"))),
    h("section", { class: "card" },
      h("h3", {}, t("order.wear")),
      h("div", { class: "row3" }, field("vertex", "mm"), field("panto", "°"), field("wrap", "°")),
      h("div", { class: "row2" }, field("refraction", "mm", true, 12), field("camera", "mm")),
      h("label", { class: "check" }, compensate, t("order.compensate")),
      h("p", { class: "hint" }, t("order.wearHint"))),
    filesCard(store, () => showOrder()),
  );
  wide.addEventListener("change", () => {
    rest.open = wide.matches;
  });

  const root = h("form", { class: "order", "aria-label": t("order.title"), novalidate: true },
    problem,
    eyes.right.root,
    eyes.left.root,
    h("button", { type: "button", class: "quiet", onclick: () => {
      store.set({ left: { ...store.order.right, pd: store.order.left.pd } });
      showOrder();
    } }, t("order.copyRight")),
    rest,
  );
  root.addEventListener("submit", (event) => event.preventDefault());

  function showDesign(): void {
    const { order } = store;
    corridor.hidden = order.design !== "progressive" && order.design !== "soft";
    designHint.hidden = order.design === "single" || EYES.some((eye) => order[eye].add > 0);
  }
  function showOrder(): void {
    const { order } = store;
    for (const eye of EYES) eyes[eye].show(order[eye]);
    for (const [name, f] of Object.entries(plain)) f.set(order[name as PlainField]);
    medium.value = order.medium;
    design.value = order.design;
    coat.value = order.coat;
    compensate.checked = order.compensate;
    showDesign();
    shape.value = order.trace ? "traced" : order.shape;
    (shape.lastElementChild as HTMLOptionElement).disabled = !order.trace;
  }
  showOrder();
  store.onReplaced(showOrder);
  store.onLenses(({ order, sheet }) => {
    showDesign();
    plain.base?.setPlaceholder(fixed(sheet.right.front_power_D[0], 2));
    plain.centre?.setPlaceholder(fixed(sheet.right.center_thickness_mm, 1));
    plain.refraction?.setPlaceholder(fixed(order.vertex, 1));
  });
  store.onProblem((p) => {
    problem.hidden = p === null;
    for (const eye of EYES) eyes[eye].setImpossible(p?.eye === eye ? p.text : null);
    if (!p) return;
    problem.replaceChildren(
      h("strong", {}, t("error.impossible", { eye: t(`eye.${p.eye}` as TextKey) })),
      h("p", {}, p.text),
      h("p", {}, t("error.lastGood")),
    );
  });
  return root;
}
