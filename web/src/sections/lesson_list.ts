// SPDX-License-Identifier: Apache-2.0
// The lessons: what to load, where to look, and what is asked. Their sentences are in texts/en.json
// under lesson.<id>; answers are computed here from the formulas that the lesson teaches.

import type { EyeRx, Order } from "../app/order";
import type { MapKind } from "./maps";

export type Question =
  | { kind: "number"; answer: number; tolerance: number; unit: string }
  | { kind: "choice"; options: number; answer: number };

export interface Lesson {
  id: string;
  paragraphs: number;
  look: "overview" | "rays" | "maps" | "why";
  explain?: string; // which number the "why" opens
  map?: MapKind; // which map the maps open with
  lens: Partial<Omit<Order, "right" | "left">> & {
    rx: Partial<EyeRx>;
    other?: Partial<EyeRx>; // how the left eye differs
  };
  questions: Question[];
}

const number = (answer: number, unit: string, tolerance: number): Question => ({
  kind: "number",
  answer,
  tolerance,
  unit,
});
const choice = (answer: number, options = 3): Question => ({ kind: "choice", options, answer });

const moved = (power: number, towardEyeMm: number): number =>
  power / (1 - (towardEyeMm / 1000) * power);
const backVertex = (f1: number, f2: number, mm: number, n: number): number =>
  f1 / (1 - (mm / 1000 / n) * f1) + f2;
const sine = (degrees: number): number => Math.sin((degrees * Math.PI) / 180);
const tangent = (degrees: number): number => Math.tan((degrees * Math.PI) / 180);
const martinSphere = (power: number, degrees: number, n: number): number =>
  power * (1 + sine(degrees) ** 2 / (2 * n));

export const LESSONS: Lesson[] = [
  {
    id: "transposition",
    paragraphs: 2,
    look: "overview",
    lens: { rx: { sphere: 2, cylinder: -1.5, axis: 170 } },
    questions: [number(2 - 1.5, "D", 0.01), number(170 - 90, "°", 0.5)],
  },
  {
    id: "vertex",
    paragraphs: 2,
    look: "why",
    explain: "worn",
    lens: { rx: { sphere: -12, cylinder: 0, axis: null }, vertex: 14, refraction: 10 },
    questions: [number(moved(-12, -4), "D", 0.02), number(moved(-6, 12), "D", 0.02), choice(1)],
  },
  {
    id: "prentice",
    paragraphs: 2,
    look: "maps",
    map: "prism",
    lens: { rx: { sphere: -6, cylinder: 0, axis: null } },
    questions: [number(0.5 * 6, "Δ", 0.02), choice(1), number(0.8 * 5, "Δ", 0.02)],
  },
  {
    id: "thick",
    paragraphs: 2,
    look: "why",
    lens: { rx: { sphere: 7.5, cylinder: 0, axis: null }, medium: "polycarbonate", base: 10.25, a: 46, b: 38 },
    questions: [number(backVertex(10.25, -3, 4, 1.586), "D", 0.01), choice(0)],
  },
  {
    id: "basecurve",
    paragraphs: 2,
    look: "overview",
    lens: { rx: { sphere: 4, cylinder: 0, axis: null }, medium: "CR-39", base: 8 },
    questions: [number(100 * (1 / (1 - (0.004 / 1.498) * 8) - 1), "%", 0.06), choice(2)],
  },
  {
    id: "crossed",
    paragraphs: 2,
    look: "overview",
    lens: { rx: { sphere: 2, cylinder: -4.25, axis: 30 } },
    questions: [number(2, "D", 0.01), number(-2 - 2.25, "D", 0.01), choice(0)],
  },
  {
    id: "minkwitz",
    paragraphs: 2,
    look: "maps",
    map: "progAstigmatism",
    lens: { rx: { sphere: 0, cylinder: 0, axis: null, add: 2 }, design: "progressive", base: 5 },
    questions: [number(2 * (2 / 14), "D/mm", 0.006), number(2 * (2 / 14) * 5, "D", 0.03), choice(1)],
  },
  {
    id: "tilt",
    paragraphs: 2,
    look: "why",
    explain: "worn",
    lens: { rx: { sphere: 6, cylinder: 0, axis: null }, medium: "CR-39", panto: 15 },
    questions: [
      number(martinSphere(6, 15, 1.5), "D", 0.02),
      number(martinSphere(6, 15, 1.5) * tangent(15) ** 2, "D", 0.02),
      choice(0),
    ],
  },
  {
    id: "observer",
    paragraphs: 2,
    look: "overview",
    lens: { rx: { sphere: -6, cylinder: 0, axis: null }, vertex: 12 },
    questions: [number(100 * (1 - 1 / (1 + 0.01505 * 6)), "%", 0.3), choice(2)],
  },
  {
    id: "edge",
    paragraphs: 2,
    look: "overview",
    lens: { rx: { sphere: -6, cylinder: 0, axis: null }, medium: "1.60", base: 2, centre: 1.5,
      shape: "round", a: 60, dbl: 4 },
    questions: [number(1.5 + (900 * 6) / (2000 * 0.594), "mm", 0.06), choice(1)],
  },
  {
    id: "imbalance",
    paragraphs: 2,
    look: "maps",
    map: "prism",
    lens: { rx: { sphere: -2, cylinder: 0, axis: null }, other: { sphere: -5 } },
    questions: [number(0.8 * (5 - 2), "Δ", 0.02), choice(0)],
  },
  {
    id: "decentration",
    paragraphs: 2,
    look: "overview",
    lens: { rx: { sphere: -6, cylinder: 0, axis: null, pd: 31 }, a: 52, b: 40, dbl: 18 },
    questions: [number((52 + 18 - 62) / 2, "mm", 0.05), number(0.1 * 6, "Δ", 0.02)],
  },
  {
    id: "light",
    paragraphs: 2,
    look: "overview",
    lens: { rx: { sphere: -3, cylinder: 0, axis: null }, medium: "1.60", coat: "broadband" },
    questions: [number((100 * 2 * 1.6) / (1.6 ** 2 + 1), "%", 0.1), choice(2)],
  },
];
