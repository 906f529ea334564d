#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Keeps README.md and docs/ true: their links, and the code that they show.

pages.py check ROOT               links and anchors exist; docs/README.md names every page; no block of code is left
                                  untested, and what one declares a later one uses;
                                  scripts, their options, and options and presets of CMake that a page uses are there
pages.py write ROOT KIND OUT PAGE...    writes the blocks of these pages into one source; KIND is cpp or cu
pages.py run ROOT KIND PROGRAM PAGE...  runs that program, and compares what it prints with what the pages say
pages.py commands ROOT PAGE       runs the blocks ```sh of a page, line by line, in a folder where abut is a copy of the sources and
                                  program.cpp and program.cu are the page's first programs; what a line compiles has to print
                                  what the page says. Lines of nvcc are left out where no device is, and that is said

How a block ```cpp is compiled, the HTML comment on the line before it says. Its words, with commas between, are:

  (nothing)        with a function main: a program. Otherwise the body of a function that sees the members of
                   docs/snippets/context.hpp (`on`, `mesh`, ...).
  continues        goes on in the same function as the block before it
  file scope       declarations that all later blocks of the page see
  cuda             for nvcc, in a .cu file; other blocks are compiled by the host's compiler
  a path           also: the block is that file, or a part of it, but for indentation. Blocks ```cmake have to say so.

A block ``` without a language, right after a block of code, is what that code prints. Programs run in a folder of their own,
in which FILES lie.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FILES = {
    "part.obj": "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n",
    "grains.csv": "x,y,z,r\n1,1,0,1\n9,9,9,1\n",
    "drops.csv": "x,y,z\n1,1,0\n",
}
LANGUAGES = {"cpp", "cmake", "sh", "text", ""}
PRINTS_NEXT = "\x1e"


def fail(message):
    sys.exit(f"pages.py: {message}")


class Block:
    def __init__(self, page, line, language, words, text, number):
        self.page, self.line, self.language, self.text, self.number = page, line, language, text, number
        self.paths = [w for w in words if "/" in w]
        self.words = [w for w in words if "/" not in w]
        self.prints = None

    @property
    def where(self):
        return f"{self.page}:{self.line}"

    @property
    def kind(self):
        return "cu" if "cuda" in self.words else "cpp"

    @property
    def is_program(self):
        return re.search(r"^int main\(", self.text, re.MULTILINE) is not None


def blocks_of(root, page):
    """The fenced blocks of a page, indentation taken off."""
    lines = (root / page).read_text(encoding="utf-8").split("\n")
    blocks, at, directive, last_fence = [], 0, None, -1
    while at < len(lines):
        fence = re.fullmatch(r"( *)```(\S*)", lines[at].rstrip())
        if fence is None:
            comment = re.fullmatch(r"<!-- (.*?) -->", lines[at].strip())
            if comment:
                directive = comment[1]
            elif lines[at].strip():
                directive, last_fence = None, -1
            at += 1
            continue
        indent, language = fence.groups()
        first = at + 1
        at = first
        while at < len(lines) and lines[at].strip() != "```":
            at += 1
        if at == len(lines):
            fail(f"{page}:{first}: this block does not end")
        text = "".join(line.removeprefix(indent) + "\n" for line in lines[first:at])
        words = [w.strip() for w in directive.split(",")] if directive else []
        block = Block(page, first + 1, language, words, text, len(blocks))
        if language not in LANGUAGES:
            fail(f"{block.where}: a block of '{language}'; expected one of {sorted(LANGUAGES)}")
        unknown = set(block.words) - {"continues", "file scope", "cuda"}
        if language == "cpp" and unknown:
            fail(f"{block.where}: the comment says {sorted(unknown)}; expected what is at the head of pages.py")
        if language == "":
            if last_fence < 0 or blocks[last_fence].language != "cpp":
                fail(f"{block.where}: a block without a language is what the code right before it prints; "
                     "if it is something else, call it text")
            blocks[last_fence].prints = text
        blocks.append(block)
        last_fence, directive, at = len(blocks) - 1, None, at + 1
    return blocks


def pages_of(root):
    return ["README.md"] + sorted(str(p.relative_to(root)) for p in (root / "docs").rglob("*.md"))


def code_of(root, pages, kind):
    return {page: [b for b in blocks_of(root, page) if b.language == "cpp" and b.kind == kind] for page in pages}


# --- check --------------------------------------------------------------------------------------------------------------


def unindented(text):
    return [line.strip() for line in text.split("\n") if line.strip()]


def check_paths(root, block):
    for path in block.paths:
        source = root / path
        if not source.is_file():
            fail(f"{block.where}: there is no {path}")
        whole, part = unindented(source.read_text(encoding="utf-8")), unindented(block.text)
        if not any(whole[i:i + len(part)] == part for i in range(len(whole))):
            fail(f"{block.where}: this is no part of {path}")


def without_code(text):
    text = re.sub(r"^ *```.*?^ *```", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"(`+).+?\1", lambda m: m[0].replace("[", " "), text)


def anchors_of(root, page):
    """As GitHub makes them of headings."""
    anchors, seen = set(), {}
    text = re.sub(r"^ *```.*?^ *```", "", (root / page).read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    for heading in re.findall(r"^#+ (.*?)\s*$", text, re.MULTILINE):
        heading = re.sub(r"\[(.*?)\]\(.*?\)", r"\1", heading).replace("`", "")
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        anchors.add(f"{slug}-{count}" if count else slug)
    return anchors | set(re.findall(r"<a (?:id|name)=\"(.*?)\"", text))


def commands_in(root, page):
    """What a page says to type: lines of its blocks ```sh, and code within sentences."""
    for block in blocks_of(root, page):
        if block.language == "sh":
            yield from block.text.replace("\\\n", " ").splitlines()
    text = re.sub(r"^ *```.*?^ *```", "", (root / page).read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    yield from (" ".join(code.split()) for code in re.findall(r"`([^`]+)`", text))


def wrong_commands(root, page):
    """Scripts, and options of them and of CMake, that are not there. A script has the options that its first comment names."""
    presets = root / "CMakePresets.json"
    presets = set(re.findall(r'"name": "(.*?)"', presets.read_text(encoding="utf-8"))) if presets.exists() else set()
    lists = "".join(path.read_text(encoding="utf-8") for where in ("", "cmake/", "tests/", "bench/", "docs/examples/")
                    for path in sorted(root.glob(f"{where}CMakeLists.txt")) + sorted(root.glob(f"{where}*.cmake")))
    for line in commands_in(root, page):
        line = line.split("#")[0]
        for script, rest in re.findall(r"(?<![\w.])sh ((?:cmake|docs)/[\w./-]+)([^|&;]*)", line):
            path = root / script
            if not path.is_file():
                yield f"there is no {script}"
                continue
            text = path.read_text(encoding="utf-8")
            usage = "".join(re.findall(r"^#.*\n", text.partition("\nset ")[0] + "\n", re.MULTILINE))
            for option in re.findall(r"(?<!\S)--?[a-z][\w-]*", rest):
                if not re.search(rf"(?<![\w-]){option}(?![\w-])", text if option == "--help" else usage):
                    yield f"{script} does not say that it has {option}"
        if re.search(r"(?:^|&& *|; *)(?:cmake|ctest) ", line):
            for option in re.findall(r"-D(ABUT_\w+)", line):
                if not re.search(rf"\b{option}\b", lists):
                    yield f"CMake has no option {option}"
            for preset in set(re.findall(r"--preset[ =]([\w-]+)", line)) - presets:
                yield f"CMakePresets.json has no {preset}"


def unused(root, page):
    """Blocks of declarations that nothing runs: no later block uses what they declare, and they assert nothing."""
    blocks = [b for b in blocks_of(root, page) if b.language == "cpp"]
    for block in blocks:
        if "file scope" not in block.words or "static_assert(" in block.text:
            continue
        names = re.findall(r"^(?:struct|class) (\w+)|^(?!struct|class)\w[^(\n]*?(\w+)\(", block.text, re.MULTILINE)
        later = "".join(b.text for b in blocks
                        if b.number > block.number and b.kind == block.kind and "file scope" not in b.words)
        if not any(re.search(rf"\b{a or b}\b", later) for a, b in names):
            yield f"{block.where}: no later block uses what this one declares"


def check(root):
    links = blocks = 0
    broken = []
    for page in pages_of(root):
        for block in blocks_of(root, page):
            check_paths(root, block)
            if block.language == "cmake" and not block.paths:
                broken.append(f"{block.where}: no file is named that a test builds with these lines")
            blocks += block.language == "cpp"
        broken += [f"{page}: {problem}" for problem in wrong_commands(root, page)]
        broken += unused(root, page)
        text = without_code((root / page).read_text(encoding="utf-8"))
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            if re.match(r"[a-z]+:", target):
                continue
            links += 1
            path, _, anchor = target.partition("#")
            file = ((root / page).parent / path).resolve() if path else root / page
            if not file.exists():
                broken.append(f"{page}: there is no {target}")
            elif anchor and anchor not in anchors_of(root, file.relative_to(root.resolve()) if path else page):
                broken.append(f"{page}: {path or page} has no heading #{anchor}")
    index = (root / "docs/README.md").read_text(encoding="utf-8")
    for page in pages_of(root):
        name = page.removeprefix("docs/")
        if page.startswith("docs/") and name != "README.md" and f"]({name}" not in index:
            broken.append(f"docs/README.md: does not name {page}")
    if broken:
        fail("\n".join(broken))
    if not links or not blocks:
        fail("expected links and code")
    print(f"{len(pages_of(root))} pages, {links} links, {blocks} blocks of code")


# --- write --------------------------------------------------------------------------------------------------------------


def write(root, kind, out, pages):
    includes, body, calls = [], [], []
    for page, blocks in code_of(root, pages, kind).items():
        space = re.sub(r"\W", "_", page)
        body.append(f"namespace {space} {{")
        open_function = False
        for block in blocks:
            lines = block.text.split("\n")
            includes += [line for line in lines if line.startswith("#include")]
            code = "\n".join("" if line.startswith("#include") else line for line in lines)
            name = f"block_{block.number}"
            if open_function and "continues" not in block.words:
                body.append("} };")
                open_function = False
            start = f'#line {block.line} "{page}"'
            mark = f"manual::mark({block.number});"
            if "file scope" in block.words:
                body += [start, code]
            elif "continues" in block.words:
                if not open_function:
                    fail(f"{block.where}: continues what?")
                body += [mark, start, code]
            elif block.is_program:
                end = code.rindex("}")
                code = re.sub(r"^int main\(", "int program(", code[:end] + "return 0;\n}", flags=re.MULTILINE)
                body += [f"namespace {name} {{", start, code, "}"]
                calls += [mark, f"if ({space}::{name}::program() != 0) return 1;"]
            else:
                body += [f"struct {name} : manual::context {{ void run() {{", mark, start, code]
                calls += [f"{space}::{name}().run();"]
                open_function = True
        if open_function:
            body.append("} };")
        body.append(f"}}  // namespace {space}")
    seen = dict.fromkeys(includes)
    text = ['#include "context.hpp"', *seen, *body, "int main() {", "if (!manual::can_run()) return 0;"]
    text += [*calls, "}", ""]
    pathlib.Path(out).write_text("\n".join(text), encoding="utf-8")


# --- run ----------------------------------------------------------------------------------------------------------------


def run(root, kind, program, pages):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in FILES.items():
            (pathlib.Path(folder) / name).write_text(text, encoding="utf-8")
        done = subprocess.run([pathlib.Path(program).resolve()], capture_output=True, text=True, cwd=folder)
    printed = iter(done.stdout.split(PRINTS_NEXT))
    before = next(printed)
    if before.startswith("abut skips: "):
        print(before)
        return
    compared, wrong = 0, []
    for page, blocks in code_of(root, pages, kind).items():
        for block in blocks:
            if "file scope" in block.words:
                continue
            number, _, text = next(printed, "").partition("\n")
            if number != str(block.number):
                fail(f"{block.where}: this was not run; the program ended with {done.returncode}\n{done.stderr}")
            if block.prints is not None:
                compared += 1
                if text != block.prints:
                    wrong.append(f"{block.where}: the page says that it prints\n{block.prints}but it prints\n{text}")
            elif text:
                wrong.append(f"{block.where}: it prints what the page does not show\n{text}")
    if wrong:
        fail("\n".join(wrong))
    if done.returncode != 0:
        fail(f"the program ended with {done.returncode}\n{done.stderr}")
    print(f"{compared} blocks print what the pages say")


# --- commands -----------------------------------------------------------------------------------------------------------


def has_device():
    if shutil.which("nvcc") is None or shutil.which("nvidia-smi") is None:
        return False
    return subprocess.run(["nvidia-smi", "-L"], capture_output=True, text=True).stdout.startswith("GPU ")


def commands(root, page):
    blocks = blocks_of(root, page)
    programs = {b.kind: b for b in reversed(blocks) if b.language == "cpp" and b.is_program}
    lines = [(b, line) for b in blocks if b.language == "sh" for line in b.text.replace("\\\n", " ").splitlines()]
    count = compared = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "abut").mkdir()
        for name in ("CMakeLists.txt", "LICENSE", "README.md"):
            if (root / name).exists():
                shutil.copy(root / name, folder / "abut")
        for name in ("cmake", "include"):
            if (root / name).exists():
                shutil.copytree(root / name, folder / "abut" / name)
        for kind, block in programs.items():
            (folder / f"program.{kind}").write_text(block.text, encoding="utf-8")
        (folder / "home").mkdir()
        environment = {**os.environ, "HOME": str(folder / "home")}
        for block, line in lines:
            if line.startswith("nvcc ") and not has_device():
                print(f"{block.where}: left out, since no device is here: {line}")
                continue
            done = subprocess.run(["sh", "-eu", "-c", line], capture_output=True, text=True, cwd=folder, env=environment)
            if done.returncode != 0:
                fail(f"{block.where}: this ended with {done.returncode}: {line}\n{done.stdout}{done.stderr}")
            count += 1
            compiled = re.search(r"program\.(cpp|cu) .*-o (\S+)", line)
            if compiled is None:
                continue
            said = subprocess.run([folder / compiled[2]], capture_output=True, text=True, cwd=folder).stdout
            expected = programs[compiled[1]].prints
            if said != expected:
                fail(f"{programs[compiled[1]].where}: the page says that it prints\n{expected}but it prints\n{said}")
            compared += 1
        if "--prefix" in "".join(line for _, line in lines) and not list(folder.glob("home/**/abut-config.cmake")):
            fail(f"{page}: nothing was installed where the page says")
    if not count or not compared:
        fail(f"{page}: expected commands, and one that compiles a program")
    print(f"{page}: commands that ran: {count}, of which compiled a program that prints what the page says: {compared}")


def main():
    command, root = sys.argv[1], pathlib.Path(sys.argv[2])
    if command == "check":
        check(root)
    elif command == "write":
        write(root, sys.argv[3], sys.argv[4], sys.argv[5:])
    elif command == "run":
        run(root, sys.argv[3], sys.argv[4], sys.argv[5:])
    elif command == "commands":
        commands(root, sys.argv[3])
    else:
        fail(f"unknown command {command}")


main()
