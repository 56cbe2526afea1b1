// SPDX-License-Identifier: Apache-2.0
// The order in and out: link, our JSON, FHIR, frame shapes of OMA files. Nothing leaves the browser.

import { fromFhir, isFhir, toFhir, toOurs } from "../app/fhir";
import { readOma } from "../app/frames";
import type { ReadEye } from "../app/engine";
import { toLink, type EyeRx } from "../app/order";
import type { Store } from "../app/store";
import { t } from "../app/texts";
import { h, uniqueId } from "../ui/dom";

const MAX_FILE_BYTES = 1_000_000;

function save(name: string, json: unknown): void {
  const blob = new Blob([`${JSON.stringify(json, null, 2)}\n`], { type: "application/json" });
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
}

export function linkTo(store: Store): string {
  return `${location.origin === "null" ? "" : location.origin}${location.pathname}#${toLink(
    store.lenses.order,
  )}`;
}

const eyeFrom = (rx: ReadEye, pd: number): EyeRx => ({
  sphere: rx.sphere,
  cylinder: rx.cylinder,
  axis: rx.cylinder === 0 ? null : rx.axis,
  add: rx.add,
  prismIn: rx.prism_in,
  prismUp: rx.prism_up,
  pd,
});

// Takes a file's text into the order; returns a sentence about what came of it.
function take(store: Store, name: string, text: string): { good: boolean; text: string } {
  const bad = (problem: string): { good: false; text: string } => ({ good: false, text: problem });
  if (/^\s*\{/.test(text)) {
    let ours = text;
    try {
      const parsed: unknown = JSON.parse(text);
      if (isFhir(parsed)) {
        const converted = fromFhir(parsed, store.order);
        if (typeof converted === "string") return bad(`${name}:${converted}`);
        ours = JSON.stringify(converted);
      }
    } catch {
      // The optics' reader says where the JSON breaks.
    }
    const read = store.engine.readPrescription(ours, name);
    if (!read.ok) return bad(read.error);
    store.take({
      ...store.order,
      right: eyeFrom(read.OD, read.PD.right),
      left: eyeFrom(read.OS, read.PD.left),
      vertex: ours === text ? read.vertex_distance : store.order.vertex,
    });
    return { good: true, text: t("files.tookRx", { name }) };
  }
  if (/^(REQ|ANS|TRCFMT|JOB|DO|HBOX|[A-Z_]+)=/m.test(text)) {
    const oma = readOma(text);
    if (typeof oma === "string") return bad(`${name}:${oma}`);
    store.take({ ...store.order, trace: oma.radii, a: oma.a, b: oma.b,
      dbl: oma.dbl ?? store.order.dbl });
    return { good: true, text: t("files.tookFrame", { name }) };
  }
  return bad(t("files.unknown", { name }));
}

export function filesCard(store: Store, changed: () => void): HTMLElement {
  const status = h("p", { class: "status", role: "status" });
  const tell = (good: boolean, text: string): void => {
    status.textContent = text;
    status.classList.toggle("bad", !good);
  };
  const id = uniqueId("file");
  const file = h("input", {
    id,
    type: "file",
    accept: ".json,.oma,.dcs,.vca,.txt,application/json",
    class: "visually-hidden",
    onchange: async () => {
      const chosen = file.files?.[0];
      file.value = "";
      if (!chosen) return;
      if (chosen.size > MAX_FILE_BYTES) return tell(false, t("files.tooBig", { name: chosen.name }));
      const result = take(store, chosen.name, await chosen.text());
      tell(result.good, result.text);
      changed();
    },
  });
  const button = (text: string, onclick: () => void): HTMLElement =>
    h("button", { type: "button", class: "quiet", onclick }, text);
  return h("section", { class: "card files" },
    h("h3", {}, t("files.title")),
    h("div", { class: "buttons" },
      button(t("files.link"), async () => {
        const link = linkTo(store);
        history.replaceState(null, "", `#${toLink(store.lenses.order)}`);
        try {
          await navigator.clipboard.writeText(link);
          tell(true, t("files.linkCopied"));
        } catch {
          tell(true, t("files.linkShown"));
        }
      }),
      h("label", { class: "quiet as-button", for: id }, t("files.open")),
      file,
      button(t("files.saveJson"), () => save("prescription.json", toOurs(store.lenses.order))),
      button(t("files.saveFhir"), () =>
        save("vision-prescription.json", toFhir(store.lenses.order, new Date()))),
    ),
    status,
    h("p", { class: "hint" }, t("files.private")),
  );
}
