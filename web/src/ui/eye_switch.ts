// SPDX-License-Identifier: Apache-2.0
// Right or left: one choice, shared by every drawing that shows a single lens.

import { EYES } from "../app/order";
import { t, type TextKey } from "../app/texts";
import { view } from "../app/view";
import { h, uniqueId } from "./dom";

export function eyeSwitch(): HTMLElement {
  const name = uniqueId("eye-switch");
  const inputs = EYES.map((eye) => {
    const input = h("input", { type: "radio", name, value: eye, onchange: () => view.setEye(eye) });
    return { eye, input };
  });
  const show = (): void => {
    for (const { eye, input } of inputs) input.checked = view.eye === eye;
  };
  view.onChange(show);
  show();
  return h("fieldset", { class: "switch" },
    h("legend", { class: "visually-hidden" }, t("eye.which")),
    ...inputs.map(({ eye, input }) => h("label", {}, input, t(`eye.${eye}` as TextKey))));
}
