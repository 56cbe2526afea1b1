// SPDX-License-Identifier: Apache-2.0
// How fast the page is, in Chromium: `scripts/web measure`. Prints, and judges nothing: what a
// machine does beside this is not the page's doing.

import { launch, missing, openPage } from "./browser.mjs";
import { serve } from "./server.mjs";

const RUNS = 5;
const STEPS = 24;

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const told = (values) => `${median(values).toFixed(1)} ms (median of ${values.length}; ` +
  `${Math.min(...values).toFixed(1)} to ${Math.max(...values).toFixed(1)})`;

if (missing) throw new Error(missing);
const browser = await launch();
const host = await serve();

const first = [];
for (let k = 0; k < RUNS; ++k) {
  const { page, close } = await openPage(browser, host.url);
  first.push(await page.evaluate(() => performance.getEntriesByName("first view")[0].startTime));
  await close();
}
console.log(`first view, after navigation began, empty cache: ${told(first)}`);

// From the slider's event until every figure stands (the mark "figures"), and until the next frame.
const step = (page) => page.evaluate(async (steps) => {
  const slider = document.querySelector('.eye-right input[type="range"]');
  const spent = { figures: [], painted: [] };
  for (let i = 0; i < steps; ++i) {
    slider.value = String((i % 2 ? -4 : -4.25) - Math.floor(i / 2) / 4);
    const start = performance.now();
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    spent.figures.push(performance.now() - start);
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
    spent.painted.push(performance.now() - start);
  }
  return spent;
}, STEPS);

for (const [what, hash] of [
  ["overview", ""],
  ["overview, tilted and compensated", "#panto=9&wrap=5&compensate=1"],
  ["overview, hard progressive", "#d=progressive&r=-2_0__2_0_0_32&l=-2_0__2_0_0_32"],
  ["overview, soft progressive", "#d=soft&r=-2_0__2_0_0_32&l=-2_0__2_0_0_32"],
  ["rays", "#tab=rays"],
  ["maps", "#tab=maps"],
  ["maps, soft progressive", "#tab=maps&d=soft&r=-2_0__2_0_0_32&l=-2_0__2_0_0_32"],
  ["why", "#tab=why"],
  ["3D", "#tab=solid"],
]) {
  const { page, close } = await openPage(browser, host.url, { hash });
  await step(page);
  const { figures, painted } = await step(page);
  console.log(`slider step, ${what}: every figure ${told(figures)}; next frame ${told(painted)}`);
  await close();
}
await browser.close();
host.close();
