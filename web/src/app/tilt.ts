// SPDX-License-Identifier: Apache-2.0
// A lens that leans, by the thin-lens matrix and by Martin's rule: for comparison with the rays.

import type { Form, Worn } from "./engine";

export interface Lean {
  degrees: number; // between the lens's axis and the line of sight
  axis: number; // TABO meridian about which it leans
}

export function leanOf({ turn }: Worn): Lean {
  const [x, y, z] = [turn[2], turn[5], turn[8]]; // the lens's axis in the straight frame
  const size = Math.hypot(x, y);
  const axis = size === 0 ? 180 : ((Math.atan2(x, y) * 180) / Math.PI + 360) % 180;
  return { degrees: (Math.atan2(size, z) * 180) / Math.PI, axis: axis || 180 };
}

const radians = (degrees: number): number => (degrees * Math.PI) / 180;

// F_worn = G C^-1 F C^-1 in the axes of the lean (optics/wear.h, ThinTilted).
export function thinTilted(power: Form, lean: Lean, index: number): Form {
  const mean = power.sphere + power.cylinder / 2;
  // Power vector in axes turned so that the tilt's own meridian is 180.
  const twice = 2 * radians(power.axis - lean.axis);
  const j0 = -(power.cylinder / 2) * Math.cos(twice);
  const j45 = -(power.cylinder / 2) * Math.sin(twice);
  const theta = radians(lean.degrees);
  const inside = Math.asin(Math.sin(theta) / index);
  const gain = (index * Math.cos(inside) - Math.cos(theta)) / (index - 1);
  const c = 1 / Math.cos(theta);
  const xx = gain * (mean + j0);
  const xy = gain * c * j45;
  const yy = gain * c * c * (mean - j0);
  const [m, k0, k45] = [(xx + yy) / 2, (xx - yy) / 2, xy];
  const half = Math.hypot(k0, k45);
  const plus = power.cylinder > 0;
  const cylinder = plus ? 2 * half : -2 * half;
  const axis = (Math.atan2(plus ? -k45 : k45, plus ? -k0 : k0) * 90) / Math.PI + lean.axis;
  return { sphere: m - cylinder / 2, cylinder, axis: (((axis % 180) + 180) % 180) || 180 };
}

// For a sphere: S (1 + sin^2 / 2n), and a cylinder of that times tan^2 about the tilt's axis.
export function martin(sphere: number, lean: Lean, index: number): Form {
  const theta = radians(lean.degrees);
  const s = sphere * (1 + Math.sin(theta) ** 2 / (2 * index));
  return { sphere: s, cylinder: s * Math.tan(theta) ** 2, axis: lean.axis };
}
