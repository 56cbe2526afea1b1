// SPDX-License-Identifier: Apache-2.0
// A line of mathematics: "F{1}" has a subscript 1, "x^2^" a superscript 2.

import { h } from "./dom";

export function formula(text: string, className = "formula"): HTMLElement {
  const line = h("p", { class: className });
  for (const part of text.split(/(\{[^}]*\}|\^[^^]*\^)/)) {
    if (part.startsWith("{")) line.append(h("sub", {}, part.slice(1, -1)));
    else if (part.startsWith("^")) line.append(h("sup", {}, part.slice(1, -1)));
    else line.append(part);
  }
  return line;
}
