// SPDX-License-Identifier: Apache-2.0
// The study that `lorgnette cost` writes (data/cost.json): ways of computing the same thing, each
// with its time and its errors. A build without that file has none to show.

export interface CostPoint {
  method: string;
  parameter: string;
  time: number;
  time_spread: number; // between the quartiles of the repetitions
  errors: Record<string, number>; // by unit; 0 is the reference
  front: boolean; // nothing is both as fast and as accurate
  preset?: string;
  note?: string;
  ms_per_frame?: number;
}

export interface CostStudy {
  name: string;
  title: string;
  reference?: string;
  time_unit: string;
  error_units: string[];
  error_descriptions?: string[];
  points: CostPoint[];
}

export interface CostReport {
  machine: Record<string, string | number>;
  calibration_ns: number;
  scene?: string;
  studies: CostStudy[];
}

const files = import.meta.glob<{ default: CostReport }>("../../../data/cost.json");

export async function loadCost(): Promise<CostReport | null> {
  const load = Object.values(files)[0];
  return load ? (await load()).default : null;
}

// Errors below this are rounding of doubles, and count as 0 (kRoundingError of the study).
export const ROUNDING = 1e-9;
export const errorOf = (point: CostPoint, unit: string): number =>
  point.errors[unit] < ROUNDING ? 0 : point.errors[unit];

export const nameOf = (point: CostPoint): string =>
  point.parameter ? `${point.method}, ${point.parameter}` : point.method;

// The fastest point within the error; undefined when none keeps it.
export function fastestWithin(study: CostStudy, unit: string, error: number): CostPoint | undefined {
  return study.points
    .filter((p) => errorOf(p, unit) <= error)
    .reduce<CostPoint | undefined>((a, b) => (a && a.time <= b.time ? a : b), undefined);
}

// Those that no other beats in this one unit, by rising time.
export function frontIn(study: CostStudy, unit: string): CostPoint[] {
  const front: CostPoint[] = [];
  for (const p of [...study.points].sort((a, b) => a.time - b.time)) {
    if (front.every((q) => errorOf(q, unit) > errorOf(p, unit))) front.push(p);
  }
  return front;
}
