// SPDX-License-Identifier: MIT
//
// A small writer of scenes for tests of docs/viewer, by the description of the format in docs/reference/formats.md. It
// shares no code with the page's reader. `edit` changes the JSON before it is written: that makes files that are wrong.

const components = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };

class Binary {
  chunks = [];
  size = 0;
  json = {
    asset: { version: "2.0" },
    buffers: [],
    bufferViews: [],
    accessors: [],
    nodes: [],
    meshes: [],
    scenes: [{ nodes: [] }],
    scene: 0,
  };

  accessor(values, componentType, type) {
    const array = new components[componentType](values);
    const bytes = new Uint8Array(array.buffer);
    const width = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }[type];
    this.json.bufferViews.push({ buffer: 0, byteOffset: this.size, byteLength: bytes.length });
    this.json.accessors.push({
      bufferView: this.json.bufferViews.length - 1,
      componentType,
      count: array.length / width,
      type,
    });
    const padded = new Uint8Array(Math.ceil(bytes.length / 4) * 4);
    padded.set(bytes);
    this.chunks.push(padded);
    this.size += padded.length;
    return this.json.accessors.length - 1;
  }

  node(node) {
    this.json.nodes.push(node);
    this.json.scenes[0].nodes.push(this.json.nodes.length - 1);
    return this.json.nodes.length - 1;
  }

  write(edit) {
    this.json.buffers = [{ byteLength: this.size }];
    edit?.(this.json);
    let text = new TextEncoder().encode(JSON.stringify(this.json));
    const length = Math.ceil(text.length / 4) * 4;
    const padded = new Uint8Array(length).fill(32);
    padded.set(text);
    const out = new Uint8Array(12 + 8 + length + 8 + this.size);
    const view = new DataView(out.buffer);
    [0x46546c67, 2, out.length, length, 0x4e4f534a].forEach((word, i) => view.setUint32(4 * i, word, true));
    out.set(padded, 20);
    view.setUint32(20 + length, this.size, true);
    view.setUint32(24 + length, 0x004e4942, true);
    let at = 28 + length;
    for (const chunk of this.chunks) {
      out.set(chunk, at);
      at += chunk.length;
    }
    return out;
  }
}

const halves = (ids) => ids.flatMap((id) => [id % 65536, Math.floor(id / 65536)]);

/**
 * sets: [{ name, kind, vertices, faces, ids, frames, role, move, numbers }] for triangles (`frames`: the vertices at times 1, 2, ...), for
 * segments, whose faces have two corners, and for surfaces, whose faces have as many as their triangles need; [{ kind: "spheres", spheres,
 * ids, as }] for spheres; results as in extras, with plain lists in place of accessors.
 */
export function writeScene({ sets, results, edit }) {
  const out = new Binary();
  const described = sets.map((set) => {
    if (set.kind === "spheres") return spheres(out, set);
    const corners = set.faces.flat();
    const ids = set.ids ?? set.faces.map((_, i) => i);
    const attributes = {
      POSITION: out.accessor(
        corners.flatMap((v) => set.vertices[v]),
        5126,
        "VEC3",
      ),
      _ID: out.accessor(halves(ids.flatMap((id, i) => set.faces[i].map(() => id))), 5123, "VEC2"),
      ...(set.kind === "triangles" && { _CORNER: out.accessor(halves(corners), 5123, "VEC2") }),
    };
    const primitive = { attributes, mode: set.kind === "segments" ? 1 : 4 };
    if (set.frames) {
      const deltas = (frame) => corners.flatMap((v) => frame[v].map((x, k) => x - set.vertices[v][k]));
      primitive.targets = set.frames.map((frame) => ({ POSITION: out.accessor(deltas(frame), 5126, "VEC3") }));
    }
    out.json.meshes.push({ primitives: [primitive] });
    const node = out.node({ name: set.name, mesh: out.json.meshes.length - 1 });
    const numbers = Object.entries(set.numbers ?? {}).map(([name, values]) => [name, out.accessor(values, 5126, "SCALAR")]);
    return {
      name: set.name,
      kind: set.kind,
      node,
      count: set.faces.length,
      moves: set.frames !== undefined,
      ...(set.role && { role: set.role, hit: out.accessor(set.hit ?? set.faces.map(() => 1), 5121, "SCALAR") }),
      ...(set.move && { move: set.move }),
      ...(numbers.length > 0 && { numbers: Object.fromEntries(numbers) }),
    };
  });
  const types = {
    a_ids: [5125, "SCALAR"],
    b_ids: [5125, "SCALAR"],
    points: [5126, "VEC3"],
    normals: [5126, "VEC3"],
    depths: [5126, "SCALAR"],
    kinds: [5121, "SCALAR"],
    vertices: [5125, "SCALAR"],
    times: [5126, "SCALAR"],
  };
  const written = results.map(({ kind, a, b, count, times_exact, step, of, part, ...lists }) => {
    const accessors = {};
    for (const [name, values] of Object.entries(lists)) accessors[name] = out.accessor(values, ...types[name]);
    return { kind, a, b, count, accessors, ...(times_exact && { times_exact }), ...(step && { step }), ...(of && { of }), ...(part !== undefined && { part }) };
  });
  out.json.extras = { abut: { version: 1, sets: described, results: written } };
  return out.write(edit);
}

function spheres(out, set) {
  const ids = set.ids ?? set.spheres.map((_, i) => i);
  if (set.as === "nodes") {
    const children = set.spheres.map(([x, y, z, r]) => {
      out.json.nodes.push({ translation: [x, y, z], scale: [r, r, r] });
      return out.json.nodes.length - 1;
    });
    return {
      name: set.name,
      kind: "spheres",
      node: out.node({ name: set.name, children }),
      count: children.length,
      as: "nodes",
      moves: false,
    };
  }
  const attributes = {
    TRANSLATION: out.accessor(
      set.spheres.flatMap((s) => s.slice(0, 3)),
      5126,
      "VEC3",
    ),
    SCALE: out.accessor(
      set.spheres.flatMap((s) => [s[3], s[3], s[3]]),
      5126,
      "VEC3",
    ),
    _ID: out.accessor(halves(ids), 5126, "VEC2"), // both are right: whole numbers, and floats as abut writes them
  };
  const node = out.node({ name: set.name, extensions: { EXT_mesh_gpu_instancing: { attributes } } });
  return { name: set.name, kind: "spheres", node, count: set.spheres.length, as: "instances", moves: false };
}

/** A torus around the y axis, as vertices and faces. */
export function torus(center, major, minor, around, about) {
  const vertices = [];
  const faces = [];
  for (let i = 0; i < around; ++i) {
    for (let j = 0; j < about; ++j) {
      const [u, v] = [(2 * Math.PI * i) / around, (2 * Math.PI * j) / about];
      const r = major + minor * Math.cos(v);
      vertices.push(
        [center[0] + r * Math.cos(u), center[1] + minor * Math.sin(v), center[2] + r * Math.sin(u)].map(Math.fround),
      );
      const at = (k, l) => ((i + k) % around) * about + ((j + l) % about);
      faces.push([at(0, 0), at(0, 1), at(1, 1)], [at(0, 0), at(1, 1), at(1, 0)]);
    }
  }
  return { vertices, faces };
}
