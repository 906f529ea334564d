// SPDX-License-Identifier: MIT
//
// The library's decisions, compiled to WebAssembly (predicate.cpp).

import code from "predicate.wasm";

export interface Answers {
  fast: boolean;
  filtered: boolean;
  exact: boolean;
}
export interface Contact {
  point: number[];
  normal: number[];
  depth: number;
}
export interface Configuration {
  group: string;
  name: string;
  hit: boolean;
  corners: number[]; // of the reference, then of the other, 9 numbers each
}

interface Calls {
  memory: WebAssembly.Memory;
  _initialize(): void;
  numbers(): number;
  answers_float(): number;
  answers_double(): number;
  contact_float(): number;
  contact_double(): number;
  sides(): void;
  common_part(): number;
  configuration_count(): number;
  configuration_name(i: number): number;
  configuration(i: number): number;
}

export class Predicate {
  private constructor(private readonly calls: Calls) {}

  /** Whether the page was built with it. */
  static readonly isHere = code.length > 0;

  static async load(): Promise<Predicate> {
    // The module prints only when it gives up, and a trap follows.
    const refuse = () => 52;
    const system = { fd_close: refuse, fd_seek: refuse, fd_write: refuse };
    const { instance } = await WebAssembly.instantiate(code as BufferSource, { wasi_snapshot_preview1: system });
    const calls = instance.exports as unknown as Calls;
    calls._initialize();
    return new Predicate(calls);
  }

  private get shared(): Float64Array {
    return new Float64Array(this.calls.memory.buffer, this.calls.numbers(), 64);
  }

  private ask(corners: ArrayLike<number>): void {
    if (corners.length !== 18) throw new Error(`expected 18 numbers, got ${corners.length}`);
    this.shared.set(corners);
  }

  answers(corners: ArrayLike<number>, scalar: "float" | "double"): Answers {
    this.ask(corners);
    const bits = scalar === "float" ? this.calls.answers_float() : this.calls.answers_double();
    return { fast: (bits & 1) !== 0, filtered: (bits & 2) !== 0, exact: (bits & 4) !== 0 };
  }

  contact(corners: ArrayLike<number>, scalar: "float" | "double"): Contact | undefined {
    this.ask(corners);
    if ((scalar === "float" ? this.calls.contact_float() : this.calls.contact_double()) === 0) return undefined;
    const n = Array.from(this.shared.subarray(0, 7));
    return { point: n.slice(0, 3), normal: n.slice(3, 6), depth: n[6]! };
  }

  /** Of each corner: -1, 0 or 1, the side of the other's plane; 2 where the other has none. */
  sides(corners: ArrayLike<number>): number[] {
    this.ask(corners);
    this.calls.sides();
    return Array.from(this.shared.subarray(0, 6));
  }

  /** The corners of what both have in common. */
  commonPart(corners: ArrayLike<number>): number[][] {
    this.ask(corners);
    const count = this.calls.common_part();
    const numbers = this.shared;
    return Array.from({ length: count }, (_, i) => Array.from(numbers.subarray(3 * i, 3 * i + 3)));
  }

  configurations(): Configuration[] {
    return Array.from({ length: this.calls.configuration_count() }, (_, i) => {
      const hit = this.calls.configuration(i) !== 0;
      const corners = Array.from(this.shared.subarray(0, 18));
      const bytes = new Uint8Array(this.calls.memory.buffer, this.calls.configuration_name(i));
      const full = new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
      const [group = full, name = full] = full.split(" / ");
      return { group, name, hit, corners };
    });
  }
}
