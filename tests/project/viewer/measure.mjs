// SPDX-License-Identifier: MIT
//
// How long the page takes with a million triangles and a hundred thousand contacts, without a graphics card:
//   ABUT_VIEWER=build/viewer node tests/project/viewer/measure.mjs [TRIANGLES]
// No test: it prints, and asserts nothing.

import { resolve } from "node:path";

process.env.ABUT_VIEWER = resolve(process.env.ABUT_VIEWER ?? "build/viewer");
const { openPage, openScene, startBrowser } = await import("./browser.mjs");
const { torus, writeScene } = await import("./glb.mjs");

const triangles = Number(process.argv[2] ?? 1000000);
const around = Math.round(Math.sqrt(triangles / 2));
const about = Math.round(triangles / 4 / around);
const sets = [[0, 0, 0], [2, 0.5, 0]].map((center, i) => ({ name: `ring ${i}`, kind: "triangles", ...torus(center, 2, 0.7, around, about) }));
const count = 100000;
const rows = Array.from({ length: count }, (_, i) => i);
const faces = sets[0].faces.length;
const id = (i, by) => (i * by) % faces;
const contacts = {
  kind: "contacts", a: 0, b: 1, count, a_ids: rows.map((i) => id(i, 7919)), b_ids: rows.map((i) => id(i, 104729)),
  points: rows.flatMap((i) => sets[0].vertices[sets[0].faces[id(i, 7919)][0]]), normals: rows.flatMap(() => [0, 1, 0]), depths: rows.map((i) => i / count),
};
const bytes = writeScene({ sets, results: [contacts] });
const browser = await startBrowser();
const page = await openPage(browser, { size: [1280, 800] });
const begin = performance.now();
await openScene(page, bytes);
const opened = performance.now() - begin;
const report = await page.evaluate(() => {
  const { view, scenes } = window.abutViewer;
  const gl = view.renderer.getContext();
  const time = (what, n) => {
    const times = [];
    for (let i = 0; i < n; ++i) {
      const from = performance.now();
      what(i);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // until it is drawn
      times.push(performance.now() - from);
    }
    return times.sort((x, y) => x - y)[Math.floor(n / 2)];
  };
  const turn = (i) => {
    view.camera.position.applyAxisAngle(view.camera.up, 0.02 * (i % 2 === 0 ? 1 : -1));
    view.frame();
  };
  const frame = time(turn, 15);
  const pick = time((i) => scenes.stage.pick(300 + 7 * i, 350), 9);
  const select = time(() => scenes.headline(), 5);
  return { renderer: gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER), frame, pick, select };
});
console.log(`${2 * faces} triangles, ${count} contacts, ${(bytes.length / 1e6).toFixed(0)} MB, 888 x 800 pixels; ${report.renderer}`);
console.log(`opened in ${(opened / 1000).toFixed(1)} s; medians: a frame ${report.frame.toFixed(0)} ms, a pick ${report.pick.toFixed(0)} ms, the deepest contact ${report.select.toFixed(0)} ms`);
await browser.close();
