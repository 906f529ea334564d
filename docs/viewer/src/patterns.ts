// SPDX-License-Identifier: MIT
//
// Patterns of sides: on which side of the other's plane each corner lies. There are 26 x 26 of triangles in two planes that
// differ, and one of triangles in one plane. Each is shown by a pair in some order of corners.

import { Configuration, Predicate } from "./predicate";

export interface Pattern {
  sides: number[]; // of the reference's corners, then of the other's
  configuration: number;
  corners: number[]; // in the order that gives these sides
  hits: number; // of the pairs that show it
  pairs: number;
}

const orders = [
  [0, 1, 2],
  [1, 2, 0],
  [2, 0, 1],
  [0, 2, 1],
  [1, 0, 2],
  [2, 1, 0],
] as const;

function inOrder(corners: number[], order: readonly number[]): number[] {
  return order.flatMap((i) => corners.slice(3 * i, 3 * i + 3));
}

/** All patterns that the configurations show; either triangle may be the reference. */
export function patternsOf(configurations: Configuration[], predicate: Predicate): Map<string, Pattern> {
  const found = new Map<string, Pattern>();
  configurations.forEach(({ corners, hit }, configuration) => {
    const seen = new Set<string>();
    for (const swap of [false, true]) {
      const [a, b] = swap ? [corners.slice(9), corners.slice(0, 9)] : [corners.slice(0, 9), corners.slice(9)];
      for (const s of orders) {
        for (const t of orders) {
          const asked = [...inOrder(a, s), ...inOrder(b, t)];
          const sides = predicate.sides(asked);
          if (sides.includes(2)) continue;
          const key = sides.join();
          const pattern = found.get(key) ?? { sides, configuration, corners: asked, hits: 0, pairs: 0 };
          if (!seen.has(key)) {
            ++pattern.pairs;
            pattern.hits += hit ? 1 : 0;
          }
          seen.add(key);
          found.set(key, pattern);
        }
      }
    }
  });
  return found;
}

/** The place of three sides among the 27. */
export function placeOf(sides: number[]): number {
  return (sides[0]! + 1) * 9 + (sides[1]! + 1) * 3 + sides[2]! + 1;
}
