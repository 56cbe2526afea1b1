// SPDX-License-Identifier: Apache-2.0
// Lens media: d-line values, as in docs/optics.md. "1.60", "1.67" and "1.74" are trade names, which
// follow the e line.

export interface Medium {
  name: string;
  index_d: number;
  abbe: number;
  density_g_cm3: number;
}

export const MEDIA: Record<string, Medium> = {
  cr39: { name: "CR-39", index_d: 1.498, abbe: 58, density_g_cm3: 1.32 },
  crown: { name: "Crown glass", index_d: 1.523, abbe: 58.6, density_g_cm3: 2.54 },
  trivex: { name: "Trivex", index_d: 1.53, abbe: 44, density_g_cm3: 1.11 },
  poly: { name: "Polycarbonate", index_d: 1.586, abbe: 30, density_g_cm3: 1.2 },
  "160": { name: "1.60 (MR-8)", index_d: 1.594, abbe: 41, density_g_cm3: 1.3 },
  "167": { name: "1.67 (MR-10)", index_d: 1.66, abbe: 32, density_g_cm3: 1.37 },
  "174": { name: "1.74 (MR-174)", index_d: 1.732, abbe: 33, density_g_cm3: 1.47 },
};
