// SPDX-License-Identifier: Apache-2.0
// The order in and out: link, our JSON, FHIR, frame shapes of OMA files. Nothing leaves the browser.

import { readOma } from "../app/frames";
import type { ReadEye } from "../app/engine";
import { toLink, type EyeRx } from "../app/order";
import { toOurs } from "../app/rx_json";
import type { Store } from "../app/store";
import { t } from "../app/texts";
import { h, uniqueId } from "../ui/dom";

const MAX_FILE_BYTES = 1_000_000;

function save(name: string, text: string): void {
  const blob = new Blob([text], { type: "application/json" });
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
    const read = store.engine.readPrescription(text, name);
    if (!read.ok) return bad(read.error);
    store.take({
      ...store.order,
      right: eyeFrom(read.OD, read.PD?.right ?? store.order.right.pd),
      left: eyeFrom(read.OS, read.PD?.left ?? store.order.left.pd),
      // A prescription's vertex distance is that of the refraction.
      refraction: read.vertex_distance === store.order.vertex ? null : read.vertex_distance,
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
  const ours = (indent?: number): string =>
    `${JSON.stringify(toOurs(store.lenses.order), null, indent)}\n`;
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
      file, // before its label, which shows its focus
      h("label", { class: "quiet as-button", for: id }, t("files.open")),
      button(t("files.saveJson"), () => save("prescription.json", ours(2))),
      button(t("files.saveFhir"), () => {
        const date = new Date().toISOString().replace(/\.\d+Z$/, "Z");
        const written = store.engine.writeFhir(ours(), date);
        if (written.ok) save("vision-prescription.json", written.fhir);
        else tell(false, written.error);
      }),
    ),
    status,
    h("p", { class: "hint" }, t("files.private")),
  );
}
