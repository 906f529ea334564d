// SPDX-License-Identifier: MIT
//
// A list of any length of which only the rows in view exist. Columns sort by a click on their heads; arrow keys step.

import { make } from "./dom";

export interface Column {
  title: string;
  explain: string;
  width: string;
  text(row: number): string;
  key?(row: number): number; // what it is sorted by
  descending?: boolean; // at the first click
}

const rowHeight = 28;
const tallest = 8_000_000; // pixels; browsers fail beyond some tens of millions

export class VirtualList {
  private columns: Column[] = [];
  private order: Uint32Array = new Uint32Array(0); // rows, as they are shown
  private sortedBy = -1;
  private descending = false;
  private chosen = -1; // a row
  private readonly body = make("div", { role: "presentation" });
  private head = make("div", { role: "row", class: "list-head" });

  constructor(
    private readonly host: HTMLElement,
    private readonly choose: (row: number) => void,
  ) {
    host.addEventListener("scroll", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(host);
    host.addEventListener("keydown", (event) => this.step(event));
  }

  show(columns: Column[], rows: Uint32Array): void {
    this.columns = columns;
    this.order = rows;
    this.sortedBy = -1;
    this.chosen = -1;
    this.host.scrollTop = 0;
    this.drawHead();
    this.draw();
  }

  sort(column: number, descending: boolean): void {
    const key = this.columns[column]?.key;
    if (key === undefined) return;
    this.sortedBy = column;
    this.descending = descending;
    const keys = Float64Array.from(this.order, key);
    const places = Uint32Array.from(this.order, (_, i) => i);
    const sign = descending ? -1 : 1;
    places.sort((i, j) => sign * (keys[i]! - keys[j]!) || this.order[i]! - this.order[j]!);
    this.order = places.map((i) => this.order[i]!);
    this.host.scrollTop = 0;
    this.drawHead();
    this.draw();
  }

  get sorting(): { column: number; descending: boolean } {
    return { column: this.sortedBy, descending: this.descending };
  }
  get rows(): Uint32Array {
    return this.order;
  }

  /** Marks a row, and brings it into view. */
  mark(row: number): void {
    this.chosen = row;
    const place = this.order.indexOf(row);
    const view = this.host.clientHeight - rowHeight;
    if (place >= 0 && view > 0) {
      const top = place * this.pitch;
      if (top < this.host.scrollTop || top + rowHeight > this.host.scrollTop + view)
        this.host.scrollTop = Math.max(0, top - view / 2);
    }
    this.draw();
  }

  /** Pixels of scrolling a row: less than its height where there are very many. */
  private get pitch(): number {
    return Math.min(rowHeight, tallest / Math.max(1, this.order.length));
  }

  private drawHead(): void {
    this.head = make("div", {
      role: "row",
      class: "list-head",
      style: `grid-template-columns: ${this.columns.map((c) => c.width).join(" ")}`,
    });
    this.columns.forEach((column, i) => {
      const sorted = this.sortedBy === i;
      const direction = sorted ? (this.descending ? "descending" : "ascending") : "none";
      const again = () => this.sort(i, sorted ? !this.descending : column.descending === true);
      const title = column.title + (sorted ? (this.descending ? " ↓" : " ↑") : "");
      const cell = make(
        "div",
        { role: "columnheader", "aria-sort": direction },
        column.key === undefined ? title : make("button", { type: "button", title: column.explain, onclick: again }, title),
      );
      this.head.append(cell);
    });
    this.host.replaceChildren(this.head, this.body);
    this.host.setAttribute("aria-rowcount", String(this.order.length + 1));
  }

  private draw(): void {
    const count = this.order.length;
    const pitch = this.pitch;
    const tall = count * pitch + (pitch < rowHeight ? this.host.clientHeight : 0);
    this.body.style.cssText = `position: relative; height: ${tall}px`;
    const first = Math.max(0, Math.floor(this.host.scrollTop / pitch) - 4);
    const last = Math.min(count, first + Math.ceil(this.host.clientHeight / rowHeight) + 8);
    const rows: HTMLElement[] = [];
    for (let place = first; place < last; ++place) {
      const row = this.order[place]!;
      const top = first * pitch + (place - first) * rowHeight;
      const element = make("div", {
        role: "row",
        class: "list-row",
        id: `row-${row}`,
        "aria-rowindex": String(place + 2),
        "aria-selected": String(row === this.chosen),
        style: `top: ${top}px; grid-template-columns: ${this.columns.map((c) => c.width).join(" ")}`,
        onclick: () => this.choose(row),
      });
      for (const column of this.columns) element.append(make("div", { role: "gridcell" }, column.text(row)));
      rows.push(element);
    }
    this.body.replaceChildren(...rows);
    if (this.chosen >= 0) this.host.setAttribute("aria-activedescendant", `row-${this.chosen}`);
    else this.host.removeAttribute("aria-activedescendant");
  }

  private step(event: KeyboardEvent): void {
    if (event.target !== this.host || this.order.length === 0) return;
    const page = Math.max(1, Math.floor(this.host.clientHeight / rowHeight) - 2);
    const steps: { [key: string]: number } = {
      ArrowDown: 1,
      ArrowUp: -1,
      PageDown: page,
      PageUp: -page,
      Home: -Infinity,
      End: Infinity,
    };
    const step = steps[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const place = this.chosen < 0 ? -1 : this.order.indexOf(this.chosen);
    const next = Math.min(this.order.length - 1, Math.max(0, place + step));
    this.choose(this.order[next]!);
  }
}
