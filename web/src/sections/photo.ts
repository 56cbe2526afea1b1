// SPDX-License-Identifier: Apache-2.0
// The user's own photograph: chosen from a file, its pupils marked by two handles. It stays in the
// browser.

import type { EyeName } from "../app/order";
import { EYES } from "../app/order";
import { t, type TextKey } from "../app/texts";
import { h, uniqueId } from "../ui/dom";

export interface PhotoMarks {
  image: ImageBitmap;
  marks: Record<EyeName, { x: number; y: number }>;
  version: number;
}

const MAX_SIDE = 2000;

export function photoMarks(onPhoto: (photo: PhotoMarks | null) => void): HTMLElement {
  const id = uniqueId("photo");
  const status = h("span", { class: "status", role: "status" });
  const stage = h("div", { class: "photo-stage", hidden: true });
  const forget = h("button", { type: "button", class: "quiet", hidden: true, onclick: () => {
    photo = null;
    stage.hidden = true;
    forget.hidden = true;
    onPhoto(null);
  } }, t("photo.forget"));
  const input = h("input", { id, type: "file", accept: "image/*", class: "visually-hidden",
    onchange: async () => {
      const file = input.files?.[0];
      input.value = "";
      if (file) await load(file);
    } });
  let photo: PhotoMarks | null = null;

  async function load(file: Blob): Promise<void> {
    try {
      const whole = await createImageBitmap(file);
      const shrink = Math.min(1, MAX_SIDE / Math.max(whole.width, whole.height));
      const image = await createImageBitmap(whole, {
        resizeWidth: Math.round(whole.width * shrink),
        resizeHeight: Math.round(whole.height * shrink),
      });
      photo = {
        image,
        version: (photo?.version ?? 0) + 1,
        marks: {
          right: { x: 0.42 * image.width, y: 0.42 * image.height },
          left: { x: 0.58 * image.width, y: 0.42 * image.height },
        },
      };
      status.textContent = t("photo.mark");
      forget.hidden = false;
      show(photo);
      onPhoto(photo);
    } catch {
      status.textContent = t("photo.wrong");
    }
  }

  function show(current: PhotoMarks): void {
    const canvas = h("canvas", { width: current.image.width, height: current.image.height,
      "aria-hidden": "true" });
    canvas.getContext("2d")!.drawImage(current.image, 0, 0);
    const handles = EYES.map((eye) => {
      const handle = h("button", { type: "button", class: "handle",
        "aria-label": t(`photo.${eye}` as TextKey) });
      const place = (): void => {
        handle.style.left = `${(100 * current.marks[eye].x) / current.image.width}%`;
        handle.style.top = `${(100 * current.marks[eye].y) / current.image.height}%`;
      };
      const moveTo = (x: number, y: number): void => {
        current.marks[eye] = {
          x: Math.min(current.image.width, Math.max(0, x)),
          y: Math.min(current.image.height, Math.max(0, y)),
        };
        current.version += 1;
        place();
        onPhoto(current);
      };
      handle.addEventListener("pointerdown", (event) => handle.setPointerCapture(event.pointerId));
      handle.addEventListener("pointermove", (event) => {
        if (!handle.hasPointerCapture(event.pointerId)) return;
        const box = canvas.getBoundingClientRect();
        moveTo(((event.clientX - box.left) / box.width) * current.image.width,
          ((event.clientY - box.top) / box.height) * current.image.height);
      });
      handle.addEventListener("keydown", (event) => {
        const step = event.shiftKey ? 10 : 1;
        const moves: Record<string, [number, number]> = {
          ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step],
        };
        const move = moves[event.key];
        if (!move) return;
        event.preventDefault();
        moveTo(current.marks[eye].x + move[0], current.marks[eye].y + move[1]);
      });
      place();
      return handle;
    });
    stage.replaceChildren(canvas, ...handles);
    stage.hidden = false;
  }

  return h("div", { class: "photo" },
    h("div", { class: "buttons" },
      input, h("label", { class: "quiet as-button", for: id }, t("photo.choose")), forget, status),
    stage);
}
