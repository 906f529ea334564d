# SPDX-License-Identifier: MIT
"""What the tables of the pages are made with. TABLES and VALUES are functions by name, which take the results (bench/report.py);
the files report_*.py beside this one fill them."""

import json
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LITERATURE = json.loads((ROOT / "bench" / "literature.json").read_text(encoding="utf-8"))
TABLES, VALUES = {}, {}


def in_table(name):
    def add(make):
        TABLES[name] = lambda results: "\n".join(make(results)).rstrip("\n") + "\n"
        return make
    return add


def programs(results):
    """The sources that can have made each of the committed results."""
    found = []
    for path in sorted(results.path.glob("*/*.json")):
        program = results[f"{path.parent.name}/{path.stem}"].context["program"].removeprefix("bench_")
        found.append(program if program.endswith(".py")
                     else program.removesuffix("_cuda") + (".cu" if program.endswith("_cuda") else ".cpp"))
    return found


# --- numbers and tables -----------------------------------------------------------------------------------------------------

def shown(value):
    """Three digits or so; nothing where there is no value."""
    if value is None:
        return ""
    digits = 0 if value >= 100 else 1 if value >= 10 else 2 if value >= 1 else 3 if value >= 0.1 else 4
    return f"{value:,.{digits}f}"


def whole(value):
    return "" if value is None else f"{value:,.0f}"


def quotient(a, b, digits=2):
    return f"{a / b:,.{digits}f}" if a and b else ""


def share(part):
    """Per cent, with more digits where it is nearly all."""
    if part is None:
        return ""
    return f"{100 * part:.3f}" if 0.99 < part < 1 else f"{100 * part:.3g}"


def rate(r, name):
    """Million a second."""
    value = r.get(name, "items_per_second")
    return value / 1e6 if value else None


def table(head, rows, left=1):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * left + " ---: |" * (len(head) - left)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def filled(head, rows, left=1):
    """A table of those columns that hold something."""
    keep = [i for i in range(len(head)) if i < left or any(row[i] for row in rows)]
    return table([head[i] for i in keep], [[row[i] for i in keep] for row in rows], left)


def made_on(r, more=""):
    """Of which machine, compiler and commit."""
    c = r.context
    if "device" in c:
        where = f"{c['device']}, CUDA {c['cuda']}"
    else:
        where = f"{c['machine']}, {c['compiler'].split(' (')[0]}"
    flags = f", `{c['flags']}`" if c.get("flags", "unknown") != "unknown" else ""
    return [f"{where}{flags}; `{c['program']}`, commit {c['commit'][:9]}, {c['date']}{more}.", ""]


SCALARS = ("float", "double")
ARITHMETICS = ("fast", "filtered", "exact")
