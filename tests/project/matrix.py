#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Keeps docs/matrix.md true: which pair of shapes has which query, and which query takes which arguments.

matrix.py check ROOT COMPILER [OPTION...]   the page says what compiles
matrix.py write ROOT COMPILER [OPTION...]   writes it so

Pairs of shapes are asked of the concepts that the queries ask (matrix.cpp). Each form of argument is compiled: a source for each query
has a function for each form, and those with errors are not taken. A compiler reports what it has refused once only, so that one source
for all queries would not do.
"""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

FORMS = {  # of the first argument: what it is called, and what it is below
    "a set": "faces", "one shape": "face", "`make_bvh`": "tree", "`wide`": "broad", "`quantised`": "small", "`make_grid`": "buckets",
    "`posed`": "placed", "bodies": "scene", "a list": "list",
}
OF_TWO = ["any", "count", "pairs", "for_each_pair", "contacts", "within", "distance", "relation", "overlaps", "contact_patches",
          "crossings", "penetration", "hausdorff"]
OF_ROWS = {"nearest": "points", "raycast": "lines", "raycast_any": "lines", "raycast_all": "lines", "sweep": "balls", "inside": "points",
           "signed_distance": "points", "winding_number": "points", "spans": "lines"}
OF_ONE = ["self_pairs", "count_self_pairs", "self_crossings"]
MORE = {"within": ", 1.0", "for_each_pair": ", use", "hausdorff": ", {.tolerance = 0.01}", "penetration": ", {.tolerance = 0.01}"}
HEAD = """#include <abut/abut.hpp>
#include <vector>

namespace {
const abut::serial on;
const abut::mesh<float> faces;
const abut::triangle<float> face{};
const abut::rigid<float> pose;
const auto tree = abut::make_bvh(on, faces);
const auto broad = abut::wide(on, tree);
const auto small = abut::quantised(on, tree);
const auto buckets = abut::make_grid(on, abut::spheres<float>{});
const auto placed = abut::posed(tree, pose);
const std::vector<abut::posed_pair<std::remove_const_t<decltype(tree)>>> list;
const auto scene = abut::make_bodies(on, std::vector<std::remove_const_t<decltype(placed)>>{});
const abut::points<float> points;
const abut::rays<float> lines;
const abut::shapes<abut::swept<abut::sphere<float>>> balls;
const auto use = [](auto) { return abut::visit::proceed; };
}  // namespace
"""


def fail(message):
    sys.exit(f"matrix.py: {message}")


def call(query, form, x):
    if query in OF_ONE:
        return f"abut::{query}(on, {x})"
    if query in OF_ROWS:
        return f"abut::{query}(on, {x}, {OF_ROWS[query]})"
    other = {"bodies": "", "a list": "", "`make_grid`": "tree, "}.get(form)
    arguments = f"{other}{x}" if other is not None else f"{x}, tree"
    return f"abut::{query}(on, {arguments}{MORE.get(query, '')})"


def forms_of(query, compiler, folder):
    """Which forms of argument a query takes: their names."""
    functions = [f"void probe_{k}() {{ (void)({call(query, form, x)}); }}" for k, (form, x) in enumerate(FORMS.items())]
    source = pathlib.Path(folder) / f"probe_{query}.cpp"
    source.write_text('#include "head.hpp"\n' + "\n".join(functions) + "\n", encoding="utf-8")
    done = subprocess.run([*compiler, "-fsyntax-only", "-w", "-fmax-errors=0", str(source)], capture_output=True, text=True, check=False)
    refused, elsewhere = set(), done.returncode != 0
    for line in re.findall(rf"{re.escape(source.name)}:(\d+):", done.stderr):
        if int(line) > 1:  # that is which include it came by
            refused.add(int(line) - 2)
            elsewhere = False
    if elsewhere:
        fail(f"{query}: the compiler says:\n{done.stderr[:2000]}")
    return [form for k, form in enumerate(FORMS) if k not in refused]


def pairs_of_shapes(root, compiler, folder):
    program = pathlib.Path(folder) / "matrix"
    subprocess.run([*compiler, "-O0", "-w", str(root / "tests/project/matrix.cpp"), "-o", str(program)], check=True)
    return [subprocess.run([str(program), *more], capture_output=True, text=True, check=True).stdout for more in ([], ["sets"])]


def blocks(root, compiler):
    queries = [*OF_TWO, *OF_ROWS, *OF_ONE]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        head = pathlib.Path(folder) / "head.hpp"
        head.write_text("#pragma once\n" + HEAD, encoding="utf-8")
        subprocess.run([*compiler, "-w", "-x", "c++-header", str(head), "-o", f"{head}.gch"], check=True)  # read once
        pairs = pool.submit(pairs_of_shapes, root, compiler, folder)
        taken = list(pool.map(lambda query: forms_of(query, compiler, folder), queries))
        of_pairs, of_sets = pairs.result()
    rows = ["| | " + " | ".join(FORMS) + " |", "| --- |" + " --- |" * len(FORMS)]
    for query, forms in zip(queries, taken):
        rows.append(f"| `{query}` | " + " | ".join("yes" if form in forms else "-" for form in FORMS) + " |")
    return {"pairs": of_pairs, "sets": of_sets, "forms": "\n".join(rows) + "\n"}


def main():
    if len(sys.argv) < 4 or sys.argv[1] not in ("check", "write"):
        fail("usage: matrix.py check|write ROOT COMPILER [OPTION...]")
    root = pathlib.Path(sys.argv[2])
    compiler = [*sys.argv[3:], "-std=c++20", f"-I{root / 'include'}"]
    page = root / "docs" / "matrix.md"
    text = page.read_text(encoding="utf-8")
    told = text
    for name, block in blocks(root, compiler).items():
        pattern = rf"(<!-- matrix.py writes {name} -->\n).*?(<!-- end of {name} -->)"
        told, n = re.subn(pattern, lambda m: m[1] + block + m[2], told, flags=re.DOTALL)
        if n != 1:
            fail(f"{page}: no block of {name}")
    if told == text:
        return
    if sys.argv[1] == "write":
        page.write_text(told, encoding="utf-8")
        return
    for old, new in zip(text.split("\n"), told.split("\n")):
        if old != new:
            fail(f"{page} says\n  {old}\nand the headers\n  {new}\nmatrix.py write mends the page")
    fail(f"{page} has other lines than the headers")


main()
