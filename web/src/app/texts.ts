// SPDX-License-Identifier: Apache-2.0
// Every sentence of the page comes from texts/en.json; another language is another such file.

import english from "../texts/en.json";

export type TextKey = keyof typeof english;
const texts: Record<string, string> = english;

// The text of `key` with {name} replaced by values.name.
export function t(key: TextKey, values: Record<string, string | number> = {}): string {
  return texts[key].replace(/\{(\w+)\}/g, (whole, name) => String(values[name] ?? whole));
}

export const hasText = (key: string): key is TextKey => key in texts;
