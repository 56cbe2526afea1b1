// SPDX-License-Identifier: Apache-2.0
// Each number of the sheet opens to its formula, the same with the order's own values, and what
// backs it.

import { SLOT } from "../app/engine";
import type { Store } from "../app/store";
import { t, type TextKey } from "../app/texts";
import { view } from "../app/view";
import { h } from "../ui/dom";
import { eyeSwitch } from "../ui/eye_switch";
import { formula } from "../ui/formula";
import { CASES, explanations } from "./explanations";

// The cases that back a number, and how to run them.
function backing(cases: string[]): (string | HTMLElement)[] {
  if (cases.length === 0) return [];
  return [` ${t("why.cases", { cases: cases.join(", ") })} `,
    h("code", {}, `lorgnette validate --case ${cases[0]}`)];
}

export interface WhySection {
  root: HTMLElement;
  open(key: string): void;
}

export function whySection(store: Store, wanted: () => boolean): WhySection {
  const list = h("div", { class: "why-list" });
  const opened = new Set<string>(["backVertex"]);
  const root = h("section", { class: "card why" },
    h("div", { class: "card-head" }, h("h2", {}, t("why.title")), eyeSwitch()),
    h("p", { class: "hint" }, t("why.hint")), list);

  const shells = new Map<string, { shell: HTMLDetailsElement; value: HTMLElement; body: HTMLElement }>();
  function draw(): void {
    const { order, sheet } = store.lenses;
    for (const e of explanations(order, sheet[view.eye], store.engine.worn(SLOT[view.eye]))) {
      let entry = shells.get(e.key);
      if (!entry) {
        const value = h("span", { class: "why-value" });
        const body = h("div", { class: "why-body" });
        const shell = h("details", { id: `why-${e.key}`, open: opened.has(e.key) },
          h("summary", {}, h("span", {}, t(`number.${e.key}` as TextKey)), value), body);
        shell.addEventListener("toggle", () => {
          if (shell.open) opened.add(e.key);
          else opened.delete(e.key);
        });
        entry = { shell, value, body };
        shells.set(e.key, entry);
        list.append(shell);
      }
      entry.value.textContent = e.value;
      entry.body.replaceChildren(
        h("p", {}, t(`why.${e.key}.text` as TextKey)),
        ...e.steps.map((step, i) => formula(step, i === 0 ? "formula" : "formula values")),
        ...(e.extra ? [e.extra] : []),
        h("p", { class: "source" }, `${t("why.source")} ${t(`why.${e.key}.source` as TextKey)}`,
          ...backing(CASES[e.key])),
      );
    }
  }
  store.onLenses(draw, wanted);
  view.onChange(() => {
    if (wanted()) draw();
  });
  return {
    root,
    open(key) {
      opened.add(key);
      const entry = shells.get(key);
      if (!entry) return;
      entry.shell.open = true;
      entry.shell.scrollIntoView({ block: "center" });
      entry.shell.querySelector("summary")?.focus();
    },
  };
}
