// SPDX-License-Identifier: Apache-2.0
// A number that is typed, stepped by arrow keys or by two buttons. A wrong entry says what is wanted
// and changes nothing.

import { fixed, parseNumber, signed } from "../app/format";
import type { Limit } from "../app/order";
import { t } from "../app/texts";
import { h, uniqueId } from "./dom";

export interface NumberField {
  root: HTMLElement;
  input: HTMLInputElement;
  set(value: number | null): void;
  setProblem(text: string | null): void;
  setPlaceholder(text: string): void;
}

interface Options {
  label: string;
  name?: string; // full name for screen readers where the label is short
  limit: Limit;
  unit?: string;
  showSign?: boolean;
  empty?: boolean; // an empty field is a value (null)
  startAt?: number; // where stepping starts from an empty field
  onValue: (value: number | null, how: "typed" | "stepped") => void;
}

const BIG_STEP = 4;

export function numberField(options: Options): NumberField {
  const { limit } = options;
  const id = uniqueId("field");
  let current: number | null = null;
  const show = (value: number | null): string =>
    value === null ? "" : options.showSign ? signed(value, limit.places) : fixed(value, limit.places);

  const input = h("input", {
    id,
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    spellcheck: "false",
    role: "spinbutton",
    "aria-valuemin": limit.min,
    "aria-valuemax": limit.max,
    "aria-label": options.name,
  });
  const problem = h("p", { class: "field-problem", id: `${id}-problem`, hidden: true });
  const range = t("field.range", {
    min: fixed(limit.min, limit.places),
    max: fixed(limit.max, limit.places),
  });

  function setProblem(text: string | null): void {
    problem.hidden = text === null;
    problem.textContent = text ?? "";
    input.setAttribute("aria-invalid", String(text !== null));
    if (text === null) input.removeAttribute("aria-describedby");
    else input.setAttribute("aria-describedby", problem.id);
  }
  function describe(): void {
    if (current === null) input.removeAttribute("aria-valuenow");
    else input.setAttribute("aria-valuenow", String(current));
    input.setAttribute("aria-valuetext", current === null ? t("field.byRule") : show(current));
  }
  function take(value: number | null, how: "typed" | "stepped"): void {
    current = value;
    describe();
    setProblem(null);
    options.onValue(value, how);
  }
  // `final`: the user has left the field, so that a half-typed entry counts as wrong.
  function read(final: boolean): void {
    const text = input.value.trim();
    if (text === "" && options.empty) return take(null, "typed");
    const halfTyped = /^[+\-−]?[.,]?$/.test(text);
    const value = parseNumber(text);
    if (Number.isNaN(value)) {
      if (final || !halfTyped) setProblem(t("field.wantNumber", { range }));
      return;
    }
    if (value < limit.min || value > limit.max) {
      if (final || text.length > 2) setProblem(t("field.got", { got: text, range }));
      return;
    }
    take(value, "typed");
  }
  function step(by: number): void {
    const from = current ?? options.startAt ?? 0;
    const next = current === null ? from : from + by * limit.step;
    const snapped = Math.round(next / limit.step) * limit.step;
    take(Math.min(limit.max, Math.max(limit.min, Number(snapped.toFixed(4)))), "stepped");
    input.value = show(current);
  }

  input.addEventListener("input", () => read(false));
  input.addEventListener("blur", () => {
    read(true);
    if (problem.hidden) input.value = show(current);
  });
  input.addEventListener("focus", () => input.select());
  input.addEventListener("keydown", (event) => {
    const steps: Record<string, number> = {
      ArrowUp: 1,
      ArrowDown: -1,
      PageUp: BIG_STEP,
      PageDown: -BIG_STEP,
    };
    if (event.key in steps) {
      event.preventDefault();
      step(steps[event.key]);
    } else if (event.key === "Enter") {
      read(true);
    }
  });

  const button = (by: number, sign: string): HTMLElement =>
    h("button", { type: "button", class: "step", tabindex: -1, "aria-hidden": "true",
      onclick: () => step(by) }, sign);
  const root = h("div", { class: "field" },
    h("label", { for: id }, options.label,
      options.unit ? h("span", { class: "unit" }, ` ${options.unit}`) : null),
    h("div", { class: "stepper" }, button(-1, "−"), input, button(1, "+")),
    problem,
  );
  return {
    root,
    input,
    set(value) {
      current = value;
      describe();
      if (document.activeElement !== input) input.value = show(value);
      setProblem(null);
    },
    setProblem,
    setPlaceholder(text) {
      input.placeholder = text;
    },
  };
}
