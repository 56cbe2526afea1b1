// SPDX-License-Identifier: Apache-2.0
// Every number of the page is the native program's: 500 random orders through both, within 1e-12.

import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { existsSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import test from "node:test";

import { callText, loadOptics } from "./optics.mjs";

const run = promisify(execFile);
const root = fileURLToPath(new URL("../../", import.meta.url));
const program = process.env.LORGNETTE ?? `${root}build/release/lorgnette`;

const ORDERS = 500;
const AT_ONCE = 4;
const MIN_CENTRE_MM = 1.5; // the program's own are those of the medium
const MIN_EDGE_MM = 1;
const MEASURED_EVERY = 5; // of them also as a camera sees them
// Both compilers keep to IEEE double and contract nothing; what differs is the C library's last
// digit in sin, cos and atan2, a few ulp, which the steepest of these lenses magnify about 100 times.
const RELATIVE = 1e-12;
// Below this a number is compared absolutely.
const FLOOR = 1e-3;
// Powers of the lens and of its surfaces are a few dioptres each; where they cancel, in a meridian
// of almost no power, what is left keeps their rounding. So a power, and a length that is one
// divided by it, is compared as a share of the greatest surface power of its meridian.
const CANCELS = /power_D|principal|focal/;

// Park and Miller's generator: the same orders everywhere.
function generator(seed) {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return state / 2147483647;
  };
}

function randomOrder(random) {
  const quarter = (low, high) => low + 0.25 * Math.floor(random() * ((high - low) * 4 + 1));
  const pick = (list) => list[Math.floor(random() * list.length)];
  const cylinder = random() < 0.3 ? 0 : quarter(-4, 4);
  return {
    eye: pick(["right", "left"]),
    sphere: quarter(-10, 8),
    cylinder,
    axis: cylinder === 0 ? 180 : 1 + Math.floor(random() * 180),
    prism_in: random() < 0.3 ? quarter(-3, 3) : 0,
    prism_up: random() < 0.3 ? quarter(-3, 3) : 0,
    index: pick([1.498, 1.523, 1.532, 1.586, 1.594, 1.66, 1.732]),
    density: pick([1.32, 2.54, 1.11, 1.2]),
    base: random() < 0.5 ? quarter(1, 9) : null,
    diameter: 40 + Math.floor(random() * 25),
    vertex: 11 + Math.floor(random() * 5),
    camera: 300 + 50 * Math.floor(random() * 20),
    depth: 12 + 0.25 * Math.floor(random() * 25),
    height: 3 + 0.25 * Math.floor(random() * 20),
  };
}

const toPage = (o) => ({
  eye: o.eye,
  sphere: o.sphere,
  cylinder: o.cylinder,
  axis: o.axis,
  prism_in: o.prism_in,
  prism_up: o.prism_up,
  medium: { name: "medium", index_d: o.index, density_g_cm3: o.density },
  ...(o.base === null ? {} : { base_curve_D: o.base }),
  diameter_mm: o.diameter,
  min_center_thickness_mm: MIN_CENTRE_MM,
  min_edge_thickness_mm: MIN_EDGE_MM,
  vertex_distance_mm: o.vertex,
  camera_mm: o.camera,
  depth_mm: o.depth,
  feature_height_mm: o.height,
  feature_meridian_deg: o.cylinder === 0 ? 180 : o.axis,
});

function toProgram(command, o) {
  const args = [command, `--sphere=${o.sphere}`, `--eye=${o.eye}`, `--index=${o.index}`,
    `--density=${o.density}`, `--diameter=${o.diameter}`, `--vertex=${o.vertex}`,
    `--min-center=${MIN_CENTRE_MM}`, `--min-edge=${MIN_EDGE_MM}`,
    `--prism-in=${o.prism_in}`, `--prism-up=${o.prism_up}`];
  if (o.cylinder !== 0) args.push(`--cylinder=${o.cylinder}`, `--axis=${o.axis}`);
  if (o.base !== null) args.push(`--base=${o.base}`);
  if (command === "measure") {
    args.push(`--camera=${o.camera}`, `--depth=${o.depth}`, `--height=${o.height}`);
  } else {
    args.push("--json");
  }
  return args;
}

const MERIDIANS = ["back_vertex_power_D", "front_vertex_power_D", "equivalent_power_D",
  "front_power_D", "back_power_D", "paper_power_D", "shape_factor", "power_factor",
  "spectacle_magnification"];

// How many times larger than the power of a meridian its surfaces are, at least once.
function cancellation({ meridians }, i) {
  const at = (name) => Math.abs(meridians[name][i]);
  return Math.max(1, Math.max(at("front_power_D"), at("back_power_D")) / at("equivalent_power_D"));
}

// [name, page, native] of every number that both state; `measured` may be null.
function numbers(page, lens, measured) {
  const rows = [];
  for (const name of MERIDIANS) {
    for (const i of [0, 1]) rows.push([`${name}[${i}]`, page[name][i], lens.meridians[name][i]]);
  }
  for (const i of [0, 1]) {
    rows.push([`radii_back_mm[${i}]`, page.radii_back_mm[i], lens.radii_back_mm[i]]);
    for (const [key, value] of Object.entries(lens.cardinal_points[i] ?? {})) {
      rows.push([`${key}[${i}]`, page.cardinal[i][key], value]);
    }
  }
  rows.push(["radius_front_mm", page.radius_front_mm[0], lens.radius_front_mm]);
  rows.push(["center_thickness_mm", page.center_thickness_mm, lens.center_thickness_mm]);
  rows.push(["edge_thickness_min_mm", page.edge_thickness_mm[0], lens.edge_thickness_min_mm]);
  rows.push(["edge_thickness_mm", page.edge_thickness_mm[1], lens.edge_thickness_mm]);
  rows.push(["mass_g", page.mass_g, lens.mass_g]);
  for (const name of measured ? ["thin", "paraxial", "exact"] : []) {
    const key = `observer_magnification_${name}`;
    rows.push([key, page[key], measured[key]]);
  }
  return rows;
}

async function native(command, order) {
  try {
    const { stdout } = await run(program, toProgram(command, order), { maxBuffer: 1 << 20 });
    return JSON.parse(stdout);
  } catch (error) {
    if (typeof error.code === "number") return { refused: error.stderr };
    throw error;
  }
}

test("the page's numbers are the native program's for 500 random orders", {
  skip: existsSync(program) ? false : `${program} is not built`,
}, async () => {
  const optics = await loadOptics();
  const random = generator(20170918);
  const orders = Array.from({ length: ORDERS }, () => randomOrder(random));
  let worst = { difference: 0 };
  let made = 0;
  let cancelled = 0; // within 1e-12 of the surfaces' powers, not of the number itself
  const compare = async (order, i) => {
    const page = JSON.parse(callText(optics, "_lg_design", 0, JSON.stringify(toPage(order))));
    const lens = await native("lens", order);
    const measured = i % MEASURED_EVERY || lens.refused ? null : await native("measure", order);
    const what = JSON.stringify(order);
    assert.equal(page.ok, !lens.refused, `${what}: ${page.error ?? lens.refused}`);
    if (!page.ok) return;
    made += 1;
    for (const [name, a, b] of numbers(page, lens, measured)) {
      if (a === null || b === null) {
        assert.equal(a, b, `${name} of ${what}`);
        continue;
      }
      const meridian = Number(/\[(\d)\]/.exec(name)?.[1] ?? 0);
      const lost = CANCELS.test(name) ? cancellation(lens, meridian) : 1;
      const strict = Math.abs(a - b) / Math.max(Math.abs(b), FLOOR);
      if (strict > RELATIVE) cancelled += 1;
      const difference = strict / lost;
      if (difference > worst.difference) worst = { difference, name, a, b, what };
      assert.ok(difference <= RELATIVE, `${name} of ${what}: page ${a}, program ${b}`);
    }
  };
  for (let i = 0; i < ORDERS; i += AT_ONCE) {
    await Promise.all(orders.slice(i, i + AT_ONCE).map((order, k) => compare(order, i + k)));
  }
  assert.ok(made > 0.6 * ORDERS, `only ${made} of the orders could be made`);
  console.log(`${made} lenses; worst relative difference ${worst.difference.toExponential(1)} ` +
    `(${worst.name ?? "none"}); ${cancelled} numbers by the share of what cancels in them`);
});
