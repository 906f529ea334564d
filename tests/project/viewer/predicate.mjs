// SPDX-License-Identifier: MIT
//
// The library's answers for tests: predicate.wasm of docs/viewer, and scenes whose results it decided.

import { readFileSync } from "node:fs";

export async function loadPredicate(file) {
  const refuse = () => 52;
  const { instance } = await WebAssembly.instantiate(readFileSync(file), {
    wasi_snapshot_preview1: { fd_close: refuse, fd_seek: refuse, fd_write: refuse },
  });
  const calls = instance.exports;
  calls._initialize();
  const numbers = () => new Float64Array(calls.memory.buffer, calls.numbers(), 64);
  return {
    touches(corners) {
      numbers().set(corners);
      return calls.answers_float() === 7;
    },
    contact(corners) {
      numbers().set(corners);
      return calls.contact_float() ? Array.from(numbers().subarray(0, 7)) : undefined;
    },
    count: () => calls.configuration_count(),
    configuration(i) {
      const hit = calls.configuration(i) !== 0;
      return { hit, corners: Array.from(numbers().subarray(0, 18)) };
    },
  };
}

/** All contacts of two meshes, by brute force over boxes that meet. */
export function contactsOf(predicate, a, b) {
  const found = { kind: "contacts", a: 0, b: 1, count: 0, a_ids: [], b_ids: [], points: [], normals: [], depths: [] };
  const corners = (mesh) => mesh.faces.map((face) => face.flatMap((v) => mesh.vertices[v]));
  const box = (t) => [0, 1, 2].map((k) => [Math.min(t[k], t[3 + k], t[6 + k]), Math.max(t[k], t[3 + k], t[6 + k])]);
  const others = corners(b).map((t) => ({ t, box: box(t) }));
  corners(a).forEach((s, i) => {
    const own = box(s);
    others.forEach(({ t, box: other }, j) => {
      if (own.some(([low, high], k) => high < other[k][0] || low > other[k][1])) return;
      const contact = predicate.contact([...s, ...t]);
      if (contact === undefined) return;
      ++found.count;
      found.a_ids.push(a.ids?.[i] ?? i);
      found.b_ids.push(b.ids?.[j] ?? j);
      found.points.push(...contact.slice(0, 3));
      found.normals.push(...contact.slice(3, 6));
      found.depths.push(contact[6]);
    });
  });
  return found;
}
