# SPDX-License-Identifier: MIT
"""Turns what the programs of tests/cuda said on a device into results, and these into the tables of docs/results/cuda-h200.md.

usage: report_cuda_tests.py FOLDER --json=OUT.json --device=NAME --driver=VERSION --cuda=VERSION [--commit=HASH] [--date=DATE]
                            [--flags=FLAGS]

FOLDER has for a program its output, NAME.out, and its output under compute-sanitizer, NAME.memcheck, or one of them. A source
may be built in parts, each with some of its tests: NAME@PART.out and NAME@PART.memcheck are summed to one row. And
SHAPES.families, where test_cuda_predicates was run for the families of two shapes alone (sphere_triangle, say): rows of
these go to a table of their own. The commit is that of the programs, by default what ABUT_COMMIT says; of programs of another
one NAME.commit says which, and families of another one are in SHAPES.COMMIT.families. The date is today's.
OUT.json is bench/results/cuda/tests.json, or for families predicates.json; then `report.py --write` writes the pages.
"""

import argparse
import datetime
import json
import os
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
from report_core import SCALARS, in_table, table, whole  # noqa: E402


# --- logs -------------------------------------------------------------------------------------------------------------------

def assertions(text):
    """What Catch2's last lines say, of each process that wrote them; nothing if none came so far."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", text)  # mpirun's output is a terminal, and coloured
    passed = [int(n) for n in re.findall(r"^All tests passed \((\d+) assertions? in \d+ test cases?\)", text, re.M)]
    rest = re.findall(r"^assertions:\s+(\d+)(.*)$", text, re.M)
    failed = [int(n) for _, more in rest for n in re.findall(r"(\d+) failed", more)]
    all_of_them = passed + [int(n) for n, _ in rest]
    if not all_of_them:
        return {}
    return {"assertions": max(all_of_them), "failed": max(failed, default=0), "processes": len(all_of_them)}


def row_of(out, memcheck):
    """Of the texts of both, None where there is none."""
    row = {}
    if out is not None:
        row.update(assertions(out) or {"no_end": 1})
    if memcheck is not None:
        errors = [int(n) for n in re.findall(r"^=+ ERROR SUMMARY: (\d+) errors?", memcheck, re.M)]
        row.update({f"memcheck_{key}": n for key, n in assertions(memcheck).items() if key != "processes"})
        row.update({"memcheck_errors": sum(errors)} if errors else {"memcheck_no_end": 1})
    return row


def sum_of(parts):
    """One row of the rows of a program's parts."""
    row = {"parts": len(parts)}
    for key in ("assertions", "failed", "memcheck_assertions", "memcheck_failed", "memcheck_errors"):
        if any(key in p for p in parts):
            row[key] = sum(p.get(key, 0) for p in parts)
    for key, count in (("no_end", "ended"), ("memcheck_no_end", "memcheck_ended")):
        if any(key in p for p in parts):
            row[count] = sum(key not in p for p in parts)
    return row


FAMILY = re.compile(r"^(?P<name>\S.*?) +(?P<scalar>float|double) +n (?P<pairs>\d+), hits +(?P<hits>[\d.]+) %, "
                    r"inputs that differ (?P<inputs>\d+), decisions that differ (?P<decisions>\d+), "
                    r"filtered against exact (?P<arithmetics>\d+)$", re.M)
COUNTS = ("pairs", "hits", "inputs", "decisions", "arithmetics")


def rows_of(folder):
    """The rows, and the commits of those that have one of their own."""
    rows, commits = {}, {p.stem: p.read_text(encoding="utf-8").strip() for p in sorted(folder.glob("*.commit"))}
    parts = {}
    for name in sorted({p.stem for p in folder.iterdir() if p.suffix in (".out", ".memcheck")}):
        texts = [folder / f"{name}{suffix}" for suffix in (".out", ".memcheck")]
        row = row_of(*(t.read_text(encoding="utf-8", errors="replace") if t.exists() else None for t in texts))
        program, _, part = name.partition("@")
        rows[program] = row
        if part:
            parts.setdefault(program, []).append(row)
            rows[program] = sum_of(parts[program])
    # Those of another commit come last: they replace what the same program said before.
    for path in sorted(folder.glob("*.families"), key=lambda p: (p.stem.count("."), p.stem)):
        shapes, _, commit = path.stem.partition(".")
        for m in FAMILY.finditer(path.read_text(encoding="utf-8", errors="replace")):
            name = f"{shapes}/{m['name']}/{m['scalar']}"
            rows[name] = {key: float(m[key]) for key in COUNTS}
            if commit:
                commits[name] = commit
    return rows, commits


# --- tables -----------------------------------------------------------------------------------------------------------------

def checks(n):
    return "one check" if n == 1 else f"{whole(n)} checks"


def outcome(row):
    if "assertions" in row:
        by = f", by {whole(row['processes'])} ranks" if row.get("processes", 1) > 1 else ""
        if "parts" in row:
            by = f", in {whole(row['parts'])} parts" + (f", {whole(row['ended'])} of which ended" if "ended" in row else "")
        if row.get("failed"):
            return f"{row['assertions'] - row['failed']} of {row['assertions']} assertions{by}: see above"
        return f"passed: {row['assertions']} assertions{by}"
    if row.get("no_end"):
        return "did not end"
    if row.get("memcheck_failed") == 0:
        return f"passed: {row['memcheck_assertions']} assertions, under memcheck"
    return "not run"


def outcome_of_memcheck(row):
    if not row:
        return "not run"
    if "memcheck_errors" not in row:
        return "did not end" if row.get("memcheck_no_end") else "not run: see above"
    failed = row.get("memcheck_failed")
    return f"{whole(row['memcheck_errors'])} error{'' if row['memcheck_errors'] == 1 else 's'}" + \
        (f" in {whole(row['memcheck_ended'])} parts, the others did not end" if "memcheck_ended" in row else "") + \
        (f"; {checks(failed)} failed, see above" if failed else "")


def made_there(c, more=""):
    return [f"{c['device']}, driver {c['driver']}, CUDA {c['cuda']}, `{c['flags']}`; commit {c['commit'][:9]}, "
            f"{c['date']}{more}.", ""]


def tests(r):
    c = r.context
    other = c.get("commits", {})
    rows = [[f"`{name}`" + (f", {other[name][:9]}" if name in other else ""), outcome(row), outcome_of_memcheck(row)]
            for name, row in r.rows.items()]
    return made_there(c) + table(["test", "result", "memcheck"], rows, 3)


@in_table("cuda-tests")
def cuda_tests(results):
    return tests(results["cuda/tests"])


def of_other_commits(commits, names):
    """Which of these rows, from the first to the last of each commit and scalar, are of another commit."""
    said = ""
    for commit, scalar in dict.fromkeys((commits[n], n.rsplit("/", 1)[1]) for n in names if n in commits):
        of_it = [n.split("/")[1] for n in names if commits.get(n) == commit and n.endswith(f"/{scalar}")]
        said += f"; in {scalar} {' to '.join(f'`{n}`' for n in dict.fromkeys((of_it[0], of_it[-1])))} of commit {commit[:9]}"
    return said


def families(r, shapes):
    rows, sums, commits = [], [], r.context.get("commits", {})
    for scalar in SCALARS:
        names = [n for n in r.names(f"{shapes}/") if n.endswith(f"/{scalar}")]
        sums.append(f"{sum(r.get(n, 'pairs') for n in names) / 1e6:,.0f} million pairs in {scalar}")
        rows += [[n.split("/", 1)[1].rsplit("/", 1)[0], scalar, f"{r.get(n, 'pairs')}", f"{r.get(n, 'hits'):.1f}"] +
                 [whole(r.get(n, key)) for key in ("inputs", "decisions", "arithmetics")] for n in names]
    return made_there(r.context, of_other_commits(commits, r.names(f"{shapes}/"))) + [f"{', '.join(sums)}:", ""] + \
        table(["family", "scalar", "pairs", "hits, %", "inputs that differ", "decisions that differ",
               "`filtered` against `exact`"], rows, 2)


@in_table("cuda-families-spheres")
def families_of_spheres(results):
    return families(results["cuda/predicates_spheres"], "sphere_triangle")


@in_table("cuda-families-triangles")
def families_of_triangles(results):
    return families(results["cuda/predicates"], "triangle_triangle")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--json", type=Path, required=True)
    for name in ("device", "driver", "cuda"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--commit", default=os.environ.get("ABUT_COMMIT", "unknown"))
    parser.add_argument("--date", default=datetime.date.today().isoformat())
    parser.add_argument("--flags", default="-arch=sm_90")
    arguments = parser.parse_args()
    if "unknown" in (arguments.commit, arguments.date):
        sys.exit("report_cuda_tests.py: of which commit and day are the programs? Expected --commit or ABUT_COMMIT")
    rows, other = rows_of(arguments.folder)
    if not rows:
        sys.exit(f"{arguments.folder}: expected files NAME.out, NAME.memcheck or SHAPES.families")
    said = {key: getattr(arguments, key) for key in ("device", "driver", "cuda", "flags", "commit", "date")}
    context = {"program": Path(__file__).name, **said, **({"commits": other} if other else {})}
    lines = ",\n".join(f"  {json.dumps(name)}: {json.dumps(row)}" for name, row in rows.items())
    arguments.json.write_text(f'{{"context": {json.dumps(context)},\n "rows": {{\n{lines}\n}}}}\n', encoding="utf-8")


if __name__ == "__main__":
    main()
