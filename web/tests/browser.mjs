// SPDX-License-Identifier: Apache-2.0
// Debian's Chromium, without its own talk to the network.

import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

const EXECUTABLE = process.env.CHROMIUM ?? "/usr/bin/chromium";

export const missing = existsSync(EXECUTABLE) ? false : `${EXECUTABLE} is not installed`;

export const launch = () =>
  chromium.launch({
    executablePath: EXECUTABLE,
    timeout: HANG_MS,
    args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
      "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });

// A machine busy with other work is slow, not wrong: nothing here waits for a clock but a hang's.
const HANG_MS = 600_000;

// A page that is ready; `problems` collects errors and requests to anywhere but `url`.
export async function openPage(browser, url, options = {}) {
  const context = await browser.newContext({
    viewport: { width: 1280, height: 900 },
    ...options.context,
  });
  context.setDefaultTimeout(HANG_MS);
  // The same unknown lenses every time (Park and Miller's generator).
  await context.addInitScript(() => {
    let state = 20170918;
    Math.random = () => {
      state = (state * 48271) % 2147483647;
      return state / 2147483647;
    };
  });
  const page = await context.newPage();
  const problems = [];
  page.on("pageerror", (error) => problems.push(`error: ${error.message}`));
  page.on("console", (message) => {
    if (message.type() === "error") problems.push(`console: ${message.text()}`);
  });
  page.on("request", (request) => {
    const to = request.url();
    if (!to.startsWith(url) && !to.startsWith("data:") && !to.startsWith("blob:")) {
      problems.push(`request to ${to}`);
    }
  });
  await page.goto(url + (options.hash ?? ""), { timeout: HANG_MS });
  await page.waitForSelector("html[data-ready]");
  return { page, problems, close: () => context.close() };
}
