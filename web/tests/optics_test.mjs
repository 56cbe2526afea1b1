// SPDX-License-Identifier: Apache-2.0
// The page's API by itself, in node.

import assert from "node:assert/strict";
import test from "node:test";

import { callText, loadOptics } from "./optics.mjs";

const optics = await loadOptics();
const design = (slot, order) =>
  JSON.parse(callText(optics, "_lg_design", slot, JSON.stringify(order)));

test("the lens of the paper's Table I has its back vertex power and passes its ray tests", () => {
  const sheet = design(0, { sphere: -4.25, cylinder: -0.75, axis: 160 });
  assert.ok(sheet.ok);
  // Exact by design; 1e-9 D leaves room for rounding in the closed form.
  assert.ok(Math.abs(sheet.back_vertex_power_D[0] + 4.25) < 1e-9);
  assert.ok(Math.abs(sheet.back_vertex_power_D[1] + 5) < 1e-9);
  assert.ok(sheet.certificate.length >= 10);
  assert.ok(sheet.certificate.every((m) => m.passed));
});

test("an unknown key is refused by name", () => {
  const answer = design(0, { sphere: -1, spere: 2 });
  assert.equal(answer.ok, false);
  assert.match(answer.error, /order:spere: unknown key/);
});

test("an impossible lens says what would be possible and leaves the slot's lens", () => {
  assert.ok(design(1, { sphere: -2 }).ok);
  const before = viewRow(1);
  const answer = design(1, { sphere: -40 });
  assert.equal(answer.ok, false);
  assert.match(answer.error, /possible/);
  assert.deepEqual(viewRow(1), before);
});

// Where a camera on the axis, 600 mm away, sees the face through one row of the lens.
function viewRow(slot) {
  const at = optics._malloc(96);
  optics.HEAPF64.set([600, 0, 0, -5, -1e-6, 5, 1e-6, 16, 0, 44, 0, 0], at / 8);
  const out = optics._lg_view(slot, at, 5, 1);
  optics._free(at);
  return [...optics.HEAPF32.slice(out / 4, out / 4 + 20)];
}

test("a plano lens moves the picture only by its thickness", () => {
  assert.ok(design(2, { sphere: 0, base_curve_D: 0, center_thickness_mm: 2 }).ok);
  const row = viewRow(2);
  for (let i = 0; i < 5; ++i) {
    const x = -4 + 2 * i;
    // Straight on: x (600 + 2 + 16) / 600; a slab shortens the path by t (1 - 1/n) = 0.665 mm.
    const bent = (x * (600 + 2 + 16 - 2 * (1 - 1 / 1.498))) / 600;
    // 1e-4 mm: float output, and the slab's law to first order of angles below 1/100.
    assert.ok(Math.abs(row[4 * i + 1] - bent) < 1e-4, `x ${x}: ${row[4 * i + 1]} against ${bent}`);
    assert.equal(row[4 * i], 0);
  }
});

test("a slot without a lens answers with lost rays, not with numbers", () => {
  assert.notEqual(viewRow(3)[0], 0);
});

test("Minkwitz: beside the corridor astigmatism grows twice as fast as power", () => {
  const n = 201;
  const half = 10;
  const at = optics._lg_progressive_map(5, 2, 14, 1.6, half, n) / 8;
  const map = optics.HEAPF64.slice(at, at + 2 * n * n);
  const step = (2 * half) / (n - 1);
  const row = Math.round((half + 7) / step); // y = -7, the middle of the corridor
  const middle = (n - 1) / 2;
  const slope = map[2 * (row * n + middle + 5) + 1] / (5 * step);
  // The golden of the surface: 0.534684 D/mm; over 0.5 mm it is straight to a few parts in 10^5.
  assert.ok(Math.abs(slope - 0.534684) < 2e-4, `${slope}`);
});

test("prescriptions are read from our JSON and from FHIR, and written to FHIR", () => {
  const ours = JSON.stringify({
    OD: { sphere: -4.25, cylinder: -0.75, axis: 160 }, OS: { sphere: -4.5 }, PD: 64 });
  const read = JSON.parse(callText(optics, "_lg_read_prescription", ours, "rx.json"));
  assert.equal(read.OD.cylinder, -0.75);
  assert.deepEqual(read.PD, { right: 32, left: 32 });
  const written = JSON.parse(callText(optics, "_lg_write_fhir", ours, "2026-11-22"));
  assert.ok(written.ok, written.error);
  const again = JSON.parse(callText(optics, "_lg_read_prescription", written.fhir, "fhir.json"));
  assert.ok(again.ok, again.error);
  assert.deepEqual(again.OD, read.OD);
  assert.deepEqual(again.OS, read.OS);
});

test("an axis without a cylinder is refused by key", () => {
  const bad = JSON.stringify({ OD: { sphere: -1, axis: 90 }, OS: { sphere: -1 }, PD: 64 });
  const read = JSON.parse(callText(optics, "_lg_read_prescription", bad, "rx.json"));
  assert.equal(read.ok, false);
  assert.match(read.error, /rx\.json:OD\.axis/);
});

test("the power ring of a strong minus lens starts at total reflection from the front", () => {
  // Plano front, index 1.5: the back has a radius of 50 mm. A camera's ray at height y, straight on,
  // is thrown back at twice the slope a, sin a = y / 50, and reaches the edge's wall in full
  // (but for one reflection of 4 per cent) once sin 2a exceeds 1 / 1.5.
  const sheet = design(0, { sphere: -10, medium: { index_d: 1.5 }, base_curve_D: 0,
    center_thickness_mm: 2, diameter_mm: 56 });
  assert.ok(sheet.ok, sheet.error);
  const start = 50 * Math.sin(Math.asin(1 / 1.5) / 2);
  const n = 2800;
  const at = optics._malloc(96);
  optics.HEAPF64.set([1e6, 0, 0, 0, -1e-6, 28, 1e-6, 16, 0, 200, 0, 1], at / 8);
  optics._lg_view(0, at, n, 1);
  optics._free(at);
  const rings = optics.HEAPF32.slice(optics._lg_rings() / 4, optics._lg_rings() / 4 + n);
  // Below the critical angle reflectance rises ever faster and then stops at 1: the steepest step.
  // (From 17 mm on: farther in, rays miss the wall.)
  let first = 1700;
  for (let i = 1700; i < 2000; ++i) {
    if (rings[i + 1] - rings[i] > rings[first + 1] - rings[first]) first = i;
  }
  // Two pixels of 0.01 mm.
  assert.ok(Math.abs((first + 1) * 0.01 - start) < 0.02, `${first / 100} against ${start}`);
});
