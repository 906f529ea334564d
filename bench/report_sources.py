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


of_source("special-patterns", "tests/predicate/configurations.test.cpp", r"expected\.size\(\) == (\d+) \* (\d+) \+ (\d+)",
          lambda a, b, c: int(a) * int(b) + int(c))
of_source("viewer-tries", "tests/project/viewer/read.test.mjs", r"const tries = (\d+);")
