# SPDX-License-Identifier: MIT
"""Writes the figures of README.md and the pages below docs from bench/results/*/*.json, and checks that they are the ones.

usage: report.py [--check]                  compares the pages with the results; fails where they differ
       report.py --write                    writes the pages and docs/figures
       report.py --take FOLDER [--write]    first takes the files FOLDER/cpu/NAME.json and FOLDER/cuda/NAME.json that benchmarks left
       report.py --stale                    lists results of programs whose sources have changed since, by git
       report.py --page OUT.md FOLDER       writes a page of its own, with plots beside it, from such a folder alone

In a page, lines between `<!-- NAME: begin -->` and `<!-- NAME: end -->` are a table of bench/report_*.py, and what is
between `<!-- v: NAME -->` and `<!-- /v -->` is a value. A table of figures that stands elsewhere is an error, unless it is of
constants, which no program measures: then the line `<!-- constants -->` is before it. A number in a sentence that reads like
a measurement (a time, a rate, a share, so many of so many, about so many, bytes, so many times faster, so many families) is an
error as well, unless nobody measured it: a bound, a setting, a size by design or an assumption has `<!-- stated -->` in its
line. cmake/report.sh runs the benchmarks. Pages of docs/results that tests write whole (tests/support/stages.hpp) end with a
checksum instead.
"""

import argparse
import json
import os
import re
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import report_tables  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"<!-- (?P<name>[\w-]+): begin -->\n(?P<text>.*?)<!-- (?P=name): end -->\n", re.S)
VALUE = re.compile(r"<!-- v: (?P<name>[\w-]+) -->(?P<text>.*?)<!-- /v -->", re.S)
CODE = re.compile(r"^ *```.*?^ *```$", re.S | re.M)
CONSTANTS = re.compile(r"^<!-- constants -->\n(?:\|.*\n)+", re.M)
STATED = "<!-- stated -->"
CHECKSUM = re.compile(r"\n<!-- checksum: ([0-9a-f]{16}) -->\n\Z")
MARK = re.compile(r"<!-- (?:[\w-]+: (?:begin|end)|v: [\w-]+|/v) -->")

# What reads like a measurement. Spaces stand for any white space.
NUMBER = r"(?:\d[\d.,^]*|half|third|quarters?|fifth|tenths?|hundredth|twice|two|three|four|five|six|seven|eight|nine|ten|" \
    r"eleven|twelve|(?:thir|four|fif|six|seven|eigh|nine)teen|(?:twen|thir|for|fif|six|seven|eigh|nine)ty(?:-[a-z]+)?|" \
    r"dozen|hundreds?|thousands?|few|some)"
UNIT = r"(?:[num]s|[\u00b5\u03bc]s|s|(?:nano|micro|milli)?seconds?|minutes?|hours?|cycles|%|per cent|[kMGT]i?B/s|" \
    r"(?:\w+ )?(?:a|per) second|\w*/s)"
MEMORY = r"(?:(?:kilo|mega|giga)?bytes?(?! order)|B|[kMGT]i?B)"
MEASURED = re.compile("|".join((
    rf"\b{NUMBER}(?: |(?<=\d))(?:to {NUMBER} |or {NUMBER} )?"
    rf"(?:(?:an? )?(?:hundred|thousand|million|billion) )?(?:of )?(?:an? )?{UNIT}(?!\w)",
    rf"\b{NUMBER}(?<=\w)(?: |(?<=\d)){MEMORY}(?!\w)",
    r"\b\d[\d,.]* of (?:the |all )?\d",
    r"\b\d[\d.]*e-?\d+ of ",
    r"\ba few (?:tenths|hundredths|thousandths)",
    r"\babout \d[\d,.]*(?![\d^e])",
    rf"(?i:\b{NUMBER} families\b)",
    rf"\b{NUMBER} times (?:as (?:fast|slow|quick|long|much time)|faster|slower|quicker|longer|the (?:time|speed))",
    rf"\b{NUMBER} of the (?:time|speed|cost)\b",
    r"\b(?:twice|half) (?:as (?:fast|slow|quick|long)|the (?:time|speed)|that of)",
)).replace(" ", r"\s+"))


# Results that nobody has committed yet, though cmake/report.sh has a row for them; and those that come without one: of
# bench/footprint.py, bench/report_cuda_tests.py and bench/report_runs.py.
NOT_MEASURED = set()
WITHOUT_ROW = {"cpu/footprint_build", "cuda/predicates", "cuda/predicates_spheres", "cuda/tests", "tests/runs"}


class Missing(Exception):
    """A table asks for results that are not there."""

    def __init__(self, name):
        super().__init__(f"there are no results {name}")
        self.name = name


class Results:
    """Rows by name, each a dict of `ms` and counters; `context` says of which machine, compiler and commit."""

    def __init__(self, source, data):
        self.source, self.context, self.rows = source, data["context"], data["rows"]

    def get(self, name, key="ms"):
        return self.rows.get(name, {}).get(key)

    def names(self, start):
        return [name for name in self.rows if name.startswith(start)]

    def parts(self, start, position):
        """What stands at a position of the names that start so, in the order of the program."""
        return list(dict.fromkeys(name.split("/")[position] for name in self.names(start)))


class Folder:
    """results["cpu/triangles"] are those of FOLDER/cpu/triangles.json."""

    def __init__(self, path):
        self.path, self.known, self.asked = Path(path), {}, 0

    def __contains__(self, name):
        return (self.path / f"{name}.json").exists()

    def __getitem__(self, name):
        self.asked += 1
        if name not in self.known:
            if name not in self:
                raise Missing(name)
            self.known[name] = Results(name, read(self.path / f"{name}.json"))
        return self.known[name]


def rounded(value):
    """Numbers as they are kept: whole ones as they are, others with five digits."""
    if not isinstance(value, float) or value.is_integer():
        return int(value) if isinstance(value, float) and abs(value) < 2**53 else value
    return float(f"{value:.5g}")


def read(path):
    """Results in the form of bench/results.hpp, also of a file of Google Benchmark: its medians and counters. One thread is
    measured by its processor time, which other jobs of the machine disturb less; threads, and what is to be disturbed, by the clock;
    a model by what it says itself."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        context = data["context"]
        if "rows" in data:
            rows = data["rows"]
        else:
            rows = {}
            # Interleaved runs come in any order; family_index is the order in which the program lists them.
            for row in sorted(data["benchmarks"], key=lambda r: r.get("family_index", 0)):
                if row.get("error_occurred") or row.get("aggregate_name", "median") != "median":
                    continue
                name = re.split(r"/(?:iterations|min_time|repeats|real_time)\b", row["run_name"])[0]
                clock = "real_time" if re.search("openmp|/busy$|/modelled/", name) else "cpu_time"
                values = {"ms": row[clock] * {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[row["time_unit"]]}
                known = {"cpu_time", "real_time", "threads", "iterations", "repetitions", "family_index", "repetition_index",
                         "per_family_instance_index"}
                values.update({k: v for k, v in row.items() if isinstance(v, (int, float)) and k not in known})
                rows[name] = values
            kept = ("program", "machine", "cores", "threads", "compiler", "flags", "commit", "date", "mesh", "peers")
            context = {k: context[k][:10] if k == "date" else context[k] for k in kept if k in context}
        rows = {name: {k: rounded(float(v)) for k, v in row.items()} for name, row in rows.items()}
        return {"context": context, "rows": rows}
    except (OSError, ValueError, KeyError, TypeError) as problem:
        sys.exit(f"{path}: not the results of a finished run: {problem!r}")


def undated(context):
    return any(context.get(key, "unknown") == "unknown" for key in ("commit", "date"))


def take(folder, into):
    """Brings what benchmarks left to where it is committed, small; nothing if some do not say of which commit they are."""
    found = sorted(p for kind in ("cpu", "cuda") for p in (folder / kind).glob("*.json"))
    if not found:
        sys.exit(f"{folder}: expected files cpu/NAME.json or cuda/NAME.json")
    if nameless := [str(path) for path in found if undated(read(path)["context"])]:
        sys.exit(f"{', '.join(nameless)}: of an unknown commit or date, not taken; programs find the commit in ABUT_COMMIT")
    for path in found:
        data = read(path)
        to = into / path.parent.name / path.name
        to.parent.mkdir(parents=True, exist_ok=True)
        lines = ",\n".join(f"  {json.dumps(name)}: {json.dumps(row)}" for name, row in data["rows"].items())
        to.write_text(f'{{"context": {json.dumps(data["context"])},\n "rows": {{\n{lines}\n}}}}\n', encoding="utf-8")
        print(f"results of {data['context'].get('program', path.stem)}: {to}")


def results_pages():
    """The pages of docs/results, in two lists: those that tests write whole, which name them, and the others."""
    tests = "".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / "tests" / "predicate").glob("*.cpp")))
    of_tests, others = [], []
    for path in sorted((ROOT / "docs" / "results").glob("*.md")):
        (of_tests if f'"{path.name}"' in tests else others).append(path)
    return of_tests, others


def pages():
    """All pages but those that tests write whole."""
    return [ROOT / "README.md"] + sorted(set((ROOT / "docs").rglob("*.md")) - set(results_pages()[0]))


def linked_from(text, folder):
    """What a program wrote for a page of docs, with its links as a page of another folder has to write them."""
    def link(match):
        return f"]({os.path.relpath(ROOT / 'docs' / match[1], folder)}"

    return text if folder == ROOT / "docs" else re.sub(r"\]\((?![a-z]+:|#)([^)#\s]+)", link, text)


def as_written(text):
    """Whether a page is as a test wrote it: its last line has the checksum of all others, FNV-1a of 64 bits."""
    match = CHECKSUM.search(text)
    if match is None:
        return False
    made = 0xcbf29ce484222325
    for byte in text[:match.start()].encode("utf-8"):
        made = (made ^ byte) * 0x100000001b3 % 2**64
    return int(match[1], 16) == made


def expected(text, folder, results, problems):
    """The page of that folder as the results would have it."""
    def made(match, known, kind):
        name = match["name"]
        if name not in known:
            problems.append(f"{kind} {name}: no program makes it")
            return match["text"]
        try:
            return linked_from(known[name](results), folder)
        except Missing as problem:
            if kind == "table" and problem.name in NOT_MEASURED:
                where, what = problem.name.split("/")
                return f"Not measured yet: `sh cmake/report.sh --{where} --only {what} --into-docs` does it.\n"
            problems.append(f"{kind} {name}: {problem}")
        except (KeyError, TypeError, ValueError, ZeroDivisionError, IndexError, StopIteration) as problem:
            problems.append(f"{kind} {name}: the results lack what it shows ({problem!r})")
        return match["text"]

    def block(match):
        return f"<!-- {match['name']}: begin -->\n{made(match, report_tables.TABLES, 'table')}<!-- {match['name']}: end -->\n"

    def value(match):
        return f"<!-- v: {match['name']} -->{made(match, report_tables.VALUES, 'value')}<!-- /v -->"

    return VALUE.sub(value, BLOCK.sub(block, text))


def is_figure(cell):
    """Whether a cell holds numbers, with their units and what stands between them, and nothing else."""
    words = [w for w in re.split(r"[\s,;:/()*~x+-]+", cell) if w]
    units = {"ns", "us", "ms", "s", "B", "kB", "KiB", "MB", "MiB", "GB", "%", "to", "and", "of", "about", "under", "million",
             "times"}
    numbers = [w for w in words if re.fullmatch(r"\d[\d.^e]*%?", w)]
    return bool(numbers) and all(w in units or w in numbers for w in words)


def loose_tables(text):
    """The numbers of lines at which a table of figures begins that no program writes."""
    text = BLOCK.sub(lambda m: "\n" * m[0].count("\n"), text)
    lines, found, code = text.split("\n"), [], False
    start = None
    for number, line in enumerate(lines + [""]):
        if line.lstrip().startswith("```"):
            code = not code
        if not code and line.startswith("|"):
            start = number if start is None else start
            continue
        if start is not None:
            # The first column says what a row is of.
            cells = [c.strip() for row in lines[start + 2:number] for c in row.strip("|").split("|")[1:]]
            if any(is_figure(c) for c in cells) and (start == 0 or lines[start - 1] != "<!-- constants -->"):
                found.append(start + 1)
            start = None
    return found


def loose_numbers(text):
    """The numbers of lines, and the words, of what reads like a measurement in sentences, and no program writes."""
    def blank(match):  # keeps lines where they are
        return "\n" * match[0].count("\n")

    lines = text.split("\n")
    for what in (BLOCK, VALUE, CODE, CONSTANTS, re.compile(r"`[^`\n]*`|\]\([^)\n]*\)")):
        text = what.sub(blank, text)
    for match in MEASURED.finditer(text):
        first, last = text.count("\n", 0, match.start()), text.count("\n", 0, match.end())
        if not any(STATED in line for line in lines[first:last + 1]):
            yield first + 1, " ".join(match[0].split())


def rows_and_results(results):
    """Where the rows of cmake/report.sh and the committed results do not belong to each other."""
    script = (ROOT / "cmake" / "report.sh").read_text(encoding="utf-8")
    rows = {f"{kind}/{name}": program for kind, name, program in
            re.findall(r"^(cpu|cuda) (\w+) (\w+)", script[script.index("    else\n        cat <<END"):], re.M)}
    there = {f"{path.parent.name}/{path.stem}" for path in results.path.glob("*/*.json")}
    for name in sorted(there - set(rows) - WITHOUT_ROW):
        yield f"bench/results/{name}.json: no row of cmake/report.sh makes it"
    for name in sorted(set(rows) - there - NOT_MEASURED):
        yield f"cmake/report.sh: there are no results of its row {name}"
    for name in sorted(NOT_MEASURED & there | NOT_MEASURED - set(rows) | WITHOUT_ROW & set(rows) | WITHOUT_ROW - there):
        yield f"bench/report.py: {name} does not belong into its lists of exceptions"
    for name in sorted(there & set(rows)):
        program = results[name].context["program"]
        if program != rows[name]:
            yield f"bench/results/{name}.json is of {program}, and cmake/report.sh runs {rows[name]}"


def undated_results(results):
    nameless = {f"{path.parent.name}/{path.stem}" for path in results.path.glob("*/*.json") if undated(read(path)["context"])}
    for name in sorted(nameless):
        yield f"bench/results/{name}.json: of an unknown commit or date"


def sources_of(program):
    """A program and all that it includes of this repository, by the text alone."""
    found, todo = set(), [ROOT / "bench" / program]
    while todo:
        path = todo.pop()
        if path in found or not path.exists():
            continue
        found.add(path)
        for quoted, name in re.findall(r'^\s*#\s*include\s+(["<])([^">]+)[">]', path.read_text(encoding="utf-8"), re.M):
            todo += [(path.parent / name).resolve()] if quoted == '"' else []
            todo.append(ROOT / "include" / name)
    return found


def stale(results):
    """Lines about results of which a source was changed after their commit; of those that nobody can tell as well."""
    def git(*arguments):
        return subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True)

    try:
        shallow = git("rev-parse", "--is-shallow-repository")
    except OSError:
        return ["there is no git: which results are stale is not known"]
    if shallow.stdout.strip() != "false":
        return ["there is no history of git here: which results are stale is not known"]
    lines, sources = [], {}
    names = sorted(f"{path.parent.name}/{path.stem}" for path in results.path.glob("*/*.json"))
    for name, program in zip(names, report_tables.programs(results)):
        commit, date = (results[name].context.get(key, "unknown") for key in ("commit", "date"))
        if program not in sources:
            sources[program] = [str(path.relative_to(ROOT)) for path in sorted(sources_of(program))]
        # What a device's tests said, and what compiling costs, is of the whole library.
        paths = sources[program] if not program.endswith(".py") else ["include"]
        later = git("log", "--format=%h", f"{commit.rstrip('+')}..HEAD", "--", *paths)
        if later.returncode != 0:
            lines.append(f"{name}: commit {commit} is not in this history")
        elif changes := later.stdout.split():
            lines.append(f"{name}: of {commit}, {date}; later commits that changed its sources: {len(changes)}, the last {changes[0]}")
    return lines


def check(results):
    problems = list(rows_and_results(results)) + list(undated_results(results))
    for path in pages():
        text, here = path.read_text(encoding="utf-8"), []
        made = expected(text, path.parent, results, here)
        if made != text:
            for old, new in zip(text.split("\n"), made.split("\n")):
                if old != new:
                    here.append(f"differs from the results: {old!r} should be {new!r}")
                    break
        marks = MARK.findall(VALUE.sub("", BLOCK.sub("", text)))
        here += [f"{mark} has no partner" for mark in marks]
        here += [f"line {n}: a table of figures that no program writes" for n in loose_tables(text)]
        here += [f"line {n}: {words!r} reads like a measurement, and no program writes it"
                 for n, words in loose_numbers(text)]
        here += [f"{plot} is not there" for plot in re.findall(r"\]\(((?:docs/|(?:\.\./)+)?figures/[^)]*)\)",
                                                               text) if not (path.parent / plot).exists()]
        problems += [f"{path.relative_to(ROOT)}: {problem}" for problem in here]
    for path in results_pages()[0]:
        if not as_written(path.read_text(encoding="utf-8")):
            problems.append(f"{path.relative_to(ROOT)}: not as the test wrote it, by the checksum in its last line")
    for source in report_tables.programs(results):
        if not (ROOT / "bench" / source).exists():
            problems.append(f"bench/{source}: the program of some results is not there")
    return problems


def write(results):
    problems = []
    for path in pages():
        text = path.read_text(encoding="utf-8")
        made = expected(text, path.parent, results, problems)
        if made != text:
            path.write_text(made, encoding="utf-8")
            print(f"written: {path.relative_to(ROOT)}")
    for problem in problems:
        print(f"left as it was: {problem}")


def draw(results, folder, verbose=False):
    """The names of the plots that were written."""
    try:
        import plots
    except ImportError as problem:
        print(f"no plots: {problem} (python3-matplotlib)")
        return []
    return plots.draw(results, folder, verbose)


def page(out, results):
    """What there are results for, one after another."""
    if not any(results.path.glob("*/*.json")):
        sys.exit(f"{results.path}: expected files cpu/NAME.json or cuda/NAME.json")
    lines = ["# What was measured here", ""]
    out.parent.mkdir(parents=True, exist_ok=True)
    for name in draw(results, out.parent):
        print(f"written: {out.parent / name}")
        lines += [f"![{name}]({name})", ""]
    for name, make in report_tables.TABLES.items():
        if name.startswith("measured-"):  # the head of a page of docs/results
            continue
        before = results.asked
        try:
            text = make(results)
        except (Missing, KeyError, TypeError, ValueError, ZeroDivisionError, IndexError, StopIteration):
            continue  # it shows what was not measured
        if results.asked > before:  # else it is of files of the tests, and not of this machine
            lines += [f"## {name}", "", text.replace("](figures/", "](")]  # they lie beside it
    out.write_text("\n".join(lines), encoding="utf-8")
    print(f"written: {out}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--take", type=Path, metavar="FOLDER")
    parser.add_argument("--stale", action="store_true")
    parser.add_argument("--page", type=Path, nargs=2, metavar=("OUT.md", "FOLDER"))
    arguments = parser.parse_args()
    committed = ROOT / "bench" / "results"
    if arguments.page:
        page(arguments.page[0], Folder(arguments.page[1]))
        return
    if arguments.stale:
        print("\n".join(stale(Folder(committed))) or "none")
        return
    if arguments.take:
        take(arguments.take, committed)
    if arguments.write:
        write(Folder(committed))
        for name in draw(Folder(committed), ROOT / "docs" / "figures", verbose=True):
            print(f"written: docs/figures/{name}")
    if arguments.check or not (arguments.take or arguments.write):
        problems = check(Folder(committed))
        for problem in problems:
            print(problem)
        sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
