// SPDX-License-Identifier: Apache-2.0
// The module that scripts/web builds from web/wasm.
declare module "*/wasm/optics.mjs" {
  export interface OpticsModule {
    HEAPF64: Float64Array;
    HEAPF32: Float32Array;
    _malloc(bytes: number): number;
    _free(pointer: number): void;
    _lg_design(slot: number, order: number): number;
    _lg_read_prescription(text: number, name: number): number;
    _lg_media(): number;
    _lg_write_fhir(text: number, date: number): number;
    _lg_gaze_map(slot: number, stop: number, halfX: number, halfY: number, n: number, m: number): number;
    _lg_gaze_line(slot: number, stop: number, meridian: number, max: number, n: number): number;
    _lg_progressive_map(
      far: number,
      add: number,
      corridor: number,
      index: number,
      soft: number,
      half: number,
      n: number,
    ): number;
    _lg_surfaces(slot: number, points: number, count: number): number;
    _lg_fan(
      slot: number,
      meridian: number,
      half: number,
      count: number,
      field: number,
      object: number,
      height: number,
    ): number;
    _lg_view(slot: number, view: number, width: number, height: number): number;
    _lg_rings(): number;
    _lg_mirrored(): number;
    _lg_worn(slot: number): number;
    _lg_focimeter(slot: number, x: number, y: number, turned: number): number;
    UTF8ToString(pointer: number): string;
    stringToUTF8(text: string, pointer: number, bytes: number): void;
    lengthBytesUTF8(text: string): number;
  }
  export default function create(): Promise<OpticsModule>;
}
