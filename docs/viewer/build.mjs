// SPDX-License-Identifier: MIT
//
// node build.mjs FOLDER: makes FOLDER/viewer.html, one file with everything in it, and FOLDER/scene.mjs, the reader of files alone,
// for tests. FOLDER has node_modules (npm ci) and predicate.wasm, without which there are no special cases.

import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const folder = resolve(process.argv[2] ?? "build/viewer");
const require = createRequire(join(folder, "package.json"));
const { build } = require("esbuild");

const wasm = join(folder, "predicate.wasm");
const predicate = {
  name: "predicate",
  setup(made) {
    made.onResolve({ filter: /^predicate\.wasm$/ }, () => ({ path: wasm, namespace: "predicate" }));
    made.onLoad({ filter: /.*/, namespace: "predicate" }, () => ({
      contents: existsSync(wasm) ? readFileSync(wasm) : new Uint8Array(0),
      loader: "binary",
    }));
  },
};

async function bundle(entry, options) {
  const made = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    write: false,
    target: "es2022",
    nodePaths: [join(folder, "node_modules")],
    plugins: [predicate],
    logLevel: "warning",
    legalComments: "eof",
    ...options,
  });
  return made.outputFiles[0].text;
}

const script = (await bundle("main.ts", { format: "iife", minify: true }))
  .replaceAll("</script", "<\\/script")
  .replaceAll("<!--", "<\\!--");
const style = readFileSync(join(here, "style.css"), "utf8");
const page = readFileSync(join(here, "index.html"), "utf8")
  .replace("/*STYLE*/", () => style)
  .replace("/*SCRIPT*/", () => script);
const place = '<script id="abut-scene" type="application/octet-stream;base64"></script>';
if (page.split(place).length !== 2) throw new Error(`expected exactly one ${place} in the page`);
writeFileSync(join(folder, "viewer.html"), page);
writeFileSync(join(folder, "scene.mjs"), await bundle("scene.ts", { format: "esm" }));
console.log(
  `${join(folder, "viewer.html")}: ${(page.length / 1e6).toFixed(2)} MB${existsSync(wasm) ? "" : ", without special cases"}`,
);
