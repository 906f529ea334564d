# SPDX-License-Identifier: MIT
"""Turns what ctest said of a whole run into a row of results, and these into the table of docs/results/tests.md.

usage: report_runs.py LOG... --run=WHAT --compiler=NAME --json=OUT.json [--commit=HASH] [--date=DATE]

LOG is what ctest printed: its last lines, with the tests that failed or did not run. Several are parts of one run. The row
is added to OUT.json, or replaces the one of the same name. The commit is that of the sources, by default what ABUT_COMMIT
says; the date is today's. OUT.json is bench/results/tests/runs.json; then `report.py --write` writes the page.
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
from report_core import in_table, table, whole  # noqa: E402

LAST = re.compile(r"^\d+% tests passed, (?:(?P<failed>\d+) tests? failed )?out of (?P<all>\d+)$", re.M)
SKIPPED = re.compile(r"^\s*\d+ - .* \(Skipped\)$", re.M)


def counts(text):
    """Passed, failed and skipped tests; nothing where ctest did not come to its end."""
    found = list(LAST.finditer(text))  # what a test prints may look like one
    if not found:
        return None
    last = found[-1]
    failed, skipped = int(last["failed"] or 0), len(SKIPPED.findall(text, last.end()))
    return {"passed": int(last["all"]) - failed - skipped, "failed": failed, "skipped": skipped}


@in_table("runs")
def runs(results):
    r = results["tests/runs"]
    rows = []
    for run, row in r.rows.items():
        of = r.context["runs"][run]
        rows.append([run, of["compiler"], of["commit"][:9], of["date"]] +
                    [whole(row[key]) for key in ("passed", "failed", "skipped")])
    return table(["run", "compiler", "commit", "date", "passed", "failed", "skipped"], rows, 4)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", type=Path, nargs="+", metavar="LOG")
    parser.add_argument("--json", type=Path, required=True)
    for name in ("run", "compiler"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--commit", default=os.environ.get("ABUT_COMMIT", "unknown"))
    parser.add_argument("--date", default=datetime.date.today().isoformat())
    arguments = parser.parse_args()
    if "unknown" in (arguments.commit, arguments.date):
        sys.exit("report_runs.py: of which commit and day is the run? Expected --commit or ABUT_COMMIT")
    said = [counts(path.read_text(encoding="utf-8", errors="replace")) for path in arguments.logs]
    for path, row in zip(arguments.logs, said):
        if row is None:
            sys.exit(f"report_runs.py: {path}: expected the last lines of ctest, one like: "
                     "100% tests passed, 0 tests failed out of 9")
    rows, all_runs = {}, {}
    if arguments.json.exists():
        data = json.loads(arguments.json.read_text(encoding="utf-8"))
        rows, all_runs = data["rows"], data["context"]["runs"]
    rows[arguments.run] = {key: sum(row[key] for row in said) for key in said[0]}
    all_runs[arguments.run] = {key: getattr(arguments, key) for key in ("compiler", "commit", "date")}
    # The commit of all is that of the last one.
    head = json.dumps({"program": Path(__file__).name, "commit": arguments.commit, "date": arguments.date}).removesuffix("}")
    lines = [",\n".join(f"  {json.dumps(run)}: {json.dumps(row)}" for run, row in part.items()) for part in (all_runs, rows)]
    arguments.json.parent.mkdir(parents=True, exist_ok=True)
    arguments.json.write_text(f'{{"context": {head}, "runs": {{\n{lines[0]}}}}},\n "rows": {{\n{lines[1]}\n}}}}\n',
                              encoding="utf-8")


if __name__ == "__main__":
    main()
