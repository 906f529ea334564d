# SPDX-License-Identifier: MIT
"""Runs bench/report.py --check, and sees that it notices what it is there for: on copies with a digit changed, a table that no
program writes, a measurement in a sentence, results that are gone, a block without an end, README at odds with them. And
runs cmake/report.sh with programs that measure nothing, bench/report_cuda_tests.py and bench/report_runs.py of logs that are
known, and report.py --take and --stale.

usage: report.py REPOSITORY
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path


def check(root):
    done = subprocess.run([sys.executable, "-B", str(root / "bench" / "report.py"), "--check"], capture_output=True,
                          text=True)
    return done.returncode, done.stdout + done.stderr


def change_digit(page, block):
    """Changes the last digit of a block."""
    text = page.read_text(encoding="utf-8")
    begin, end = text.index(f"<!-- {block}: begin -->"), text.index(f"<!-- {block}: end -->")
    at = max(m.start() for m in re.finditer(r"\d(?= \|)", text[begin:end])) + begin
    page.write_text(text[:at] + str((int(text[at]) + 1) % 10) + text[at + 1:], encoding="utf-8")


def replace(page, old, new):
    text = page.read_text(encoding="utf-8")
    if old not in text:
        raise SystemExit(f"{page}: no {old!r} to change")
    page.write_text(text.replace(old, new, 1), encoding="utf-8")


def append(page, lines):
    page.write_text(page.read_text(encoding="utf-8") + lines, encoding="utf-8")


MUTATIONS = {
    "a digit of a table": lambda r: change_digit(r / "docs" / "results" / "trade.md", "trade-cpu"),
    "a digit of README": lambda r: change_digit(r / "README.md", "cost-peers"),
    "a table that no program writes": lambda r: append(r / "docs" / "building.md",
                                                       "\n| what | ms |\n| --- | ---: |\n| a query | 1.25 |\n"),
    "a measurement in a sentence": lambda r: append(r / "docs" / "building.md", "\nA query takes 1.25\nms here.\n"),
    "a factor in a sentence": lambda r: append(r / "README.md", "\nIt is 17.4 times faster.\n"),
    "a share in a sentence": lambda r: append(r / "docs" / "results" / "contacts.md", "\nIt keeps some 80 % of them.\n"),
    "a rate in a sentence": lambda r: append(r / "docs" / "guide" / "rays.md", "\nIt reads half a million inputs a second.\n"),
    "bytes in a sentence": lambda r: append(r / "docs" / "building.md", "\nA tree of it takes 3.5 MiB here.\n"),
    "so many of so many in a sentence": lambda r: append(r / "docs" / "building.md", "\nIt finds 1,234 of the 5,678.\n"),
    "a number that the source has no more": lambda r: replace(r / "tests" / "project" / "viewer" / "read.test.mjs",
                                                              "const tries = 4000", "const tries = 4001"),
    "a family that the source has more": lambda r: replace(r / "tests" / "support" / "flat_triangles.hpp", "    random, ",
                                                           "    more,\n    random, "),
    "a number word in a sentence": lambda r: append(r / "docs" / "building.md", "\nIt takes twenty-three seconds.\n"),
    "kilobytes in a sentence": lambda r: append(r / "docs" / "building.md", "\nIt takes thirty kilobytes.\n"),
    "a count of families in a sentence": lambda r: append(r / "docs" / "building.md", "\nTwenty-one families are tried.\n"),
    "a part in a sentence": lambda r: append(r / "docs" / "building.md", "\nIt is 5e-6 of the diagonal.\n"),
    "a number with about in a sentence": lambda r: append(r / "docs" / "building.md", "\nIt sends about 160 and 13.\n"),
    "a block of an unknown name": lambda r: append(r / "docs" / "building.md",
                                                   "<!-- nobody: begin -->\n<!-- nobody: end -->\n"),
    "a block without an end": lambda r: replace(r / "docs" / "results" / "trade.md", "<!-- trade-cpu: end -->\n", ""),
    "results that are gone": lambda r: (r / "bench" / "results" / "cpu" / "trade.json").unlink(),
    "other results": lambda r: replace(r / "bench" / "results" / "cpu" / "trade.json", '"ns": ', '"ns": 7'),
    "results that no row makes": lambda r: replace(r / "cmake" / "report.sh", "cpu ties bench_ties ", "# "),
    "a row without results": lambda r: replace(r / "cmake" / "report.sh", "cpu within ", "cpu x bench_x {}\ncpu within "),
    "results of another program": lambda r: replace(r / "cmake" / "report.sh", "cpu ties bench_ties ", "cpu ties bench_x "),
    "results that are said not to be measured": lambda r: replace(r / "bench" / "report.py", "WITHOUT_ROW = ",
                                                                'NOT_MEASURED |= {"cpu/ties"}\nWITHOUT_ROW = '),
    "a program that is gone": lambda r: (r / "bench" / "trade.cpp").unlink(),
    "a page of results that no test writes": lambda r: shutil.copy(r / "docs" / "results" / "sphere-sphere.md",
                                                                   r / "docs" / "results" / "sphere-cylinder.md"),
    "a digit of a page that a test wrote": lambda r: replace(r / "docs" / "results" / "within.md", "44.8", "44.9"),
    "a page of a test without its end": lambda r: replace(r / "docs" / "results" / "within.md", "<!-- checksum: ", "<!-- "),
    "a digit of what a device said": lambda r: replace(r / "bench" / "results" / "cuda" / "tests.json", '"failed": 0',
                                                       '"failed": 1'),
    "a digit of what ctest said": lambda r: change_digit(r / "docs" / "results" / "tests.md", "runs"),
    "results of an unknown commit": lambda r: replace(r / "bench" / "results" / "cpu" / "ties.json", '"commit": "',
                                                      '"commit": "unknown", "was": "'),
    "results of no date": lambda r: replace(r / "bench" / "results" / "cpu" / "ties.json", '"date": "', '"day": "'),
    "a plot that is gone": lambda r: (r / "docs" / "figures" / "trade-cpu.svg").unlink(),
}


# A program that brings some results, if it finds its data; else it fails.
PROGRAM = """#!/bin/sh
for argument in "$@"; do
    case $argument in
        --json=*) out=${{argument#*=}} ;;
        --data=*) [ -f "${{argument#*=}}/mine" ] || exit 3 ;;
    esac
done
cp '{results}' "$out"
"""


def try_script(root):
    """What is wrong with cmake/report.sh."""
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        copy, programs, data = Path(folder) / "copy", Path(folder) / "all programs", Path(folder) / "my data"
        for part in ("docs", "bench", "cmake"):
            shutil.copytree(root / part, copy / part)
        for made in (programs, data):
            made.mkdir()
        (data / "mine").touch()
        for name in ("trade", "trade_scenes"):
            program = programs / f"bench_{name}"
            program.write_text(PROGRAM.format(results=root / "bench" / "results" / "cpu" / "trade.json"), encoding="utf-8")
            program.chmod(0o755)

        def run(what, status, expected, *arguments):
            done = subprocess.run(["sh", copy / "cmake" / "report.sh", *arguments], capture_output=True, text=True, cwd=folder,
                                  env={k: v for k, v in os.environ.items() if k != "ABUT_COMMIT"})
            if done.returncode != status or expected not in done.stdout + done.stderr:
                wrong.append(f"report.sh, {what}: expected {status} and {expected!r}, found {done.returncode}: "
                             f"{done.stdout}{done.stderr}")

        some = ("--bin", "all programs", "--only", "trade")
        some = (*some, "--only", "trade_scenes", "--data")
        run("names with spaces, of the caller's folder", 0, "cpu/trade_scenes: ", *some, "my data")
        report = copy / "build" / "report" / "report.md"
        page = report.read_text(encoding="utf-8") if report.exists() else ""
        if "## trade-cpu" not in page or "## sphere-families" in page:
            wrong.append("report.sh: the page has not what was measured here, or more")
        run("pages of results that do not say their commit", 1, "set ABUT_COMMIT", *some, "my data", "--into-docs")
        run("a program that fails", 1, "cpu/trade_scenes: FAILED (3)", *some, "all programs")
        run("a benchmark that is not there", 1, "--only tarde: there are ", "--bin", "all programs", "--only", "tarde")
        run("results that are not there", 1, "expected files cpu/NAME.json", "--from", "nowhere")
    return wrong


def report(root, *arguments):
    return subprocess.run([sys.executable, "-B", str(root / "bench" / "report.py"), *arguments], capture_output=True, text=True)


def try_take(root):
    """What is wrong with --take."""
    with tempfile.TemporaryDirectory() as folder:
        copy, new = Path(folder) / "copy", Path(folder) / "new"
        shutil.copytree(root / "bench", copy / "bench")
        (new / "cpu").mkdir(parents=True)
        made, taken = new / "cpu" / "ties.json", copy / "bench" / "results" / "cpu" / "ties.json"
        taken.unlink()
        wrong = []
        for what, says, status in (("an unknown commit", ('"commit": "', '"commit": "unknown", "was": "'), 1),
                                   ("an unknown date", ('"date": "', '"day": "'), 1), ("a commit and a date", ("", ""), 0)):
            shutil.copy(root / "bench" / "results" / "cpu" / "ties.json", made)
            replace(made, *says)
            done = report(copy, "--take", str(new))
            if done.returncode != status or taken.exists() != (status == 0):
                wrong.append(f"report.py --take of {what}: {done.returncode}, {done.stdout}{done.stderr}")
        return wrong


def try_stale(root):
    """What is wrong with --stale."""
    if shutil.which("git") is None:
        return []
    with tempfile.TemporaryDirectory() as folder:
        copy, name = Path(folder), ["-c", "user.name=a", "-c", "user.email=a@b.invalid"]

        def git(*arguments):
            return subprocess.run(["git", "-C", folder, *arguments], capture_output=True, text=True, check=True).stdout.strip()

        for part in ("bench", "include", "tests/support"):
            shutil.copytree(root / part, copy / part)
        for path in (copy / "bench" / "results").glob("*/*.json"):
            if path.stem not in ("ties", "distance"):
                path.unlink()
        said = [report(copy, "--stale")]
        git("init", "-q")
        git("add", "-A")
        git(*name, "commit", "-qm", "all")
        for path in (copy / "bench" / "results" / "cpu").glob("*.json"):
            replace(path, '"commit": "', f'"commit": "{git("rev-parse", "--short=9", "HEAD")}", "was": "')
        said.append(report(copy, "--stale"))
        append(copy / "bench" / "distance_scene.hpp", "\n")  # of bench/distance.cpp alone
        git(*name, "commit", "-qam", "more")
        said.append(report(copy, "--stale"))
        expected = (r"there is no history of git here.*\n", r"cuda/distance: commit \w+ is not .*\ncuda/ties: .*\n",
                    r"cpu/distance: of \w+, .*: 1, the last \w+\ncuda/distance: .*\ncuda/ties: .*\n")
        return [f"report.py --stale: expected {text!r}, found {done.returncode}: {done.stdout}{done.stderr}"
                for text, done in zip(expected, said) if done.returncode != 0 or not re.fullmatch(text, done.stdout)]


# What programs of tests/cuda say, and the rows that it makes.
LOGS = {"passes.out": "...\nAll tests passed (1 assertion in 1 test case)\n",
        "passes.memcheck": "All tests passed (12 assertions in 3 test cases)\n\n========= ERROR SUMMARY: 0 errors\n",
        "fails.out": "test cases:  3 |  2 passed | 1 failed\nassertions: 20 | 19 passed | 1 failed\n\n" * 2,
        "fails.memcheck": "All tests passed (20 assertions in 3 test cases)\n========= ERROR SUMMARY: 1 error\n",
        "ends.out": "terminate called\n", "ends.commit": "89abcde\n", "ends.memcheck": "assertions: 7 | 5 passed | 2 failed\n",
        "parts@a.out": "All tests passed (5 assertions in 1 test case)\n", "parts@b.out": "terminate called\n",
        "parts@a.memcheck": "All tests passed (5 assertions in 1 test case)\n========= ERROR SUMMARY: 2 errors\n",
        "parts@b.memcheck": "assertions: 4 | 3 passed | 1 failed\n========= ERROR SUMMARY: 0 errors\n",
        "sphere_triangle.families": "needle 1e3         float  n 300, hits  70.5 %, inputs that differ 0, "
                                    "decisions that differ 2, filtered against exact 1\n",
        "sphere_triangle.fedcba9.families": "radius 0           double n 9, hits   1.0 %, inputs that differ 0, "
                                            "decisions that differ 0, filtered against exact 0\n"}
ROWS = {"passes": {"assertions": 1, "failed": 0, "processes": 1, "memcheck_assertions": 12, "memcheck_failed": 0,
                   "memcheck_errors": 0},
        "fails": {"assertions": 20, "failed": 1, "processes": 2, "memcheck_assertions": 20, "memcheck_failed": 0,
                  "memcheck_errors": 1},
        "ends": {"no_end": 1, "memcheck_assertions": 7, "memcheck_failed": 2, "memcheck_no_end": 1},
        "parts": {"parts": 2, "assertions": 5, "failed": 0, "memcheck_assertions": 9, "memcheck_failed": 1, "memcheck_errors": 2,
                  "ended": 1},
        "sphere_triangle/needle 1e3/float": {"pairs": 300, "hits": 70.5, "inputs": 0, "decisions": 2, "arithmetics": 1},
        "sphere_triangle/radius 0/double": {"pairs": 9, "hits": 1, "inputs": 0, "decisions": 0, "arithmetics": 0}}


def try_write(root):
    """What is wrong with --write: a table keeps its columns where the results lack one."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        shutil.copy(root / "README.md", copy)
        for part in ("docs", "bench", "cmake", "tests/predicate", "tests/support", "tests/project/viewer"):
            shutil.copytree(root / part, copy / part)
        made = copy / "bench" / "results" / "cpu" / "footprint_build.json"
        made.write_text(made.read_text(encoding="utf-8").replace('"nvcc_instructions"', '"nvcc_others"'), encoding="utf-8")
        says = report(copy, "--write").stdout
        kept = "instructions |" in (copy / "docs" / "results" / "footprint.md").read_text(encoding="utf-8")
        return [] if kept and "table footprint: the results lack" in says else [f"report.py --write without a column: {says}"]


def try_logs(root):
    """What is wrong with bench/report_cuda_tests.py."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in LOGS.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        out = Path(folder) / "tests.json"
        said = {"device": "some device", "driver": "580.1", "cuda": "13.0", "commit": "0123abc", "date": "2026-01-31"}
        subprocess.run([sys.executable, "-B", root / "bench" / "report_cuda_tests.py", folder, f"--json={out}",
                        *(f"--{key}={value}" for key, value in said.items())], check=True)
        made = json.loads(out.read_text(encoding="utf-8"))
        wrong = [f"report_cuda_tests.py: expected {ROWS}, found {made['rows']}"] if made["rows"] != ROWS else []
        said_too = {**said, "commits": {"ends": "89abcde", "sphere_triangle/radius 0/double": "fedcba9"}}
        wrong += [f"report_cuda_tests.py: it does not say {key}" for key in said_too if made["context"].get(key) != said_too[key]]
        for commit, status in (("unknown", 1), ("0123abc", 0)):  # of the environment
            done = subprocess.run([sys.executable, "-B", root / "bench" / "report_cuda_tests.py", folder, f"--json={out}",
                                   *(f"--{key}={said[key]}" for key in ("device", "driver", "cuda"))],
                                  env={**os.environ, "ABUT_COMMIT": commit}, capture_output=True, text=True)
            if done.returncode != status:
                wrong.append(f"report_cuda_tests.py: of commit {commit} it ends with {done.returncode}")
        return wrong


# What ctest says of runs in parts, of one that failed, and of one that was cut off; and what it makes of each.
CTEST = {"all": ["1/9 Test #1: a ... Passed\n\n100% tests passed, 0 tests failed out of 9\n\nTotal Test time (real) = 1 sec\n\n"
                 "The following tests did not run:\n\t  3 - cuda/a b (Skipped)\n\t 12 - c (Skipped)\n",
                 "100% tests passed, 0 tests failed out of 1\n"],
         "some": ["33% tests passed, 2 tests failed out of 3\n\nThe following tests did not run:\n\t  3 - a (Skipped)\n\n"
                  "The following tests FAILED:\n\t  1 - b (Failed)\n\t  2 - c (Skipped) (Timeout)\n"],
         "none": ["1/9 Test #1: a ... Passed\n"]}
RUNS = {"all": {"passed": 8, "failed": 0, "skipped": 2}, "some": {"passed": 0, "failed": 2, "skipped": 1}}


def try_runs(root):
    """What is wrong with bench/report_runs.py."""
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "runs.json"
        for run, commit in (("some", "0123abc"), ("all", "0123abc"), ("none", "0123abc"), ("all", "unknown"), ("some", "89abcde")):
            logs = [Path(folder) / f"{i}.log" for i in range(len(CTEST[run]))]
            for log, text in zip(logs, CTEST[run]):
                log.write_text(text, encoding="utf-8")
            done = subprocess.run([sys.executable, "-B", root / "bench" / "report_runs.py", *logs, f"--run={run}",
                                   "--compiler=g++", f"--json={out}", f"--commit={commit}"], capture_output=True, text=True)
            if (done.returncode == 0) != (run in RUNS and commit != "unknown"):
                wrong.append(f"report_runs.py: {run} of {commit} ends with {done.returncode}: {done.stderr}")
        made = json.loads(out.read_text(encoding="utf-8"))
        commits = {run: of["commit"] for run, of in made["context"]["runs"].items()}
        if made["rows"] != RUNS or commits != {"some": "89abcde", "all": "0123abc"}:
            wrong.append(f"report_runs.py: expected {RUNS}, found {made}")
    return wrong


def main():
    root = Path(sys.argv[1]).resolve()
    status, says = check(root)
    print(says, end="")
    wrong = try_script(root) + try_logs(root) + try_runs(root) + try_take(root) + try_write(root) + try_stale(root)
    for line in wrong:
        print(line)
    failed = status != 0 or bool(wrong)
    for name, mutate in MUTATIONS.items():
        with tempfile.TemporaryDirectory() as folder:
            copy = Path(folder)
            shutil.copy(root / "README.md", copy)
            for part in ("docs", "bench", "cmake", "tests/predicate", "tests/support", "tests/project/viewer"):
                shutil.copytree(root / part, copy / part)
            mutate(copy)
            status, found = check(copy)
            if status != 1 or found == says or "Traceback" in found:
                print(f"the check does not notice: {name}")
                failed = True
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
