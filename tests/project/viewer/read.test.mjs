// SPDX-License-Identifier: MIT
//
// The page's reader of scenes, without a browser: what is right is read as it was written, what is wrong is refused with a
// reason, and bytes changed at random never do anything else. ABUT_VIEWER names the folder with scene.mjs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { join } from "node:path";
import { frames, hostile, motion, small } from "./scenes.mjs";
import { writeScene } from "./glb.mjs";

const { readScene, placeOf, FileError } = await import(join(process.env.ABUT_VIEWER, "scene.mjs"));

test("a scene is read as it was written", () => {
  const scene = readScene(writeScene(small()), "small");
  assert.equal(scene.title, "small");
  assert.deepEqual(
    scene.sets.map((s) => [s.name, s.shape, s.count, s.span, s.hits]),
    [
      ["a", "triangles", 2, 3, 1],
      ["b", "triangles", 2, 3, 2],
      ["balls", "spheres", 2, 1, 1],
    ],
  );
  assert.deepEqual(Array.from(scene.sets[0].ids), [7, 70000]);
  assert.equal(scene.sets[0].elementOf(70000), 1);
  assert.equal(scene.sets[0].elementOf(1), -1);
  const [contacts, pairs] = scene.results;
  assert.deepEqual(
    [contacts.kind, contacts.count, Array.from(contacts.aIds), Array.from(contacts.bIds)],
    ["contacts", 2, [7, 7], [0, 1]],
  );
  assert.deepEqual(Array.from(contacts.depths), [0.25, 0.5]);
  assert.deepEqual([pairs.kind, Array.from(pairs.aIds), Array.from(pairs.bIds)], ["pairs", [7], [1]]);
  assert.equal(scene.duration, 0);
});

test("a motion is read as it was written", () => {
  const scene = readScene(writeScene(motion()), "motion");
  assert.equal(scene.duration, 1);
  assert.deepEqual(Array.from(scene.results[0].times), [0.5, 0.25]);
  assert.deepEqual(scene.results[0].exactTimes, ["0.5", "0.25"]);
  assert.deepEqual(
    scene.sets.map((s) => Array.from(s.hit)),
    [[1], [1, 0]],
  );
});

test("faces are hit by their vertices, their edges, and as a whole", () => {
  const hits = (kinds, vertices) =>
    readScene(
      writeScene({ ...motion(), results: [{ kind: "impacts", a: 0, b: 1, count: 1, kinds, vertices, times: [0.5] }] }),
      "",
    ).sets.map((s) => Array.from(s.hit));
  assert.deepEqual(hits([2], [0, 1, 1, 2]), [[1], [1, 1]], "the edge of both faces");
  assert.deepEqual(hits([2], [0, 1, 3, 2]), [[1], [0, 1]], "an edge of one, against its direction");
  assert.deepEqual(hits([1], [3, 0, 1, 2]), [[1], [0, 1]], "a vertex of one");
  assert.deepEqual(hits([0], [2, 2, 0, 1]), [[1], [1, 0]], "one face, from another corner on");
});

test("several frames, an origin, parts and notes", () => {
  const scene = readScene(writeScene(frames()), "");
  assert.deepEqual(
    [scene.duration, scene.origin, scene.notes, scene.results[0].step, scene.results[0].of],
    [3, [1000000, 0, 0], ["nine were found"], 2, 9],
  );
  const at = (time) => placeOf(scene.sets[0], 0, time);
  assert.deepEqual([0, 0.5, 1, 1.5, 2, 2.25, 3, 9].map(at), [
    [1, 1, 1],
    [1, 1, 1.5],
    [1, 1, 2],
    [1.25, 1, 2],
    [1.5, 1, 2],
    [1.5, 1, 0],
    [1.5, 1, -6],
    [1.5, 1, -6],
  ]);
  assert.deepEqual(placeOf(scene.sets[1], 1, 2.5), [4, 0, 0]);
  const part = small();
  part.edit = (json) => Object.assign(json.extras.abut.sets[0], { of: 99 });
  assert.equal(readScene(writeScene(part), "").sets[0].of, 99);
});

test("spheres as nodes are the same as instances", () => {
  const nodes = small();
  nodes.sets[2].as = "nodes";
  nodes.sets[2].ids = undefined;
  const instances = small();
  instances.sets[2].ids = undefined;
  const read = (scene) => readScene(writeScene(scene), "").sets[2];
  assert.deepEqual(Array.from(read(nodes).positions), Array.from(read(instances).positions));
  assert.deepEqual(Array.from(read(nodes).radii), Array.from(read(instances).radii));
});

for (const { name, bytes, says } of hostile()) {
  test(`refused: ${name}`, () => {
    assert.throws(
      () => readScene(bytes, "hostile"),
      (error) => (error instanceof FileError && says.test(error.message)) || assert.fail(String(error)),
    );
  });
}

test("bytes changed at random are read or refused, never worse", () => {
  const seed = Number(process.env.ABUT_SEED ?? 20261124);
  let state = seed;
  const random = (n) => ((state = (Math.imul(state, 1664525) + 1013904223) >>> 0), Math.floor((state / 2 ** 32) * n));
  let refused = 0;
  const originals = [writeScene(small()), writeScene(motion())];
  const tries = 4000;
  for (let i = 0; i < tries; ++i) {
    let bytes = originals[i % 2].slice();
    for (let k = 0; k <= random(3); ++k) bytes[random(bytes.length)] = random(3) === 0 ? 48 + random(10) : random(256);
    if (random(8) === 0) bytes = bytes.subarray(0, random(bytes.length));
    try {
      readScene(bytes, "");
    } catch (error) {
      assert.ok(error instanceof FileError, `seed ${seed}, try ${i}: ${error.stack}`);
      ++refused;
    }
  }
  console.log(`seed ${seed}: ${refused} of ${tries} refused`);
  assert.ok(refused > tries / 5 && refused < tries, `${refused} refused`);
});
