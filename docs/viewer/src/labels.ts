// SPDX-License-Identifier: MIT
//
// Words at places of the picture, kept there as the camera moves.

import * as THREE from "three";
import { make } from "./dom";
import { View } from "./view";

export interface Label {
  at: THREE.Vector3;
  text: string;
  look: string;
}

export class Labels {
  private shown: { at: THREE.Vector3; element: HTMLElement }[] = [];

  constructor(
    private readonly host: HTMLElement,
    private readonly view: View,
  ) {}

  set(labels: Label[]): void {
    this.shown = labels.map(({ at, text, look }) => ({ at, element: make("div", { class: `label ${look}` }, text) }));
    this.host.replaceChildren(...this.shown.map((label) => label.element));
    this.place();
  }

  place(): void {
    for (const { at, element } of this.shown) {
      const { x, y, inFront } = this.view.toScreen(at);
      element.style.left = `${x}px`;
      element.style.top = `${y}px`;
      element.style.visibility = inFront ? "visible" : "hidden";
    }
  }
}
