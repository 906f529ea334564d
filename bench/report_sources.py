# SPDX-License-Identifier: MIT
"""Values within sentences that nobody measured: they are what the source has, and are read from it."""

import re

from report_core import *  # noqa: F403


def of_source(name, path, pattern, number=int):
    """The value is what a pattern finds in a file; `number` makes one of its groups."""
    def found(results):
        match = re.search(pattern, (ROOT / path).read_text(encoding="utf-8"))
        if match is None:
            raise KeyError(f"{pattern!r} in {path}")
        return whole(number(*match.groups()))
    VALUES[name] = found


def enumerators(name, path, enum):
    """The value is how many names an enumeration has, but for one called `count`."""
    def found(results):
        match = re.search(rf"enum class {enum} : [^{{]*\{{(.*?)\}};", (ROOT / path).read_text(encoding="utf-8"), re.S)
        if match is None:
            raise KeyError(f"enum class {enum} in {path}")
        names = re.findall(r"\w+", re.sub(r"//.*", "", match[1]))
        return whole(len([n for n in names if n != "count"]))
    VALUES[name] = found


enumerators("flat-families", "tests/support/flat_triangles.hpp", "flat_family")
enumerators("solid-families", "tests/support/solid_pairs.hpp", "solid_family")
enumerators("face-families", "tests/support/shared_faces.hpp", "places")
of_source("special-patterns", "tests/predicate/configurations.test.cpp", r"expected\.size\(\) == (\d+) \* (\d+) \+ (\d+)",
          lambda a, b, c: int(a) * int(b) + int(c))
of_source("viewer-tries", "tests/project/viewer/read.test.mjs", r"const tries = (\d+);")
