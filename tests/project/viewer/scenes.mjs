// SPDX-License-Identifier: MIT
//
// Scenes for tests: small ones, and files that are wrong, each with what has to be said about it.

import { writeScene } from "./glb.mjs";

/** Two sets of triangles with ids of their own, and two spheres. */
export function small() {
  return {
    sets: [
      {
        name: "a",
        kind: "triangles",
        vertices: [
          [0, 0, 0],
          [4, 0, 0],
          [0, 4, 0],
          [9, 0, 0],
          [9, 4, 0],
        ],
        faces: [
          [0, 1, 2],
          [1, 3, 4],
        ],
        ids: [7, 70000],
      },
      {
        name: "b",
        kind: "triangles",
        vertices: [
          [1, 1, -1],
          [1, 1, 1],
          [2, 1, 1],
          [1, 2, 1],
        ],
        faces: [
          [0, 1, 2],
          [0, 1, 3],
        ],
      },
      {
        name: "balls",
        kind: "spheres",
        spheres: [
          [5, 5, 5, 1],
          [1, 1, 0, 0.5],
        ],
        ids: [0, 1],
      },
    ],
    results: [
      {
        kind: "contacts",
        a: 0,
        b: 1,
        count: 2,
        a_ids: [7, 7],
        b_ids: [0, 1],
        points: [1, 1, 0, 1, 1.25, 0],
        normals: [0, 0, 1, 0, 0, -1],
        depths: [0.25, 0.5],
      },
      { kind: "pairs", a: 0, b: 2, count: 1, a_ids: [7], b_ids: [1] },
    ],
  };
}

/** A corner that falls through a face at 0.5, and edges that cross at 0.25. */
export function motion() {
  const fall = [
    [1, 1, 1],
    [1.5, 1, 2.5],
    [1, 1.5, 2.5],
  ];
  return {
    sets: [
      {
        name: "falling",
        kind: "triangles",
        vertices: fall,
        frames: [fall.map(([x, y, z]) => [x, y, z - 2])],
        faces: [[0, 1, 2]],
      },
      {
        name: "floor",
        kind: "triangles",
        vertices: [
          [0, 0, 0],
          [4, 0, 0],
          [0, 4, 0],
          [4, 4, -5],
        ],
        faces: [
          [0, 1, 2],
          [1, 3, 2],
        ],
      },
    ],
    results: [
      {
        kind: "impacts",
        a: 0,
        b: 1,
        count: 2,
        kinds: [0, 2],
        vertices: [0, 0, 1, 2, 0, 1, 0, 1],
        times: [0.5, 0.25],
        times_exact: ["0.5", "0.25"],
      },
    ],
  };
}

/** Frames in which a face goes up, to the side, and down through the floor: at 2.25, a quarter of the third step. */
export function frames() {
  const scene = motion();
  const [start] = [scene.sets[0].vertices];
  const moved = (dx, dz) => start.map(([x, y, z]) => [x + dx, y, z + dz]);
  scene.sets[0].frames = [moved(0, 1), moved(0.5, 1), moved(0.5, -7)];
  scene.results = [
    { kind: "impacts", a: 0, b: 1, count: 1, of: 9, step: 2, kinds: [0], vertices: [0, 0, 1, 2], times: [0.25] },
  ];
  scene.edit = (json) => Object.assign(json.extras.abut, { origin: [1000000, 0, 0], notes: ["nine were found"] });
  return scene;
}

/** What solids and sweeps leave behind: a curve, a patch with numbers, a move, a sweep with its way, and a safe step. */
export function findings() {
  const square = [
    [0, 0, 0],
    [2, 0, 0],
    [2, 2, 0],
    [0, 2, 0],
  ];
  const floor = square.map(([x, y, z]) => [4 * x - 3, 4 * y - 3, z - 1]);
  const raised = (by) => square.map(([x, y, z]) => [x, y, z + by]);
  return {
    sets: [
      { name: "floor", kind: "triangles", vertices: floor, faces: [[0, 1, 2], [0, 2, 3]] },
      { name: "lid", kind: "triangles", vertices: raised(0), frames: [raised(3)], faces: [[0, 1, 2], [0, 2, 3]] },
      { name: "curve", kind: "segments", role: "curves", vertices: square, faces: [[0, 1], [1, 2], [2, 3], [3, 0]] },
      {
        name: "patches",
        kind: "surfaces",
        role: "patches",
        vertices: [...raised(0.5), [0, 0, 2]],
        faces: [
          [0, 1, 2, 0, 2, 3],
          [4, 4, 4, 4, 4, 4],
        ],
        numbers: { area: [4, 0], depth: [0.125, 0] },
      },
      { name: "way out", kind: "triangles", role: "move", move: [0, 0, 3], vertices: raised(1), faces: [[0, 1, 2]] },
      {
        name: "movers",
        kind: "surfaces",
        vertices: raised(2),
        frames: [raised(1)],
        faces: [[0, 1, 2, 0, 2, 3]],
      },
      {
        name: "movers: ways",
        kind: "segments",
        role: "ways",
        hit: [1, 0],
        vertices: [[1, 1, 2], [1, 1, 1], [1, 1, 0]],
        faces: [[0, 1], [1, 2]],
      },
    ],
    results: [
      {
        kind: "sweeps",
        a: 5,
        b: 0,
        count: 1,
        a_ids: [0],
        b_ids: [1],
        points: [1, 1, -1],
        normals: [0, 0, 1],
        times: [0.5],
      },
      { kind: "safe_step", a: 1, b: 0, count: 0, part: 0.375 },
    ],
  };
}

export function hostile() {
  const edited = (edit, scene = small) => writeScene({ ...scene(), edit });
  const good = writeScene(small());
  const patched = (at, word) => {
    const bytes = good.slice();
    new DataView(bytes.buffer).setUint32(at, word, true);
    return bytes;
  };
  const text = new TextEncoder();
  const badJson = good.slice();
  badJson.set(text.encode("{]"), 20);
  const extras = (json) => json.extras.abut;
  const result = (json) => extras(json).results[0];
  return [
    { name: "nothing", bytes: new Uint8Array(0), says: /not a .glb file: 0 bytes/ },
    { name: "another format", bytes: text.encode("solid part\nfacet normal 0 0 1\n"), says: /does not begin with "glTF"/ },
    { name: "version 1", bytes: patched(4, 1), says: /version 1; .* version 2/ },
    {
      name: "cut off",
      bytes: good.slice(0, good.length - 40),
      says: new RegExp(`cut off: its header says ${good.length} bytes, and there are ${good.length - 40}`),
    },
    { name: "cut off in the header", bytes: good.slice(0, 9), says: /9 bytes/ },
    { name: "a length of 4 GB", bytes: patched(8, 0xffffffff), says: /says 4294967295 bytes/ },
    { name: "a chunk of 4 GB", bytes: patched(12, 0xfffffff0), says: /chunk 0: it says 4294967280 bytes/ },
    { name: "bad JSON", bytes: badJson, says: /JSON cannot be read/ },
    { name: "no JSON chunk", bytes: patched(16, 0x12345678), says: /no JSON chunk/ },
    {
      name: "a buffer of 4 GB",
      bytes: edited((j) => (j.buffers[0].byteLength = 4294967296)),
      says: /byteLength says 4294967296/,
    },
    {
      name: "a view out of range",
      bytes: edited((j) => (j.bufferViews[0].byteOffset = 4294967290)),
      says: /bufferViews 0: bytes 4294967290/,
    },
    {
      name: "an accessor out of range",
      bytes: edited((j) => (j.accessors[0].count = 1000000000)),
      says: /accessor 0: 1000000000 elements/,
    },
    {
      name: "an accessor that is not there",
      bytes: edited((j) => (result(j).accessors.depths = 999)),
      says: /results 0: depths: accessor: 999 is out of range/,
    },
    {
      name: "no accessor at all",
      bytes: edited((j) => delete result(j).accessors.depths),
      says: /results 0: depths: expected a whole number/,
    },
    {
      name: "another type",
      bytes: edited((j) => (result(j).accessors.depths = result(j).accessors.points)),
      says: /expected SCALAR, got "VEC3"/,
    },
    {
      name: "another component",
      bytes: edited((j) => (result(j).accessors.depths = result(j).accessors.a_ids)),
      says: /expected FLOAT, got UNSIGNED_INT/,
    },
    {
      name: "a count too large",
      bytes: edited((j) => (extras(j).sets[0].count = 4000000000)),
      says: /count says 4000000000 triangles, and there are 6 vertices/,
    },
    {
      name: "a count of results too large",
      bytes: edited((j) => (result(j).count = 3)),
      says: /results 0: a_ids: expected 3 elements, got 2/,
    },
    {
      name: "a count of results too small",
      bytes: edited((j) => (result(j).count = 1)),
      says: /results 0: a_ids: expected 1 elements, got 2/,
    },
    {
      name: "a count below 0",
      bytes: edited((j) => (result(j).count = -1)),
      says: /count: expected a whole number, got -1/,
    },
    {
      name: "an id of nothing",
      bytes: writeScene({ ...small(), results: [{ kind: "pairs", a: 0, b: 1, count: 1, a_ids: [8], b_ids: [0] }] }),
      says: /a_ids: element 0: there is no 8 in "a"/,
    },
    { name: "a set of nothing", bytes: edited((j) => (result(j).b = 5)), says: /there is no set 5, there are 3/ },
    {
      name: "a kind of nothing",
      bytes: edited((j) => (extras(j).sets[0].kind = "teapots")),
      says: /kind: expected one of triangles/,
    },
    {
      name: "a role of nothing",
      bytes: edited((j) => (extras(j).sets[2].role = "hat"), findings),
      says: /sets 2: role: expected one of curves, patches, move, ways, got "hat"/,
    },
    {
      name: "a number for too few",
      bytes: writeScene((({ sets, results }) => ((sets[3].numbers.depth = [1]), { sets, results }))(findings())),
      says: /sets 3: numbers: depth: expected 2 elements, got 1/,
    },
    {
      name: "a move of two numbers",
      bytes: edited((j) => (extras(j).sets[4].move = [1, 2]), findings),
      says: /sets 4: move: expected 3 numbers/,
    },
    {
      name: "a part above 1",
      bytes: edited((j) => (extras(j).results[1].part = 1.5), findings),
      says: /results 1: part: 1.5 is not in \[0, 1\]/,
    },
    { name: "no part", bytes: edited((j) => delete extras(j).results[1].part, findings), says: /results 1: part: expected 1 numbers/ },
    {
      name: "a sweep that ends late",
      bytes: writeScene((({ sets, results }) => ((results[0].times = [2]), { sets, results }))(findings())),
      says: /results 0: times: element 0: 2 is not in \[0, 1\]/,
    },
    {
      name: "a node of nothing",
      bytes: edited((j) => (extras(j).sets[0].node = 77)),
      says: /sets 0: node: 77 is out of range/,
    },
    {
      name: "a vertex of nothing",
      bytes: writeScene({
        ...motion(),
        results: [{ kind: "impacts", a: 0, b: 1, count: 1, kinds: [0], vertices: [9, 0, 1, 2], times: [0.5] }],
      }),
      says: /there is no vertex 9 in "falling"/,
    },
    {
      name: "a time that is none",
      bytes: writeScene({
        ...motion(),
        results: [{ kind: "impacts", a: 0, b: 1, count: 1, kinds: [0], vertices: [0, 0, 1, 2], times: [1.5] }],
      }),
      says: /1.5 is not in \[0, 1\]/,
    },
    {
      name: "a place that is none",
      bytes: writeScene({
        sets: [
          {
            ...small().sets[0],
            vertices: [
              [0, 0, 0],
              [NaN, 0, 0],
              [0, 4, 0],
              [9, 0, 0],
              [9, 4, 0],
            ],
          },
        ],
        results: [],
      }),
      says: /vertex 1: a coordinate is not finite \(NaN\)/,
    },
    {
      name: "a radius below 0",
      bytes: writeScene({ sets: [{ name: "s", kind: "spheres", spheres: [[0, 0, 0, -1]] }], results: [] }),
      says: /sphere 0: no radius \(-1\)/,
    },
    { name: "no results of abut", bytes: edited((j) => delete j.extras), says: /no results of abut/ },
    { name: "another version", bytes: edited((j) => (extras(j).version = 2)), says: /version 2; this page reads version 1/ },
    { name: "sets that are no list", bytes: edited((j) => (extras(j).sets = { length: 3 })), says: /sets: expected a list/ },
    { name: "indices", bytes: edited((j) => (j.meshes[0].primitives[0].indices = 0)), says: /got indices/ },
    {
      name: "ids that are halves of nothing",
      bytes: edited((j) => (j.meshes[0].primitives[0].attributes._CORNER = 0)),
      says: /expected VEC2, got "VEC3"/,
    },
    { name: "sparse", bytes: edited((j) => (j.accessors[0].sparse = {})), says: /sparse accessors/ },
    {
      name: "data elsewhere",
      bytes: edited((j) => (j.buffers[0].uri = "http://example.org/x.bin")),
      says: /data is in another file/,
    },
  ];
}
