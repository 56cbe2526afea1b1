// SPDX-License-Identifier: Apache-2.0
// The WebAssembly optics in node.

import { fileURLToPath } from "node:url";

const module = fileURLToPath(new URL("../src/wasm/optics.mjs", import.meta.url));

export const loadOptics = async () => (await import(module)).default();

// A function of the page's API that takes texts last and returns text.
export function callText(optics, name, ...args) {
  const pointers = [];
  const plain = args.map((arg) => {
    if (typeof arg !== "string") return arg;
    const size = optics.lengthBytesUTF8(arg) + 1;
    const at = optics._malloc(size);
    optics.stringToUTF8(arg, at, size);
    pointers.push(at);
    return at;
  });
  const text = optics.UTF8ToString(optics[name](...plain));
  pointers.forEach((at) => optics._free(at));
  return text;
}
