// SPDX-License-Identifier: Apache-2.0
// The materials that the optics knows, by name; filled once when the optics has started.

export interface Medium {
  name: string;
  index_d: number;
  abbe: number;
  density_g_cm3: number;
  min_center_mm: number;
  min_edge_mm: number;
}

export const MEDIA: Record<string, Medium> = {};

export function fillMedia(media: Medium[]): void {
  for (const medium of media) MEDIA[medium.name] = medium;
}
