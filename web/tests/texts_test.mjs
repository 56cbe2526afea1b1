// SPDX-License-Identifier: Apache-2.0
// What the page says is all in one file, and what it cites exists.

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { fileURLToPath } from "node:url";
import test from "node:test";

const root = fileURLToPath(new URL("../../", import.meta.url));
const source = `${root}web/src/`;
const texts = JSON.parse(readFileSync(`${source}texts/en.json`, "utf8"));
const files = readdirSync(source, { recursive: true })
  .filter((name) => name.endsWith(".ts"))
  .map((name) => [name, readFileSync(source + name, "utf8")]);

test("every validation case that an explanation cites is there", () => {
  const have = new Set(readdirSync(`${root}validation/cases`).map((n) => n.slice(0, 4).toUpperCase()));
  const [, code] = files.find(([name]) => name.endsWith("explanations.ts"));
  const cited = [...code.matchAll(/"(V\d{3})"/g)].map((m) => m[1]);
  assert.ok(cited.length > 20);
  for (const name of cited) assert.ok(have.has(name), name);
});

test("every key in the code has a text, and every text is used", () => {
  const used = new Set();
  const families = [/^lesson\./]; // `why.${key}.text`; the lessons' own by the test below
  for (const [, code] of files) {
    for (const [, key] of code.matchAll(/"([a-z]+(?:\.[A-Za-z0-9]+)+)"/g)) used.add(key);
    for (const [, pattern] of code.matchAll(/`([a-z]+\.[^`\s]*)`/g)) {
      const parts = pattern.split(/\$\{[^}]*\}/).map((p) => p.replaceAll(".", "\\."));
      families.push(new RegExp(`^${parts.join(".+")}$`));
    }
  }
  const sections = new Set(Object.keys(texts).map((key) => key.split(".")[0]));
  const isKey = (key) => sections.has(key.split(".")[0]) && key.includes(".");
  assert.deepEqual([...used].filter((key) => isKey(key) && !(key in texts)), []);
  assert.deepEqual(
    Object.keys(texts).filter((key) => !used.has(key) && !families.some((f) => f.test(key))), []);
});

test("every lesson has its title, paragraphs, questions, options and reasons, and no others", () => {
  const [, code] = files.find(([name]) => name.endsWith("lesson_list.ts"));
  const want = [];
  for (const part of code.split(/\n    id: /).slice(1)) {
    const id = part.match(/^"(\w+)"/)[1];
    want.push("title");
    const keys = ["title"];
    const paragraphs = Number(part.match(/paragraphs: (\d)/)[1]);
    for (let k = 1; k <= paragraphs; ++k) keys.push(`p${k}`);
    const questions = [...part.slice(part.indexOf("questions:")).matchAll(/\b(number|choice)\(/g)];
    questions.forEach(([, kind], i) => {
      keys.push(`q${i + 1}`, `q${i + 1}.why`);
      if (kind === "choice") keys.push(...["a", "b", "c"].map((o) => `q${i + 1}.${o}`));
    });
    const have = Object.keys(texts).filter((k) => k.startsWith(`lesson.${id}.`));
    assert.deepEqual(have.sort(), keys.map((k) => `lesson.${id}.${k}`).sort());
  }
  assert.ok(want.length >= 8, `${want.length} lessons`);
});
