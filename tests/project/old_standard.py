# SPDX-License-Identifier: MIT
"""Compiles each header alone as C++17: the first error says what is needed, and nothing else follows but the stop.

usage: old_standard.py INCLUDE_DIR COMPILER
"""

import subprocess
import sys
from pathlib import Path

MESSAGE = "abut needs C++20 or newer: compile with -std=c++20"
# What holds no C++20 of its own, and what includes other libraries' headers first.
LEFT_OUT = {"abut/arithmetic/strict.hpp", "abut/error.hpp", "abut/collide/pair_rule.hpp", "abut/execution/schedule.hpp",
            "abut/traverse/traversal.hpp", "abut/io/error.hpp"}


def main():
    root, compiler = Path(sys.argv[1]), sys.argv[2]
    problems, looked_at = [], 0
    for file in sorted((root / "abut").rglob("*.hpp")):
        name = file.relative_to(root).as_posix()
        if name in LEFT_OUT or name.startswith(("abut/execution/cuda", "abut/experimental/cuda", "abut/io/obj", "abut/io/read")):
            continue
        done = subprocess.run([compiler, "-std=c++17", "-fsyntax-only", f"-I{root}", "-x", "c++", "-"],
                              input=f"#include <{name}>\nabut::mesh<float> m;\n", capture_output=True, text=True)
        errors = [line for line in done.stderr.splitlines() if "error: " in line]
        looked_at += 1
        if done.returncode == 0 or not errors or MESSAGE not in errors[0] or len(errors) > 2:
            problems.append(f"{name}: {len(errors)} errors, the first: {errors[0] if errors else 'none'}")
    for line in problems:
        print(line)
    print(f"{looked_at} headers as C++17: {len(problems)} problems")
    return 1 if problems or looked_at == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
