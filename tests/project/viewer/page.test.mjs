// SPDX-License-Identifier: MIT
//
// The page in a real browser: every control does what it says, picking gives the face that a ray meets first, and the numbers
// beside the picture are those of the file, which the library decided (predicate.wasm).

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { folder, html, openPage, openScene, settle, startBrowser, text } from "./browser.mjs";
import { torus, writeScene } from "./glb.mjs";
import { contactsOf, loadPredicate } from "./predicate.mjs";
import { firstMet } from "./rays.mjs";
import { findings, frames, hostile, motion, small } from "./scenes.mjs";

let browser, page, predicate, meshes, contacts, bytes;

before(async () => {
  predicate = await loadPredicate(join(folder, "predicate.wasm"));
  const a = { name: "ring", kind: "triangles", ...torus([0, 0, 0], 2, 0.7, 30, 14) };
  const b = { name: "other ring", kind: "triangles", ...torus([0.7, 0.3, 0.2], 2, 0.7, 30, 14) };
  b.vertices = b.vertices.map(([x, y, z]) => [x, z, -y].map(Math.fround));
  a.ids = a.faces.map((_, i) => 3 * i + 70001); // ids are not places
  b.ids = b.faces.map((_, i) => b.faces.length - 1 - i);
  meshes = [a, b];
  contacts = contactsOf(predicate, a, b);
  assert.ok(contacts.count > 60, `${contacts.count} contacts`);
  bytes = writeScene({ sets: meshes, results: [contacts] });
  browser = await startBrowser();
  page = await openPage(browser);
});
after(async () => browser?.close());

const corners = (set, id) => meshes[set].faces[meshes[set].ids.indexOf(id)].flatMap((v) => meshes[set].vertices[v]);
const numbers = (row) => row.split(/\s+/).slice(1).map(Number);
const plainZero = (values) => values.map((x) => x + 0); // the page shows -0 as 0
const viewer = (expression, argument) =>
  page.evaluate(
    `((argument) => { const v = window.abutViewer; return (${expression}); })(${JSON.stringify(argument) ?? "undefined"})`,
  );
const picture = () => viewer("(v.view.frame(), v.view.canvas.toDataURL())");

test("it opens without a word on the console, and says what to do", async () => {
  assert.match(await text(page, "#welcome"), /Open a \.glb file/);
  assert.deepEqual(page.problems, []);
});

test("the deepest contact: one click from the scene to its faces and its numbers", async () => {
  await openScene(page, bytes, "rings.glb");
  const deepest = contacts.depths.indexOf(Math.max(...contacts.depths));
  const [idA, idB] = [contacts.a_ids[deepest], contacts.b_ids[deepest]];
  const headline = page.getByRole("button", { name: /^Deepest contact/ });
  assert.match(await headline.innerText(), new RegExp(`face ${idA} of ring and face ${idB} of other ring`));
  await headline.click();
  await settle(page);
  const details = await text(page, "#details");
  assert.match(details, new RegExp(`Deepest contact \\(number ${deepest}\\)`));
  assert.ok(details.includes(`face ${idA} of ring`) && details.includes(`face ${idB} of other ring`), details);
  const rows = (await page.locator("#contact-numbers tr").allInnerTexts()).map(numbers);
  const shown = [...rows[1], ...rows[2], ...rows[0]].map(Math.fround);
  assert.deepEqual(
    plainZero(shown),
    plainZero(predicate.contact([...corners(0, idA), ...corners(1, idB)])),
    "point, normal and depth as the library says",
  );
  const shownCorners = (await page.locator("#details .corners tr").allInnerTexts()).map((row) =>
    row.split(/\s+/).slice(2).map(Number).map(Math.fround),
  );
  assert.deepEqual(plainZero(shownCorners.flat()), plainZero([...corners(0, idA), ...corners(1, idB)]));
  const middle = await viewer("v.view.toScreen(v.scenes.stage.pointOfContact(0, argument))", deepest);
  const box = await page.locator("#canvas").boundingBox();
  assert.ok(Math.hypot(middle.x - box.width / 2, middle.y - box.height / 2) < 3, "it is in the middle of the picture");
});

/** Red, green and blue of a pixel of the picture. */
const pixel = (at) =>
  viewer(
    `(() => { v.view.frame(); const gl = v.view.renderer.getContext(); const out = new Uint8Array(4), k = v.view.canvas.width / v.view.width;
      gl.readPixels(Math.floor(argument.x * k), v.view.canvas.height - 1 - Math.floor(argument.y * k), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out); return [...out.slice(0, 3)]; })()`,
    at,
  );
const isOrange = ([r, g, b]) => r > 150 && r > 1.4 * g && g > b;
const apart = (p, q) => Math.max(...p.map((x, i) => Math.abs(x - q[i])));

test("first sight: the deepest contact is in view with its numbers, and bodies are ghosts", async () => {
  const deepest = contacts.depths.indexOf(Math.max(...contacts.depths));
  await openScene(page, writeScene({ sets: [meshes[1], meshes[0]], results: [] }), "none.glb");
  assert.equal(await page.locator("#solid").isChecked(), true, "where nothing touches there is nothing to see through to");
  assert.equal(await page.locator("#details").isVisible(), false);
  await openScene(page, bytes, "rings.glb");
  assert.deepEqual(await viewer("v.scenes.selection"), { kind: "row", result: 0, row: deepest });
  assert.match(await text(page, "#contact-numbers"), /depth/);
  assert.match(await text(page, "#labels"), / deep/);
  const at = await viewer("v.view.toScreen(v.scenes.stage.pointOfContact(0, argument))", deepest);
  const box = await page.locator("#canvas").boundingBox();
  const tools = await page.locator("#scene-tools").boundingBox();
  assert.ok(at.x > 0 && at.x < box.width && at.y > 0 && box.y + at.y < tools.y, `${at.x}, ${at.y}`);
  const corner = await viewer("v.scenes.stage.screenOf(0, 0)");
  assert.ok(corner.x > 0 && corner.x < box.width && corner.y > 0 && corner.y < box.height, "and bodies around it");

  await page.keyboard.press("Escape");
  await page.keyboard.press("f");
  await settle(page);
  const [ground, ...drawn] = [{ x: 3, y: 3 }];
  for (let element = 0; element < meshes[0].ids.length; ++element) {
    const place = await viewer("v.scenes.stage.screenOf(0, argument)", element);
    const met = await firstMet(page, place, meshes);
    const isHit = contacts.a_ids.includes(meshes[0].ids[element]);
    if (met?.clear && met.set === 0 && met.element === element && drawn[Number(isHit)] === undefined) drawn[Number(isHit)] = place;
  }
  const [plain, hit] = drawn;
  await page.locator("#arrows").fill("0");
  const background = await pixel(ground);
  const ghost = await pixel(plain);
  assert.ok(isOrange(await pixel(hit)) && !isOrange(ghost), "what is hit stands out");
  await page.keyboard.press("s");
  const solid = await pixel(plain);
  assert.ok(apart(solid, background) > apart(ghost, background) + 10, "a ghost is fainter");
  assert.ok(isOrange(await pixel(hit)));
  await page.keyboard.press("s");
  assert.deepEqual(await pixel(plain), ghost);
  await page.keyboard.press("h");
  const faint = await pixel(plain);
  assert.ok(apart(faint, background) > 2 && apart(faint, background) < apart(ghost, background), "hits only keeps some of it");
  assert.ok(isOrange(await pixel(hit)));
  await page.keyboard.press("h");
  await page.locator("#arrows").fill("0.4");
  const looks = await page.evaluate(() =>
    [".headline .go", ".headline"].map((which) => getComputedStyle(document.querySelector(which)).backgroundColor),
  );
  assert.notEqual(looks[0], looks[1], "the card's action looks like a button");
});

test("after a jump the faces are seen from their front", async () => {
  for (let row = 0; row < contacts.count; row += 3) {
    await viewer("v.scenes.select({ kind: 'row', result: 0, row: argument }, true)", row);
    const eye = await viewer("v.view.camera.position.clone().sub(v.scenes.stage.pointOfContact(0, argument)).normalize().toArray()", row);
    const facing = [corners(0, contacts.a_ids[row]), corners(1, contacts.b_ids[row])].map((c) => {
      const [u, w] = [0, 1].map((k) => [0, 1, 2].map((i) => c[3 * (k + 1) + i] - c[i]));
      const n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
      return n.reduce((sum, x, i) => sum + x * eye[i], 0) / Math.hypot(...n);
    });
    assert.ok(facing[0] > 0.3, `row ${row}: ${facing}`);
  }
  await page.keyboard.press("Escape");
});

test("picking gives the face that the ray meets first, and its partners", async () => {
  await page.keyboard.press("Escape");
  await page.keyboard.press("f");
  await settle(page);
  const box = await page.locator("#canvas").boundingBox();
  let asked = 0;
  let partnersSeen = 0;
  for (let i = 0; i < 300 && asked < 30; ++i) {
    const set = i % 2;
    const element =
      i < 100
        ? meshes[set].ids.indexOf((set === 0 ? contacts.a_ids : contacts.b_ids)[(i * 31) % contacts.count])
        : (i * 7919) % meshes[set].faces.length;
    const at = await viewer("v.scenes.stage.screenOf(argument[0], argument[1])", [set, element]);
    const met = await firstMet(page, at, meshes);
    if (met === undefined || !met.clear) continue; // an edge is too near
    ++asked;
    const picked = await viewer("v.scenes.stage.pick(argument.x, argument.y)", at);
    assert.deepEqual(picked, { set: met.set, element: met.element }, `at ${at.x}, ${at.y}`);
    const id = meshes[met.set].ids[met.element];
    const partners = contacts.a_ids
      .map((_, k) => k)
      .filter((k) => (met.set === 0 ? contacts.a_ids : contacts.b_ids)[k] === id);
    if (asked % 4 !== 0 && (partners.length === 0 || partnersSeen > 12)) continue;
    await page.mouse.click(box.x + at.x, box.y + at.y);
    assert.equal(await text(page, "#picked-id"), String(id));
    const buttons = await page.locator("#details .partners button").allInnerTexts();
    const expected = partners.map((k) => (met.set === 0 ? contacts.b_ids : contacts.a_ids)[k]);
    assert.deepEqual(
      buttons.map((b) => Number(/^face (\d+),/.exec(b)[1])),
      expected,
    );
    partnersSeen += partners.length;
    assert.deepEqual(await viewer("v.scenes.selection"), { kind: "element", set: met.set, element: met.element });
  }
  assert.ok(asked >= 25 && partnersSeen >= 5, `${asked} picked, ${partnersSeen} partners`);
  await page.mouse.click(box.x + 8, box.y + 8);
  assert.equal(await page.locator("#details").isVisible(), false, "a click on nothing clears");
});

test("an arrow can be picked, and a partner followed", async () => {
  const at = await viewer(
    "(() => { for (let row = 0; row < argument; ++row) { const p = v.view.toScreen(v.scenes.stage.pointOfContact(0, row)); for (let k = -12; k < 13; ++k) { const q = v.scenes.stage.pick(p.x + k, p.y + 6); if (q && 'result' in q) return { x: p.x + k, y: p.y + 6, row: q.row }; } } })()",
    60,
  );
  const box = await page.locator("#canvas").boundingBox();
  await page.mouse.click(box.x + at.x, box.y + at.y);
  assert.deepEqual(await viewer("v.scenes.selection"), { kind: "row", result: 0, row: at.row });
  await page.locator("#details h3 button").first().click();
  assert.equal(await text(page, "#picked-id"), String(contacts.a_ids[at.row]));
  await page.locator("#details .partners button").first().click();
  assert.equal((await viewer("v.scenes.selection")).kind, "row");
});

test("the list sorts, finds ids, and steps by keys", async () => {
  const depths = async () => (await page.locator("#list .list-row div:nth-child(2)").allInnerTexts()).map(Number);
  const down = [...contacts.depths].sort((x, y) => y - x);
  await page.getByRole("button", { name: /^depth/ }).click();
  assert.deepEqual((await depths()).slice(0, 5).map(Math.fround), down.toReversed().slice(0, 5));
  await page.getByRole("button", { name: /^depth/ }).click();
  assert.deepEqual((await depths()).slice(0, 5).map(Math.fround), down.slice(0, 5));
  await page.keyboard.press("/");
  const id = contacts.b_ids[3];
  for (const [asked, count] of [
    [`b ${id}`, contacts.b_ids.filter((b) => b === id).length],
    [`a ${id}`, 0],
    [`b ${contacts.a_ids[0]}`, 0],
    [`${contacts.a_ids[0]}`, contacts.a_ids.filter((a) => a === contacts.a_ids[0]).length],
  ]) {
    await page.fill("#search", asked);
    assert.match(await text(page, "#row-count"), new RegExp(`^${count} of ${contacts.count} rows`));
    assert.equal(await page.locator("#list .list-row").count(), count);
  }
  await page.fill("#search", "seven");
  assert.match(await text(page, "#row-count"), /Type an id/);
  await page.fill("#search", "");
  await page.getByRole("button", { name: /^#/ }).click();
  await page.locator("#list").focus();
  await page.keyboard.press("End");
  assert.deepEqual(await viewer("v.scenes.selection"), { kind: "row", result: 0, row: contacts.count - 1 });
  await page.keyboard.press("ArrowUp");
  assert.equal((await viewer("v.scenes.selection")).row, contacts.count - 2);
  assert.equal(await page.locator("#list").getAttribute("aria-activedescendant"), `row-${contacts.count - 2}`);
  await page.keyboard.press("Escape");
});

test("hits only, apart, arrows, sets, z up", async () => {
  await page.keyboard.press("f");
  await settle(page);
  const isHit = new Set(contacts.a_ids);
  const plain = meshes[0].ids.findIndex((id) => !isHit.has(id));
  const visible = async () => {
    for (let element = plain; element < meshes[0].ids.length; ++element) {
      if (isHit.has(meshes[0].ids[element])) continue;
      const at = await viewer("v.scenes.stage.screenOf(0, argument)", element);
      const met = await firstMet(page, at, meshes);
      if (met?.set === 0 && met.element === element && met.clear) return { at, element };
    }
  };
  const { at, element } = await visible();
  const pick = () => viewer("v.scenes.stage.pick(argument.x, argument.y)", at);
  assert.deepEqual(await pick(), { set: 0, element });
  await page.keyboard.press("h");
  assert.equal(await page.locator("#hits-only").isChecked(), true);
  const others = await pick();
  assert.ok(others === undefined || "result" in others || isHit.has(meshes[0].ids[others.element]) || others.set === 1);
  assert.notDeepEqual(others, { set: 0, element });
  await page.getByLabel("Hits only").click();
  assert.deepEqual(await pick(), { set: 0, element });
  await page.getByLabel("Show ring", { exact: true }).click();
  assert.notEqual((await pick())?.set, 0);
  await page.getByLabel("Show ring", { exact: true }).click();
  const before = await picture();
  await page.locator("#explode").fill("1");
  const apart = await viewer("v.scenes.stage.screenOf(0, argument)", element);
  assert.ok(Math.hypot(apart.x - at.x, apart.y - at.y) > 30, "it has moved");
  await page.locator("#explode").fill("0");
  await settle(page);
  assert.ok((await picture()) === before, "and back");
  await page.locator("#arrows").fill("0.9");
  await settle(page);
  assert.ok((await picture()) !== before);
  await page.locator("#arrows").fill("0.4");
  await page.keyboard.press("z");
  await settle(page);
  assert.ok((await picture()) !== before);
  await page.keyboard.press("z");
  await page.keyboard.press("e");
  assert.equal(await page.locator("#explode").inputValue(), "0.6");
  await page.keyboard.press("e");
  await settle(page);
  assert.ok((await picture()) === before);
});

test("the mouse turns, moves and zooms", async () => {
  const box = await page.locator("#canvas").boundingBox();
  const place = () => viewer("[...v.view.camera.position.toArray(), ...v.view.controls.target.toArray()]");
  let last = await place();
  for (const [button, wheel] of [
    ["left", 0],
    ["right", 0],
    ["", -300],
  ]) {
    await page.mouse.move(box.x + 300, box.y + 200);
    if (wheel !== 0) await page.mouse.wheel(0, wheel);
    else {
      await page.mouse.down({ button });
      await page.mouse.move(box.x + 380, box.y + 240, { steps: 3 });
      await page.mouse.up({ button });
    }
    await settle(page);
    await page.waitForTimeout(60);
    const now = await place();
    assert.notDeepEqual(now, last, button || "wheel");
    last = now;
  }
  await page.getByRole("button", { name: "Show all" }).click();
});

test("dark and light, help, window size, names for all controls", async () => {
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  await page.getByRole("button", { name: "Dark or light" }).click();
  assert.notEqual(await ground(), light);
  await page.keyboard.press("t");
  assert.equal(await ground(), light);
  await page.keyboard.press("?");
  assert.equal(await page.locator("#help").isVisible(), true);
  assert.match(await text(page, "#keys"), /hits only/);
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("#help").isVisible(), false);
  for (const [width, height] of [
    [420, 800],
    [900, 600],
  ]) {
    await page.setViewportSize({ width, height });
    await settle(page);
    const fits = await page.evaluate(() => {
      const [canvas, stage] = [document.getElementById("canvas"), document.getElementById("stage")];
      return [
        document.documentElement.scrollWidth <= innerWidth,
        Math.abs(canvas.clientWidth - stage.clientWidth) < 2,
        canvas.clientHeight > 200,
        [...document.querySelectorAll("#scene-tools *, #side *")].every((e) => e.getBoundingClientRect().right <= innerWidth + 1),
      ];
    });
    assert.deepEqual(fits, [true, true, true, true], `${width} x ${height}`);
  }
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, input:not([type=file]), select, [role=grid], canvas[tabindex]")]
      .filter((e) => !(e.getAttribute("aria-label") || e.labels?.length || e.textContent.trim() || e.title))
      .map((e) => e.outerHTML),
  );
  assert.deepEqual(nameless, []);
  const dark = await openPage(browser, { scheme: "dark" });
  assert.equal(await dark.evaluate(() => document.documentElement.dataset.theme), "dark");
  assert.deepEqual(dark.problems, []);
  await dark.close();
});

test("a motion: slider, first impact, stepping, playing", async () => {
  await openScene(page, writeScene(motion()), "motion.glb");
  const time = () => viewer("v.scenes.stage.time");
  await page.locator("#time").fill("0.75");
  assert.equal(await time(), 0.75);
  assert.equal(await page.locator("#z-up").isChecked(), true, "it falls along z, so z is up: y in the picture");
  const z = await viewer(
    "v.scenes.stage.ballOf([{ set: 0, side: 'a', vertices: [0] }]).center.y / v.scenes.stage.scale + v.scenes.stage.origin.z",
  );
  assert.ok(Math.abs(z + 0.5) < 1e-5, `the corner is at ${z}`);
  await page.getByRole("button", { name: "First impact", exact: true }).click();
  assert.equal(await time(), 0.25);
  assert.match(await text(page, "#details"), /First impact \(number 1\)[^]*edge 0 1 of falling[^]*edge 0 1 of floor/);
  await page.keyboard.press("]");
  assert.equal(await time(), 0.5);
  assert.match(await text(page, "#details"), /vertex 0 of falling[^]*face 0 1 2 of floor/);
  assert.match(await text(page, "#details"), /vertex 0\s+1\s+1\s+0\n/);
  await page.keyboard.press("[");
  assert.equal(await time(), 0.25);
  assert.ok(
    await page.evaluate(() => {
      const canvas = document.getElementById("time-marks");
      return new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer).some(
        (x) => x !== 0,
      );
    }),
    "moments are marked",
  );
  await page.locator("#canvas").focus();
  await page.keyboard.press("Space");
  await page.waitForFunction(() => window.abutViewer.scenes.stage.time > 0.3);
  await page.keyboard.press("Space");
  const stopped = await time();
  await page.waitForTimeout(120);
  assert.equal(await time(), stopped);
});

test("several frames: the clock, the step of an impact, an origin", async () => {
  await openScene(page, writeScene(frames()), "frames.glb");
  await page.getByRole("button", { name: /^First impact: t = 0.25/ }).click();
  assert.equal(await viewer("v.scenes.stage.time"), 2.25);
  const details = await text(page, "#details");
  assert.match(details, /0.25 of step 2/);
  assert.equal(await text(page, "#time-value"), "step 2 of 3, t = 0.25");
  assert.match(details, /vertex 0\s+1000001.5\s+1\s+0\n/);
  assert.match(await text(page, "#row-count"), /^1 of 9 rows/);
  assert.match(await text(page, "#summary"), /nine were found/);
  const place = () => viewer("v.scenes.stage.screenOf(0, 0)");
  const before = await place();
  await page.locator("#time").fill("1.5");
  assert.notDeepEqual(await place(), before);
  await page.locator("#time").fill("2.25");
  assert.deepEqual(await place(), before);
  // What is drawn is where it is said to be.
  await page.locator("#time").fill("2.9");
  const at = await place();
  assert.deepEqual(await viewer("v.scenes.stage.pick(argument.x, argument.y)", at), { set: 0, element: 0 });
});

test("what is hit in a step of a motion is marked in that step alone", async () => {
  const scene = frames();
  scene.sets[0].frames[2] = scene.sets[0].frames[1]; // at rest: the face stays where it is
  scene.sets[0].vertices.push(...[0, 1, 2].map((v) => [3 + (v === 1), 3, 4 + (v === 2)]));
  for (const frame of scene.sets[0].frames) frame.push(...scene.sets[0].vertices.slice(3));
  scene.sets[0].faces.push([3, 4, 5]);
  const other = { ...scene.results[0], step: 1, vertices: [3, 0, 1, 2], times: [1] };
  scene.results.push(other);
  await openScene(page, writeScene(scene), "steps.glb");
  assert.equal(await text(page, "#time-value"), "step 1 of 3, t = 1", "the first of both, at the end of its step");
  const hits = () => viewer("[0, 3].map((i) => v.scenes.stage.parts[0].object.geometry.getAttribute('hit').array[i])");
  assert.deepEqual(await hits(), [0, 1]);
  for (const [time, step, expected] of [
    ["0.5", "step 0 of 3, t = 0.500", [0, 0]],
    ["1.5", "step 1 of 3, t = 0.500", [0, 1]],
    ["2", "step 2 of 3, t = 0.000", [1, 0]],
    ["3", "step 2 of 3, t = 1.000", [1, 0]],
  ]) {
    await page.locator("#time").fill(time);
    assert.equal(await text(page, "#time-value"), step);
    assert.deepEqual(await hits(), expected, step);
  }
  assert.deepEqual(await page.locator("#summary .sets td:last-child").allInnerTexts(), ["2 hit", "1 hit"]);
  const widths = await page.evaluate(() => {
    const select = document.getElementById("which-result");
    const pen = document.createElement("canvas").getContext("2d");
    pen.font = getComputedStyle(select).font;
    return [select.clientWidth - 36, ...[...select.options].map((o) => pen.measureText(o.text).width)];
  });
  assert.ok(Math.max(...widths.slice(1)) < widths[0], `the choice of a list is not cut off: ${widths}`);
});

test("curves, patches, a move, what sweeps and a safe step", async () => {
  await openScene(page, writeScene(findings()), "findings.glb");
  const time = () => viewer("v.scenes.stage.time");
  assert.equal(await time(), 1, "what sweeps has stopped where it touches");
  assert.match(await text(page, "#details"), /of its way\s+0.5\s+point\s+1\s+1\s+-1\s+normal\s+0\s+0\s+1/);
  assert.match(await text(page, "#labels"), /after 0.5 of its way/);
  const cards = await page.locator(".headline").allInnerTexts();
  assert.deepEqual(
    cards.map((card) => card.split("\n").filter((line) => line !== "")),
    [
      ["First touch: after 0.5 of its way", "shape 0 of movers touches face 1 of floor", "Go there →"],
      ["patches: 0.125 deep", "deepest of 2 patches, area 4, depth 0.125", "Go there →"],
      ["Safe step: 0.375", "of the way is free", "Show it →"],
      ["way out: 3 long", "a move by 0, 0, 3", "Play it ▶"],
    ],
  );
  assert.deepEqual(await page.locator("#which-result option").allInnerTexts(), ["Touches: movers and floor (1)"]);
  assert.match(await text(page, "#list"), /of its way[^]*0\s+0.5\s+0\s+1/);

  await page.getByRole("button", { name: /^Safe step/ }).click();
  assert.equal(await time(), 0.375);
  const green = await page.evaluate(() => {
    const canvas = document.getElementById("time-marks");
    const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height }).getContext("2d");
    copy.drawImage(canvas, 0, 0); // of the page's own it is read a second time, of which the browser complains
    const { data } = copy.getImageData(0, canvas.height - 2, canvas.width, 1);
    return [0.01, 0.36, 0.39, 0.9].map((part) => data[4 * Math.floor(part * canvas.width) + 3] > 0);
  });
  assert.deepEqual(green, [true, true, false, false], "the free part is marked on the clock");

  await page.getByRole("button", { name: /^patches/ }).click();
  assert.deepEqual(await viewer("v.scenes.selection"), { kind: "element", set: 3, element: 0 });
  assert.match(await text(page, "#details"), /patch 0 of patches[^]*area\s+4\s+depth\s+0.125/);

  // A curve is wider than a line, in its colour, and can be picked beside its middle.
  await page.keyboard.press("Escape");
  await page.keyboard.press("f");
  await settle(page);
  for (const name of ["lid", "patches", "movers", "way out", "movers: ways", "floor"]) await page.getByLabel(`Show ${name}`, { exact: true }).click();
  const ends = await viewer("[0, 1].map((e) => v.view.toScreen(v.scenes.stage.vertex(2, 2 * 1 + e).applyMatrix4(v.scenes.stage.content.matrixWorld)))");
  const middle = { x: (ends[0].x + ends[1].x) / 2, y: (ends[0].y + ends[1].y) / 2 };
  const length = Math.hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y);
  const aside = [(ends[0].y - ends[1].y) / length, (ends[1].x - ends[0].x) / length];
  const beside = (by) => ({ x: middle.x + by * aside[0], y: middle.y + by * aside[1] });
  const ground = await pixel({ x: 3, y: 3 });
  const isDrawn = async (by) => apart(await pixel(beside(by)), ground) > 60;
  assert.deepEqual([await isDrawn(-1), await isDrawn(1), await isDrawn(4), await isDrawn(-4)], [true, true, false, false]);
  assert.deepEqual(await viewer("v.scenes.stage.pick(argument.x, argument.y)", middle), { set: 2, element: 1 });

  await page.getByRole("button", { name: /^way out/ }).click();
  await page.waitForFunction(() => window.abutViewer.scenes.stage.time > 0 && window.abutViewer.scenes.stage.time < 0.3);
  await page.getByRole("button", { name: "Play the motion" }).click();
});

test("files come by drop, by ?scene=, and in the page", async () => {
  await page.evaluate(
    (base64) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], "dropped.glb"));
      for (const kind of ["dragenter", "dragover", "drop"])
        document.body.dispatchEvent(new DragEvent(kind, { bubbles: true, cancelable: true, dataTransfer: transfer }));
    },
    Buffer.from(writeScene(small())).toString("base64"),
  );
  await page.waitForFunction(() => document.getElementById("file-name").textContent === "dropped.glb");
  assert.match(await text(page, "#summary"), /Deepest contact: 0.5/);

  const serve = (route) => {
    const { pathname } = new URL(route.request().url());
    if (pathname === "/viewer.html") return route.fulfill({ contentType: "text/html", body: html() });
    if (pathname === "/rings.glb") return route.fulfill({ body: Buffer.from(bytes) });
    return route.fulfill({ status: 404, body: "" });
  };
  const fetched = await openPage(browser, { serve, url: "http://viewer.test/viewer.html?scene=rings.glb" });
  assert.equal(await text(fetched, "#file-name"), "rings.glb");
  await fetched.goto("http://viewer.test/viewer.html?scene=missing.glb");
  await fetched.waitForSelector("html[data-ready]");
  assert.match(await text(fetched, "#message"), /missing.glb: cannot be fetched \(status 404\)/);
  await fetched.close();

  const place = '<script id="abut-scene" type="application/octet-stream;base64">';
  const [head, tail, ...more] = html().split(place);
  assert.deepEqual(more, []);
  for (const [content, says] of [
    [Buffer.from(bytes).toString("base64"), undefined],
    ["no base64!", /no base64/],
  ]) {
    const name = join(folder, `embedded-${process.pid}.html`);
    writeFileSync(name, head + place + content + tail);
    const embedded = await openPage(browser, { url: pathToFileURL(name).href });
    if (says === undefined) assert.match(await text(embedded, "#summary"), /Deepest contact/);
    else assert.match(await text(embedded, "#message"), says);
    assert.deepEqual(embedded.problems, []);
    await embedded.close();
    (await import("node:fs")).unlinkSync(name);
  }
});

test("the gallery: one page leads to all scenes", { skip: !process.env.ABUT_GALLERY }, async () => {
  const at = process.env.ABUT_GALLERY;
  const tool = (name, ...words) => execFileSync(process.execPath, [new URL(`../../../docs/viewer/${name}.mjs`, import.meta.url).pathname, ...words]);
  const says = {
    rings: [/Pairs that touch: \d+[^]*the way out: 1.0\d* long/, "curves"],
    patches: [/patches: 0.15 deep[^]*of 4 patches, area 0.16/, "patches"],
    sweeps: [/First touch: after 0.4 of its way[^]*shape 1 of movers touches/, "ways"],
    safe_step: [/Safe step: 0.4166666666/, ""],
  };
  const names = Object.keys(says);
  for (const name of names) tool("embed", join(folder, "viewer.html"), join(at, `${name}.glb`), join(at, `${name}.html`));
  tool("gallery", at, ...names, "<b>");
  for (const [width, scheme] of [
    [1280, "light"],
    [400, "dark"],
  ]) {
    const gallery = await browser.newPage({ viewport: { width, height: 800 }, colorScheme: scheme });
    await gallery.goto(pathToFileURL(join(at, "index.html")).href);
    assert.deepEqual(await gallery.locator("a").evaluateAll((all) => all.map((a) => a.getAttribute("href"))), [
      ...names.map((name) => `${name}.html`),
      "%3Cb%3E.html",
    ]);
    assert.match(await gallery.locator("li").last().innerText(), /^<b>/, "a name is no markup");
    assert.ok(await gallery.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await gallery.close();
  }
  for (let i = 0; i < names.length; ++i) {
    const opened = await openPage(browser, { url: pathToFileURL(join(at, "index.html")).href, ready: "a" });
    for (let k = 0; k <= i; ++k) await opened.keyboard.press("Tab");
    await opened.keyboard.press("Enter");
    await opened.waitForSelector("html[data-ready]");
    const [card, role] = says[names[i]];
    assert.match(await text(opened, "#summary"), card);
    assert.ok(await opened.evaluate((role) => window.abutViewer.scenes.scene.sets.some((set) => set.role === role), role));
    assert.equal(await opened.locator("#message").isVisible(), false);
    assert.deepEqual(opened.problems, []);
    await opened.close();
  }
});

test("files that are wrong give a message, and the scene stays", async () => {
  await openScene(page, bytes, "rings.glb");
  for (const { name, bytes: wrong, says } of hostile()) {
    await openScene(page, wrong, `${name}.glb`);
    assert.equal(await page.locator("#message").isVisible(), true, name);
    assert.match(await text(page, "#message-text"), says);
    assert.equal(await text(page, "#file-name"), "rings.glb");
    await page.getByRole("button", { name: "Close" }).click();
  }
  assert.match(await text(page, "#summary"), /Deepest contact/);
});

test("a hundred thousand rows: few of them exist, and the last can be reached", async () => {
  const n = 100000;
  const count = Array.from({ length: n }, (_, i) => i);
  const big = {
    kind: "pairs",
    a: 0,
    b: 1,
    count: n,
    a_ids: count.map((i) => (i % 2 === 0 ? 7 : 70000)),
    b_ids: count.map((i) => i % 2),
  };
  await openScene(page, writeScene({ sets: small().sets, results: [big] }), "big.glb");
  assert.ok((await page.locator("#list .list-row").count()) < 60);
  await page.getByRole("button", { name: /^#/ }).click();
  await page.locator("#list").focus();
  await page.keyboard.press("End");
  assert.equal((await viewer("v.scenes.selection")).row, n - 1);
  assert.equal(await page.locator(`#row-${n - 1}`).isVisible(), true);
  assert.ok((await page.locator("#list .list-row").count()) < 60);
});

test("special cases: all of them as written down, and corners that move", async () => {
  await page.keyboard.press("c");
  await page.waitForSelector("#case-check");
  const count = predicate.count();
  assert.match(await text(page, "#case-check"), new RegExp(`^${count} of ${count} came out as written down`));
  const answers = await viewer(
    "v.cases.stage.active = false, Array.from({ length: v.cases.count }, (_, i) => { v.cases.open(i); return [document.getElementById('case-touch').textContent, document.getElementById('case-part').textContent, [...v.cases.corners]]; })",
  );
  answers.forEach(([touch, part, shown], i) => {
    const { hit, corners: asked } = predicate.configuration(i);
    assert.deepEqual(
      [touch, part !== "In common: nothing.", shown],
      [hit ? "They touch" : "They do not touch", hit, asked],
      `case ${i}`,
    );
  });
  await viewer("(v.cases.stage.active = true, v.cases.open(0))");
  await page.keyboard.press("ArrowRight");
  assert.equal(await text(page, "#case-number"), `2 of ${count}`);
  await page.getByRole("button", { name: "← Previous" }).click();
  await page.getByRole("button", { name: "← Previous" }).click();
  assert.equal(await text(page, "#case-number"), `${count} of ${count}`);
  await page.getByLabel("Configuration").selectOption(
    await page
      .locator("#case-chooser option")
      .filter({ hasText: /corner on, equal$/ })
      .first()
      .getAttribute("value"),
  );
  assert.equal(await text(page, "#case-touch"), "They touch"); // both have a corner at (4, 0, 0)
  const x = page.getByLabel("Reference, corner A, x");
  await x.fill("3.5");
  assert.equal(await text(page, "#case-touch"), "They do not touch");
  await page.getByRole("button", { name: "As written down" }).click();
  await x.press("Alt+ArrowDown");
  assert.equal(await text(page, "#case-touch"), "They do not touch", "one float away");
  await x.press("Alt+ArrowUp");
  assert.equal(await text(page, "#case-touch"), "They touch");
  await settle(page);
  const before = await viewer("[...v.cases.corners]");
  const box = await page.locator("#canvas").boundingBox();
  const drag = async (dx, dy) => {
    const from = await viewer("v.cases.stage.screenOfCorner(1)");
    await page.mouse.move(box.x + from.x, box.y + from.y);
    await page.mouse.down();
    await page.mouse.move(box.x + from.x + dx, box.y + from.y + dy, { steps: 4 });
    await page.mouse.up();
    const to = await viewer("v.cases.stage.screenOfCorner(1)");
    return Math.hypot(to.x - from.x - dx, to.y - from.y - dy);
  };
  const wayOff = await drag(60, -30);
  assert.ok(wayOff < 40, `a whole step from where it was dragged: ${wayOff} pixels`);
  const moved = await viewer("[...v.cases.corners]");
  assert.notDeepEqual(moved.slice(3, 6), before.slice(3, 6));
  assert.deepEqual([...moved.slice(0, 3), ...moved.slice(6)], [...before.slice(0, 3), ...before.slice(6)]);
  assert.ok(moved.every(Number.isInteger), "in whole steps");
  assert.equal(await text(page, "#case-touch"), predicate.touches(moved) ? "They touch" : "They do not touch");
  await page.getByLabel("Whole steps").click();
  const off = await drag(-35, 20);
  assert.ok(off < 1.5, `where it was dragged: ${off} pixels`);
  await page.getByText("All patterns of sides").click();
  await page.getByText(/^677 patterns/).waitFor();
  await page.locator("#patterns").click({ position: { x: 20, y: 20 } });
  assert.equal((await viewer("v.cases.predicate.sides(v.cases.corners)")).join(), "-1,-1,0,-1,-1,0");
  await page.keyboard.press("c");
});

test("all that time the page said nothing on the console and asked for nothing", () => {
  assert.deepEqual(page.problems, []);
});

// A scene that the library's own writer made, if there is one: ABUT_SCENE.
test(
  "a scene of an example: its contacts are those that the predicate finds",
  { skip: !process.env.ABUT_SCENE },
  async () => {
    const { readScene } = await import(join(folder, "scene.mjs"));
    const file = readFileSync(process.env.ABUT_SCENE);
    const scene = readScene(new Uint8Array(file), "example");
    const result = scene.results.find((r) => r.kind === "contacts");
    assert.ok(result.count > 100);
    const [a, b] = [scene.sets[result.a], scene.sets[result.b]];
    const cornersOf = (set, id) => Array.from(set.positions.subarray(9 * set.elementOf(id), 9 * set.elementOf(id) + 9));
    for (let i = 0; i < result.count; i += Math.ceil(result.count / 2000)) {
      const found = predicate.contact([...cornersOf(a, result.aIds[i]), ...cornersOf(b, result.bIds[i])]);
      const written = [
        ...result.points.subarray(3 * i, 3 * i + 3),
        ...result.normals.subarray(3 * i, 3 * i + 3),
        result.depths[i],
      ];
      assert.deepEqual(found, written, `contact ${i}`);
    }
    await openScene(page, file, "example.glb");
    const deepest = Math.max(...result.depths);
    await page.keyboard.press("d");
    const shown = Number(/depth\s+(\S+)/.exec(await text(page, "#contact-numbers"))[1]);
    assert.equal(Math.fround(shown), deepest);
    assert.deepEqual(page.problems, []);
  },
);
