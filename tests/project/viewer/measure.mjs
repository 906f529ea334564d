// SPDX-License-Identifier: MIT
//
// How long the page takes with a million triangles and a hundred thousand contacts, without a graphics card:
//   ABUT_VIEWER=build/viewer node tests/project/viewer/measure.mjs [TRIANGLES]
// No test: it prints, and asserts nothing.

import { readdirSync, readFileSync } from "node:fs";
import { resolve } from "node:path";

process.env.ABUT_VIEWER = resolve(process.env.ABUT_VIEWER ?? "build/viewer");
const { openPage, openScene, startBrowser } = await import("./browser.mjs");
const { torus, writeScene } = await import("./glb.mjs");

/** Seconds of processors that the browser has taken (Linux): other programs do not slow these down as they do a clock's. */
function processorSeconds() {
  const parents = new Map();
  const spent = new Map();
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const fields = readFileSync(`/proc/${pid}/stat`, "utf8")
        .replace(/^.*\) /, "")
        .split(" ");
      parents.set(Number(pid), Number(fields[1]));
      spent.set(Number(pid), (Number(fields[11]) + Number(fields[12])) / 100);
    } catch {} // it has ended
  }
  const isOurs = (pid) => pid === process.pid || (parents.has(pid) && isOurs(parents.get(pid)));
  return [...spent].reduce((sum, [pid, seconds]) => sum + (pid !== process.pid && isOurs(pid) ? seconds : 0), 0);
}

const triangles = Number(process.argv[2] ?? 1000000);
const around = Math.round(Math.sqrt(triangles / 2));
const about = Math.round(triangles / 4 / around);
const sets = [
  [0, 0, 0],
  [2, 0.5, 0],
].map((center, i) => ({ name: `ring ${i}`, kind: "triangles", ...torus(center, 2, 0.7, around, about) }));
const count = 100000;
const rows = Array.from({ length: count }, (_, i) => i);
const faces = sets[0].faces.length;
const id = (i, by) => (i * by) % faces;
const contacts = {
  kind: "contacts",
  a: 0,
  b: 1,
  count,
  a_ids: rows.map((i) => id(i, 7919)),
  b_ids: rows.map((i) => id(i, 104729)),
  points: rows.flatMap((i) => sets[0].vertices[sets[0].faces[id(i, 7919)][0]]),
  normals: rows.flatMap(() => [0, 1, 0]),
  depths: rows.map((i) => i / count),
};
const bytes = writeScene({ sets, results: [contacts] });
const browser = await startBrowser();
const page = await openPage(browser, { size: [1280, 800] });
const openedFrom = [performance.now(), processorSeconds()];
await openScene(page, bytes);
const opened = [performance.now() - openedFrom[0], processorSeconds() - openedFrom[1]];
const renderer = await page.evaluate(() => {
  const gl = window.abutViewer.view.renderer.getContext();
  return gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
});
/** Milliseconds of the clock, the median; and of processors, the mean. */
async function measured(what, n) {
  const spent = processorSeconds();
  const times = await page.evaluate(`(() => {
    const { view, scenes } = window.abutViewer;
    const gl = view.renderer.getContext();
    return Array.from({ length: ${n} }, (_, i) => {
      const from = performance.now();
      (${what})(view, scenes, i);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // until it is drawn
      return performance.now() - from;
    });
  })()`);
  return `${times.sort((x, y) => x - y)[Math.floor(n / 2)].toFixed(0)} ms (processors: ${((1000 * (processorSeconds() - spent)) / n).toFixed(0)} ms)`;
}
const frame = await measured((view, _, i) => {
  view.camera.position.applyAxisAngle(view.camera.up, 0.02 * (i % 2 === 0 ? 1 : -1));
  view.frame();
}, 10);
const pick = await measured((_, scenes, i) => scenes.stage.pick(300 + 7 * i, 350), 6);
console.log(
  `${2 * faces} triangles, ${count} contacts, ${(bytes.length / 1e6).toFixed(0)} MB, 888 x 800 pixels; ${renderer}`,
);
console.log(
  `opened in ${(opened[0] / 1000).toFixed(1)} s (processors: ${opened[1].toFixed(1)} s); a frame ${frame}; a pick ${pick}`,
);
await browser.close();
