#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that what names the version of abut names that of config.hpp, and that recipes of package managers name what there is.

usage: packaging.py ROOT

Before it reads the real tree, it spoils copies of these files, and fails if one of that goes unnoticed.
"""

import json
import re
import shutil
import sys
import tempfile
from pathlib import Path

CONFIG = "include/abut/config.hpp"
RECIPES = "cmake/packaging"
# Where the version stands, and the date that goes with it.
NAMED = {
    "docs/CHANGELOG.md": r"^## \[(\d[^\]]*)\] - (\d{4}-\d\d-\d\d)$",
    "docs/CITATION.cff": r"^version: (\S+)\ndate-released: \"(\S+)\"$",
    f"{RECIPES}/vcpkg/abut/vcpkg.json": r"^  \"version\": \"([^\"]*)\"",
    f"{RECIPES}/conan/conanfile.py": r"^    version = \"([^\"]*)\"",
    f"{RECIPES}/spack/spack_repo/abut/packages/abut/package.py": r"^    version\(\"(\d[^\"]*)\", tag=\"v\1\"\)",
}
SHORT = {"docs/building.md": r"`find_package\(abut (\d+\.\d+) REQUIRED\)`"}


def problems_of(root):
    problems, dates = [], {}
    config = (root / CONFIG).read_text(encoding="utf-8")
    version = ".".join(re.search(rf"#define ABUT_VERSION_{part} (\d+)", config)[1] for part in ("MAJOR", "MINOR", "PATCH"))
    for name, pattern in NAMED.items():
        found = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.MULTILINE)
        if found is None or found[1] != version:
            problems.append(f"{name}: names {found[1] if found else 'no version'}, and {CONFIG} is {version}")
        elif found.re.groups == 2:
            dates[name] = found[2]
    if len(set(dates.values())) > 1:
        problems.append(f"dates of {version} differ: {dates}")
    for name, pattern in SHORT.items():
        for short in re.findall(pattern, (root / name).read_text(encoding="utf-8")):
            if short != version.rsplit(".", 1)[0]:
                problems.append(f"{name}: asks for version {short}, and {CONFIG} is {version}")

    # Options of CMake that recipes set are options that there are; a wrong name would be passed over.
    options = set(re.findall(r"^(?:option|set)\((ABUT_\w+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"), re.MULTILINE))
    for path in sorted((root / RECIPES).rglob("*")):
        if path.name in ("portfile.cmake", "conanfile.py", "package.py"):
            text = path.read_text(encoding="utf-8")
            for option in sorted(set(re.findall(r"(?:-D|\b)(ABUT_\w+)", text)) - options):
                problems.append(f"{path.relative_to(root)}: CMakeLists.txt has no option {option}")
            if path.suffix == ".py":
                try:
                    compile(text, str(path), "exec")
                except SyntaxError as error:
                    problems.append(f"{path.relative_to(root)}: {error}")
        elif path.suffix == ".json":
            try:
                json.loads(path.read_text(encoding="utf-8"))
            except ValueError as error:
                problems.append(f"{path.relative_to(root)}: {error}")
    return problems, version


SPOILED = [
    (CONFIG, "#define ABUT_VERSION_PATCH ", "#define ABUT_VERSION_PATCH 9"),
    ("docs/CITATION.cff", "date-released: \"20", "date-released: \"19"),
    ("docs/CHANGELOG.md", "\n## [0.2.0]", "\n## [9.2.0]"),
    ("docs/building.md", "`find_package(abut 0.", "`find_package(abut 9."),
    (f"{RECIPES}/vcpkg/abut/vcpkg.json", "\"license\": ", "\"license\" "),
    (f"{RECIPES}/vcpkg/abut/portfile.cmake", "-DABUT_TESTS", "-DABUT_TEST"),
    (f"{RECIPES}/conan/conanfile.py", "    def build(self):", "    def build(self)"),
    (f"{RECIPES}/spack/spack_repo/abut/packages/abut/package.py", "tag=\"v", "tag=\"w"),
]


def unnoticed(root):
    missed = []
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, old, new) in enumerate(SPOILED):
            copy = Path(folder) / str(number)
            for file in {CONFIG, "CMakeLists.txt", *NAMED, *SHORT}:
                (copy / file).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(root / file, copy / file)
            shutil.copytree(root / RECIPES, copy / RECIPES, dirs_exist_ok=True)
            text = (copy / name).read_text(encoding="utf-8")
            if old not in text:
                missed.append(f"{name} has nothing to spoil: {old!r}")
                continue
            (copy / name).write_text(text.replace(old, new, 1), encoding="utf-8")
            if not problems_of(copy)[0]:
                missed.append(f"{name} with {new!r} for {old!r}")
    return missed


def main():
    root = Path(sys.argv[1])
    problems, version = problems_of(root)
    missed = unnoticed(root)
    for problem in problems:
        print(problem)
    for each in missed:
        print(f"planted, and not noticed: {each}")
    print(f"version {version}: {len(problems)} problems, {len(missed)} plants unnoticed")
    return 1 if problems or missed else 0


sys.exit(main())
