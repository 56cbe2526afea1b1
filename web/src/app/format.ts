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
