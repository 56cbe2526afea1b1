// SPDX-License-Identifier: Apache-2.0
// Light or dark: the system's choice until the user makes one.

import { t } from "../app/texts";
import { h } from "./dom";

const KEY = "lorgnette-theme";

function stored(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null; // storage is closed to this page
  }
}

export function applyTheme(): void {
  const choice = stored();
  if (choice === "light" || choice === "dark") document.documentElement.dataset.theme = choice;
}

const isDark = (): boolean =>
  (document.documentElement.dataset.theme ??
    (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";

// `onChange`: for what has read the colours and does not follow by itself.
export function themeButton(onChange: () => void): HTMLElement {
  const button = h("button", { type: "button", class: "quiet", onclick: () => {
    const next = isDark() ? "light" : "dark";
    document.documentElement.dataset.theme = next;
    try {
      localStorage.setItem(KEY, next);
    } catch {
      // Without storage the choice lasts as long as the page.
    }
    show();
    onChange();
  } });
  const show = (): void => {
    button.textContent = t(isDark() ? "page.light" : "page.dark");
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    show();
    onChange();
  });
  show();
  return button;
}
