// SPDX-License-Identifier: MIT
//
// node embed.mjs PAGE SCENE OUT: the page with a scene in it, one HTML file.

import { readFileSync, writeFileSync } from "node:fs";
import { basename } from "node:path";

const [page, scene, out] = process.argv.slice(2);
const opening = '<script id="abut-scene" type="application/octet-stream;base64">';
const parts = readFileSync(page, "utf8").split(opening + "</script>");
if (parts.length !== 2) throw new Error(`${page}: expected one place for a scene, found ${parts.length - 1}`);
const name = basename(scene).replace(/[&<"]/g, (c) => `&#${c.charCodeAt(0)};`);
writeFileSync(
  out,
  `${parts[0]}${opening.slice(0, -1)} data-name="${name}">${readFileSync(scene).toString("base64")}</script>${parts[1]}`,
);
