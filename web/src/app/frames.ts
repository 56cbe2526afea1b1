// SPDX-License-Identifier: Apache-2.0
// The outline of a boxed lens: a few shapes by formula, or a trace from an OMA file.

import type { EyeName, Order } from "./order";

export type FrameShape = "panto" | "round" | "oval" | "rect";

const POINTS = 144;

// Exponents of the superellipse |x/a|^p + |y/b|^p = 1 above and below the middle.
const EXPONENT: Record<FrameShape, [number, number]> = {
  round: [2, 2],
  oval: [2.3, 2.3],
  panto: [3.4, 2.15],
  rect: [4.6, 3.6],
};

// The right lens as the wearer's front shows it: +x toward the wearer's right (temple), +y up,
// about the middle of the box.
function boxedOutline(order: Order): [number, number][] {
  if (order.trace) {
    // OMA: counter-clockwise as drawn, 0 toward the nose for the right lens.
    const n = order.trace.length;
    return order.trace.map((r, k) => {
      const angle = (2 * Math.PI * k) / n;
      return [-r * Math.cos(angle), r * Math.sin(angle)];
    });
  }
  const points: [number, number][] = [];
  const a = order.a / 2;
  const b = (order.shape === "round" ? order.a : order.b) / 2;
  for (let k = 0; k < POINTS; ++k) {
    const angle = (2 * Math.PI * k) / POINTS;
    const c = Math.cos(angle);
    const d = Math.sin(angle);
    const p = EXPONENT[order.shape][d >= 0 ? 0 : 1];
    const x = a * Math.sign(c) * Math.abs(c) ** (2 / p);
    const y = b * Math.sign(d) * Math.abs(d) ** (2 / p);
    points.push([x, y]);
  }
  return points;
}

// Contour in the lens frame (+x to the wearer's right, +y up) about the optical centre.
export function contourOf(order: Order, eye: EyeName): [number, number][] {
  const toNose = (order.a + order.dbl) / 2 - order[eye].pd;
  const side = eye === "right" ? 1 : -1; // of +x: toward the temple for the right eye
  return boxedOutline(order).map(([x, y]) => [side * (x + toNose), y]);
}

// Farthest reach of the contour from the optical centre along +-(ux, uy).
export function reach(contour: [number, number][], ux: number, uy: number): [number, number] {
  let low = 0;
  let high = 0;
  const n = contour.length;
  for (let i = 0; i < n; ++i) {
    const [x0, y0] = contour[i];
    const [x1, y1] = contour[(i + 1) % n];
    const c0 = x0 * uy - y0 * ux;
    const c1 = x1 * uy - y1 * ux;
    if (c0 * c1 > 0 || c0 === c1) continue;
    const f = c0 / (c0 - c1);
    const along = (x0 + f * (x1 - x0)) * ux + (y0 + f * (y1 - y0)) * uy;
    low = Math.min(low, along);
    high = Math.max(high, along);
  }
  return [low, high];
}

export interface OmaTrace {
  radii: number[]; // mm, of the right lens
  a: number;
  b: number;
  dbl: number | null;
}

const OMA_RADII = 120;

// Shape and box out of an OMA/VCA file with TRCFMT 1 (radii in 1/100 mm); a sentence when it is not.
export function readOma(text: string): OmaTrace | string {
  const lines = text.split(/[\r\n]+/).map((line) => line.trim());
  const value = (label: string): string[] | undefined =>
    lines.find((line) => line.startsWith(`${label}=`))?.slice(label.length + 1).split(";");
  const traces: { side: string; radii: number[] }[] = [];
  let wanted = 0;
  for (const line of lines) {
    if (line.startsWith("TRCFMT=")) {
      const [format, count, spacing, side] = line.slice(7).split(";");
      if (format !== "1") return `TRCFMT: got format ${format}, want 1 (text)`;
      if (spacing !== "E") return `TRCFMT: got spacing ${spacing}, want E (equal angles)`;
      wanted = Number(count);
      if (!(wanted >= 24 && wanted <= 4000)) return `TRCFMT: got ${count} radii, want 24..4000`;
      traces.push({ side, radii: [] });
    } else if (line.startsWith("R=") && traces.length > 0) {
      const radii = line.slice(2).split(";").filter((r) => r !== "").map((r) => Number(r) / 100);
      traces[traces.length - 1].radii.push(...radii);
    }
  }
  const trace = traces.find((candidate) => candidate.side === "R") ?? traces[0];
  if (!trace) return "TRCFMT: missing, want a traced shape";
  if (trace.radii.length !== wanted) return `R: got ${trace.radii.length} radii, want ${wanted}`;
  if (!trace.radii.every((r) => r >= 5 && r <= 60)) return "R: want radii of 5..60 mm";
  const radii = Array.from({ length: OMA_RADII }, (_, k) => {
    // A left trace is the right one mirrored: R[k] = L[(N/2 - k) mod N].
    const at = (k * wanted) / OMA_RADII;
    const turned = trace.side === "L" ? (wanted / 2 - at + wanted) % wanted : at;
    const low = Math.floor(turned);
    const [r0, r1] = [trace.radii[low % wanted], trace.radii[(low + 1) % wanted]];
    return Math.round(100 * (r0 + (turned - low) * (r1 - r0))) / 100; // as a link carries it
  });
  const xs = radii.map((r, k) => r * Math.cos((2 * Math.PI * k) / OMA_RADII));
  const ys = radii.map((r, k) => r * Math.sin((2 * Math.PI * k) / OMA_RADII));
  const box = (v: number[]): number => Math.max(...v) - Math.min(...v);
  const dbl = Number(value("DBL")?.[0] ?? Number.NaN);
  return {
    radii,
    a: Math.round(Number(value("HBOX")?.[0] ?? box(xs)) * 10) / 10,
    b: Math.round(Number(value("VBOX")?.[0] ?? box(ys)) * 10) / 10,
    dbl: Number.isFinite(dbl) && dbl > 0 ? dbl : null,
  };
}
