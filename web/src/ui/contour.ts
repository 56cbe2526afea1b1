// SPDX-License-Identifier: Apache-2.0
// Iso-lines of a grid by marching squares, and colours for its values.

export interface Grid {
  n: number; // columns
  m: number; // rows, downwards
  values: Float64Array; // NaN where there is none
}

// Segments of the line value = level, in grid coordinates (column, row).
export function isoLine(grid: Grid, level: number): [number, number, number, number][] {
  const { n, m, values } = grid;
  const segments: [number, number, number, number][] = [];
  for (let j = 0; j + 1 < m; ++j) {
    for (let i = 0; i + 1 < n; ++i) {
      const a = values[j * n + i] - level;
      const b = values[j * n + i + 1] - level;
      const c = values[(j + 1) * n + i + 1] - level;
      const d = values[(j + 1) * n + i] - level;
      if (Number.isNaN(a + b + c + d)) continue;
      const cuts: [number, number][] = [];
      if (a < 0 !== b < 0) cuts.push([i + a / (a - b), j]);
      if (b < 0 !== c < 0) cuts.push([i + 1, j + b / (b - c)]);
      if (c < 0 !== d < 0) cuts.push([i + d / (d - c), j + 1]);
      if (d < 0 !== a < 0) cuts.push([i, j + a / (a - d)]);
      for (let k = 0; k + 1 < cuts.length; k += 2) segments.push([...cuts[k], ...cuts[k + 1]]);
    }
  }
  return segments;
}

// Levels at a round step, at most `most` of them between low and high.
export function roundLevels(low: number, high: number, most = 9): number[] {
  const step = [0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 20].find(
    (candidate) => (high - low) / candidate <= most) ?? 50;
  const levels: number[] = [];
  for (let v = Math.ceil(low / step) * step; v <= high + 1e-12; v += step) {
    levels.push(Math.round(v / step) * step);
  }
  return levels;
}

type Rgb = [number, number, number];
const RISING: Rgb[] = [[247, 251, 249], [190, 224, 220], [120, 190, 192], [240, 190, 110], [196, 92, 30]];
const BOTH: Rgb[] = [[31, 94, 168], [134, 180, 222], [246, 246, 244], [240, 178, 110], [180, 76, 20]];

function along(stops: Rgb[], f: number): Rgb {
  const at = Math.min(0.9999, Math.max(0, f)) * (stops.length - 1);
  const k = Math.floor(at);
  return stops[k].map((v, i) => v + (at - k) * (stops[k + 1][i] - v)) as Rgb;
}

export const rising = (f: number): Rgb => along(RISING, f);
export const aroundZero = (f: number): Rgb => along(BOTH, f);

// The grid as a small picture, for an SVG <image> that smooths it.
export function heatPicture(grid: Grid, colour: (value: number) => Rgb): string {
  const canvas = document.createElement("canvas");
  canvas.width = grid.n;
  canvas.height = grid.m;
  const context = canvas.getContext("2d")!;
  const image = context.createImageData(grid.n, grid.m);
  grid.values.forEach((value, k) => {
    const [r, g, b] = Number.isNaN(value) ? [120, 120, 120] : colour(value);
    image.data.set([r, g, b, 255], 4 * k);
  });
  context.putImageData(image, 0, 0);
  return canvas.toDataURL();
}
