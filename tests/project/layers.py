# SPDX-License-Identifier: MIT
"""Checks the headers below include/abut against the table of layers in docs/architecture.md.

usage: layers.py TABLE.md INCLUDE_DIR

Before it reads the real tree, it plants one violation of each kind in a copy and fails if one of them goes unnoticed.
"""

import re
import shutil
import sys
import tempfile
from pathlib import Path

INCLUDE = re.compile(r"^\s*#\s*include\b\s*(.*)$")
CONFIG_EXCEPTION = "#if defined(__CUDA_ARCH__)"
STOP = "#include <abut/stopped_by_the_error_above>"  # after an #error; there is no such file, and that stops the compiler
EXECUTION_ONLY = {
    "<<<": re.compile(r"<<<"),
    "#pragma omp": re.compile(r"#\s*pragma\s+omp|_Pragma\s*\(\s*\"omp"),
    "__CUDA_ARCH__": re.compile(r"__CUDA_ARCH__"),
    "thrust::": re.compile(r"\bthrust\s*::"),
    "cub::": re.compile(r"\bcub\s*::"),
    "a CUDA, Thrust, CUB or OpenMP header": re.compile(r"#\s*include\s*[<\"](cuda|cooperative_groups|thrust/|cub/|omp\.h)"),
}


class Layer:
    def __init__(self, level, sees, never):
        self.level, self.sees, self.never = level, sees, never


def read_table(text):
    """The layers by name, and what is wrong with the table itself."""
    layers, problems = {}, []
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) != 4 or not cells[0].isdigit():
            continue
        names = [re.findall(r"`([^`]+)`", cell) for cell in cells[1:]]
        if len(names[0]) != 1:
            problems.append(f"table: one name in the second column, please: {line}")
            continue
        layers[names[0][0]] = Layer(int(cells[0]), set(names[1]), set(names[2]))
    if not layers:
        problems.append("table: no row found")
    for name, layer in layers.items():
        for other in sorted(layer.sees | layer.never):
            if other not in layers:
                problems.append(f"table: {name} names {other}, which has no row")
        for other in sorted(layer.sees & layers.keys()):
            if layers[other].level >= layer.level:
                problems.append(f"table: {name} (level {layer.level}) sees {other} (level {layers[other].level})")
    return layers, problems


def layer_of(path):
    return path.split("/")[0] + "/" if "/" in path else path


def read_headers(root, problems):
    """For each header its includes of ours as (line, path); notes what no layer may hold."""
    headers = {}
    for file in sorted(p for p in (root / "abut").rglob("*") if p.is_file()):
        path = file.relative_to(root / "abut").as_posix()
        headers[path] = []
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            where = f"{path}:{number}"
            if not path.startswith("execution/"):
                for word, pattern in EXECUTION_ONLY.items():
                    exempt = path == "config.hpp" and word == "__CUDA_ARCH__" and line == CONFIG_EXCEPTION
                    if pattern.search(line) and not exempt:
                        problems.append(f"{where}: {word} outside execution/")
            include = INCLUDE.match(line)
            if include is None or line == STOP:
                continue
            name = include.group(1)
            if not name.startswith("<"):
                problems.append(f"{where}: includes are written <abut/...>, not {name}")
            elif name.startswith("<abut/"):
                headers[path].append((number, name[len("<abut/"):].split(">")[0]))
    return headers


def reached(headers, start):
    """All headers that one reaches, each with the header that led there."""
    found, todo = {}, [start]
    while todo:
        path = todo.pop()
        for _, target in headers.get(path, []):
            if target not in found and target != start:
                found[target] = path
                todo.append(target)
    return found


def check(table, root):
    layers, problems = read_table(table)
    headers = read_headers(root, problems)
    for path, includes in headers.items():
        mine = layer_of(path)
        if mine not in layers:
            problems.append(f"{path}: {mine} has no row in the table")
            continue
        for number, target in includes:
            where, theirs = f"{path}:{number}", layer_of(target)
            if target not in headers:
                problems.append(f"{where}: <abut/{target}> does not exist")
            if theirs != mine and theirs not in layers[mine].sees:
                problems.append(f"{where}: {mine} does not see {theirs} (<abut/{target}>)")
            is_for_nvcc = re.match(r"(execution|experimental)/cuda|cuda(_devices)?\.hpp$", path)
            if re.match(r"execution/cuda", target) and mine != "execution/" and not is_for_nvcc:
                problems.append(f"{where}: only cuda.hpp, cuda_devices.hpp and execution/ include <abut/{target}>")
        if layers[mine].never:
            for target, via in sorted(reached(headers, path).items()):
                if layer_of(target) in layers[mine].never:
                    problems.append(f"{path}: must not reach {target}, and does through {via}")
    return headers, problems


# Each plant is one line more in one header (a new one, if need be), and a part of the complaint that it must cause.
PLANTS = [
    ("config.hpp", "#include <abut/arithmetic/vec.hpp>", "config.hpp does not see arithmetic/"),
    ("config.hpp", "#define ABUT_ARCH __CUDA_ARCH__", "__CUDA_ARCH__ outside"),
    ("arithmetic/planted.hpp", "#include <abut/shape/primitive.hpp>", "arithmetic/ does not see shape/"),
    ("arithmetic/planted.hpp", "#include <abut/execution/planted.hpp>", "arithmetic/ does not see execution/"),
    ("execution/planted.hpp", "#include <abut/arithmetic/vec.hpp>", "execution/ does not see arithmetic/"),
    ("shape/planted.hpp", "#include <abut/index/planted.hpp>", "shape/ does not see index/"),
    ("predicate/planted.hpp", "  #  include <abut/index/planted.hpp>", "predicate/ does not see index/"),
    ("predicate/planted.hpp", "#include <abut/shape/set_planted.hpp>", "predicate/planted.hpp: must not reach execution/"),
    ("traverse/planted.hpp", "#include <abut/narrow/planted.hpp>", "traverse/ does not see narrow/"),
    ("collide/planted.hpp", "#include <abut/execution/cuda_planted.hpp>", "only cuda.hpp, cuda_devices.hpp and execution/ include"),
    ("abut.hpp", "#include <abut/io/planted.hpp>", "abut.hpp does not see io/"),
    ("stray/planted.hpp", "", "stray/ has no row"),
    ("shape/planted.hpp", "#include <abut/shape/absent.hpp>", "does not exist"),
    ("shape/planted.hpp", "#include \"primitive.hpp\"", "includes are written <abut/...>"),
    ("shape/planted.hpp", "#include SOME_MACRO", "includes are written <abut/...>"),
    ("index/planted.hpp", "    build<<<1, 32>>>();", "<<< outside"),
    ("index/planted.hpp", "#pragma omp parallel for", "#pragma omp outside"),
    ("index/planted.hpp", "# pragma  omp simd", "#pragma omp outside"),
    ("index/planted.hpp", "_Pragma(\"omp parallel\")", "#pragma omp outside"),
    ("predicate/planted.hpp", "#ifdef __CUDA_ARCH__", "__CUDA_ARCH__ outside"),
    ("collide/planted.hpp", "thrust::sort(a, b);", "thrust:: outside"),
    ("collide/planted.hpp", "cub::DeviceScan::ExclusiveSum(a, b);", "cub:: outside"),
    ("collide/planted.hpp", "#include <cuda_runtime.h>", "a CUDA, Thrust, CUB or OpenMP header outside"),
]


def self_test(table, root):
    """What goes unnoticed of the planted violations, in a tree and in the table."""
    missed = []
    folders = [name for name in read_table(table)[0] if name.endswith("/")]
    for place, line, complaint in PLANTS:
        with tempfile.TemporaryDirectory() as name:
            copy = Path(name)
            shutil.copytree(root / "abut", copy / "abut")
            for folder in folders:
                (copy / "abut" / folder).mkdir(exist_ok=True)
                (copy / "abut" / folder / "planted.hpp").touch()
            (copy / "abut/execution/cuda_planted.hpp").touch()
            (copy / "abut/shape/set_planted.hpp").write_text("#include <abut/execution/planted.hpp>\n")
            (copy / "abut" / place).parent.mkdir(exist_ok=True)
            before = len(check(table, copy)[1])
            with open(copy / "abut" / place, "a", encoding="utf-8") as file:
                file.write(line + "\n")
            problems = check(table, copy)[1]
            if len(problems) <= before or not any(complaint in problem for problem in problems):
                missed.append(f"self-test: unnoticed in {place}: {line!r} (expected: {complaint})")
    row = "| 1 | `arithmetic/` | `config.hpp`, `shape/` | |"
    if not any("sees shape/" in problem for problem in read_table(table + "\n" + row)[1]):
        missed.append("self-test: unnoticed in the table: a layer that sees a higher one")
    return missed


def main():
    table, root = Path(sys.argv[1]).read_text(encoding="utf-8"), Path(sys.argv[2])
    missed = self_test(table, root)
    headers, problems = check(table, root)
    for line in missed + problems:
        print(line)
    if not headers:
        print(f"no header below {root}/abut")
    includes = sum(len(targets) for targets in headers.values())
    print(f"{len(headers)} headers, {includes} includes, {len(PLANTS) + 1} planted violations: "
          f"{len(problems)} problems, {len(missed)} plants unnoticed")
    return 1 if missed or problems or not headers else 0


if __name__ == "__main__":
    sys.exit(main())
