#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Keeps docs/matrix.md true: which pair of shapes has which query, and which query takes which arguments.

matrix.py check ROOT COMPILER [OPTION...]       all that the page says compiles under a processor's policy; and of one query of each
                                                front it says all that does, under each executor
matrix.py check-all ROOT COMPILER [OPTION...]   that it says all that does, of all queries
matrix.py write ROOT COMPILER [OPTION...]       writes it so

Pairs of shapes are asked of the concepts that the queries ask (matrix.cpp). Each form of argument is compiled, for each executor: a
source for each query has a function for each form, and those with errors are not taken. Options have to name the folder of mpi.h.
"""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

COLUMNS = {  # of the table of forms: which of the arguments they are (matrix_arguments.hpp)
    "a set": ["faces"], "one shape": ["face"], "a tree, posed or not": ["tree", "broad", "small", "placed"], "`make_grid`": ["buckets"],
    "a list": ["list"], "a list of several kinds": ["mixed_list"], "bodies": ["scene"], "bodies of several kinds": ["mixed"],
    "in motion": ["step"],
}
FORMS = [form for column in COLUMNS.values() for form in column]
LETTERS = {"tree": "S", "divided": "D", "list": "L", "mixed_list": "K", "scene": "B", "mixed": "M", "step": "W"}
EXECUTORS = {  # but the processor, which the forms tell of
    "`cuda`": "cuda", "`cuda_devices`": "devices", "ranks": "ranks", "a stream": "stream",
}
OF_TWO = ["any", "count", "pairs", "for_each_pair", "contacts", "any_within", "count_within", "within", "touching_bodies", "bodies_within",
          "distance", "relation", "overlaps", "contact_patches", "crossings", "penetration", "hausdorff"]
OF_ROWS = {"any_each": "rows", "any_within_each": "rows", "count_each": "rows", "nearest": "points", "raycast": "lines",
           "raycast_any": "lines", "raycast_all": "lines", "raycast_detailed": "lines", "sweep": "balls", "inside": "points",
           "signed_distance": "points", "winding_number": "points", "spans": "lines"}
OF_ONE = ["self_pairs", "count_self_pairs", "self_within", "self_crossings"]
IN_MOTION = {"impacts": 2, "first_impact": 2, "safe_step": 2, "safe_steps": 2, "self_impacts": 1, "first_self_impact": 1,
             "safe_self_step": 1, "safe_self_steps": 1, "first_meetings": 1}  # and how many arguments
FRONTS = ["pairs", "touching_bodies", "distance", "overlaps", "hausdorff", "any_each", "nearest", "raycast_all", "self_pairs", "impacts",
          "first_meetings"]  # of queries of one front one is asked of all executors by `check`
QUERIES = [*OF_TWO, *OF_ROWS, *OF_ONE, *IN_MOTION]
MORE = {"any_within": ", 1.0", "count_within": ", 1.0", "within": ", 1.0", "bodies_within": ", 1.0", "self_within": ", 1.0",
        "any_within_each": ", 1.0", "for_each_pair": ", {}::visitor", "hausdorff": ", {{.tolerance = 0.01}}",
        "penetration": ", {{.tolerance = 0.01}}"}
WAYS = {"any_each": "ways", "touching_bodies": "way", "first_meetings": "ways"}  # what is in motion, where it is no mesh
OUTCOMES = {"any": "value<bool>", "any_within": "value<bool>", "count": "value<std::uint64_t>", "count_within": "value<std::uint64_t>",
            "count_self_pairs": "value<std::uint64_t>", "contacts": "result<abut::contact<float>>",
            "crossings": "result<abut::crossing<float>>", "self_crossings": "result<abut::crossing<float>>"}


def fail(message):
    sys.exit(f"matrix.py: {message}")


def call(query, executor, form):
    """A call of a query with arguments of a form."""
    if executor == "stream":
        executor = f"stream<abut::async_{OUTCOMES.get(query, 'result<abut::index_pair>')}>"
    of, tree = f"ask::{executor}", f"ask::{executor}::tree"
    more = MORE.get(query, "").format(of)
    if form == "step":
        x = f"{of}::{WAYS.get(query, form)}"
        is_alone = query in OF_ONE or query in WAYS or IN_MOTION.get(query) == 1
        more = more or (", {.tolerance = 0.01}" if query in WAYS else "")
        return f"abut::{query}({of}::on, {x}{'' if is_alone else ', ' + x}{more})"
    x = f"{of}::{form}"
    is_whole = form in ("list", "mixed_list") or form in ("scene", "mixed") and query not in OF_ROWS
    if is_whole or query in OF_ONE or IN_MOTION.get(query) == 1:
        return f"abut::{query}({of}::on, {x}{more})"
    other = f"{of}::{OF_ROWS[query]}" if query in OF_ROWS else tree
    first, second = (tree, x) if form == "buckets" and query not in OF_ROWS else (x, other)
    return f"abut::{query}({of}::on, {first}, {second}{more})"


def sifted(query, probes, compiler, folder, name):
    """Which of the probes, an executor and a form each, compile. Those with errors are left out until no error is left, since a compiler
    reports what it has refused once only."""
    probes = list(probes)
    source = pathlib.Path(folder) / f"{name}_{query}.cpp"
    while probes:
        functions = [f"void probe_{k}() {{ (void)({call(query, *probe)}); }}" for k, probe in enumerate(probes)]
        source.write_text('#include "matrix_arguments.hpp"\n' + "\n".join(functions) + "\n", encoding="utf-8")
        done = subprocess.run([*compiler, "-fsyntax-only", "-w", "-fmax-errors=0", f"-I{folder}", str(source)], capture_output=True,
                              text=True, check=False)
        if done.returncode == 0:
            break
        # Line 1 is that which an include came by.
        refused = {int(line) - 2 for line in re.findall(rf"{re.escape(source.name)}:(\d+):", done.stderr) if int(line) > 1}
        if not refused:
            fail(f"{query}: the compiler says:\n{done.stderr[:2000]}")
        probes = [probe for k, probe in enumerate(probes) if k not in refused]
    return set(probes)


def taken(query, probes, told, compiler, folder):
    """Which of the probes compile. `told` are those that the page says do, which are not compiled twice if it is right."""
    return (sifted(query, [p for p in probes if p in told], compiler, folder, "told")
            | sifted(query, [p for p in probes if p not in told], compiler, folder, "others"))


def pairs_of_shapes(root, compiler, folder):
    program = pathlib.Path(folder) / "matrix"
    subprocess.run([*compiler, "-O0", "-w", str(root / "tests/project/matrix.cpp"), "-o", str(program)], check=True)
    return [subprocess.run([str(program), *more], capture_output=True, text=True, check=True).stdout for more in ([], ["sets"])]


def table(head, rows):
    return "\n".join(["| | " + " | ".join(head) + " |", "| --- |" + " --- |" * len(head),
                      *(f"| `{query}` | " + " | ".join(cells) + " |" for query, cells in rows)]) + "\n"


def yes_or_no(query, there, column):
    """Whether all forms of a column are taken, or none."""
    taken_forms = [form for form in column if ("processor", form) in there]
    if taken_forms and taken_forms != column:
        fail(f"{query} takes of one column {taken_forms} and not the others: give them columns of their own")
    return "yes" if taken_forms else "-"


def cells_of(text, name):
    """The rows of a table of the page, by their queries."""
    block = re.search(rf"<!-- matrix.py writes {name} -->\n(.*?)<!-- end of {name} -->", text, re.DOTALL)
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in (block[1] if block else "").split("\n")]
    return {row[0].strip("`"): row[1:] for row in rows if row and row[0].startswith("`")}


def blocks(root, compiler, text, asked_of_all):
    """What the page has to say. Of queries that are not in asked_of_all it is taken to be right about executors and about what is refused."""
    forms_told, executors_told = cells_of(text, "forms"), cells_of(text, "executors")
    letter_of = {letter: form for form, letter in LETTERS.items()}

    def told_of(query):
        told = {("processor", form) for column, cell in zip(COLUMNS.values(), forms_told.get(query, [])) if cell == "yes"
                for form in column}
        for executor, cell in zip(EXECUTORS.values(), executors_told.get(query, [""])[1:]):
            told |= {(executor, letter_of[letter]) for letter in cell if letter in letter_of}
        return told

    def there_of(query):
        told, probes = told_of(query), [("processor", form) for form in FORMS]
        others = [(executor, form) for executor in EXECUTORS.values() for form in LETTERS if form != "divided" or executor == "devices"]
        if query in asked_of_all:
            return taken(query, probes + others, told, compiler, folder)
        return sifted(query, [p for p in probes if p in told], compiler, folder, "told") | (told & set(others))

    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        pairs = pool.submit(pairs_of_shapes, root, compiler, folder)
        head = root / "tests/project/matrix_arguments.hpp"
        subprocess.run([*compiler, "-w", "-x", "c++-header", str(head), "-o", f"{folder}/{head.name}.gch"], check=True)  # read once
        of_queries = list(pool.map(there_of, QUERIES))
        of_pairs, of_sets = pairs.result()

    def letters(there, executor):
        return "".join(letter for form, letter in LETTERS.items() if (executor, form) in there) or "-"

    all_of = list(zip(QUERIES, of_queries))
    forms = [(query, [yes_or_no(query, there, column) for column in COLUMNS.values()]) for query, there in all_of]
    executors = [(query, [letters(there, x) for x in ("processor", *EXECUTORS.values())]) for query, there in all_of]
    return {"pairs": of_pairs, "sets": of_sets, "forms": table(COLUMNS, forms),
            "executors": table(["`serial`, `openmp`", *EXECUTORS], executors)}


def main():
    if len(sys.argv) < 4 or sys.argv[1] not in ("check", "check-all", "write"):
        fail("usage: matrix.py check|check-all|write ROOT COMPILER [OPTION...]")
    root = pathlib.Path(sys.argv[2])
    compiler = [*sys.argv[3:], "-std=c++20", f"-I{root / 'include'}"]
    page = root / "docs" / "matrix.md"
    text = page.read_text(encoding="utf-8")
    told = text
    asked_of_all = FRONTS if sys.argv[1] == "check" else QUERIES
    for name, block in blocks(root, compiler, text, asked_of_all).items():
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
