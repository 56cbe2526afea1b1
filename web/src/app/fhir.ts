// SPDX-License-Identifier: Apache-2.0
// HL7 FHIR VisionPrescription (R4, R5) into and out of our JSON. FHIR has no pupillary distance and
// no vertex distance: reading keeps those of the page.

import type { Order } from "./order";
import { EYES } from "./order";

type Json = Record<string, unknown>;
const isObject = (value: unknown): value is Json => typeof value === "object" && value !== null;

export const isFhir = (value: unknown): value is Json =>
  isObject(value) && value.resourceType !== undefined;

// Our JSON's object, still to be checked by the optics; or what is wrong.
export function fromFhir(resource: Json, order: Order): Json | string {
  if (resource.resourceType !== "VisionPrescription") {
    return `resourceType: got ${String(resource.resourceType)}, want VisionPrescription`;
  }
  const list = resource.lensSpecification;
  if (!Array.isArray(list) || list.length === 0) return "lensSpecification: missing";
  const out: Json = { PD: { right: order.right.pd, left: order.left.pd } };
  for (const entry of list) {
    if (!isObject(entry)) return "lensSpecification: want objects";
    if (entry.power !== undefined || entry.backCurve !== undefined) {
      return "lensSpecification: got a contact lens, want spectacle lenses";
    }
    if (entry.eye !== "right" && entry.eye !== "left") {
      return `lensSpecification.eye: got ${String(entry.eye)}, want right or left`;
    }
    const eye: Json = {};
    for (const key of ["sphere", "cylinder", "axis", "add", "prism"]) {
      if (entry[key] !== undefined) eye[key] = entry[key];
    }
    eye.sphere ??= 0;
    const key = entry.eye === "right" ? "OD" : "OS";
    if (out[key] !== undefined) return `lensSpecification: two entries for the ${entry.eye} eye`;
    out[key] = eye;
  }
  if (!out.OD || !out.OS) return "lensSpecification: want one entry for each eye";
  return out;
}

function prisms(horizontal: number, vertical: number): Json[] {
  const list: Json[] = [];
  if (horizontal) list.push({ amount: Math.abs(horizontal), base: horizontal > 0 ? "in" : "out" });
  if (vertical) list.push({ amount: Math.abs(vertical), base: vertical > 0 ? "up" : "down" });
  return list;
}

export function toFhir(order: Order, now: Date): Json {
  const system = "http://terminology.hl7.org/CodeSystem/ex-visionprescriptionproduct";
  return {
    resourceType: "VisionPrescription",
    status: "active",
    created: now.toISOString(),
    patient: { display: "not stated" },
    dateWritten: now.toISOString(),
    prescriber: { display: "not stated" },
    lensSpecification: EYES.map((eye) => {
      const rx = order[eye];
      const prism = prisms(rx.prismIn, rx.prismUp);
      return {
        product: { coding: [{ system, code: "lens" }] },
        eye,
        sphere: rx.sphere,
        ...(rx.cylinder ? { cylinder: rx.cylinder, axis: rx.axis } : {}),
        ...(prism.length ? { prism } : {}),
        ...(rx.add ? { add: rx.add } : {}),
      };
    }),
  };
}

export function toOurs(order: Order): Json {
  const eye = (name: "right" | "left"): Json => {
    const rx = order[name];
    return {
      sphere: rx.sphere,
      ...(rx.cylinder ? { cylinder: rx.cylinder, axis: rx.axis } : {}),
      ...(rx.add ? { add: rx.add } : {}),
      ...(rx.prismIn ? { prism_in: rx.prismIn } : {}),
      ...(rx.prismUp ? { prism_up: rx.prismUp } : {}),
    };
  };
  return {
    OD: eye("right"),
    OS: eye("left"),
    PD: { right: order.right.pd, left: order.left.pd },
    vertex_distance: order.vertex,
  };
}
