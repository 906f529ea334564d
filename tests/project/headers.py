#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles each header alone, and twice, which tests its guard: in chains, so that the compiler starts once for several.

usage: headers.py PART PARTS INCLUDE_DIR LIST COMPILER ARGUMENT...   the chains PART, PART + PARTS, ... of the headers in LIST
       headers.py flaws COMPILER ARGUMENT...                        headers made on purpose: those that are wrong are noticed

LIST has a header a line, abut/..., and after it what it needs of the compiler beyond ARGUMENTs, with tabs between.

A source that includes `low`, and then `high`, tests both alone if `high` includes `low` above all that it declares. For `low`
comes first, and `high` sees of other headers what it would see alone: all that it includes, `low` among that. A chain is a list of
headers in which each is so included, directly or not, by the next. The fewest chains that hold all headers are a matching in a
graph of two parts (Fulkerson 1956). The headers of a chain need the same of the compiler.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

INCLUDE = re.compile(r"#\s*include\s*<(abut/[^>]+)>")


def included_above(file):
    """What of ours a header includes in any case, and before its first line that is neither comment nor directive."""
    names, depth, comment = set(), 0, False
    for line in file.read_text(encoding="utf-8").splitlines():
        line = line.strip()
        comment = comment or line.startswith("/*")
        if comment:
            comment = "*/" not in line
            continue
        found = INCLUDE.match(line)
        if re.match(r"#\s*if", line):
            depth += 1
        elif re.match(r"#\s*endif", line):
            depth -= 1
        elif found and depth == 0:
            names.add(found.group(1))
        elif depth == 0 and line and not line.startswith(("#", "//")):
            break
    return names


def closures(root, headers):
    """For each header those of `headers` that it includes, directly or not."""
    below = {}

    def visit(name):
        if name not in below:
            below[name] = set()  # a header that includes itself is another test's business
            for other in sorted(included_above(root / name)):
                if (root / other).is_file():
                    below[name] |= {other} | visit(other)
        return below[name]

    return {name: visit(name) & headers.keys() for name in headers}


def chains_of(root, headers):
    below = closures(root, headers)
    above = {}  # of a header, the one after it in its chain

    def place(high, tried):
        """Gives `high` a header before it, for which others may have to take another one."""
        for low in sorted(below[high], key=lambda name: (-len(below[name]), name)):
            if low in tried or headers[low] != headers[high]:
                continue
            tried.add(low)
            if low not in above or place(above[low], tried):
                above[low] = high
                return True
        return False

    for high in sorted(headers):
        place(high, set())
    before = {high: low for low, high in above.items()}
    chains = []
    for last in sorted(headers.keys() - above.keys()):
        chain = [last]
        while chain[0] in before:
            chain.insert(0, before[chain[0]])
        chains.append(chain)
    return chains


def compiles(root, names, command, show):
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "headers.cpp"
        source.write_text("".join(2 * f"#include <{name}>\n" for name in names), encoding="utf-8")
        done = subprocess.run([*command, f"-I{root}", source], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode and show:
        print(done.stdout)
    return done.returncode == 0


def wrong_of(root, headers, chains, command, show=True):
    """The headers that do not compile alone."""
    wrong = []
    for chain in chains:
        command_here = [*command, *headers[chain[0]]]
        if compiles(root, chain, command_here, False):
            continue
        alone = [name for name in chain if not compiles(root, [name], command_here, show)]
        wrong += alone or [" with ".join(chain)]
    return wrong


def read_list(file):
    words = [line.split("\t") for line in Path(file).read_text(encoding="utf-8").splitlines() if line]
    return {line[0]: line[1:] for line in words}


LOW = "#pragma once\n#include <cstddef>\nnamespace abut { inline std::size_t low() { return 1; } }\n"
HIGH = "#pragma once\n#include <abut/low.hpp>\nnamespace abut { inline std::size_t high() { return low(); } }\n"
FLAWED = {
    "no guard": "#include <abut/low.hpp>\nnamespace abut { inline std::size_t twice() { return low(); } }\n",
    "nothing included": "#pragma once\nnamespace abut { inline auto beside() { return low(); } }\n",
    "included late": "#pragma once\nnamespace abut { inline auto late() { return low(); } }\n#include <abut/low.hpp>\n",
    "included perhaps": "#pragma once\n#if 0\n#include <abut/low.hpp>\n#endif\nnamespace abut { inline auto none() { return low(); } }\n",
    "another's": "#pragma once\n#include <abut/low.hpp>\nnamespace abut { inline std::vector<int> numbers() { return {}; } }\n",
}


def flaws(command):
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "abut").mkdir()
        headers = {"abut/low.hpp": [], "abut/other.hpp": []}
        for flaw, text in [("none", HIGH), *FLAWED.items()]:
            (root / "abut/low.hpp").write_text(LOW, encoding="utf-8")
            (root / "abut/other.hpp").write_text(text, encoding="utf-8")
            chains = chains_of(root, headers)
            wrong = wrong_of(root, headers, chains, command, False)
            is_right = chains == [list(headers)] and not wrong if flaw == "none" else wrong == ["abut/other.hpp"]
            print(f"flaw: {flaw}: wrong {wrong} in chains {chains}: {'as expected' if is_right else 'NOT as expected'}")
            failed += not is_right
    return 1 if failed else 0


def main():
    if sys.argv[1] == "flaws":
        return flaws(sys.argv[2:])
    part, parts, root, headers = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]), read_list(sys.argv[4])
    chains = chains_of(root, headers)
    chosen = chains[part - 1::parts]
    wrong = wrong_of(root, headers, chosen, sys.argv[5:])
    for name in wrong:
        print(f"{name}: does not compile alone")
    print(f"{sum(map(len, chosen))} of {len(headers)} headers in {len(chosen)} of {len(chains)} chains: {len(wrong)} wrong")
    return 1 if wrong or not chosen else 0


if __name__ == "__main__":
    sys.exit(main())
