#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that each source file says its licence in its first lines, once, and that LICENSE is that licence.

usage: licence.py ROOT

Before it reads the real tree, it plants files without that line, or with another, and fails if one of them goes unnoticed.
"""

import sys
import tempfile
from pathlib import Path

LINE = "SPDX-License-Identifier: MIT"
ENDINGS = {".hpp", ".cpp", ".cu", ".py", ".sh", ".cmake", ".in", ".js", ".mjs", ".ts", ".css", ".html", ".yml", ".yaml", ".cff"}
NAMES = {"CMakeLists.txt", "run"}  # and all whose name begins with a dot
FOLDERS = ("", ".ci", ".github", "bench", "cmake", "docs", "include", "tests")  # "": the files at the top
LINES = 3  # what goes before it: a line for the shell or the browser
LEFT_OUT = {".git", "build", "node_modules", "__pycache__"}
DATA = {"corpus", "seeds", "results"}  # nobody's sources


def sources(root):
    paths = [path for folder in FOLDERS for path in ((root / folder).rglob("*") if folder else root.glob("*"))]
    for path in sorted(paths):
        parts = path.relative_to(root).parts
        if LEFT_OUT.intersection(parts) or DATA.intersection(parts[:-1]) or not path.is_file() or path.is_symlink():
            continue
        if path.suffix in ENDINGS or path.name in NAMES or (path.name.startswith(".") and len(parts) == 1):
            yield path


def problems_of(root):
    problems, count = [], 0
    for path in sources(root):
        count += 1
        text = path.read_text(encoding="utf-8")
        head = text.split("\n")[:LINES]
        if not any(LINE in line for line in head):
            problems.append(f"{path.relative_to(root)}: its first {LINES} lines do not hold '{LINE}'")
    licence = root / "LICENSE"
    if not licence.is_file() or not licence.read_text(encoding="utf-8").startswith("MIT License\n"):
        problems.append("LICENSE: is not the MIT License")
    return problems, count


def planted():
    """Each of these has to be a problem by itself, and a tree without them none."""
    good = {"LICENSE": "MIT License\n", "a.hpp": f"// {LINE}\n", "b.sh": f"#!/bin/sh\n# {LINE}\n", "build/c.hpp": "", "docs/viewer/node_modules/c.mjs": "",
            "tests/io/seeds/obj/d.sh": "", ".ci/run": f"#!/bin/sh\n# {LINE}\n"}
    bad = {"none": {"include/abut/e.cpp": "int main() {}\n"}, "late": {"f.py": "\n" * LINES + f"# {LINE}\n"},
           "another": {"g.cmake": "# SPDX-License-Identifier: BSL-1.0\n"}, "of a name": {"docs/CMakeLists.txt": "project(a)\n"},
           "hidden": {".clang-format": "BasedOnStyle: Google\n"}, "of the CI": {".ci/run": "#!/bin/sh\n"},
           "of the whole": {"LICENSE": "Boost Software License\n"}}
    unnoticed = []
    for name, files in {"nothing": {}, **bad}.items():
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for file, text in {**good, **files}.items():
                (root / file).parent.mkdir(parents=True, exist_ok=True)
                (root / file).write_text(text, encoding="utf-8")
            if len(problems_of(root)[0]) != (0 if name == "nothing" else 1):
                unnoticed.append(name)
    return unnoticed


def main():
    unnoticed = planted()
    for name in unnoticed:
        print(f"planted, and not noticed: {name}")
    problems, count = problems_of(Path(sys.argv[1]))
    for problem in problems:
        print(problem)
    print(f"{count} source files: {len(problems)} problems, {len(unnoticed)} plants unnoticed")
    return 1 if problems or unnoticed or count < 500 else 0


sys.exit(main())
