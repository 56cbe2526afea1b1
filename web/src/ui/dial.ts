// SPDX-License-Identifier: Apache-2.0
// The axis of a cylinder on a protractor in TABO notation: dragged, or turned by arrow keys.

import { h, s } from "./dom";

export interface Dial {
  root: HTMLElement;
  set(axis: number | null): void;
}

export function axisDial(label: string, onAxis: (axis: number) => void): Dial {
  let axis: number | null = null;
  const needle = s("line", { class: "dial-needle", x1: 0, y1: 0, x2: 0, y2: 0 });
  const knob = s("circle", { class: "dial-knob", r: 5 });
  const ticks = Array.from({ length: 13 }, (_, i) => {
    const a = (i * 15 * Math.PI) / 180;
    const inner = i % 3 === 0 ? 33 : 36;
    return s("line", {
      x1: inner * Math.cos(a),
      y1: -inner * Math.sin(a),
      x2: 40 * Math.cos(a),
      y2: -40 * Math.sin(a),
    });
  });
  const drawing = s("svg", { viewBox: "-62 -54 124 62", "aria-hidden": "true" },
    s("path", { class: "dial-arc", d: "M-40 0A40 40 0 0 1 40 0Z" }),
    s("g", { class: "dial-ticks" }, ...ticks),
    needle,
    knob,
    s("text", { x: 45, y: 4 }, "0"),
    s("text", { x: 0, y: -42, "text-anchor": "middle" }, "90"),
    s("text", { x: -45, y: 4, "text-anchor": "end" }, "180"),
  );
  const root = h("div", {
    class: "dial",
    role: "slider",
    tabindex: 0,
    "aria-label": label,
    "aria-valuemin": 1,
    "aria-valuemax": 180,
  });
  root.append(drawing);

  function take(value: number): void {
    const wrapped = ((((Math.round(value) - 1) % 180) + 180) % 180) + 1;
    set(wrapped);
    onAxis(wrapped);
  }
  function set(value: number | null): void {
    axis = value;
    root.classList.toggle("dial-off", value === null);
    const a = ((value ?? 180) * Math.PI) / 180;
    const x = 40 * Math.cos(a);
    const y = -40 * Math.sin(a);
    needle.setAttribute("x2", String(x));
    needle.setAttribute("y2", String(y));
    knob.setAttribute("cx", String(x));
    knob.setAttribute("cy", String(y));
    root.setAttribute("aria-valuenow", String(value ?? 180));
  }
  const point = (event: PointerEvent): void => {
    const box = drawing.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * 124 - 62;
    const y = -(((event.clientY - box.top) / box.height) * 62 - 54);
    take((Math.atan2(Math.max(0, y), x) * 180) / Math.PI);
  };
  root.addEventListener("pointerdown", (event) => {
    root.setPointerCapture(event.pointerId);
    point(event);
  });
  root.addEventListener("pointermove", (event) => {
    if (root.hasPointerCapture(event.pointerId)) point(event);
  });
  root.addEventListener("keydown", (event) => {
    const steps: Record<string, number> = {
      ArrowUp: 1, ArrowRight: -1, ArrowLeft: 1, ArrowDown: -1, PageUp: 10, PageDown: -10,
    };
    if (!(event.key in steps)) return;
    event.preventDefault();
    take((axis ?? 180) + steps[event.key]);
  });
  return { root, set };
}
