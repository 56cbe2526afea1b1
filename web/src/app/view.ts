// SPDX-License-Identifier: Apache-2.0
// What the page shows beside the order: which eye the drawings are of, and which tab is open.

import type { EyeName } from "./order";

type Listener = () => void;

class ViewState {
  eye: EyeName = "right";
  tab = "overview";
  private listeners: Listener[] = [];

  onChange(call: Listener): void {
    this.listeners.push(call);
  }
  setEye(eye: EyeName): void {
    this.eye = eye;
    this.tell();
  }
  openTab(tab: string): void {
    this.tab = tab;
    this.tell();
  }
  private tell(): void {
    for (const call of this.listeners) call();
  }
}

export const view = new ViewState();
