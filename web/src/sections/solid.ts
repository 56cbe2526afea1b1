// SPDX-License-Identifier: Apache-2.0
// The cut lens as a solid that turns, by three; the library is loaded when the view is first opened.

import { SLOT } from "../app/engine";
import { contourOf } from "../app/frames";
import type { Store } from "../app/store";
import { t } from "../app/texts";
import { view } from "../app/view";
import { h } from "../ui/dom";
import { eyeSwitch } from "../ui/eye_switch";

const RINGS = 14;
const TURN = 0.12; // radians by arrow key
type Three = typeof import("./solid_three");

// Front and back of the lens on rings from the optical centre to the cut edge, and the wall.
export interface SolidMesh {
  positions: Float32Array; // viewer's x, y up, z toward the viewer, mm
  indices: number[];
}

export function solidMesh(contour: [number, number][], surfaces: (p: number[]) => Float64Array): SolidMesh {
  const n = contour.length;
  const points: number[] = [0, 0];
  for (let r = 1; r <= RINGS; ++r) {
    for (const [x, y] of contour) points.push((x * r) / RINGS, (y * r) / RINGS);
  }
  const z = surfaces(points);
  const count = points.length / 2;
  const positions = new Float32Array(6 * count);
  for (let k = 0; k < count; ++k) {
    const [x, y] = [-points[2 * k], points[2 * k + 1]];
    positions.set([x, y, -z[2 * k]], 3 * k);
    positions.set([x, y, -z[2 * k + 1]], 3 * (count + k));
  }
  const at = (ring: number, k: number): number => (ring === 0 ? 0 : 1 + (ring - 1) * n + (k % n));
  const indices: number[] = [];
  for (let ring = 0; ring < RINGS; ++ring) {
    for (let k = 0; k < n; ++k) {
      const [a, b, c, d] = [at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)];
      indices.push(a, b, c, count + a, count + c, count + b);
      if (ring > 0) indices.push(a, c, d, count + a, count + d, count + c);
    }
  }
  for (let k = 0; k < n; ++k) {
    const [a, b] = [at(RINGS, k), at(RINGS, k + 1)];
    indices.push(a, count + a, b, b, count + a, count + b);
  }
  return { positions, indices };
}

export function solidSection(store: Store, wanted: () => boolean): HTMLElement {
  const canvas = h("canvas", { class: "solid", tabindex: 0, role: "application",
    "aria-label": t("solid.alt") });
  const status = h("p", { class: "status" });
  const root = h("section", { class: "card" },
    h("div", { class: "card-head" }, h("h2", {}, t("solid.title")), eyeSwitch()),
    canvas, status, h("p", { class: "hint" }, t("solid.hint")));
  let scene: ReturnType<Three["createScene"]> | null = null;
  let loading = false;

  async function draw(): Promise<void> {
    if (!scene) {
      if (loading) return;
      loading = true;
      try {
        scene = (await import("./solid_three")).createScene(canvas);
      } catch {
        status.textContent = t("solid.none");
        return;
      }
    }
    const { order } = store.lenses;
    scene.show(solidMesh(contourOf(order, view.eye), (p) => store.engine.surfaces(SLOT[view.eye], p)));
  }
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (canvas.hasPointerCapture(event.pointerId)) {
      scene?.turn(event.movementX * 0.01, event.movementY * 0.01);
    }
  });
  canvas.addEventListener("keydown", (event) => {
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, -TURN], ArrowDown: [0, TURN],
    };
    if (!(event.key in turns)) return;
    event.preventDefault();
    scene?.turn(...turns[event.key]);
  });
  store.onLenses(() => void draw(), wanted);
  view.onChange(() => {
    if (wanted()) void draw();
  });
  return root;
}
