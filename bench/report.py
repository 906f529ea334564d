# SPDX-License-Identifier: MIT
"""Turns the JSON of bench_spheres_mesh and bench_triangles, and of the same on CUDA, into the tables of docs/benchmarks.md.

usage: report.py [--into PAGE.md] NAME=RESULTS.json...

Without --into it prints the tables. With it, each replaces what stands in the page between the lines
`<!-- NAME: begin -->` and `<!-- NAME: end -->`; the rest of the page stays.
"""

import argparse
import json
import re
import sys
from pathlib import Path

SPHERES, TRIANGLES, VERTICES = 1703244, 62976, 31488
LABELS = {"none": "brute force", "grid": "buckets (`make_grid`)", "bvh": "BVH (`make_bvh`)", "embree": "Embree"}


class Results:
    """Medians by name, as milliseconds with counters. One thread is measured by its processor time, which other jobs on
    the machine disturb less; threads and devices by the clock."""

    def __init__(self, path):
        try:
            data = json.loads(Path(path).read_text(encoding="utf-8"))
        except (OSError, ValueError) as problem:
            sys.exit(f"{path}: not the results of a finished run: {problem}")
        self.context = data["context"]
        self.rows = {}
        # Interleaved runs come in any order; family_index is the order in which the program lists them.
        for row in sorted(data["benchmarks"], key=lambda r: r.get("family_index", 0)):
            if row.get("aggregate_name") != "median":
                continue
            name = re.split(r"/(?:iterations|min_time|repeats|real_time)\b", row["run_name"])[0]
            unit = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[row["time_unit"]]
            clock = "real_time" if "/openmp" in name or "/cuda" in name else "cpu_time"
            self.rows[name] = dict(row, ms=row[clock] * unit)

    def ms(self, name):
        return self.rows[name]["ms"] if name in self.rows else None

    def counter(self, name, key):
        return self.rows.get(name, {}).get(key)

    def policies(self):
        found = {name.split("/")[2] for name in self.rows if name.startswith("all/")}
        return [policy for policy in ("serial", "openmp", "cuda") if policy in found]


def shown(ms):
    if ms is None:
        return ""
    digits = 0 if ms >= 100 else 1 if ms >= 10 else 2 if ms >= 1 else 3 if ms >= 0.1 else 4
    return f"{ms:,.{digits}f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" + " ---: |" * (len(head) - 1)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def whole_scene(r):
    rows = []
    for policy in r.policies():
        for index in ("grid", "bvh", "embree"):
            if r.ms(f"all/{index}/{policy}") is None:
                continue
            size = r.counter(f"build/{index}/{policy}", "bytes")
            asked = [r.ms(f"{answer}/{index}/{policy}/{SPHERES}") for answer in ("pairs", "unsorted", "count")]
            pairs = r.counter(f"all/{index}/{policy}", "pairs")
            rows.append([f"{LABELS[index]}, {policy}", shown(r.ms(f"build/{index}/{policy}"))] + [shown(t) for t in asked] +
                        [shown(r.ms(f"all/{index}/{policy}")), f"{size:,.0f}" if size else "", f"{pairs:,.0f}"])
    lines = [f"The whole scene ({SPHERES:,} spheres, {TRIANGLES:,} triangles), in ms:", ""]
    return lines + table(["", "build", "query: sorted pairs", "unsorted", "count", "build and sorted pairs",
                          "bytes of the index", "pairs"], rows)


def floor(r):
    pairs = r.counter(f"pairs/bvh/{r.policies()[0]}/{SPHERES}", "pairs")
    least = 12 * (SPHERES + TRIANGLES + VERTICES) + 8 * pairs
    reading = r.rows["floor/read"]
    if "bytes_per_second" in reading:
        # Google Benchmark divides by the clock; here the same bytes over the processor's time.
        rate = reading["bytes_per_second"] * reading["real_time"] / reading["cpu_time"]
    else:
        rate = reading["bytes"] / reading["ms"] * 1e3
    line = (f"Floor of the query: the spheres and the mesh read once and the pairs written once are {least / 1e6:.1f} MB; "
            f"at the {rate / 1e9:,.1f} GB/s that a read loop reached in the same run, {shown(least / rate * 1e3)} ms.")
    call = r.ms("floor/call")
    if call is not None:
        line += f" A call that does next to nothing and waits for a number takes {shown(call)} ms."
    return [line, ""]


def peers(r):
    ours, theirs = r.ms("all/bvh/serial"), r.ms("all/embree/serial")
    if ours is None:
        return []
    if theirs is None:
        return ["Embree was not there in this run, so its row is left out.", ""]
    unsorted = r.ms("all_unsorted/embree/serial")
    query = r.ms(f"unsorted/bvh/serial/{SPHERES}") / r.ms(f"unsorted/embree/serial/{SPHERES}")
    built = r.ms("build/bvh/serial") / r.ms("build/embree/serial")
    return [f"abut over Embree, one core, same run: build and sorted pairs **{ours / theirs:.2f}** ({ours / unsorted:.2f} if "
            f"Embree need not sort); build {built:.2f}, unsorted query {query:.2f}.", ""]


def by_size(r):
    names = [(index, policy) for index in ("none", "grid", "bvh") for policy in r.policies()
             if any(n.startswith(f"pairs/{index}/{policy}/") for n in r.rows)]
    sizes = sorted({int(n.split("/")[3]) for n in r.rows if n.startswith("pairs/") and "embree" not in n})
    rows = []
    for size in sizes:
        counts = [r.counter(f"pairs/{index}/{policy}/{size}", "pairs") for index, policy in names]
        pairs = next(c for c in counts if c is not None)
        rows.append([f"{size:,}", f"{pairs:,.0f}"] + [shown(r.ms(f"pairs/{i}/{p}/{size}")) for i, p in names])
    heads = [f"{LABELS[index].split(' (')[0]}, {policy}" for index, policy in names]
    return ["Query alone, sorted pairs, in ms, by the number of spheres:", ""] + table(["spheres", "pairs"] + heads, rows)


def arithmetic(r):
    rows = []
    kinds = sorted({tuple(n.split("/")[1:3]) for n in r.rows if n.startswith("arithmetic/")}, key=lambda k: (k[0], k[1] != "float"))
    for index, scalar in kinds:
        times = {a: r.ms(f"arithmetic/{index}/{scalar}/{a}") for a in ("fast", "filtered", "exact")}
        ratio = times["filtered"] / times["fast"] if times["fast"] and times["filtered"] else None
        rows.append([f"{LABELS[index].split(' (')[0]}, {scalar}"] + [shown(t) for t in times.values()] +
                    [f"{ratio:.2f}" if ratio else ""])
    policy = "cuda" if "cuda" in r.policies() else "serial"
    return [f"What certainty costs: query of the whole scene, sorted pairs, {policy}, in ms:", ""] + \
        table(["", "`fast`", "`filtered`", "`exact`", "`filtered` / `fast`"], rows)


def break_even(r):
    keys = sorted({tuple(map(int, n.split("/")[2:4])) for n in r.rows if n.startswith("break_even/")}, key=lambda k: (k[1], k[0]))
    rows = []
    for spheres, triangles in keys:
        times = {i: r.ms(f"break_even/{i}/{spheres}/{triangles}") for i in ("none", "grid", "bvh")}
        best = min(times, key=times.get)
        cells = [f"**{shown(t * 1e3)}**" if i == best else shown(t * 1e3) for i, t in times.items()]
        rows.append([f"{triangles:,}", f"{spheres:,}"] + cells)
    policy = "cuda" if "cuda" in r.policies() else "serial"
    return [f"Small scenes, build and sorted pairs, {policy}, in us (the fastest in bold):", ""] + \
        table(["triangles", "spheres", "brute force", "buckets", "BVH"], rows)


# --- triangles against triangles ---------------------------------------------------------------------------------------

ARITHMETICS = ("fast", "filtered", "exact")
STAGES = {"first": "filter", "late": "late", "word": "64 bits", "one_limb": "1 limb", "two_limbs": "2 limbs",
          "any_span": "any span"}
QUERIES = (("0", "any"), ("1", "count"), ("50", "count"), ("1", "any"), ("1", "pairs"), ("50", "pairs"), ("1", "unsorted"),
           ("50", "unsorted"))


def parts_of(r, kind, position):
    """What stands at a position of the names of a kind, in the order of the program."""
    return list(dict.fromkeys(n.split("/")[position] for n in r.rows if n.startswith(kind + "/")))


def rate(r, name):
    per_second = r.counter(name, "items_per_second")
    return per_second / 1e6 if per_second else None


def quotient(a, b, digits=2):
    return f"{a / b:.{digits}f}" if a and b else ""


def share(part):
    """Per cent, with more digits where it is nearly all."""
    if part is None:
        return ""
    return f"{100 * part:.3f}" if 0.99 < part < 1 else f"{100 * part:.3g}"


def pairs_one_by_one(r):
    peers = [p for p in ("cgal", "fcl") if f"pair/{p}/double/1" in r.rows]
    names = {"cgal": "CGAL", "fcl": "FCL"}
    rows = []
    for scalar in ("float", "double"):
        for percent in sorted(parts_of(r, "pair", 3), key=float):
            rates = {a: rate(r, f"pair/{a}/{scalar}/{percent}") for a in ARITHMETICS}
            # A peer's name says double: that is what it works in, on the same numbers as float.
            theirs = [rate(r, f"pair/{p}/double/{percent}") if scalar == "float" else None for p in peers]
            hits = r.counter(f"pair/filtered/{scalar}/{percent}", "hits")
            rows.append([scalar, f"{100 * hits:.1f}"] + [shown(v) for v in rates.values()] +
                        [quotient(rates["fast"], rates["filtered"])] + [shown(v) for v in theirs] +
                        [quotient(rates["filtered"], v) for v in theirs])
    head = ["", "hits, %"] + [f"`{a}`" for a in ARITHMETICS] + ["time of `filtered` / `fast`"]
    head += [names[p] for p in peers] + [f"`filtered` over {names[p]}" for p in peers]
    lines = ["Pairs decided one by one, in million a second:", ""] + table(head, rows)
    if r.counter("pair/filtered/float/1", "registers") is None:
        return lines
    rows = []
    for scalar in ("float", "double"):
        for a in ARITHMETICS:
            taken = [r.counter(f"pair/{a}/{scalar}/1", key) for key in ("registers", "local_bytes")]
            rows.append([f"`{a}`, {scalar}"] + [f"{v:,.0f}" for v in taken])
    return lines + ["What a thread of these kernels takes:", ""] + \
        table(["", "registers", "bytes of local memory (stack and spills)"], rows)


def one_against_many(r):
    lines = []
    for policy in ("serial", "openmp", "cuda"):
        for scalar in ("float", "double"):
            sizes = [n.split("/")[3] for n in r.rows if n.startswith(f"read/{scalar}/{policy}/")]
            if not sizes:
                continue

            def name(q, a, percent, n):
                return f"one/{q}/{a}/{scalar}/{percent}/{policy}/{n}"

            asked = [(q, a, p) for p, q in QUERIES for a in ARITHMETICS if name(q, a, p, sizes[0]) in r.rows]
            rows = []
            for n in sizes:
                read = r.ms(f"read/{scalar}/{policy}/{n}")
                rows.append([f"{int(n):,}", shown(read)] + [shown(r.ms(name(*what, n))) for what in asked] +
                            [quotient(r.ms(name(q, "filtered", p, n)), read) for q, p in (("any", "0"), ("count", "1"))])
            head = ["triangles", "read"] + [f"`{q}`, {p} % hits, `{a}`" for q, a, p in asked]
            lines += [f"One triangle against many, {policy}, {scalar}, in ms; the last two columns are `filtered`, with no "
                      "hit and with 1 %, over a loop that only reads the same bytes:", ""]
            lines += table(head + ["`any` / read", "`count` / read"], rows)
    return lines


def call_floor(r):
    call, reading = r.ms("floor/call"), r.rows.get("floor/read")
    if call is None:
        return []
    speed = reading["bytes"] / reading["ms"] / 1e6
    return [f"In the same run a GiB was read at {speed:,.0f} GB/s, and a call that does next to nothing and waits for a "
            f"number took {shown(call)} ms: no query is faster.", ""]


def with_copy(r):
    rows = []
    for name in r.rows:
        if name.startswith("one/copied/"):
            _, _, _, scalar, _, policy, n = name.split("/")
            times = [r.ms(name.replace("copied", "count", 1)), r.ms(f"copy/{scalar}/{policy}/{n}"), r.ms(name)]
            rows.append([f"{int(n):,}", scalar] + [shown(t) for t in times] + [quotient(times[2], times[1])])
    if not rows:
        return []
    head = ["triangles", "", "`count`, resident", "copy alone", "copy, check and `count`", "all / copy"]
    return ["With the copy from page-locked host memory, and the check of every coordinate, before each `count` (1 % hits, "
            "`filtered`), in ms:", ""] + table(head, rows)


def many_against_many(r):
    rows = []
    for policy in ("serial", "openmp", "cuda"):
        names = [name for name in r.rows if name.startswith("many/") and f"/{policy}/" in name]
        for n in dict.fromkeys(name.split("/")[5] for name in names):
            counted = f"many/count/filtered/float/{policy}/{n}"
            times = [r.ms(f"many/{what}/float/{policy}/{n}") for what in ("count/fast", "count/filtered", "pairs/filtered")]
            rows.append([f"{int(n):,} x {int(n):,}, {policy}", f"{r.counter(counted, 'found'):,.0f}"] +
                        [shown(t) for t in times] + [shown(int(n) ** 2 / r.ms(counted) / 1e6)])
    head = ["", "hits", "`count`, `fast`", "`count`, `filtered`", "`pairs`, `filtered`", "10^9 pairs/s"]
    return ["Many against many, all pairs in tiles, float, in ms, and 10^9 pairs a second of `count`, `filtered`:", ""] + \
        table(head, rows)


def families(r):
    lines = []
    for scalar in ("float", "double"):
        def name(a, family):
            return f"family/{a}/{scalar}/{family}"

        # `late` is a stage of float alone.
        stages = [s for s in STAGES if (s, scalar) != ("late", "double")]
        stages = [s for s in stages if r.counter(name("filtered", "random"), s) is not None]
        arithmetics = [a for a in ARITHMETICS if name(a, "random") in r.rows]
        rows = []
        for family in parts_of(r, "family", 3):
            rates = [rate(r, name(a, family)) for a in arithmetics]
            rows.append([family, f"{100 * r.counter(name('filtered', family), 'hits'):.1f}"] + [shown(v) for v in rates] +
                        [quotient(rates[0], rates[1])] + [share(r.counter(name("filtered", family), s)) for s in stages])
        which = ", and which stage of `filtered` decides them, in %:" if stages else ":"
        lines += [f"The families of `tests/support/triangle_families.hpp`, {scalar}, in million pairs a second{which}", ""]
        lines += table(["family", "hits, %"] + [f"`{a}`" for a in arithmetics] + ["time of `filtered` / `fast`"] +
                       [STAGES[s] for s in stages], rows)
    return lines


SPHERE_PARTS = (whole_scene, peers, floor, by_size, arithmetic, break_even)
TRIANGLE_PARTS = (one_against_many, call_floor, with_copy, many_against_many, pairs_one_by_one, families)


def report(r):
    machine = r.context.get("device")
    lines = []
    if machine:
        lines += [f"{machine}, CUDA {r.context['cuda'] // 1000}.{r.context['cuda'] % 1000 // 10}; pool at the end of the run: "
                  f"{r.context['pool_reserved']:,} bytes reserved, at most {r.context['pool_peak']:,} in use.", ""]
    is_triangles = any(name.startswith("family/") for name in r.rows)
    for part in TRIANGLE_PARTS if is_triangles else SPHERE_PARTS:
        lines += part(r)
    return "\n".join(lines).rstrip() + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--into", type=Path, metavar="PAGE.md")
    parser.add_argument("results", nargs="+", metavar="NAME=RESULTS.json")
    arguments = parser.parse_args()
    page = arguments.into.read_text(encoding="utf-8") if arguments.into else None
    for argument in arguments.results:
        name, _, path = argument.partition("=")
        if not path:
            parser.error(f"expected NAME=RESULTS.json, found {argument}")
        text = report(Results(path))
        if page is None:
            print(f"## {name}\n\n{text}")
            continue
        begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->"
        if begin not in page or end not in page:
            sys.exit(f"{arguments.into}: no lines {begin.strip()} and {end}")
        before, rest = page.split(begin, 1)
        page = before + begin + text + end + rest.split(end, 1)[1]
    if page is not None:
        arguments.into.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
