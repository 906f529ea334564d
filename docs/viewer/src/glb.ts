// SPDX-License-Identifier: MIT
//
// Binary glTF: the container and its accessors, each checked before it is read. Every refusal is a FileError that says where,
// what was expected and what is there. No size that a file claims is believed: nothing is allocated before it was compared
// with the bytes that are there.

export class FileError extends Error {}

export function refuse(message: string): never {
  throw new FileError(message);
}

export type Json = { [key: string]: unknown };

export function isObject(value: unknown): value is Json {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

/** A whole number of at least 0, as counts, offsets and indices are. */
export function whole(value: unknown, where: string, otherwise?: number): number {
  if (value === undefined && otherwise !== undefined) return otherwise;
  if (typeof value !== "number" || !Number.isSafeInteger(value) || value < 0)
    refuse(`${where}: expected a whole number, got ${shown(value)}`);
  return value;
}

export function list(value: unknown, where: string): unknown[] {
  if (value === undefined) return [];
  if (!Array.isArray(value)) refuse(`${where}: expected a list, got ${shown(value)}`);
  return value;
}

export function entry(items: unknown[], index: number, where: string): Json {
  if (index >= items.length) refuse(`${where}: ${index} is out of range, there are ${items.length}`);
  const item = items[index];
  if (!isObject(item)) refuse(`${where} ${index}: expected an object, got ${shown(item)}`);
  return item;
}

export function shown(value: unknown): string {
  const text = JSON.stringify(value) ?? String(value);
  return text.length > 60 ? text.slice(0, 57) + "..." : text;
}

type Numbers = Float32Array | Uint32Array | Uint16Array | Uint8Array | Int16Array | Int8Array;
const kinds: {
  [code: number]: { name: string; make: new (buffer: ArrayBuffer, at: number, n: number) => Numbers; size: number };
} = {
  5120: { name: "BYTE", make: Int8Array as never, size: 1 },
  5121: { name: "UNSIGNED_BYTE", make: Uint8Array as never, size: 1 },
  5122: { name: "SHORT", make: Int16Array as never, size: 2 },
  5123: { name: "UNSIGNED_SHORT", make: Uint16Array as never, size: 2 },
  5125: { name: "UNSIGNED_INT", make: Uint32Array as never, size: 4 },
  5126: { name: "FLOAT", make: Float32Array as never, size: 4 },
};
const widths: { [type: string]: number } = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };

export interface Accessor {
  values: Numbers;
  count: number;
  width: number;
  component: string;
}

export class Glb {
  readonly json: Json;
  private readonly binary: Uint8Array;
  private readonly accessors: unknown[];
  private readonly views: unknown[];

  constructor(bytes: Uint8Array) {
    if (bytes.length < 12) refuse(`not a .glb file: ${bytes.length} bytes, its header alone has 12`);
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (view.getUint32(0, true) !== 0x46546c67) refuse('not a .glb file: it does not begin with "glTF"');
    const version = view.getUint32(4, true);
    if (version !== 2) refuse(`glTF version ${version}; this page reads version 2`);
    const length = view.getUint32(8, true);
    if (length > bytes.length) refuse(`the file is cut off: its header says ${length} bytes, and there are ${bytes.length}`);
    let json: Uint8Array | undefined;
    let binary: Uint8Array | undefined;
    for (let at = 12, number = 0; at + 8 <= length; ++number) {
      const size = view.getUint32(at, true);
      const kind = view.getUint32(at + 4, true);
      if (at + 8 + size > length)
        refuse(`chunk ${number}: it says ${size} bytes, and ${length - at - 8} are left of the file`);
      const chunk = bytes.subarray(at + 8, at + 8 + size);
      if (kind === 0x4e4f534a && json === undefined) json = chunk;
      if (kind === 0x004e4942 && binary === undefined) binary = chunk;
      at += 8 + size;
    }
    if (json === undefined) refuse("the file has no JSON chunk");
    let parsed: unknown;
    try {
      parsed = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(json));
    } catch (error) {
      refuse(`its JSON cannot be read: ${error instanceof Error ? error.message : String(error)}`);
    }
    if (!isObject(parsed)) refuse(`its JSON is no object: ${shown(parsed)}`);
    this.json = parsed;
    this.binary = binary ?? new Uint8Array(0);
    this.accessors = list(parsed.accessors, "accessors");
    this.views = list(parsed.bufferViews, "bufferViews");
    const buffer = list(parsed.buffers, "buffers")[0];
    if (isObject(buffer)) {
      if (buffer.uri !== undefined) refuse("buffers 0: its data is in another file, which this page does not read");
      const claimed = whole(buffer.byteLength, "buffers 0: byteLength");
      if (claimed > this.binary.length)
        refuse(`buffers 0: byteLength says ${claimed}, and the file has ${this.binary.length} bytes of data`);
    }
  }

  /** The numbers of an accessor, of the type that is expected; a view of the file where that can be. */
  accessor(index: unknown, where: string, type: string, component?: string): Accessor {
    const number = whole(index, where);
    const found = entry(this.accessors, number, `${where}: accessor`);
    const name = `${where}: accessor ${number}`;
    const kind = kinds[found.componentType as number];
    if (kind === undefined) refuse(`${name}: no componentType ${shown(found.componentType)}`);
    if (found.type !== type) refuse(`${name}: expected ${type}, got ${shown(found.type)}`);
    if (component !== undefined && kind.name !== component) refuse(`${name}: expected ${component}, got ${kind.name}`);
    if (found.sparse !== undefined) refuse(`${name}: sparse accessors are not read`);
    const count = whole(found.count, `${name}: count`);
    const width = widths[type] ?? refuse(`${name}: no type ${type}`);
    const viewNumber = whole(found.bufferView, `${name}: bufferView`);
    const view = entry(this.views, viewNumber, `${name}: bufferView`);
    if (whole(view.buffer, `bufferViews ${viewNumber}: buffer`) !== 0)
      refuse(`bufferViews ${viewNumber}: only buffer 0 is in the file`);
    const from = whole(view.byteOffset, `bufferViews ${viewNumber}: byteOffset`, 0);
    const size = whole(view.byteLength, `bufferViews ${viewNumber}: byteLength`);
    if (from + size > this.binary.length)
      refuse(`bufferViews ${viewNumber}: bytes ${from} to ${from + size} of ${this.binary.length}`);
    const element = width * kind.size;
    const stride = whole(view.byteStride, `bufferViews ${viewNumber}: byteStride`, element) || element;
    const at = whole(found.byteOffset, `${name}: byteOffset`, 0);
    if (count > 0 && at + (count - 1) * stride + element > size)
      refuse(`${name}: ${count} elements of ${stride} bytes from ${at} on, and bufferView ${viewNumber} has ${size} bytes`);
    const start = this.binary.byteOffset + from + at;
    const buffer = this.binary.buffer as ArrayBuffer;
    let values: Numbers;
    if (stride === element && start % kind.size === 0) {
      values = new kind.make(buffer, start, count * width);
    } else {
      const packed = new Uint8Array(count * element);
      const source = new Uint8Array(buffer);
      for (let i = 0; i < count; ++i)
        packed.set(source.subarray(start + i * stride, start + i * stride + element), i * element);
      values = new kind.make(packed.buffer, 0, count * width);
    }
    return { values, count, width, component: kind.name };
  }

  floats(index: unknown, where: string, type: string): Float32Array {
    return this.accessor(index, where, type, "FLOAT").values as Float32Array;
  }

  /** Numbers of 32 bits that lie in the file as their low and their high half, as whole numbers or as floats. */
  halves(index: unknown, where: string): Uint32Array {
    const { values, count } = this.accessor(index, where, "VEC2");
    const joined = new Uint32Array(count);
    for (let i = 0; i < count; ++i) {
      const [low, high] = [values[2 * i]!, values[2 * i + 1]!];
      if (!(low >= 0 && low < 65536 && high >= 0 && high < 65536 && low % 1 === 0 && high % 1 === 0))
        refuse(`${where}: element ${i}: expected two halves of a number, got ${low} and ${high}`);
      joined[i] = low + high * 65536;
    }
    return joined;
  }
}
