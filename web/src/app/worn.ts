// SPDX-License-Identifier: Apache-2.0
// From the lens's own frame to the straight one, in which face and camera stand still.

import type { Worn } from "./engine";

export type Point = [number, number, number];

export function direct(worn: Worn, [x, y, z]: Point): Point {
  const m = worn.turn;
  return [
    m[0] * x + m[1] * y + m[2] * z,
    m[3] * x + m[4] * y + m[5] * z,
    m[6] * x + m[7] * y + m[8] * z,
  ];
}

export function straight(worn: Worn, point: Point): Point {
  const [x, y, z] = direct(worn, point);
  return [x + worn.origin[0], y + worn.origin[1], z + worn.origin[2]];
}
