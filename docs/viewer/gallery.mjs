// SPDX-License-Identifier: MIT
//
// node gallery.mjs FOLDER NAME...: FOLDER/index.html, a page with a card for each scene: its picture FOLDER/NAME-small.png, if that is
// there, what it shows, and a link to FOLDER/NAME.html.

import { existsSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const known = {
  mesh_pair: ["Two meshes that touch", "All contacts of two scans, with depth and normal."],
  cloth: ["A cloth that falls on a ball", "60 steps, and what the last would have hit."],
  spheres: ["Spheres against a mesh", "A million spheres and a torus: which of them touch which face."],
  triangle: ["One triangle against many", "A million triangles, and those that one of them meets."],
  clash: ["Clashes of a building's parts", "Walls, a slab and a pipe: where surfaces cross, and how parts lie to each other."],
  rings: ["Two rings that cross", "The faces that meet, the curve where they do, and a move that parts them."],
  patches: ["A table that stands in a floor", "One patch for each foot, with area and depth."],
  sweeps: ["Capsules that go through a room", "Their ways, and what each touches first."],
  safe_step: ["A block that falls past a shelf", "How much of the step is free, and all impacts."],
};

const [folder, ...names] = process.argv.slice(2);
const escaped = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const card = (name) => {
  const [title, sentence] = (Object.hasOwn(known, name) && known[name]) || [name, ""];
  const picture = existsSync(join(folder, `${name}-small.png`))
    ? `<img src="${encodeURIComponent(name)}-small.png" alt="" width="560" height="380">`
    : "";
  return `<li><a href="${encodeURIComponent(name)}.html">${picture}<b>${escaped(title)}</b><span>${escaped(sentence)}</span></a></li>`;
};
writeFileSync(
  join(folder, "index.html"),
  `<!doctype html>
<!-- SPDX-License-Identifier: MIT -->
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>abut: scenes to look at</title>
<style>
:root { color-scheme: light dark; --page: #f6f5f2; --panel: #fff; --line: #dedbd3; --text: #23262b; --quiet: #666a70; --accent: #0b62b8; }
@media (prefers-color-scheme: dark) {
  :root { --page: #14171b; --panel: #1b1f24; --line: #343b44; --text: #e6e8ea; --quiet: #9aa3ad; --accent: #7db7f5; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1240px; padding: 20px; font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; color: var(--text); background: var(--page); }
h1 { font-size: 24px; margin: 0 0 4px; }
p, span { color: var(--quiet); }
p { margin: 0 0 18px; }
ul { list-style: none; margin: 0; padding: 0; display: grid; gap: 18px; grid-template-columns: repeat(auto-fill, minmax(min(100%, 280px), 1fr)); }
a { display: flex; flex-direction: column; height: 100%; padding-bottom: 12px; border: 1px solid var(--line); border-radius: 10px; overflow: hidden; background: var(--panel); color: inherit; text-decoration: none; }
a:hover, a:focus-visible { border-color: var(--accent); outline: 2px solid var(--accent); }
a:hover b { text-decoration: underline; }
img { width: 100%; height: auto; display: block; }
b { margin: 10px 14px 2px; color: var(--accent); font-size: 17px; }
span { margin: 0 14px; }
</style>
</head>
<body>
<h1>Which of these touch, where, how deep, and when</h1>
<p>Scenes that abut wrote. Each opens as a page of its own, offline.</p>
<ul>
${names.map(card).join("\n")}
</ul>
</body>
</html>
`,
);
