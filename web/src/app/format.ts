// SPDX-License-Identifier: Apache-2.0
// Numbers as opticians write them: a sign on powers, a true minus, fixed places.

export function fixed(value: number | null | undefined, places: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "∞";
  const text = value.toFixed(places);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
}

export function signed(value: number | null | undefined, places = 2): string {
  const text = fixed(value, places);
  return value !== null && value !== undefined && value > 0 && Number(text) !== 0
    ? `+${text}`
    : text;
}

// "+1,25" or "−0.5" as a number; NaN when it is none.
export function parseNumber(text: string): number {
  const plain = text.trim().replace("−", "-").replace(",", ".");
  return /^[+-]?(\d+\.?\d*|\.\d+)$/.test(plain) ? Number(plain) : Number.NaN;
}

// "−4.25 −0.75 × 160"; without a cylinder that shows at these places, the sphere alone.
export function rxText(
  form: { sphere: number; cylinder: number; axis: number | null },
  places = 2,
): string {
  if (Math.abs(form.cylinder) < 0.5 * 10 ** -places) return signed(form.sphere, places);
  const axis = form.axis || 180;
  const whole = Math.abs(axis - Math.round(axis)) < 0.05;
  return `${signed(form.sphere, places)} ${signed(form.cylinder, places)} × ${fixed(axis, whole ? 0 : 1)}`;
}
