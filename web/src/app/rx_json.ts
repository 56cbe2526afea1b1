// SPDX-License-Identifier: Apache-2.0
// The prescription of an order in our JSON.

import type { EyeName, Order } from "./order";

export function toOurs(order: Order): Record<string, unknown> {
  const eye = (name: EyeName): Record<string, unknown> => {
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
    vertex_distance: order.refraction ?? order.vertex,
  };
}
