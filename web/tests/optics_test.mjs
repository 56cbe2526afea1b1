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

// What a camera sees through a row of the lens; the fields of PageView, but camera_mm and those
// after it that the test does not name.
function view(slot, { camera = 600, x0, x1, y = 0, depth = 16, faceX = 32, rings = 0, mirrored = 0, n }) {
  const at = optics._malloc(88);
  optics.HEAPF64.set(
    [camera, 0, 0, x0, y - 1e-6, x1, y + 1e-6, depth, faceX, rings, mirrored], at / 8);
  const out = optics._lg_view(slot, at, n, 1);
  optics._free(at);
  return [...optics.HEAPF32.slice(out / 4, out / 4 + 4 * n)];
}
const viewRow = (slot) => view(slot, { x0: -5, x1: 5, n: 5 });

test("a plano lens moves the picture only by its thickness", () => {
  assert.ok(design(2, { sphere: 0, base_curve_D: 0, center_thickness_mm: 2 }).ok);
  const row = viewRow(2);
  for (let i = 0; i < 5; ++i) {
    const x = -4 + 2 * i;
    // Straight on: x (600 + 2 + 16) / 600; a slab shortens the path by t (1 - 1/n) = 0.665 mm. The
    // answer is where the camera sees that point without the lens, from the middle of the face.
    const bent = (x * (600 + 2 + 16 - 2 * (1 - 1 / 1.498))) / 600;
    const bare = 32 + (bent * 600) / 618;
    // 1e-4 mm: float output, the slab's law to first order of angles below 1/100, and the nose's
    // last 1e-3 mm of depth at the pupil.
    assert.ok(Math.abs(row[4 * i + 1] - bare) < 1e-4, `x ${x}: ${row[4 * i + 1]} against ${bare}`);
    assert.equal(row[4 * i], 0);
  }
});

test("a slot without a lens answers with lost rays, not with numbers", () => {
  assert.notEqual(viewRow(3)[0], 0);
});

test("Minkwitz: beside the corridor astigmatism grows twice as fast as power", () => {
  const n = 201;
  const half = 10;
  const at = optics._lg_progressive_map(5, 2, 14, 1.6, 0, half, n) / 8;
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
  view(0, { camera: 1e6, x0: 0, x1: 28, rings: 1, n });
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

test("a soft progressive front spreads the astigmatism of the hard one", () => {
  const worst = (soft) => {
    const n = 61;
    const at = optics._lg_progressive_map(5, 2, 14, 1.6, soft, 25, n) / 8;
    const map = optics.HEAPF64.slice(at, at + 2 * n * n);
    let most = 0;
    for (let k = 0; k < n * n; ++k) {
      const [x, y] = [(k % n) - 30, Math.floor(k / n) - 30];
      if (Math.hypot(x, y) < 30) most = Math.max(most, map[2 * k + 1]);
    }
    return most;
  };
  // kSoftLeastGain of optics/soft_progressive.h.
  assert.ok(worst(1) < 0.75 * worst(0), `${worst(1)} against ${worst(0)}`);
});

test("a lens that leans acts stronger, about the axis of the tilt; compensation takes it back", () => {
  // Small and thin, since the rules are those of thin lenses.
  const lean = { sphere: 6, medium: { index_d: 1.5 }, diameter_mm: 10, min_edge_thickness_mm: 0.1,
    min_center_thickness_mm: 0.2, pantoscopic_deg: 15 };
  const worn = design(0, lean).worn;
  // Martin's rule to second order: 6.134 and 0.44 x 180; the next order and the thickness of 0.25 mm
  // make a hundredth of each, 0.08 D and 0.02 D.
  const plus = worn.cylinder < 0
    ? { sphere: worn.sphere + worn.cylinder, cylinder: -worn.cylinder, axis: (worn.axis + 90) % 180 }
    : worn;
  assert.ok(Math.abs(plus.sphere - 6.134) < 0.08, JSON.stringify(worn));
  assert.ok(Math.abs(plus.cylinder - 0.44) < 0.02, JSON.stringify(worn));
  assert.ok(Math.abs(((plus.axis + 90) % 180) - 90) < 0.01, JSON.stringify(worn));
  const made = design(0, { ...lean, compensate: true });
  assert.ok(made.ok, made.error);
  // kWearTolerance_D of optics/wear.h is 1e-9; sphere and cylinder are sums of its three numbers.
  assert.ok(Math.abs(made.worn.sphere - 6) < 4e-9, JSON.stringify(made.worn));
  assert.ok(Math.abs(made.worn.cylinder) < 4e-9, JSON.stringify(made.worn));
  assert.ok(made.made.sphere < 5.95, JSON.stringify(made.made));
});

test("a lens worn nearer than tested is made for its place", () => {
  const made = design(0, { sphere: -12, vertex_distance_mm: 10, refraction_vertex_mm: 14,
    compensate: true });
  // -12 / (1 - 0.004 (-12)), exact; 4e-9 as above.
  assert.ok(Math.abs(made.worn.sphere + 12 / 1.048) < 4e-9, JSON.stringify(made.worn));
});

test("a parallel plate mirrors straight back, twice, with the shares of its two surfaces", () => {
  assert.ok(design(2, { sphere: 0, base_curve_D: 0, center_thickness_mm: 2 }).ok);
  view(2, { x0: -6, x1: 6, mirrored: 1, n: 3 });
  const rows = optics.HEAPF32.slice(optics._lg_mirrored() / 4, optics._lg_mirrored() / 4 + 30);
  const r = (0.498 / 2.498) ** 2;
  for (let i = 0; i < 3; ++i) {
    const x = -4 + 4 * i;
    const sine = x / Math.hypot(x, 600);
    for (const [at, share] of [[0, r], [5, (1 - r) ** 2 * r]]) {
      // 1e-6: float output.
      assert.ok(Math.abs(rows[10 * i + at] - sine) < 1e-6, `${rows[10 * i + at]} against ${sine}`);
      for (const c of [2, 3, 4]) {
        // 1e-5: at angles below 1/100 Fresnel's reflectance changes by a part in 10^4 of itself.
        assert.ok(Math.abs(rows[10 * i + at + c] - share) < 1e-5, `${rows[10 * i + at + c]}`);
      }
    }
  }
});

test("light through the picture is the sheet's straight on, and less where it meets the lens aslant", () => {
  for (const coat of ["none", "single", "v", "broadband"]) {
    const sheet = design(2, { sphere: 0, base_curve_D: 0, center_thickness_mm: 2, coat, tint: 0.3 });
    // To 63 degrees, and such that the rays meet the middle of the face.
    const row = view(2, { camera: 20, x0: -0.5, x1: 40.5, n: 41, faceX: -60 });
    // The table multiplies two averages over the spectrum where the sheet averages the product: they
    // differ by the reflectances' variance, below 1e-3 for these coats.
    assert.ok(Math.abs(row[3] - sheet.luminous_transmittance) < 1e-3,
      `${coat}: ${row[3]} against ${sheet.luminous_transmittance}`);
    const aslant = row.filter((_, i) => i % 4 === 3 && row[i - 3] === 0);
    assert.ok(aslant[aslant.length - 1] < row[3] - 0.02, `${coat}: ${aslant[aslant.length - 1]}`);
  }
});

test("the focimeter reads the order at the centre and Prentice beside it", () => {
  assert.ok(design(3, { sphere: -4, cylinder: -1.5, axis: 30 }).ok);
  const read = (x, y, turned = 0) => {
    const at = optics._lg_focimeter(3, x, y, turned) / 8;
    return [...optics.HEAPF64.slice(at, at + 6)];
  };
  const [mean, j0, j45] = read(0, 0);
  // The instrument's own pupil of 2.5 mm sees a little of the lens' aberration: below 0.02 D here.
  assert.ok(Math.abs(mean + 4.75) < 0.02 && Math.abs(j0 - 0.375) < 0.02 &&
    Math.abs(j45 - 0.75 * Math.sin(Math.PI / 3)) < 0.02, `${[mean, j0, j45]}`);
  const [, , , px, py] = read(0, -5);
  // base = -F r by Long's matrix in the lens frame; rays and Prentice differ by the lens' thickness
  // and curves, below 6 per cent at 5 mm.
  const f = [[-4.75 + 0.375, -0.75 * Math.sin(Math.PI / 3)], [-0.75 * Math.sin(Math.PI / 3), -4.75 - 0.375]];
  const base = [0.5 * f[0][1], 0.5 * f[1][1]];
  assert.ok(Math.hypot(px - base[0], py - base[1]) < 0.06 * Math.hypot(...base), `${[px, py]} ${base}`);
  // Turned round it reads the front vertex power, weaker in the mean for a lens thick enough.
  assert.notEqual(read(0, 0, 1)[0], mean);
});

test("the very same order in another slot gives the very same text", () => {
  const order = { sphere: -3.5, cylinder: 1, axis: 77, pantoscopic_deg: 8, face_form_deg: 5 };
  assert.deepEqual(design(0, order), design(1, order));
});
