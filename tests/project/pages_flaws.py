#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pages.py notices what is wrong with a page. Usage: pages_flaws.py"""

import pathlib
import subprocess
import sys
import tempfile

PAGES = pathlib.Path(__file__).with_name("pages.py")
GOOD = """# Title

See [here](#title) and [there](docs/README.md#title).

```cpp
std::printf("1");
```

```
1
```

`sh cmake/do.sh --fast` does it, or:

```sh
sh cmake/do.sh --fast part.obj  # not --slow
sh cmake/do.sh --help
cmake --preset quick -DABUT_HERE=ON && ctest --preset quick
```
"""
SCRIPT = "#!/bin/sh\n# usage: sh cmake/do.sh [--fast] FILE\nset -eu\ncase $1 in --help | --slow) ;; esac\n"
CHECKED = {
    "a link to no file": ("docs/README.md#title", "docs/none.md", "there is no docs/none.md"),
    "a link to no heading": ("(#title)", "(#titel)", "has no heading #titel"),
    "code in a block of another name": ("```cpp", "```c++", "a block of 'c++'"),
    "code in a block without a name": ("```cpp", "```", "a block without a language"),
    "a comment that says nothing known": ("```cpp", "<!-- continued -->\n```cpp", "the comment says"),
    "a file that is not there": ("```cpp", "<!-- docs/none.cpp -->\n```cpp", "there is no docs/none.cpp"),
    "a file that holds something else": ("```cpp", "<!-- docs/README.md -->\n```cpp", "no part of docs/README.md"),
    "lines for CMake of no file": ("```cpp", "```cmake\n```\n\n```cpp", "no file is named"),
    "a script that is not there": ("sh cmake/do.sh --help", "sh cmake/did.sh", "there is no cmake/did.sh"),
    "a script that is not there, in a sentence": ("`sh cmake/do.sh", "`sh cmake/did.sh", "there is no cmake/did.sh"),
    "an option that a script does not name": ("--fast part.obj", "--slow part.obj", "does not say that it has --slow"),
    "a part of an option": ("do.sh --fast` does", "do.sh --fas` does", "does not say that it has --fas"),
    "an option that CMake does not have": ("ABUT_HERE", "ABUT_HER", "CMake has no option ABUT_HER"),
    "a preset that is not there": ("ctest --preset quick", "ctest --preset quack", "has no quack"),
    "code that no block runs": ("```cpp", "<!-- file scope -->\n```cpp\nint f() {}\n```\n\n```cpp", "no later block uses"),
    "a block without an end": ("ctest --preset quick\n```\n", "ctest --preset quick\n", "does not end"),
}
MARK = "\\036%d\\n"  # as docs/snippets/context.hpp prints it
RUN = {
    "nothing": (f"printf '{MARK}1\\n' 0", None),
    "another result": (f"printf '{MARK}2\\n' 0", "the page says that it prints"),
    "a block that was not run": ("true", "this was not run"),
    "a crash after the last block": (f"printf '{MARK}1\\n' 0; exit 3", "ended with 3"),
}
# A page whose commands are run.
ASKS = """```sh
g++ -I abut/include program.cpp -o program
```

```cpp
#include <cstdio>

int main() {
    std::printf("1\\n");
}
```

```
1
```

```sh
mkdir "$HOME/there"
```
"""
COMMANDS = {
    "a command that fails": ('mkdir "$HOME/there"', "mkdir none/there", "this ended with 1: mkdir none/there"),
    "a program that cannot be compiled": ("<cstdio>", "<cstdoi>", "this ended with 1: g++"),
    "a program that prints something else": ("\n1\n", "\n2\n", "the page says that it prints"),
    "a folder for what is installed": ("mkdir", "true --prefix", "nothing was installed"),
    "no command": ("```sh", "```text", "expected commands"),
}


def pages(root, *arguments):
    done = subprocess.run([sys.executable, "-B", PAGES, arguments[0], root, *arguments[1:]], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def expect(what, outcome, message):
    status, said = outcome
    if (status == 0) != (message is None) or (message or "") not in said:
        sys.exit(f"{what}: expected {'success' if message is None else message}, found {status}: {said}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs").mkdir()
        (root / "docs/README.md").write_text("# Title\n", encoding="utf-8")
        (root / "cmake").mkdir()
        (root / "cmake/do.sh").write_text(SCRIPT, encoding="utf-8")
        (root / "CMakeLists.txt").write_text('option(ABUT_HERE "" ON)\n', encoding="utf-8")
        (root / "CMakePresets.json").write_text('{"name": "quick"}\n', encoding="utf-8")
        page = root / "README.md"
        page.write_text(GOOD, encoding="utf-8")
        expect("nothing", pages(root, "check"), None)
        for what, (right, wrong, message) in CHECKED.items():
            page.write_text(GOOD.replace(right, wrong, 1), encoding="utf-8")
            expect(what, pages(root, "check"), message)
        (root / "docs/more.md").write_text("# More\n", encoding="utf-8")
        page.write_text(GOOD, encoding="utf-8")
        expect("a page that the index does not name", pages(root, "check"), "does not name docs/more.md")
        program = root / "program"
        for what, (script, message) in RUN.items():
            program.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
            program.chmod(0o755)
            expect(what, pages(root, "run", "cpp", program, "README.md"), message)
        page.write_text(ASKS, encoding="utf-8")
        expect("nothing in commands", pages(root, "commands", "README.md"), None)
        for what, (right, wrong, message) in COMMANDS.items():
            page.write_text(ASKS.replace(right, wrong), encoding="utf-8")
            expect(what, pages(root, "commands", "README.md"), message)
    print(f"{len(CHECKED) + len(RUN) + len(COMMANDS)} flaws are noticed")


main()
