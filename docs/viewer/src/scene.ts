// SPDX-License-Identifier: MIT
//
// What a file that abut wrote says: sets of shapes, and results that name them by their ids. docs/files.md has the format.
// All that can be wrong with a file is found here, before anything is drawn.

import { Accessor, entry, FileError, Glb, isObject, Json, list, refuse, shown, whole } from "./glb";

export const shapes = ["triangles", "spheres", "segments", "points", "boxes", "surfaces"] as const;
export type Shape = (typeof shapes)[number];
/** What a set is in a scene, if it is no body: what was found, drawn. */
export const roles = ["curves", "patches", "move", "ways"] as const;
export type Role = (typeof roles)[number];
export const kindsOfResult = ["pairs", "contacts", "impacts", "sweeps", "safe_step"] as const;
export type KindOfResult = (typeof kindsOfResult)[number];
export const kindsOfImpact = ["vertex and face", "face and vertex", "edge and edge"] as const;

/** A set of shapes. An element of it is drawn by `span` vertices in a row; a sphere by its centre and radius. */
export interface ShapeSet {
  name: string;
  shape: Shape;
  count: number;
  of: number; // how many the whole set has
  span: number;
  positions: Float32Array;
  frames: Float32Array[]; // what is added to positions at times 1, 2, ...; none of a set that stands still
  radii: Float32Array | undefined;
  ids: Uint32Array; // one an element
  corners: Uint32Array | undefined; // a mesh's vertex numbers, one a drawn vertex
  role: Role | "";
  move: number[] | undefined; // of an arrow: how far and where it points
  numbers: [string, Float32Array][]; // what is said of each element
  hit: Uint8Array; // one an element: whether it is hit in some step
  hitSteps: Map<number, Uint8Array>; // in which step of a motion; empty where what is hit is so at all times
  hits: number;
  hitIsGiven: boolean;
  elementOf(id: number): number; // -1 if there is none
  vertexAt(vertex: number): number; // a drawn vertex with this number, -1 if there is none
}

export interface Result {
  kind: KindOfResult;
  a: number;
  b: number;
  count: number;
  of: number; // how many there are in all
  step: number; // of impacts: the time at which their step begins
  aIds: Uint32Array; // pairs and contacts
  bIds: Uint32Array;
  part: number; // of a safe step: how much of the step is free
  points: Float32Array; // contacts and sweeps
  normals: Float32Array;
  depths: Float32Array;
  kinds: Uint8Array; // impacts
  vertices: Uint32Array;
  // Of sweeps: after which part of its way a shape touches.
  times: Float32Array;
  exactTimes: string[] | undefined;
}

export interface Scene {
  title: string;
  sets: ShapeSet[];
  results: Result[];
  origin: number[]; // is to be added to all coordinates
  duration: number; // the last frame's time; 0 where nothing moves
  notes: string[];
}

const none = { u32: new Uint32Array(0), f32: new Float32Array(0), u8: new Uint8Array(0) };

function refuseUnlessFinite(values: Float32Array, where: string): void {
  for (let i = 0; i < values.length; ++i) {
    if (!Number.isFinite(values[i]))
      refuse(`${where}: vertex ${Math.floor(i / 3)}: a coordinate is not finite (${values[i]})`);
  }
}

function sameCount(found: number, expected: number, where: string): void {
  if (found !== expected) refuse(`${where}: expected ${expected} elements, got ${found}`);
}

/** The inverse of a list of numbers; the first of equals counts. */
function inverse(numbers: Uint32Array): (number: number) => number {
  let ascending = true;
  for (let i = 0; i < numbers.length && ascending; ++i) ascending = numbers[i] === i;
  if (ascending) return (number) => (number < numbers.length ? number : -1);
  let map: Map<number, number> | undefined;
  return (number) => {
    if (map === undefined) {
      map = new Map();
      for (let i = numbers.length - 1; i >= 0; --i) map.set(numbers[i]!, i);
    }
    return map.get(number) ?? -1;
  };
}

function vector(value: unknown, otherwise: number[], where: string): number[] {
  if (value === undefined) return otherwise;
  const numbers = list(value, where);
  if (numbers.length !== otherwise.length || !numbers.every((x) => typeof x === "number" && Number.isFinite(x)))
    refuse(`${where}: expected ${otherwise.length} numbers, got ${shown(value)}`);
  return numbers as number[];
}

type Drawn = Pick<ShapeSet, "span" | "positions" | "frames" | "radii" | "ids" | "corners">;

class Reader {
  private readonly nodes: unknown[];
  private readonly meshes: unknown[];

  constructor(private readonly glb: Glb) {
    this.nodes = list(glb.json.nodes, "nodes");
    this.meshes = list(glb.json.meshes, "meshes");
  }

  set(value: unknown, number: number): ShapeSet {
    const where = `sets ${number}`;
    if (!isObject(value)) refuse(`${where}: expected an object, got ${shown(value)}`);
    const shape = value.kind as Shape;
    if (!shapes.includes(shape)) refuse(`${where}: kind: expected one of ${shapes.join(", ")}, got ${shown(value.kind)}`);
    const name = typeof value.name === "string" && value.name !== "" ? value.name : `set ${number}`;
    const count = whole(value.count, `${where}: count`);
    const drawn =
      count === 0
        ? this.nothing()
        : shape === "spheres"
          ? this.spheres(value, count, where)
          : this.drawn(value, shape, count, where);
    refuseUnlessFinite(drawn.positions, where);
    drawn.frames.forEach((frame, i) => refuseUnlessFinite(frame, `${where}: frame ${i + 1}`));
    if (value.ids !== undefined && count > 0) {
      drawn.ids = this.glb.accessor(value.ids, `${where}: ids`, "SCALAR", "UNSIGNED_INT").values as Uint32Array;
      sameCount(drawn.ids.length, count, `${where}: ids`);
    }
    const hit = new Uint8Array(count);
    if (value.hit !== undefined) {
      const given = this.glb.accessor(value.hit, `${where}: hit`, "SCALAR", "UNSIGNED_BYTE");
      sameCount(given.count, count, `${where}: hit`);
      for (let i = 0; i < count; ++i) hit[i] = given.values[i] !== 0 ? 1 : 0;
    }
    const elementOf = inverse(drawn.ids);
    const vertexAt = inverse(drawn.corners ?? none.u32);
    const of = whole(value.of, `${where}: of`, count);
    if (value.role !== undefined && !roles.includes(value.role as Role))
      refuse(`${where}: role: expected one of ${roles.join(", ")}, got ${shown(value.role)}`);
    const role = (value.role as Role | undefined) ?? "";
    const numbers = Object.entries(isObject(value.numbers) ? value.numbers : {}).map(([name, accessor]): [string, Float32Array] => {
      const found = this.glb.accessor(accessor, `${where}: numbers: ${name}`, "SCALAR", "FLOAT");
      sameCount(found.count, count, `${where}: numbers: ${name}`);
      return [name, found.values as Float32Array];
    });
    const move = value.move === undefined ? undefined : vector(value.move, [0, 0, 0], `${where}: move`);
    const hitIsGiven = value.hit !== undefined;
    return { name, shape, count, of, role, move, numbers, hit, hitSteps: new Map(), hits: 0, hitIsGiven, elementOf, vertexAt, ...drawn };
  }

  private nothing(): Drawn {
    return { span: 1, positions: none.f32, frames: [], radii: undefined, ids: none.u32, corners: undefined };
  }

  private node(value: unknown, where: string): Json {
    return entry(this.nodes, whole(value, `${where}: node`), `${where}: node`);
  }

  private drawn(set: Json, shape: Shape, count: number, where: string): Drawn {
    const node = this.node(set.node, where);
    const mesh = entry(this.meshes, whole(node.mesh, `${where}: mesh`), `${where}: mesh`);
    const primitive = entry(list(mesh.primitives, `${where}: primitives`), 0, `${where}: primitive`);
    const modes: { [shape: string]: number } = { triangles: 4, boxes: 4, surfaces: 4, segments: 1, points: 0 };
    const mode = whole(primitive.mode, `${where}: mode`, 4);
    if (mode !== modes[shape]) refuse(`${where}: ${shape} are drawn by mode ${modes[shape]}, got ${mode}`);
    if (primitive.indices !== undefined) refuse(`${where}: expected vertices in the order of the elements, got indices`);
    const attributes = isObject(primitive.attributes) ? primitive.attributes : {};
    const positions = this.glb.floats(attributes.POSITION, `${where}: POSITION`, "VEC3");
    const vertices = positions.length / 3;
    const span = shape === "triangles" ? 3 : shape === "segments" ? 2 : shape === "points" ? 1 : vertices / count;
    if (vertices !== span * count || (modes[shape] === 4 && span % 3 !== 0))
      refuse(`${where}: count says ${count} ${shape}, and there are ${vertices} vertices`);
    const frames = list(primitive.targets, `${where}: targets`).map((target, i) => {
      const name = `${where}: targets ${i}: POSITION`;
      const frame = this.glb.floats(isObject(target) ? target.POSITION : undefined, name, "VEC3");
      sameCount(frame.length / 3, vertices, name);
      return frame;
    });
    return {
      span,
      positions,
      frames,
      radii: undefined,
      ids: this.ids(attributes._ID, count, span, where),
      corners: this.corners(attributes._CORNER, vertices, where),
    };
  }

  private ids(accessor: unknown, count: number, span: number, where: string): Uint32Array {
    const ids = new Uint32Array(count);
    if (accessor === undefined) return ids.map((_, i) => i);
    const all = this.glb.halves(accessor, `${where}: _ID`);
    sameCount(all.length, count * span, `${where}: _ID`);
    for (let i = 0; i < count; ++i) ids[i] = all[i * span]!;
    return ids;
  }

  private corners(accessor: unknown, vertices: number, where: string): Uint32Array | undefined {
    if (accessor === undefined) return undefined;
    const corners = this.glb.halves(accessor, `${where}: _CORNER`);
    sameCount(corners.length, vertices, `${where}: _CORNER`);
    return corners;
  }

  private spheres(set: Json, count: number, where: string): Drawn {
    const node = this.node(set.node, where);
    const instancing = isObject(node.extensions) ? node.extensions.EXT_mesh_gpu_instancing : undefined;
    const radii = new Float32Array(count);
    let positions: Float32Array;
    let ids: Uint32Array;
    if (isObject(instancing)) {
      const attributes = isObject(instancing.attributes) ? instancing.attributes : {};
      positions = this.glb.floats(attributes.TRANSLATION, `${where}: TRANSLATION`, "VEC3");
      sameCount(positions.length / 3, count, `${where}: TRANSLATION`);
      const scales = this.glb.floats(attributes.SCALE, `${where}: SCALE`, "VEC3");
      sameCount(scales.length / 3, count, `${where}: SCALE`);
      for (let i = 0; i < count; ++i) radii[i] = scales[3 * i]!;
      ids = this.ids(attributes._ID, count, 1, where);
    } else {
      const children = list(node.children, `${where}: children`);
      sameCount(children.length, count, `${where}: children`);
      positions = new Float32Array(3 * count);
      ids = new Uint32Array(count);
      children.forEach((child, i) => {
        const sphere = this.node(child, `${where}: child ${i}`);
        positions.set(vector(sphere.translation, [0, 0, 0], `${where}: child ${i}: translation`), 3 * i);
        radii[i] = vector(sphere.scale, [1, 1, 1], `${where}: child ${i}: scale`)[0]!;
        ids[i] = i;
      });
    }
    radii.forEach((r, i) => {
      if (!(Number.isFinite(r) && r >= 0)) refuse(`${where}: sphere ${i}: no radius (${r})`);
    });
    return { span: 1, positions, frames: [], radii, ids, corners: undefined };
  }

  result(value: unknown, number: number, sets: ShapeSet[]): Result {
    const where = `results ${number}`;
    if (!isObject(value)) refuse(`${where}: expected an object, got ${shown(value)}`);
    const kind = value.kind as KindOfResult;
    if (!kindsOfResult.includes(kind))
      refuse(`${where}: kind: expected one of ${kindsOfResult.join(", ")}, got ${shown(value.kind)}`);
    const count = whole(value.count, `${where}: count`);
    const a = whole(value.a, `${where}: a`);
    const b = whole(value.b, `${where}: b`);
    for (const side of [a, b])
      if (side >= sets.length) refuse(`${where}: there is no set ${side}, there are ${sets.length}`);
    const accessors = isObject(value.accessors) ? value.accessors : {};
    const read = (name: string, type: string, component: string, elements: number): Accessor => {
      const found = this.glb.accessor(accessors[name], `${where}: ${name}`, type, component);
      sameCount(found.count, elements, `${where}: ${name}`);
      return found;
    };
    const of = whole(value.of, `${where}: of`, count);
    const step = whole(value.step, `${where}: step`, 0);
    const result: Result = {
      kind,
      a,
      b,
      count,
      of,
      step,
      aIds: none.u32,
      bIds: none.u32,
      points: none.f32,
      normals: none.f32,
      depths: none.f32,
      kinds: none.u8,
      vertices: none.u32,
      times: none.f32,
      part: kind === "safe_step" ? vector([value.part], [0], `${where}: part`)[0]! : 0,
      exactTimes: undefined,
    };
    if (result.part < 0 || result.part > 1) refuse(`${where}: part: ${result.part} is not in [0, 1]`);
    if (kind === "safe_step" && count !== 0) refuse(`${where}: a safe step has no rows, and count is ${count}`);
    if (count === 0) return result;
    if (kind !== "impacts") {
      result.aIds = read("a_ids", "SCALAR", "UNSIGNED_INT", count).values as Uint32Array;
      result.bIds = read("b_ids", "SCALAR", "UNSIGNED_INT", count).values as Uint32Array;
      this.refuseUnknown(result.aIds, sets[a]!, `${where}: a_ids`);
      this.refuseUnknown(result.bIds, sets[b]!, `${where}: b_ids`);
    }
    if (hasPlaces(result)) {
      result.points = read("points", "VEC3", "FLOAT", count).values as Float32Array;
      result.normals = read("normals", "VEC3", "FLOAT", count).values as Float32Array;
      refuseUnlessFinite(result.points, `${where}: points`);
    }
    if (kind === "contacts") result.depths = read("depths", "SCALAR", "FLOAT", count).values as Float32Array;
    if (kind === "impacts" || kind === "sweeps") {
      result.times = read("times", "SCALAR", "FLOAT", count).values as Float32Array;
      result.times.forEach((time, i) => {
        if (!(time >= 0 && time <= 1)) refuse(`${where}: times: element ${i}: ${time} is not in [0, 1]`);
      });
    }
    if (kind === "impacts") {
      result.kinds = read("kinds", "SCALAR", "UNSIGNED_BYTE", count).values as Uint8Array;
      result.vertices = read("vertices", "SCALAR", "UNSIGNED_INT", 4 * count).values as Uint32Array;
      this.refuseImpacts(result, sets, where);
      if (value.times_exact !== undefined) {
        const texts = list(value.times_exact, `${where}: times_exact`);
        sameCount(texts.length, count, `${where}: times_exact`);
        result.exactTimes = texts.map(String);
      }
    }
    return result;
  }

  private refuseUnknown(ids: Uint32Array, set: ShapeSet, where: string): void {
    ids.forEach((id, i) => {
      if (set.elementOf(id) < 0) refuse(`${where}: element ${i}: there is no ${id} in "${set.name}"`);
    });
  }

  private refuseImpacts(result: Result, sets: ShapeSet[], where: string): void {
    for (let i = 0; i < result.count; ++i) {
      if (result.kinds[i]! >= kindsOfImpact.length) refuse(`${where}: kinds: element ${i}: no kind ${result.kinds[i]}`);
      for (const { set, vertices } of featuresOf(result, i)) {
        for (const v of vertices) {
          if (sets[set]!.vertexAt(v) < 0)
            refuse(`${where}: vertices: element ${i}: there is no vertex ${v} in "${sets[set]!.name}"`);
        }
      }
    }
  }
}

/** Whether each row has a point and a normal. */
export function hasPlaces(result: Result): boolean {
  return result.kind === "contacts" || result.kind === "sweeps";
}

export interface Feature {
  set: number;
  vertices: number[];
}

/** The two features of an impact, that of side a first. */
export function featuresOf(result: Result, i: number): [Feature, Feature] {
  const [p, q, r, s] = result.vertices.subarray(4 * i, 4 * i + 4) as unknown as [number, number, number, number];
  if (result.kinds[i] === 0)
    return [
      { set: result.a, vertices: [p] },
      { set: result.b, vertices: [q, r, s] },
    ];
  if (result.kinds[i] === 1)
    return [
      { set: result.a, vertices: [q, r, s] },
      { set: result.b, vertices: [p] },
    ];
  return [
    { set: result.a, vertices: [p, q] },
    { set: result.b, vertices: [r, s] },
  ];
}

/** Where a drawn vertex is at a time, in the file's coordinates. */
export function placeOf(set: ShapeSet, at: number, time: number): [number, number, number] {
  const p = set.positions;
  const [from, part] = stretchOf(set, time);
  const [low, high] = [set.frames[from - 1], set.frames[from]];
  const moved = (i: number) => p[i]! + (1 - part) * (low?.[i] ?? 0) + (high === undefined ? 0 : part * high[i]!);
  return [moved(3 * at), moved(3 * at + 1), moved(3 * at + 2)];
}

/** The frame before a time, at most the last but one, and which part of the way to the next has passed. */
export function stretchOf(set: ShapeSet, time: number): [number, number] {
  const from = Math.max(0, Math.min(Math.floor(time), set.frames.length - 1));
  return [from, Math.min(1, Math.max(0, time - from))];
}

/** The index of the greatest value, the first of equals; -1 of none. */
export function greatest(values: Float32Array): number {
  let best = values.length > 0 ? 0 : -1;
  for (let i = 1; i < values.length; ++i) if (values[i]! > values[best]!) best = i;
  return best;
}

/** The index of the least value, the first of equals; -1 of none. */
export function least(values: Float32Array): number {
  let best = values.length > 0 ? 0 : -1;
  for (let i = 1; i < values.length; ++i) if (values[i]! < values[best]!) best = i;
  return best;
}

/** A face is hit where a vertex, an edge or all of it is in an impact. */
function markImpacts(set: ShapeSet, side: number, result: Result, hit: Uint8Array): void {
  const met: Set<string | number>[] = [new Set(), new Set(), new Set()];
  const corners = set.corners;
  if (corners === undefined) return;
  const key = (vertices: ArrayLike<number>) =>
    vertices.length === 1
      ? vertices[0]!
      : Array.from(vertices)
          .sort((x, y) => x - y)
          .join();
  const touched = new Set<number>();
  for (let i = 0; i < result.count; ++i) {
    for (const feature of featuresOf(result, i)) {
      if (feature.set !== side) continue;
      met[feature.vertices.length - 1]!.add(key(feature.vertices));
      feature.vertices.forEach((v) => touched.add(v));
    }
  }
  for (let e = 0; e < set.count; ++e) {
    const [p, q, r] = [corners[e * set.span]!, corners[e * set.span + 1]!, corners[e * set.span + 2]!];
    if (!touched.has(p) && !touched.has(q) && !touched.has(r)) continue;
    const features = [[p], [q], [r], [p, q], [q, r], [r, p], [p, q, r]];
    if (features.some((feature) => met[feature.length - 1]!.has(key(feature)))) hit[e] = 1;
  }
}

const otherSteps = -1;

/** What is hit in a step of a motion: all that is, where no step is known. */
export function hitsAt(set: ShapeSet, step: number): Uint8Array {
  return set.hitSteps.get(step) ?? set.hitSteps.get(otherSteps) ?? set.hit;
}

/** What a result touches is hit, whether the set says so or not; what an impact touches, in its step alone. */
function markHits(sets: ShapeSet[], results: Result[]): void {
  const given = sets.map((set) => set.hit);
  for (const set of sets) set.hit = new Uint8Array(set.count);
  for (const result of results) {
    const a = sets[result.a]!;
    const b = sets[result.b]!;
    for (const id of result.aIds) a.hit[a.elementOf(id)] = 1;
    for (const id of result.bIds) b.hit[b.elementOf(id)] = 1;
  }
  sets.forEach((set, side) => {
    const impacts = results.filter((r) => r.kind === "impacts" && r.count > 0 && (r.a === side || r.b === side));
    const steps = new Set(impacts.map((r) => r.step));
    const together = (one: Uint8Array, other: Uint8Array) => one.map((h, e) => h | other[e]!);
    // What the file says is hit is so in the step of the impacts. Of several steps it does not tell them apart.
    if (steps.size === 0 || (set.hitIsGiven && steps.size > 1)) {
      set.hit = together(set.hit, given[side]!);
    } else {
      set.hitSteps.set(otherSteps, set.hit);
      for (const step of steps) {
        const hit = together(set.hit, given[side]!);
        if (!set.hitIsGiven) for (const r of impacts) if (r.step === step) markImpacts(set, side, r, hit);
        set.hitSteps.set(step, hit);
      }
      for (const hit of set.hitSteps.values()) set.hit = together(set.hit, hit);
    }
    set.hits = set.hit.reduce((sum, h) => sum + h, 0);
  });
}

export function readScene(bytes: Uint8Array, title: string): Scene {
  const glb = new Glb(bytes);
  const extras = isObject(glb.json.extras) ? glb.json.extras.abut : undefined;
  if (!isObject(extras))
    refuse("no results of abut in this file (extras.abut); other programs show it, and abut::io::write_gltf writes them");
  if (extras.version !== 1) refuse(`extras.abut: version ${shown(extras.version)}; this page reads version 1`);
  const reader = new Reader(glb);
  const sets = list(extras.sets, "sets").map((set, i) => reader.set(set, i));
  const results = list(extras.results, "results").map((result, i) => reader.result(result, i, sets));
  markHits(sets, results);
  return {
    title,
    sets,
    results,
    origin: vector(extras.origin, [0, 0, 0], "origin"),
    duration: Math.max(0, ...sets.map((set) => set.frames.length)),
    notes: list(extras.notes, "notes").map(String),
  };
}

export { FileError };
