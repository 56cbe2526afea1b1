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
const SEEN_EVERY = 5; // of them also as a camera sees them
const MIN_CENTRE_MM = 1.5; // the program's own are those of the medium
const MIN_EDGE_MM = 1;
// Both compilers keep to IEEE double and contract nothing; the C libraries differ in the last digit
// of sin, cos and atan2, a few ulp, which the steepest of these lenses magnify about 100 times.
const RELATIVE = 1e-12;
// Below this a number is compared absolutely; one that is measured by the differences of rays, or
// left over by a search, from 10 (D, degrees) on: those state an error of their own, above 1e-13.
const FLOOR = 1e-3;
const MEASURED = /^(certificate|worn)/;
const MEASURED_FLOOR = 10;
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

const CORRIDOR_MM = 16;
// The page's multifocal fronts, and how the program is asked for each.
const FRONTS = [
  ["round", "--multifocal=round", "--segment-width=24"],
  ["flat28", "--multifocal=flat-top", "--segment-width=28"],
  ["flat35", "--multifocal=flat-top", "--segment-width=35"],
  ["executive", "--multifocal=executive"],
  ["progressive", "--multifocal=progressive", `--corridor=${CORRIDOR_MM}`],
  ["soft", "--multifocal=soft", `--corridor=${CORRIDOR_MM}`],
];

function randomOrder(random) {
  const chance = (share) => random() < share;
  const quarter = (low, high) => low + 0.25 * Math.floor(random() * ((high - low) * 4 + 1));
  const pick = (list) => list[Math.floor(random() * list.length)];
  const cylinder = chance(0.3) ? 0 : quarter(-4, 4);
  const vertex = 11 + Math.floor(random() * 5);
  const [design, ...multifocal] = chance(0.6) ? ["single"] : pick(FRONTS);
  // Leaning, or worn elsewhere than tested, and made for that; 0.5 mm so that it is never none.
  const wear = chance(0.8) ? null : { panto: Math.floor(random() * 15), wrap: Math.floor(random() * 10),
    refraction: vertex + 0.5 };
  return {
    eye: pick(["right", "left"]),
    sphere: quarter(-10, 8),
    cylinder,
    axis: cylinder === 0 ? 180 : 1 + Math.floor(random() * 180),
    add: design === "single" ? 0 : quarter(0.75, 3),
    prism_in: chance(0.3) ? quarter(-3, 3) : 0,
    prism_up: chance(0.3) ? quarter(-3, 3) : 0,
    index: pick([1.498, 1.523, 1.532, 1.586, 1.594, 1.66, 1.732]),
    density: pick([1.32, 2.54, 1.11, 1.2]),
    base: chance(0.5) ? quarter(1, 9) : null,
    centre: chance(0.2) ? 5 + quarter(0, 4) : null,
    diameter: 40 + Math.floor(random() * 25),
    design,
    multifocal,
    coat: pick(["none", "single", "v", "broadband"]),
    tint: chance(0.3) ? 0.05 + 0.05 * Math.floor(random() * 16) : 0,
    vertex,
    wear,
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
  add: o.add,
  prism_in: o.prism_in,
  prism_up: o.prism_up,
  design: o.design,
  corridor_mm: CORRIDOR_MM,
  coat: o.coat,
  tint: o.tint,
  medium: { name: "medium", index_d: o.index, density_g_cm3: o.density },
  ...(o.base === null ? {} : { base_curve_D: o.base }),
  ...(o.centre === null ? {} : { center_thickness_mm: o.centre }),
  diameter_mm: o.diameter,
  min_center_thickness_mm: MIN_CENTRE_MM,
  min_edge_thickness_mm: MIN_EDGE_MM,
  vertex_distance_mm: o.vertex,
  ...(o.wear === null ? {} : { compensate: true, pantoscopic_deg: o.wear.panto,
    face_form_deg: o.wear.wrap, refraction_vertex_mm: o.wear.refraction }),
  camera_mm: o.camera,
  depth_mm: o.depth,
  feature_height_mm: o.height,
  feature_meridian_deg: o.cylinder === 0 ? 180 : o.axis,
});

// `seen`: as a camera sees it, which puts the entrance pupil of the wearer's own magnification at the
// depth of what is seen.
function toProgram(o, seen) {
  const args = ["lens", "--json", `--sphere=${o.sphere}`, `--eye=${o.eye}`, `--index=${o.index}`,
    `--density=${o.density}`, `--diameter=${o.diameter}`, `--vertex=${o.vertex}`,
    `--min-center=${MIN_CENTRE_MM}`, `--min-edge=${MIN_EDGE_MM}`, `--coat=${o.coat}`,
    `--prism-in=${o.prism_in}`, `--prism-up=${o.prism_up}`, ...o.multifocal];
  if (o.cylinder !== 0) args.push(`--cylinder=${o.cylinder}`, `--axis=${o.axis}`);
  if (o.add !== 0) args.push(`--add=${o.add}`);
  if (o.base !== null) args.push(`--base=${o.base}`);
  if (o.centre !== null) args.push(`--center-thickness=${o.centre}`);
  if (o.tint !== 0) args.push(`--tint=${1 - o.tint}`);
  if (o.wear !== null) {
    args.push(`--pantoscopic=${o.wear.panto}`, `--face-form=${o.wear.wrap}`,
      `--refraction-vertex=${o.wear.refraction}`);
  }
  if (seen) args.push(`--camera=${o.camera}`, `--depth=${o.depth}`, `--height=${o.height}`);
  return args;
}

const MERIDIANS = ["back_vertex_power_D", "front_vertex_power_D", "equivalent_power_D",
  "front_power_D", "back_power_D", "paper_power_D", "paper_power_error_D", "shape_factor",
  "power_factor"];

// How many times larger than the power of a meridian its surfaces are, at least once.
function cancellation({ meridians }, i) {
  const at = (name) => Math.abs(meridians[name][i]);
  return Math.max(1, Math.max(at("front_power_D"), at("back_power_D")) / at("equivalent_power_D"));
}

// A form of the program, always with a minus cylinder, as the order writes its own.
function written({ sphere_D, cylinder_D, axis_deg }, order) {
  return order.cylinder > 0 && cylinder_D !== 0
    ? { sphere: sphere_D + cylinder_D, cylinder: -cylinder_D, axis: (axis_deg + 90) % 180 }
    : { sphere: sphere_D, cylinder: cylinder_D, axis: axis_deg };
}

// [name, page, native] of every number that both state; either may be null.
function numbers(page, lens, order, seen) {
  const rows = [];
  const add = (name, a, b) => rows.push([name, a, b]);
  for (const name of seen ? MERIDIANS : [...MERIDIANS, "spectacle_magnification"]) {
    for (const i of [0, 1]) add(`${name}[${i}]`, page[name][i], lens.meridians[name][i]);
  }
  for (const i of [0, 1]) {
    add(`radius_front_mm[${i}]`, page.radius_front_mm[i], lens.radii_front_mm[i]);
    add(`radii_back_mm[${i}]`, page.radii_back_mm[i], lens.radii_back_mm[i]);
    for (const [key, value] of Object.entries(lens.cardinal_points[i] ?? {})) {
      add(`${key}[${i}]`, page.cardinal[i][key], value);
    }
  }
  add("edge_thickness_min_mm", page.edge_thickness_mm[0], lens.edge_thickness_min_mm);
  add("edge_thickness_mm", page.edge_thickness_mm[1], lens.edge_thickness_mm);
  for (const name of ["center_thickness_mm", "mass_g", "min_blank_mm"]) {
    add(name, page[name], lens[name]);
  }
  for (const name of ["luminous_transmittance", "filter_category"]) {
    add(name, page[name], lens.light[name]);
  }
  if (seen) {
    for (const name of ["thin", "paraxial", "exact"]) {
      const key = `observer_magnification_${name}`;
      add(key, page[key], lens[key]);
    }
  } else {
    add("pupil_mm", page.pupil_mm, lens.pupil_mm);
  }
  for (const which of order.wear ? ["target", "worn"] : []) {
    const form = written(lens.wear[which], order);
    add(`${which} sphere`, page[which].sphere, form.sphere);
    add(`${which} cylinder`, page[which].cylinder, form.cylinder);
    if (order.cylinder !== 0) add(`${which} axis`, page[which].axis % 180, form.axis % 180);
  }
  if (order.wear) {
    for (const name of ["prism_in", "prism_up"]) {
      add(`worn ${name}`, page.worn[name], lens.wear.worn[name]);
    }
  }
  assert.deepEqual(page.certificate.map((m) => m.quantity), lens.certificate.map((m) => m.quantity));
  page.certificate.forEach((m, i) => {
    const { predicted, measured, tolerance, passed } = lens.certificate[i];
    add(`certificate, ${m.quantity}, ordered`, m.ordered, predicted);
    add(`certificate, ${m.quantity}`, m.measured, measured);
    add(`certificate, ${m.quantity}, tolerance`, m.tolerance, tolerance);
    assert.equal(m.passed, passed, m.quantity);
  });
  return rows;
}

async function native(order, seen) {
  try {
    const { stdout } = await run(program, toProgram(order, seen), { maxBuffer: 1 << 20 });
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
  let compared = 0;
  let same = 0; // to the last bit
  let cancelled = 0; // within 1e-12 of the surfaces' powers, not of the number itself
  const compare = async (order, i) => {
    const page = JSON.parse(callText(optics, "_lg_design", 0, JSON.stringify(toPage(order))));
    const seen = i % SEEN_EVERY === 0 && order.wear === null;
    const lens = await native(order, seen);
    const what = JSON.stringify(order);
    assert.equal(page.ok, !lens.refused, `${what}: ${page.error ?? lens.refused}`);
    if (!page.ok) return;
    made += 1;
    for (const [name, a, b] of numbers(page, lens, order, seen)) {
      compared += 1;
      if (a === b) same += 1;
      else if (a === null || b === null) assert.equal(a, b, `${name} of ${what}`);
      const meridian = Number(/\[(\d)\]/.exec(name)?.[1] ?? 0);
      const lost = CANCELS.test(name) ? cancellation(lens, meridian) : 1;
      const floor = MEASURED.test(name) ? MEASURED_FLOOR : FLOOR;
      const strict = Math.abs(a - b) / Math.max(Math.abs(b), floor);
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
  console.log(`${made} lenses, ${compared} numbers, ${same} of them the same to the last bit; ` +
    `worst relative difference ${worst.difference.toExponential(1)} (${worst.name ?? "none"}); ` +
    `${cancelled} numbers by the share of what cancels in them`);
});
