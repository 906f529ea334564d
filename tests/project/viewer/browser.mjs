// SPDX-License-Identifier: MIT
//
// The page in a real browser, headless, with its graphics in software. ABUT_VIEWER names the folder with viewer.html and
// node_modules, ABUT_CHROMIUM the browser.

import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { startChromium } from "../../../docs/viewer/chromium.mjs";

export const folder = process.env.ABUT_VIEWER;

export const startBrowser = () => startChromium(folder, process.env.ABUT_CHROMIUM ?? "/usr/bin/chromium");

export const html = () => readFileSync(join(folder, "viewer.html"), "utf8");
export const viewerUrl = pathToFileURL(join(folder, "viewer.html")).href;

/** A page of the viewer, ready. `problems` gathers what it says on the console, and what it asks of the network. */
export async function openPage(browser, { url = viewerUrl, size = [900, 600], scheme = "light", serve, ready = "html[data-ready]" } = {}) {
  const page = await browser.newPage({
    viewport: { width: size[0], height: size[1] },
    colorScheme: scheme,
    reducedMotion: "reduce",
  });
  page.problems = [];
  page.on("console", (message) => {
    // Reading pixels back is what picking is; a driver in software complains of it.
    if (message.type() !== "log" && !/GPU stall due to ReadPixels/.test(message.text()))
      page.problems.push(`${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (error) => page.problems.push(error.stack ?? String(error)));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url()) && serve === undefined) page.problems.push(`asks for ${request.url()}`);
  });
  if (serve !== undefined) await page.route("http://viewer.test/**", serve);
  await page.goto(url);
  await page.waitForSelector(ready);
  return page;
}

export async function openScene(page, bytes, name = "test.glb") {
  const path = join(folder, name);
  const isLarge = bytes.length > 40e6; // Playwright sends no more
  if (isLarge) writeFileSync(path, bytes);
  await page.setInputFiles("#file", isLarge ? path : { name, mimeType: "model/gltf-binary", buffer: Buffer.from(bytes) });
  await page.waitForFunction(
    (wanted) => document.getElementById("file-name").textContent === wanted || !document.getElementById("message").hidden,
    name,
  );
  await settle(page);
}

/** Waits until nothing flies and a frame was drawn. */
export async function settle(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page.waitForFunction(() => !window.abutViewer.view.flying);
}

export const text = (page, selector) => page.locator(selector).innerText();
