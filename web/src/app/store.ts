// SPDX-License-Identifier: Apache-2.0
// The order that stands, the lenses that came of it, and who wants to know.

import { Engine, SLOT, type Sheet } from "./engine";
import { EYES, lensOrder, type EyeName, type Order } from "./order";

export interface Lenses {
  order: Order; // the last one that gave two lenses
  sheet: Record<EyeName, Sheet>;
}

export interface Problem {
  eye: EyeName;
  text: string;
}

type Listener = (lenses: Lenses) => void;

export class Store {
  problem: Problem | null = null;
  private listeners: { wanted: () => boolean; call: Listener; stale: boolean }[] = [];
  private problemListeners: ((problem: Problem | null) => void)[] = [];
  private replacedListeners: (() => void)[] = [];
  lenses: Lenses;

  constructor(
    readonly engine: Engine,
    public order: Order,
    fallback: Order,
  ) {
    const first = this.designed(order) ?? this.designed(fallback);
    if (!first) throw new Error(this.problem?.text ?? "no lens");
    this.lenses = first;
    if (first.order !== order) this.order = fallback;
  }

  // Both lenses of an order; the last good lenses stay when one cannot be made.
  private designed(order: Order): Lenses | null {
    const sheets: Partial<Record<EyeName, Sheet>> = {};
    for (const eye of EYES) {
      const answer = this.engine.design(SLOT[eye], lensOrder(order, eye));
      if (!answer.ok) {
        this.problem = { eye, text: answer.error };
        return null;
      }
      sheets[eye] = answer;
    }
    this.problem = null;
    return { order, sheet: sheets as Record<EyeName, Sheet> };
  }

  // A whole new order that the form did not make itself: a file, a lesson, a link.
  take(order: Order): void {
    this.replace(order);
    for (const call of this.replacedListeners) call();
  }

  set(change: Partial<Order>): void {
    this.replace({ ...this.order, ...change });
  }

  replace(order: Order): void {
    this.order = order;
    const lenses = this.designed(order);
    if (lenses) {
      this.lenses = lenses;
      for (const listener of this.listeners) listener.stale = true;
      this.refresh();
    } else {
      // The other eye may have changed already: bring both slots back to the last good pair.
      const problem = this.problem;
      this.designed(this.lenses.order);
      this.problem = problem;
    }
    for (const call of this.problemListeners) call(this.problem);
  }

  // `wanted` tells whether the listener is in view; one that is not catches up on refresh().
  onLenses(call: Listener, wanted: () => boolean = () => true): void {
    this.listeners.push({ wanted, call, stale: true });
    this.refresh();
  }

  onProblem(call: (problem: Problem | null) => void): void {
    this.problemListeners.push(call);
  }

  onReplaced(call: () => void): void {
    this.replacedListeners.push(call);
  }

  refresh(): void {
    for (const listener of this.listeners) {
      if (!listener.stale || !listener.wanted()) continue;
      listener.stale = false;
      listener.call(this.lenses);
    }
  }
}
