// SPDX-License-Identifier: Apache-2.0
// The room that a lens mirrors: a window of four panes at the upper left behind the camera, a lamp at
// the right, and walls. A direction is (x to the wearer's right, y up) of a unit vector that points
// from the lens toward the camera's side.

export type Light = [number, number, number]; // linear; white paper in the room's light is 1

const WINDOW = { x0: 0.1, x1: 0.5, y0: 0.1, y1: 0.62, bar: 0.018, light: [9, 9.6, 10.4] as Light };
const LAMP = { x: -0.5, y: 0.34, radius: 0.075, light: [24, 19, 12] as Light };
const SOFT = 0.008; // width of a border, so that it does not flicker between pixels

// 0 outside, 1 inside, smooth over the border.
const step = (distance: number): number => Math.min(1, Math.max(0, 0.5 + distance / (2 * SOFT)));

export function roomAt(x: number, y: number, into: Light): void {
  const wall = 0.22 + 0.16 * Math.max(-1, Math.min(1, y));
  into[0] = wall;
  into[1] = wall * 0.97;
  into[2] = wall * 0.92;
  const w = WINDOW;
  const inside = Math.min(x - w.x0, w.x1 - x, y - w.y0, w.y1 - y);
  if (inside > -SOFT) {
    const bars = Math.min(
      Math.abs(x - (w.x0 + w.x1) / 2) - w.bar, Math.abs(y - (w.y0 + w.y1) / 2) - w.bar);
    const f = step(inside) * step(bars);
    for (let c = 0; c < 3; ++c) into[c] += f * (w.light[c] - into[c]);
    return;
  }
  const lamp = LAMP.radius - Math.hypot(x - LAMP.x, y - LAMP.y);
  if (lamp > -SOFT) {
    const f = step(lamp);
    for (let c = 0; c < 3; ++c) into[c] += f * (LAMP.light[c] - into[c]);
  }
}
