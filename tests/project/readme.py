#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The program in README.md is docs/examples/first.cpp, and what it prints is what README.md says. Usage: readme.py ROOT PROGRAM"""

import pathlib
import re
import subprocess
import sys

root, program = pathlib.Path(sys.argv[1]), sys.argv[2]
readme = (root / "README.md").read_text(encoding="utf-8")
shown = re.search(r"<!-- (docs/examples/\S+) -->\n```cpp\n(.*?)```\n\n```\n(.*?)```", readme, re.DOTALL)
if shown is None:
    sys.exit("README.md: expected <!-- docs/examples/FILE -->, a cpp block and a block of its output")
path, source, output = shown.groups()
if source != (root / path).read_text(encoding="utf-8"):
    sys.exit(f"README.md: the program is not {path}")
printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
if printed != output:
    sys.exit(f"README.md: says that {path} prints\n{output}but it prints\n{printed}")
print(f"README.md shows {path} and its output")
