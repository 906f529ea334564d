// SPDX-License-Identifier: MIT
//
// Results as rows of a list, in words, and as what stands out in the picture.

import { brief, shortest } from "./dom";
import { featuresOf, greatest, hasPlaces, least, Result, Scene } from "./scene";
import { Mark } from "./marks";
import { Column } from "./virtual_list";

const nouns: { [shape: string]: string } = {
  triangles: "face",
  spheres: "sphere",
  segments: "segment",
  points: "point",
  boxes: "box",
  surfaces: "shape",
};

export function noun(scene: Scene, set: number): string {
  const { shape, role } = scene.sets[set]!;
  return role === "patches" ? "patch" : nouns[shape]!;
}

export function elementName(scene: Scene, set: number, id: number): string {
  return `${noun(scene, set)} ${id} of ${scene.sets[set]!.name}`;
}

export function featureName(vertices: number[]): string {
  return `${["vertex", "edge", "face"][vertices.length - 1]} ${vertices.join(" ")}`;
}

/** The moment of an impact on the scene's clock. */
export function timeOf(result: Result, row: number): number {
  return result.step + result.times[row]!;
}

export function timeText(result: Result, row: number): string {
  return result.exactTimes?.[row] ?? shortest(result.times[row]!);
}

export function titleOf(scene: Scene, result: Result): string {
  // Of a long name both ends: a list of choices has one line for each.
  const short = (name: string) => (name.length > 16 ? `${name.slice(0, 8)}…${name.slice(-7)}` : name);
  const [a, b] = [short(scene.sets[result.a]!.name), short(scene.sets[result.b]!.name)];
  const what = { pairs: "Pairs", contacts: "Contacts", impacts: "Impacts", sweeps: "Touches", safe_step: "Safe step" }[result.kind];
  return `${what}: ${a}${result.a === result.b ? " with itself" : ` and ${b}`} (${result.count.toLocaleString("en")})`;
}

export function columnsOf(result: Result): Column[] {
  const number: Column = { title: "#", explain: "Sort by number", width: "56px", text: (i) => String(i), key: (i) => i };
  if (result.kind === "impacts") {
    return [
      number,
      {
        title: "time",
        explain: "Sort by time of impact",
        width: "92px",
        text: (i) => brief(result.times[i]!),
        key: (i) => result.times[i]!,
      },
      {
        title: "what meets",
        explain: "Sort by kind",
        width: "1fr",
        key: (i) => result.kinds[i]!,
        text: (i) =>
          featuresOf(result, i)
            .map((f) => featureName(f.vertices))
            .join(" · "),
      },
    ];
  }
  const ids: Column[] = [
    {
      title: "a",
      explain: "Sort by the id in a",
      width: "1fr",
      text: (i) => String(result.aIds[i]),
      key: (i) => result.aIds[i]!,
    },
    {
      title: "b",
      explain: "Sort by the id in b",
      width: "1fr",
      text: (i) => String(result.bIds[i]),
      key: (i) => result.bIds[i]!,
    },
  ];
  if (!hasPlaces(result)) return [number, ...ids];
  if (result.kind === "sweeps") {
    const time = (i: number) => result.times[i]!;
    return [number, { title: "of its way", explain: "Sort by time", width: "104px", text: (i) => shortest(time(i)), key: time }, ...ids];
  }
  const depth: Column = {
    title: "depth",
    explain: "Sort by depth",
    width: "104px",
    text: (i) => shortest(result.depths[i]!),
    key: (i) => result.depths[i]!,
    descending: true,
  };
  return [number, depth, ...ids];
}

/** "7", "a 7" or "b 7": rows with this id or vertex, on either side or on one. Undefined if it is no number. */
export function rowsWith(result: Result, text: string): Uint32Array | undefined {
  const asked = /^\s*([ab]?)\s*(\d+)\s*$/i.exec(text);
  if (asked === null) return undefined;
  const side = asked[1]!.toLowerCase();
  const id = Number(asked[2]);
  const rows: number[] = [];
  for (let i = 0; i < result.count; ++i) {
    const [a, b] =
      result.kind === "impacts" ? featuresOf(result, i).map((f) => f.vertices) : [[result.aIds[i]!], [result.bIds[i]!]];
    if ((side !== "b" && a!.includes(id)) || (side !== "a" && b!.includes(id))) rows.push(i);
  }
  return Uint32Array.from(rows);
}

export function allRows(result: Result): Uint32Array {
  return Uint32Array.from({ length: result.count }, (_, i) => i);
}

/** What a row is about. */
export function marksOf(scene: Scene, result: Result, row: number): Mark[] {
  if (result.kind === "impacts") {
    const [a, b] = featuresOf(result, row);
    return [
      { set: a.set, side: "a", vertices: a.vertices },
      { set: b.set, side: "b", vertices: b.vertices },
    ];
  }
  return [
    { set: result.a, side: "a", elements: [scene.sets[result.a]!.elementOf(result.aIds[row]!)] },
    { set: result.b, side: "b", elements: [scene.sets[result.b]!.elementOf(result.bIds[row]!)] },
  ];
}

/** Results that say something of their own: pairs whose contacts are there too say nothing more. */
export function distinctResults(scene: Scene): number[] {
  const isToldBy = (pairs: Result, other: Result) =>
    other.kind === "contacts" && other.a === pairs.a && other.b === pairs.b && other.count === pairs.count;
  return scene.results.flatMap((r, i) =>
    r.kind === "pairs" && scene.results.some((other) => isToldBy(r, other)) ? [] : [i],
  );
}

/** A row of a result. */
export interface Place {
  result: number;
  row: number;
}

/** The earliest impact of all. */
export function firstImpact(scene: Scene): Place | undefined {
  let best: Place | undefined;
  scene.results.forEach((result, i) => {
    if (result.kind !== "impacts" || result.count === 0) return;
    const row = least(result.times);
    const before = best && scene.results[best.result]!;
    if (before === undefined || timeOf(result, row) < timeOf(before, best!.row)) best = { result: i, row };
  });
  return best;
}

/** What is touched first of all that sweeps. */
export function firstTouch(scene: Scene): Place | undefined {
  const places = scene.results.flatMap((r, result) => (r.kind === "sweeps" && r.count > 0 ? [{ result, row: least(r.times) }] : []));
  const time = ({ result, row }: Place) => scene.results[result]!.times[row]!;
  return places.sort((p, q) => time(p) - time(q))[0];
}

/** What is said of a contact or of the end of a sweep, in a few words. */
export function measureOf(result: Result, row: number): string {
  return result.kind === "contacts" ? `${shortest(result.depths[row]!)} deep` : `after ${shortest(result.times[row]!)} of its way`;
}

/** The deepest contact of all. */
export function deepestContact(scene: Scene): Place | undefined {
  let best: Place | undefined;
  scene.results.forEach((result, i) => {
    if (result.kind !== "contacts" || result.count === 0) return;
    const row = greatest(result.depths);
    if (best === undefined || result.depths[row]! > scene.results[best.result]!.depths[best.row]!) best = { result: i, row };
  });
  return best;
}

export interface Partner {
  row: number;
  set: number;
  element: number;
}

/** The rows of a result that an element is in, with the element on the other side (of impacts: rows alone). */
export function partnersOf(scene: Scene, result: Result, set: number, element: number): Partner[] {
  const found: Partner[] = [];
  const one = scene.sets[set]!;
  if (result.kind === "impacts") {
    const corners = one.corners?.subarray(element * one.span, (element + 1) * one.span);
    if (corners === undefined) return found;
    for (let row = 0; row < result.count; ++row) {
      const mine = featuresOf(result, row).some((f) => f.set === set && f.vertices.every((v) => corners.includes(v)));
      if (mine) found.push({ row, set: -1, element: -1 });
    }
    return found;
  }
  const id = one.ids[element]!;
  for (let row = 0; row < result.count; ++row) {
    if (result.a === set && result.aIds[row] === id)
      found.push({ row, set: result.b, element: scene.sets[result.b]!.elementOf(result.bIds[row]!) });
    else if (result.b === set && result.bIds[row] === id)
      found.push({ row, set: result.a, element: scene.sets[result.a]!.elementOf(result.aIds[row]!) });
  }
  return found;
}
