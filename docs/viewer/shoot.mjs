// SPDX-License-Identifier: MIT
//
// node shoot.mjs FOLDER CHROMIUM PAGE.html OUT.png [light|dark] [WIDTHxHEIGHT] [KEY...]: a picture of a page with a scene in it,
// after these keys were pressed: names of keys; #ID, a click; ID=VALUE, which is filled in; @canvas, the scene alone. Its graphics are drawn in software. FOLDER has node_modules. Fails if the page shows no scene.

import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { startChromium } from "./chromium.mjs";

const [folder, chromiumPath, page, out, colorScheme = "light", size = "1280x800", ...keys] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const browser = await startChromium(folder, chromiumPath);
const tab = await browser.newPage({ viewport: { width, height }, colorScheme, reducedMotion: "reduce" });
const [path, hash = ""] = page.split("#");
await tab.goto(pathToFileURL(resolve(path)).href + (hash && `#${hash}`));
await tab.waitForSelector("html[data-ready]", { timeout: 120000 });
for (const key of keys) {
  if (key === "@canvas") {
    const content = "#app { grid-template: minmax(0, 1fr) / minmax(0, 1fr) !important } #side, .tools, #labels { display: none !important }";
    await tab.addStyleTag({ content });
    await tab.evaluate(() => {
      const { view, scenes } = window.abutViewer;
      view.resize();
      scenes.fit(true);
      scenes.firstSight();
    });
  } else if (key.includes("=")) await tab.locator(`#${key.split("=")[0]}`).fill(key.split("=")[1]);
  else if (key.startsWith("#")) await tab.click(key);
  else await tab.keyboard.press(key);
}
await tab.waitForTimeout(300);
await tab.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
await tab.screenshot({ path: out, timeout: 120000 });
const message = tab.locator("#message");
if (await message.isVisible()) {
  console.error(`${page}: ${await tab.locator("#message-text").innerText()}`);
  process.exitCode = 1;
}
await browser.close();
