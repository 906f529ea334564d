# SPDX-License-Identifier: MIT
"""The tables and values of the pages, by name: TABLES and VALUES, of functions that take the results (bench/report.py)."""

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


def table(head, rows, left=1):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * left + " ---: |" * (len(head) - left)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def filled(head, rows):
    """A table of those columns that hold something."""
    keep = [i for i in range(len(head)) if any(row[i] for row in rows)]
    return table([head[i] for i in keep], [[row[i] for i in keep] for row in rows])


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


# --- speed against wrong answers --------------------------------------------------------------------------------------------

PREDICATES = {"triangle_triangle": "triangle, triangle", "segment_triangle": "segment, triangle",
              "sphere_triangle": "sphere, triangle", "capsule_triangle": "capsule, triangle",
              "box_triangle": "box, triangle", "plane_triangle": "plane, triangle"}
INPUTS = ("random", "touching", "lattice")


def trade(r, ns):
    rows = []
    for predicate, name in PREDICATES.items():
        for kind in INPUTS:
            for scalar in SCALARS:
                at = f"{predicate}/{kind}/{scalar}/"
                if at + "fast" not in r.rows:
                    continue
                times = [ns(r, at + a) for a in ARITHMETICS]
                wrong = [r.get(at + a, "wrong_per_million") for a in ARITHMETICS]
                rows.append([f"{name}, {kind}", scalar] + [shown(t) for t in times] + [quotient(times[1], times[0])] +
                            [whole(w) for w in wrong])
    head = ["pairs", "", "`fast`, ns", "`filtered`, ns", "`exact`, ns", "`filtered` / `fast`", "`fast` wrong",
            "`filtered` wrong",
            "`exact` wrong"]
    return table(head, rows, 2)


@in_table("trade-cpu")
def trade_cpu(results):
    r = results["cpu/trade"]
    pairs = r.get("triangle_triangle/random/float/fast", "pairs")
    return ["Time of a pair on one core, and wrong answers per million:", ""] + trade(r, lambda r, n: r.get(n, "ns")) + \
        made_on(r, f"; {pairs:,} pairs a row")


@in_table("trade-cuda")
def trade_cuda(results):
    r = results["cuda/trade"]
    pairs = r.get("triangle_triangle/random/float/fast", "pairs")
    return ["Time of a pair, all pairs of a row at once, one a thread; and wrong answers per million:", ""] + \
        trade(r, lambda r, n: r.get(n) and 1e6 * r.get(n) / pairs) + made_on(r, f"; {pairs:,} pairs a row")


@in_table("trade-stages")
def trade_stages(results):
    r = results["cpu/trade"]
    rows = []
    for predicate, name in PREDICATES.items():
        for scalar in SCALARS:
            decides = [share(r.get(f"{predicate}/{k}/{scalar}/filtered", "filter_decides") or 0) for k in INPUTS]
            last = [shown((r.get(f"{predicate}/{k}/{scalar}/resolve", "ns") or 0) / 1e3) for k in INPUTS]
            rows.append([name, scalar] + decides + last)
    head = ["pairs", ""] + [f"{k}, %" for k in INPUTS] + [f"`resolve`, {k}, us" for k in INPUTS]
    return ["The share of pairs that the floating-point filter decides, and the time of the last stage alone:", ""] + \
        table(head, rows, 2) + made_on(r)


@in_table("trade-registers")
def trade_registers(results):
    r = results["cuda/trade"]
    rows = []
    for predicate, name in PREDICATES.items():
        for scalar in SCALARS:
            cells = []
            for a in ARITHMETICS:
                at = f"{predicate}/random/{scalar}/{a}"
                cells += [whole(r.get(at, "registers")), whole(r.get(at, "local_bytes"))]
            rows.append([name, scalar] + cells)
    head = ["pairs", ""] + [f"`{a}`: {what}" for a in ARITHMETICS for what in ("registers", "bytes")]
    return ["What a thread of a kernel takes that calls `intersects`: registers, and bytes of stack and spills:", ""] + \
        table(head, rows, 2) + made_on(r)


# --- spheres against a mesh -------------------------------------------------------------------------------------------------

SPHERES, TRIANGLES, VERTICES = 1703244, 62976, 31488
LABELS = {"none": "brute force", "grid": "buckets (`make_grid`)", "bvh": "BVH (`make_bvh`)", "embree": "Embree"}


def policies(r):
    found = {name.split("/")[2] for name in r.names("all/")}
    return [policy for policy in ("serial", "openmp", "cuda") if policy in found]


def whole_scene(r):
    rows = []
    for policy in policies(r):
        for index in ("grid", "bvh", "embree"):
            if r.get(f"all/{index}/{policy}") is None:
                continue
            asked = [r.get(f"{answer}/{index}/{policy}/{SPHERES}") for answer in ("pairs", "unsorted", "count")]
            rows.append([f"{LABELS[index]}, {policy}", shown(r.get(f"build/{index}/{policy}"))] + [shown(t) for t in asked] +
                        [shown(r.get(f"all/{index}/{policy}")), whole(r.get(f"build/{index}/{policy}", "bytes")),
                         whole(r.get(f"all/{index}/{policy}", "pairs"))])
    return [f"The whole scene ({SPHERES:,} spheres, {TRIANGLES:,} triangles), in ms:", ""] + \
        table(["", "build", "query: sorted pairs", "unsorted", "count", "build and sorted pairs", "bytes of the index",
               "pairs"],
              rows)


def floor(r):
    pairs = r.get(f"pairs/bvh/{policies(r)[0]}/{SPHERES}", "pairs")
    least = 12 * (SPHERES + TRIANGLES + VERTICES) + 8 * pairs
    rate = r.get("floor/read", "bytes_per_second")
    rate = rate if rate else r.get("floor/read", "bytes") / r.get("floor/read") * 1e3
    line = (f"The floor of the query: spheres and mesh read once and pairs written once are {least / 1e6:.1f} MB. At the "
            f"{rate / 1e9:,.1f} GB/s that a read loop reached in the same run that takes {shown(least / rate * 1e3)} ms.")
    if r.get("floor/call") is not None:
        line += f" A call that does next to nothing and waits for a number takes {shown(r.get('floor/call'))} ms."
    return [line, ""]


def peers(r):
    ours, theirs = r.get("all/bvh/serial"), r.get("all/embree/serial")
    if ours is None or theirs is None:
        return []
    query = r.get(f"unsorted/bvh/serial/{SPHERES}") / r.get(f"unsorted/embree/serial/{SPHERES}")
    built = r.get("build/bvh/serial") / r.get("build/embree/serial")
    return [f"abut over Embree, one core, same run: build and sorted pairs **{ours / theirs:.2f}** "
            f"({ours / r.get('all_unsorted/embree/serial'):.2f} if Embree need not sort); build {built:.2f}, unsorted query "
            f"{query:.2f}.", ""]


def by_size(r):
    names = [(i, p) for i in ("none", "grid", "bvh") for p in policies(r) if r.names(f"pairs/{i}/{p}/")]
    sizes = sorted({int(n.split("/")[3]) for n in r.names("pairs/") if "embree" not in n})
    rows = []
    for size in sizes:
        counts = [r.get(f"pairs/{i}/{p}/{size}", "pairs") for i, p in names]
        rows.append([f"{size:,}", whole(next(c for c in counts if c is not None))] +
                    [shown(r.get(f"pairs/{i}/{p}/{size}")) for i, p in names])
    heads = [f"{LABELS[i].split(' (')[0]}, {p}" for i, p in names]
    return ["Query alone, sorted pairs, in ms, by the number of spheres:", ""] + table(["spheres", "pairs"] + heads, rows)


def arithmetic(r):
    rows = []
    kinds = sorted({tuple(n.split("/")[1:3]) for n in r.names("arithmetic/")}, key=lambda k: (k[0], k[1] != "float"))
    for index, scalar in kinds:
        times = [r.get(f"arithmetic/{index}/{scalar}/{a}") for a in ARITHMETICS]
        rows.append([f"{LABELS[index].split(' (')[0]}, {scalar}"] + [shown(t) for t in times] + [quotient(times[1],
                                                                                                          times[0])])
    policy = "cuda" if "cuda" in policies(r) else "serial"
    return [f"What certainty costs: query of the whole scene, sorted pairs, {policy}, in ms:", ""] + \
        table(["", "`fast`", "`filtered`", "`exact`", "`filtered` / `fast`"], rows)


def break_even(r):
    keys = sorted({tuple(map(int, n.split("/")[2:4])) for n in r.names("break_even/")}, key=lambda k: (k[1], k[0]))
    rows = []
    for spheres, triangles in keys:
        times = {i: r.get(f"break_even/{i}/{spheres}/{triangles}") for i in ("none", "grid", "bvh")}
        best = min(times, key=times.get)
        cells = [f"**{shown(t * 1e3)}**" if i == best else shown(t * 1e3) for i, t in times.items()]
        rows.append([f"{triangles:,}", f"{spheres:,}"] + cells)
    if not rows:
        return []
    policy = "cuda" if "cuda" in policies(r) else "serial"
    return [f"Small scenes, build and sorted pairs, {policy}, in us (the fastest in bold):", ""] + \
        table(["triangles", "spheres", "brute force", "buckets", "BVH"], rows, 2)


def spheres_mesh(r):
    return made_on(r) + whole_scene(r) + peers(r) + floor(r) + by_size(r) + arithmetic(r) + break_even(r)


@in_table("spheres-cpu")
def spheres_cpu(results):
    return spheres_mesh(results["cpu/spheres_mesh"])


@in_table("spheres-cuda")
def spheres_cuda(results):
    return spheres_mesh(results["cuda/spheres_mesh"])


@in_table("spheres-sources")
def spheres_sources(results):
    cpu, cuda, theirs = results["cpu/spheres_mesh"], results["cuda/spheres_mesh"], LITERATURE["lee_hsieh_2019"]
    n = 2**20
    rows = [[f"Lee and Hsieh: {name}", shown(ms), ""] for name, ms in theirs["whole_scene_ms"].items()]
    rows += [[f"Lee and Hsieh: {name}", "", shown(ms)] for name, ms in theirs["spheres_2_20_ms"].items()]
    for r in (cpu, cuda):
        for policy in policies(r):
            for index in ("grid", "bvh"):
                rows.append([f"abut: {LABELS[index]}, {policy}, with its build", shown(r.get(f"all/{index}/{policy}")), ""])
                rows.append([f"abut: {LABELS[index]}, {policy}, query alone",
                             shown(r.get(f"pairs/{index}/{policy}/{SPHERES}")),
                             shown(r.get(f"pairs/{index}/{policy}/{n}"))])
    return [f"The figures of the source, of its own machine ({theirs['machine']}), and ours, in ms:", ""] + \
        table(["", "whole scene", "2^20 spheres"], rows)


# --- triangles against triangles --------------------------------------------------------------------------------------------

STAGES = {"first": "filter", "late": "late", "word": "64 bits", "one_limb": "1 limb", "two_limbs": "2 limbs",
          "any_span": "any span"}
QUERIES = (("0", "any"), ("1", "count"), ("50", "count"), ("1", "any"), ("1", "pairs"), ("50", "pairs"), ("1", "unsorted"),
           ("50", "unsorted"))


def rate(r, name):
    """Million a second."""
    value = r.get(name, "items_per_second")
    return value / 1e6 if value else None


def pairs_one_by_one(r):
    there = [p for p in ("cgal", "fcl") if f"pair/{p}/double/1" in r.rows]
    names = {"cgal": "CGAL", "fcl": "FCL"}
    rows = []
    for scalar in SCALARS:
        for percent in sorted(r.parts("pair/", 3), key=float):
            rates = {a: rate(r, f"pair/{a}/{scalar}/{percent}") for a in ARITHMETICS}
            # A peer's name says double: that is what it works in, on the same numbers as float.
            theirs = [rate(r, f"pair/{p}/double/{percent}") if scalar == "float" else None for p in there]
            rows.append([scalar, f"{100 * r.get(f'pair/filtered/{scalar}/{percent}', 'hits'):.1f}"] +
                        [shown(v) for v in rates.values()] + [quotient(rates["fast"], rates["filtered"])] +
                        [shown(v) for v in theirs] + [quotient(rates["filtered"], v) for v in theirs])
    head = ["", "hits, %"] + [f"`{a}`" for a in ARITHMETICS] + ["time of `filtered` / `fast`"]
    head += [names[p] for p in there] + [f"`filtered` over {names[p]}" for p in there]
    lines = ["Pairs decided one by one, in million a second:", ""] + table(head, rows)
    if r.get("pair/filtered/float/1", "registers") is None:
        return lines
    rows = [[f"`{a}`, {s}"] + [whole(r.get(f"pair/{a}/{s}/1", key)) for key in ("registers", "local_bytes")]
            for s in SCALARS for a in ARITHMETICS]
    return lines + ["What a thread of these kernels takes:", ""] + \
        table(["", "registers", "bytes of local memory (stack and spills)"], rows)


def one_against_many(r):
    lines = []
    for policy in ("serial", "openmp", "cuda"):
        for scalar in SCALARS:
            sizes = [n.split("/")[3] for n in r.names(f"read/{scalar}/{policy}/")]
            if not sizes:
                continue

            def name(q, a, percent, n):
                return f"one/{q}/{a}/{scalar}/{percent}/{policy}/{n}"

            asked = [(q, a, p) for p, q in QUERIES for a in ARITHMETICS if name(q, a, p, sizes[0]) in r.rows]
            rows = []
            for n in sizes:
                read = r.get(f"read/{scalar}/{policy}/{n}")
                rows.append([f"{int(n):,}", shown(read)] + [shown(r.get(name(*what, n))) for what in asked] +
                            [quotient(r.get(name(q, "filtered", p, n)), read) for q, p in (("any", "0"), ("count", "1"))])
            head = ["triangles", "read"] + [f"`{q}`, {p} % hits, `{a}`" for q, a, p in asked]
            lines += [f"One triangle against many, {policy}, {scalar}, in ms; the last two columns are `filtered`, with no "
                      "hit and with 1 %, over a loop that only reads the same bytes:", ""]
            lines += table(head + ["`any` / read", "`count` / read"], rows)
    return lines


def call_floor(r):
    if r.get("floor/call") is None:
        return []
    speed = r.get("floor/read", "bytes") / r.get("floor/read") / 1e6
    return [f"In the same run a GiB was read at {speed:,.0f} GB/s, and a call that does next to nothing and waits for a "
            f"number took {shown(r.get('floor/call'))} ms: no query is faster.", ""]


def with_copy(r):
    rows = []
    for name in r.names("one/copied/"):
        _, _, _, scalar, _, policy, n = name.split("/")
        times = [r.get(name.replace("copied", "count", 1)), r.get(f"copy/{scalar}/{policy}/{n}"), r.get(name)]
        rows.append([f"{int(n):,}", scalar] + [shown(t) for t in times] + [quotient(times[2], times[1])])
    if not rows:
        return []
    head = ["triangles", "", "`count`, resident", "copy alone", "copy, check and `count`", "all / copy"]
    return ["With the copy from page-locked host memory, and the check of every coordinate, before each `count` (1 % hits, "
            "`filtered`), in ms:", ""] + table(head, rows, 2)


def many_against_many(r):
    rows = []
    for policy in ("serial", "openmp", "cuda"):
        names = [name for name in r.names("many/") if f"/{policy}/" in name]
        for n in dict.fromkeys(name.split("/")[5] for name in names):
            counted = f"many/count/filtered/float/{policy}/{n}"
            times = [r.get(f"many/{what}/float/{policy}/{n}") for what in ("count/fast", "count/filtered", "pairs/filtered")]
            rows.append([f"{int(n):,} x {int(n):,}, {policy}", whole(r.get(counted, "found"))] + [shown(t) for t in times] +
                        [shown(int(n) ** 2 / r.get(counted) / 1e6)])
    head = ["", "hits", "`count`, `fast`", "`count`, `filtered`", "`pairs`, `filtered`", "10^9 pairs/s"]
    return ["Many against many, all pairs in tiles, float, in ms, and 10^9 pairs a second of `count`, `filtered`:", ""] + \
        table(head, rows)


def families(r):
    lines = []
    for scalar in SCALARS:
        def name(a, family):
            return f"family/{a}/{scalar}/{family}"

        # `late` is a stage of float alone.
        stages = [s for s in STAGES if (s, scalar) != ("late", "double")]
        stages = [s for s in stages if r.get(name("filtered", "random"), s) is not None]
        there = [a for a in ARITHMETICS if name(a, "random") in r.rows]
        rows = []
        for family in r.parts("family/", 3):
            rates = [rate(r, name(a, family)) for a in there]
            rows.append([family, f"{100 * r.get(name('filtered', family), 'hits'):.1f}"] + [shown(v) for v in rates] +
                        [quotient(rates[0], rates[1])] + [share(r.get(name("filtered", family), s)) for s in stages])
        which = ", and which stage of `filtered` decides them, in %:" if stages else ":"
        lines += [f"The families of `tests/support/triangle_families.hpp`, {scalar}, in million pairs a second{which}", ""]
        lines += table(["family", "hits, %"] + [f"`{a}`" for a in there] + ["time of `filtered` / `fast`"] +
                       [STAGES[s] for s in stages], rows)
    return lines


def triangles(r):
    return made_on(r) + one_against_many(r) + call_floor(r) + with_copy(r) + many_against_many(r) + pairs_one_by_one(r) + \
        families(r)


@in_table("triangles-cpu")
def triangles_cpu(results):
    return triangles(results["cpu/triangles"])


@in_table("triangles-cuda")
def triangles_cuda(results):
    return triangles(results["cuda/triangles"])


@in_table("triangles-sources")
def triangles_sources(results):
    cpu, cuda, theirs = results["cpu/triangles"], results["cuda/triangles"], LITERATURE["maffina_2012"]
    rows = []
    for n in theirs["one_core_ms"]:
        rows.append([f"{int(n):,}", shown(theirs["one_core_ms"][n]), shown(theirs["gpu_ms"][n]),
                     shown(cpu.get(f"one/count/filtered/float/1/serial/{n}")),
                     shown(cuda.get(f"one/count/filtered/float/1/cuda/{n}")),
                     shown(cuda.get(f"one/copied/filtered/float/1/cuda/{n}"))])
    return [f"One triangle against many, of the source ({theirs['machine']}) and here, float, `filtered`, in ms:", ""] + \
        table(["triangles", "source, one core", "source, GPU", "here, one core", "here, device", "here, with the copy"],
              rows)


# --- ties -------------------------------------------------------------------------------------------------------------------

@in_table("ties-cpu")
def ties_cpu(results):
    r = results["cpu/ties"]
    lines = []
    for what, title, unit in (("pair", "Pairs decided one by one, ns of processor time for a pair", 1),
                              ("count", "Whole queries with two trees, ms of processor time", 1e-6)):
        rows = []
        for name in r.parts(f"{what}/float/", 2):
            cells = []
            for scalar in SCALARS:
                at = f"{what}/{scalar}/{name}"
                cells += [shown(r.get(at, a) * unit) for a in ARITHMETICS] + [quotient(r.get(at, "filtered"),
                                                                                       r.get(at, "fast"))]
            left = [share(r.get(f"{what}/float/{name}", "filter_leaves"))] if what == "pair" else []
            rows.append([name] + left + cells)
        head = ["pairs"] + (["filter leaves, %"] if what == "pair" else [])
        head += [f"{s}: {a}" for s in SCALARS for a in ("`fast`", "`filtered`", "`exact`", "`filtered` / `fast`")]
        lines += [f"{title}:", ""] + table(head, rows)
    return lines + made_on(r)


@in_table("ties-cuda")
def ties_cuda(results):
    r = results["cuda/ties"]
    lines = []
    for what, title, unit in (("count", "Whole queries with two trees, ms", 1),
                              ("pair", "Pairs decided one by one in a plain kernel, ms for all", 1)):
        rows = []
        for name in r.parts(f"{what}/fast/float/", 3):
            cells = []
            for scalar in SCALARS:
                times = [r.get(f"{what}/{a}/{scalar}/{name}") for a in ARITHMETICS]
                cells += [shown(t) for t in times] + [quotient(times[1], times[0])]
            rows.append([name, whole(r.get(f"{what}/filtered/float/{name}",
                                           "found" if what == "count" else "items"))] + cells)
        head = ["scene", "pairs that touch"] if what == "count" else ["family", "pairs"]
        head += [f"{s}: {a}" for s in SCALARS for a in ("`fast`", "`filtered`", "`exact`", "`filtered` / `fast`")]
        lines += [f"{title}:", ""] + table(head, rows)
    return lines + made_on(r)


# --- nearest points and validation ------------------------------------------------------------------------------------------

@in_table("nearest-cpu")
def nearest_cpu(results):
    r = results["cpu/nearest"]
    lines = []
    for question, title, names in (
            ("nearest", "the nearest triangle", {"embree": "Embree, point queries", "bvh": "`make_bvh`",
                                                 "sah": "`make_bvh`, `sah`",
                                                 "wide_sah": "`wide`, of a `sah` tree",
                                                 "oriented_sah": "`oriented`, of a `sah` tree"}),
            ("nearest_vertex", "the nearest vertex", {"nanoflann": "nanoflann", "bvh": "`make_bvh` of `vertices(mesh)`",
                                                      "sah": "the same, `sah`"})):
        points = min(int(n) for n in r.parts(f"{question}/", 3))
        peer = r.get(f"{question}/{next(iter(names))}/serial/{points}")
        rows = []
        for index, name in names.items():
            ms = r.get(f"{question}/{index}/serial/{points}")
            if ms is not None:
                rows.append([name, shown(ms), shown(points / ms / 1e3), quotient(ms, peer)])
        lines += [f"For {points:,} points {title}, one core, ms:", ""] + \
            table(["", "ms", "million points a second", "over the peer"], rows)
    return lines + made_on(r)


@in_table("nearest-cuda")
def nearest_cuda(results):
    r = results["cuda/nearest"]
    names = {"bvh": "`make_bvh`", "ploc": "`ploc`", "quantised": "`quantised`", "oriented": "`oriented`, of `ploc`"}
    rows = [[f"{int(n):,}"] + [shown(r.get(f"nearest/{i}/cuda/{n}")) for i in names] for n in r.parts("nearest/", 3)]
    floor_ms = r.get(f"nearest/bvh/cuda/{SPHERES}", "floor_ms")
    return ["For so many points the nearest triangle, ms:", ""] + table(["points"] + list(names.values()), rows) + \
        [f"To read the scene and to write the answers once takes {shown(floor_ms)} ms at the speed of a read loop.", ""] + \
        made_on(r)


@in_table("validate-cpu")
def validate_cpu(results):
    r = results["cpu/validate"]
    rows = []
    for n in r.parts("validate/in_order/float/serial/", 4):
        for order, name in (("in_order", "of the torus"), ("random", "random")):
            sort, one = r.get(f"sort/{order}/serial/{n}"), r.get(f"validate/{order}/float/serial/{n}")
            rows.append([f"{int(n):,}", name, shown(sort), shown(r.get(f"half_edges/{order}/serial/{n}")), shown(one),
                         quotient(one, sort, 1), shown(r.get(f"validate/{order}/double/serial/{n}")),
                         shown(r.get(f"validate/{order}/float/openmp/{n}"))])
    return ["ms; one core, and in the last column threads:", ""] + \
        table(["triangles", "order", "sort alone", "half-edges", "`validate`, float", "`validate` / sort", "double",
               "float, `openmp`"], rows, 2) + made_on(r, f"; {r.context.get('threads', 'all')} threads")


@in_table("validate-cuda")
def validate_cuda(results):
    r = results["cuda/validate"]
    rows = []
    for n in r.parts("validate/in_order/float/cuda/", 4):
        for order, name in (("in_order", "of the torus"), ("random", "random")):
            rows.append([f"{int(n):,}", name] + [shown(r.get(f"{at}/cuda/{n}")) for at in (
                f"half_edges/{order}", f"validate/{order}/float", f"validate/{order}/double", f"uploaded/{order}")])
    return ["Data resident, ms; in the last column the mesh is uploaded first, from pageable memory:", ""] + \
        table(["triangles", "order", "half-edges", "`validate`, float", "double", "float, with the upload"], rows,
              2) + made_on(r)


# --- mesh against mesh ------------------------------------------------------------------------------------------------------

@in_table("meshes-cpu")
def meshes_cpu(results):
    r, layouts = results["cpu/meshes"], results["cpu/builders"]
    rows = []
    for answer in ("pairs", "unsorted", "count", "boxes", "contacts"):
        build = shown(r.get("build/bvh/serial")) if answer == "pairs" else ""
        name = "the walk alone" if answer == "boxes" else answer
        rows.append([f"BVH, {name}", build, shown(r.get(f"{answer}/baked/serial")), shown(r.get(f"{answer}/posed/serial")),
                     whole(r.get(f"{answer}/baked/serial", "pairs"))])
    rows.append(["SAH, wide, pairs",
                 f"{shown(layouts.get('build/sah/serial'))} + {shown(layouts.get('convert/wide/sah/serial'))}",
                 shown(layouts.get("pairs/baked/sah/wide")), shown(layouts.get("pairs/posed/sah/wide")),
                 whole(layouts.get("pairs/baked/sah/wide", "pairs"))])
    for peer, name in (("embree_low", "Embree, low quality"), ("embree_medium", "Embree, medium quality"),
                       ("fcl_obb", "FCL, oriented boxes"), ("bullet_gimpact", "Bullet, GImpact"),
                       ("cgal", "CGAL, AABB tree")):
        at = f"unsorted/{peer}/serial"
        if r.get(at) is not None:
            rows.append([f"{name}, unsorted", shown(r.get(f"build/{peer}/serial")), shown(r.get(at)), "",
                         whole(r.get(at, "pairs"))])
    return table(["ms", "build of one tree", "baked", "posed", "pairs"], rows) + made_on(r)


ANY_SCENES = {"hit": "hit", "graze": "graze", "near_miss": "near miss", "shells": "shells"}


@in_table("any")
def any_scenes(results):
    r = results["cpu/any"]
    rows = []
    for tree, name in (("linear", "linear BVH"), ("sah", "SAH"), ("sah_wide", "SAH, wide"),
                       ("sah_oriented", "SAH, oriented"),
                       ("sah_kdop18", "SAH, 18 planes"), ("embree_low", "Embree, low quality"),
                       ("embree_medium", "Embree, medium quality"), ("fcl_obb", "FCL, oriented boxes")):
        for kind in ("baked", "posed"):
            times = [r.get(f"any/{s}/{kind}/{tree}") for s in ANY_SCENES]
            if times[0] is not None:
                rows.append([f"{name}, {kind}"] + [shown(None if t is None else 1e3 * t) for t in times])
    pairs = [whole(r.get(f"any/{s}/baked/linear", "pairs")) for s in ANY_SCENES]
    return table(["us"] + list(ANY_SCENES.values()), [["pairs that touch"] + pairs] + rows) + made_on(r)


TRAVERSALS = {"one_first": "one first", "larger_first": "larger first", "alternate": "alternate",
              "both_at_once": "both at once",
              "breadth_first": "breadth first, from the roots"}


@in_table("descents")
def descents(results):
    r = results["cpu/descents"]
    builders = r.parts("walk/", 1)
    rows = [[name] + [c for b in builders for c in (whole(r.get(f"walk/{b}/{t}", "boxes")), shown(r.get(f"walk/{b}/{t}")))]
            for t, name in TRAVERSALS.items()]
    head = ["descend"] + [c for b in builders for c in (f"`{b}`: boxes", "ms")]
    return table(head, rows) + made_on(r, f"; {whole(r.get('walk/sah/both_at_once', 'leaves'))} pairs of leaves from each")


@in_table("patches")
def patches(results):
    r = results["cpu/descents"]
    names = [t for t in TRAVERSALS if t != "breadth_first"]
    rows = [[f"{int(n):,}"] + [shown(1e3 * r.get(f"patch/{n}/{t}")) for t in names] for n in r.parts("patch/", 1)]
    return table(["triangles of the patch, us"] + [TRAVERSALS[t] for t in names], rows) + made_on(r)


@in_table("depths")
def depths(results):
    r, theirs = results["cpu/descents"], LITERATURE["backman_2011"]["box_tests_per_depth_345944"]
    at = r.parts("depth/linear/", 2)
    rows = [[d, whole(theirs.get(d) and float(theirs[d])), whole(r.get(f"depth/linear/{d}", "boxes")),
             whole(r.get(f"depth/sah/{d}", "boxes"))]
            for d in at]
    rows.append(["all", whole(float(sum(theirs.values()))), whole(r.get("walk/linear/both_at_once", "boxes")),
                 whole(r.get("walk/sah/both_at_once", "boxes"))])
    return table(["depth", "source, from depth 6", "here, `linear`", "here, `sah`"], rows) + made_on(r)


@in_table("meshes-cuda")
def meshes_cuda(results):
    r = results["cuda/meshes"]
    asked = {"pairs": "pairs, sorted", "unsorted": "unsorted", "fast_unsorted": "`fast`, unsorted", "count": "count",
             "any": "any",
             "boxes": "box pairs alone", "contacts": "contacts"}
    rows = [[kind] + [shown(r.get(f"{q}/{kind}/cuda")) for q in asked] for kind in ("baked", "posed")]
    near = ["pairs", "unsorted", "fast", "count", None, "boxes", None]
    beside = [shown(r.get(f"near/{q}/cuda")) if q else "" for q in near]
    rows.append([f"nearly on itself, {whole(r.get('near/pairs/cuda', 'pairs'))} pairs"] + beside)
    lines = table(["ms"] + list(asked.values()), rows)
    lines += [f"An empty call takes {shown(r.get('floor/call'))} ms; sorted pairs with one of the trees built in the call "
              f"{shown(r.get('pairs/baked_with_build/cuda'))} ms.", ""]
    rows = [[n.split("/", 1)[1].removesuffix("/cuda").replace("_", " ").replace("/", ", from depth "),
             shown(r.get(n))] for n in r.names("traversal/")]
    lines += ["By other traversals, baked and unsorted:", ""] + table(["traversal", "ms"], rows)
    rows = [[n.split("/")[1], shown(r.get(n)), whole(r.get(n, "pairs"))] for n in r.names("batch/") if "one_by_one" not in n]
    rows.append([f"{rows[-1][0]}, one by one", shown(r.get("batch/1000/one_by_one/cuda")),
                 whole(r.get("batch/1000/one_by_one/cuda", "pairs"))])
    lines += ["Posed pairs of a small mesh in one call:", ""] + table(["pairs of meshes", "ms", "pairs of triangles"], rows)
    rows = [[f"{int(n):,}", shown(r.get(f"build/bvh/cuda/{n}")),
             shown(r.get(f"sort/cuda/{n}"))] for n in r.parts("build/bvh/cuda/", 3)]
    return lines + ["Build of a linear BVH:", ""] + table(["triangles", "build, ms", "sort of its codes alone"], rows) + \
        made_on(r, f"; {r.context.get('mesh', 'the mesh above')}" if "mesh" in r.context else "")


SIZES = ("2766", "27674", "138376", "345944")


def of_size(results, kind, n):
    return results[f"{kind}/meshes" if n == SIZES[-1] else f"{kind}/meshes_{n}"]


@in_table("sizes")
def sizes(results):
    lines = []
    for title, phase, rows_of in (
            ("Middle phase, the walk of two trees, and the build of one, in ms", "middle", (
                ("walk: one core", "cpu", "boxes/posed/serial"), ("walk: device", "cuda", "boxes/posed/cuda"),
                ("build: one core", "cpu", "build/bvh/serial"), ("build: device", "cuda", "build/bvh/cuda/{}"))),
            ("Near phase, in ms; of ours both phases together", "near", (
                ("pairs: one core", "cpu", "pairs/posed/serial"), ("pairs: device", "cuda", "pairs/posed/cuda"),
                ("contacts: one core", "cpu", "contacts/posed/serial"), ("contacts: device", "cuda", "contacts/posed/cuda")))):
        rows = []
        for n in SIZES:
            theirs = LITERATURE["backman_2011"]["sizes"][n]
            rows.append([f"{int(n):,}", shown(theirs[f"{phase}_cpu_ms"]), shown(theirs[f"{phase}_gpu_ms"])] +
                        [shown(of_size(results, kind, n).get(name.format(n))) for _, kind, name in rows_of])
        lines += [f"{title}:", ""] + filled(["triangles", "source: processor", "source: GPU"] + [head for head, _,
                                                                                                 _ in rows_of], rows)
    return lines + made_on(results["cpu/meshes"]) + made_on(results["cuda/meshes"])


# --- reduction of contacts --------------------------------------------------------------------------------------------------

def kept(r, name):
    return f"{r.get(name, 'share'):.3f} ({r.get(name, 'worst'):.3f})"


@in_table("reduction")
def reduction(results):
    r = results["cpu/reduce_contacts"]
    rows = [[f"{scene.replace('_', ' ')}, {whole(r.get(f'{scene}/binning/4', 'contacts'))} contacts", method] +
            [kept(r, f"{scene}/{method}/{n}") for n in (4, 8, 16, 32)] for scene in r.parts("", 0) for method in ("binning",
                                                                                                                  "extremes")]
    return table(["scene", "method", "4", "8", "16", "32"], rows, 2) + made_on(r)


@in_table("reduction-bins")
def reduction_bins(results):
    r = results["cpu/reduce_contacts"]
    rows = [[name.split("/")[0].replace("_", " "), name.split("/")[2], whole(r.get(name, "kept")),
             kept(r, name)] for name in r.rows if "/bins/" in name]
    return table(["scene", "bins", "contacts", "share kept (worst loss)"], rows) + made_on(r)


# --- builders and layouts ---------------------------------------------------------------------------------------------------

BUILDERS = ("linear", "mean_split", "sah", "ploc")


@in_table("builders")
def builders(results):
    r = results["cpu/builders"]
    rows = []
    for b in BUILDERS:
        at, wide = f"pairs/baked/{b}/standard", f"pairs/baked/{b}/wide"
        rows.append([f"`{b}`", shown(r.get(f"build/{b}/serial")), shown(r.get(f"build/{b}/openmp")),
                     shown(r.get(f"refit/{b}/serial")),
                     shown(r.get(f"convert/wide/{b}/serial"))] +
                    [f"{r.get(at, key):.1f} / {r.get(wide, key):.1f}" for key in ("sah_cost", "mean_depth",
                                                                                  "greatest_depth")])
    for quality in ("low", "medium"):
        if r.get(f"build/embree_{quality}/serial") is not None:
            rows.append([f"Embree, {quality} quality", shown(r.get(f"build/embree_{quality}/serial"))] + [""] * 6)
    return table(["ms", "build", "`openmp`", "refit", "conversion to `wide`", "`sah_cost`: as built / `wide`", "mean depth",
                  "greatest depth"], rows) + made_on(r, f"; {r.context.get('threads')} threads for `openmp`")


@in_table("layouts")
def layouts_queries(results):
    r = results["cpu/builders"]
    rows = []
    for b in BUILDERS:
        for layout in ("standard", "quantised", "leafless", "wide"):
            at = f"{b}/{layout}"
            if r.get(f"pairs/baked/{at}") is not None:
                rows.append([f"`{b}`, `{layout}`"] + [shown(r.get(f"{q}/{at}")) for q in ("unsorted/baked", "pairs/baked",
                                                                                          "pairs/posed",
                                                                                         "one_sided")] +
                            [f"{r.get(f'pairs/baked/{at}', 'bytes_per_shape'):.0f}"])
    for quality in ("low", "medium"):
        if r.get(f"unsorted/embree_{quality}/serial") is not None:
            rows.append([f"Embree, {quality} quality", shown(r.get(f"unsorted/embree_{quality}/serial"))] + [""] * 4)
    return table(["ms", "baked, unsorted", "baked", "posed", "bare", "bytes a triangle"], rows) + made_on(r)


@in_table("volumes")
def volumes(results):
    r, any_r = results["cpu/builders"], results["cpu/any"]
    rows = []
    for name, in_any in (("standard", "sah"), ("wide", "sah_wide"), ("oriented", "sah_oriented"), ("kdop18", "sah_kdop18"),
                         ("sphere", None)):
        cells = [shown(r.get(f"convert/{name}/sah/serial")), shown(r.get(f"unsorted/baked/sah/{name}")),
                 shown(r.get(f"pairs/posed/sah/{name}"))]
        for s in ANY_SCENES:
            pair = [in_any and any_r.get(f"any/{s}/{kind}/{in_any}") for kind in ("baked", "posed")]
            cells.append(" / ".join(shown(1e3 * t) for t in pair) if all(pair) else "")
        rows.append([f"`{name}`"] + cells)
    return table(["", "conversion, ms", "pairs, baked, unsorted, ms", "posed, ms"] + [f"any, {s}, baked / posed, us" for s in
                                                                                    ANY_SCENES.values()], rows) + made_on(r)


@in_table("builders-cuda")
def builders_cuda(results):
    r = results["cuda/builders"]
    scenes = (("mesh", f"{whole(r.get('build/mesh', 'items'))} triangles"),
              ("random", f"{whole(r.get('build/random', 'items'))}"))
    rows = []
    for at, name in (("build/{}", "build, `linear`"), ("build/ploc/{}", "build, `ploc`"),
                     ("build_and_refit_first/{}", "build, and the first refit"),
                     ("refit/{}", "any later refit"), ("convert/quantised/{}", "conversion, `quantised`"),
                     ("convert/leafless/{}", "conversion, `leafless`")):
        rows.append([name] + [shown(r.get(at.format(s))) for s, _ in scenes])
    lines = table(["ms"] + [name for _, name in scenes], rows)
    rows = [[f"`{n.split('/')[1]}`", shown(r.get(n)), f"{r.get(n, 'sah_cost'):.1f}",
             whole(r.get(n, "bytes_per_shape"))] for n in r.names("pairs/")]
    return lines + ["Sorted pairs of the mesh and its turned copy, ms:", ""] + \
        table(["", "ms", "`sah_cost`", "bytes a triangle"], rows) + made_on(r)


# --- fronts -----------------------------------------------------------------------------------------------------------------

def fronts(r):
    rows = []
    for name, row in r.rows.items():
        if "without_ms" in row:
            scene, step, query = name.split("/", 2)
            rows.append([scene, step, query, shown(row["without_ms"]), shown(row["ms"]),
                         quotient(row["ms"], row["without_ms"]),
                         whole(row["items"]), whole(row["opened"])])
    return table(["scene", "step", "query", "without, ms", "with, ms", "with / without", "items", "opened in a frame"], rows,
                 3) + made_on(r)


@in_table("fronts-cpu")
def fronts_cpu(results):
    return fronts(results["cpu/fronts"])


@in_table("fronts-cuda")
def fronts_cuda(results):
    return fronts(results["cuda/fronts"])


# --- features in motion -----------------------------------------------------------------------------------------------------

KINDS = {"vertex_face": "vertex-face", "edge_edge": "edge-edge"}


@in_table("motion-cpu")
def motion_cpu(results):
    r = results["cpu/motion"]
    rows = []
    for scene in r.parts("stage/", 1):
        for scalar in SCALARS:
            def at(stage):
                return f"stage/{scene}/{scalar}/{stage}"
            rows.append([scene, scalar] + [shown(r.get(at(s))) for s in ("build", "refit", "walk", "search", "self_impacts",
                        "self_impacts_conservative", "self_impacts_fast", "first_self_impact")] +
                        [whole(r.get(at("walk"), "candidates"))] +
                        [whole(r.get(at(s), "impacts")) for s in ("self_impacts", "self_impacts_conservative",
                                                                  "self_impacts_fast")])
    return table(["scene", "ms", "build", "refit", "walk", "walk, decide and time", "`self_impacts`", "with `conservative`",
                  "with `fast`",
                  "`first_self_impact`", "candidates", "impacts", "by `conservative`", "by `fast`"], rows, 2) + made_on(r)


@in_table("motion-arithmetics")
def motion_arithmetics(results):
    r = results["cpu/motion"]
    rows = []
    for scene in r.parts("stage/", 1):
        for scalar in SCALARS:
            at = [f"stage/{scene}/{scalar}/self_impacts{a}" for a in ("", "_conservative", "_fast")]
            rows.append([scene, scalar] + [whole(r.get(n, "impacts")) for n in at] + [shown(r.get(n)) for n in at])
    return table(["scene", "", "found by `filtered`", "`conservative`", "`fast`", "`filtered`, ms", "`conservative`",
                  "`fast`"], rows, 2) + made_on(r)


@in_table("motion-tests")
def motion_tests(results):
    r = results["cpu/motion"]
    rows = []
    for scene in r.parts("time/", 1):
        for scalar in SCALARS:
            for kind, name in KINDS.items():
                at = f"time/{scene}/{scalar}/{kind}/"
                if r.get(at + "filtered") is None:
                    continue
                cells = [shown(rate(r, at + a)) for a in ("fast", "conservative", "filtered", "exact")]
                cells += [whole(r.get(at + a, key)) for a in ("fast", "conservative") for key in ("missed_per_million",
                                                                                                  "phantom_per_million")]
                rows.append([scene, scalar, name] + cells)
    return table(["scene", "", "", "`fast`", "`conservative`", "`filtered`", "`exact`", "`fast`: missed", "invented",
                  "`conservative`: missed", "invented"], rows, 3) + made_on(r, "; the right half is per million candidates")


@in_table("motion-looks")
def motion_looks(results):
    r = results["cpu/motion"]
    keys = {"no_by_volume": "no by volume", "no_by_direction": "no by direction", "no_by_areas": "no by areas", "yes": "yes",
            "open": "open",
            "open_late": "open after halves", "no_time": "time not found in registers"}
    rows = []
    for name in r.names("look/"):
        _, scene, scalar, kind = name.split("/")
        rows.append([scene, scalar, KINDS[kind], whole(r.get(name, "candidates"))] + [share(r.get(name, k)) for k in keys])
    return table(["scene", "", "%", "candidates"] + list(keys.values()), rows, 3) + made_on(r)


def motion_scenes(r):
    """SCENE/SCALAR of the real scenes, in the order of the program."""
    return [f"{a}/{b}" for a,
            b in dict.fromkeys(tuple(n.split("/")[:2]) for n in r.rows if "/" in n and n.endswith("/frame"))]


@in_table("motion-cuda")
def motion_cuda(results):
    r = results["cuda/motion"]
    rows = []
    for s in motion_scenes(r):
        rows.append([s, whole(r.get(f"{s}/build", "faces"))] +
                    [whole(r.get(f"{s}/{k}/walk/static_partition", "candidates")) for k in KINDS] +
                    [whole(r.get(f"{s}/impacts", "impacts"))] + [shown(r.get(f"{s}/{q}")) for q in ("build", "refit", "walk",
                                                                                                    "impacts", "frame",
                    "halves/from_roots", "halves/from_fronts")] + [whole(r.get(f"{s}/same", "same"))])
    return table(["scene, ms", "faces", "vertex-face candidates", "edge-edge", "impacts", "build", "refit", "walk",
                  "`self_impacts`", "frame",
                  "two halves, from roots", "from fronts", "100 runs: same bits"], rows) + made_on(r)


@in_table("motion-cuda-tests")
def motion_cuda_tests(results):
    r = results["cuda/motion"]
    rows = []
    for s in motion_scenes(r):
        for kind, name in KINDS.items():
            cells = []
            for a in ("fast", "filtered", "conservative"):
                at = f"{s}/{kind}/{a}/"
                second = shown(r.get(at + "second"))
                cells += [shown(r.get(at + "first")) + (f" + {second}" if second else ""),
                          whole(r.get(at + "first", "left")),
                          whole(r.get(at + "second", "found"))]
            rows.append([s, name] + cells)
    head = [f"`{a}`: {what}" for a in ("fast", "filtered", "conservative") for what in ("first + second, ms", "left",
                                                                                        "found")]
    return table(["scene", ""] + head, rows, 2) + made_on(r)


SCHEDULES = ("shared_list", "static_partition", "work_stealing", "lazy_work_stealing")


@in_table("motion-schedules")
def motion_schedules(results):
    r = results["cuda/motion"]
    rows = []
    for s in motion_scenes(r):
        for kind, name in KINDS.items():
            at = f"{s}/{kind}/walk/"
            lazy, steal, dealt = (r.rows[at + k] for k in ("lazy_work_stealing", "work_stealing", "static_partition"))
            rows.append([s, name] + [shown(r.get(at + k)) for k in SCHEDULES] +
                        [f"{whole(dealt['balances'])} / {dealt['idle_share']:.2f}",
                         f"{whole(steal['steals'])} / {steal['idle_share']:.2f}",
                         f"{whole(lazy['steals'])} / {whole(lazy['transfers'])} / {lazy['idle_share']:.2f}"])
    return table(["scene", "ms"] + [k.replace("_", " ") for k in SCHEDULES] + ["static: balances / idle",
                                                                               "stealing: steals / idle",
                 "lazy: steals / transfers / idle"], rows, 2) + made_on(r)


@in_table("motion-scaling")
def motion_scaling(results):
    r = results["cuda/motion"]
    rows = []
    for s in motion_scenes(r):
        for kind, name in KINDS.items():
            parts = [r.get(f"{s}/{kind}/walk/part/{n}") for n in (8, 4, 2)] + [r.get(f"{s}/{kind}/walk/static_partition")]
            rows.append([s, name] + [shown(t) for t in parts] + [quotient(parts[0], parts[-1], 1)])
    return table(["scene", "ms", "1/8 of the blocks", "1/4", "1/2", "all", "gain"], rows, 2) + made_on(r)


@in_table("motion-sources")
def motion_sources(results):
    r = results["cuda/motion"]
    rows = []
    for s in motion_scenes(r):
        scene = s.split("/")[0]
        theirs = LITERATURE["dasilva_2013"]["models"].get(scene)
        if theirs:
            ccd = LITERATURE["scalable_ccd"]["models"].get(scene, {})
            both = [" / ".join(shown(theirs.get(f"{w}_{g}_ms")) or "-" for g in ("gts450", "gt520")) for w in ("stealing",
                                                                                                               "gproximity")]
            rows.append([scene] + both + [whole(theirs["front_nodes"]), shown(ccd.get("best_broad_phase_ms")),
                                          shown(ccd.get("earliest_time_ms")),
                                          shown(r.get(f"{s}/walk")), shown(r.get(f"{s}/frame")),
                                          whole(r.get(f"{s}/halves/from_fronts", "nodes"))])
    return table(["scene, ms", "da Silva 2013, lazy work stealing, GTS 450 / GT 520", "its gProximity, the same",
                  "its front nodes",
                  "Scalable-CCD: best broad phase", "earliest time alone", "walk here", "frame here", "front nodes here"],
                 rows) + made_on(r)


@in_table("flying")
def flying(results):
    r = results["cuda/motion_flying"]
    theirs = {"64": "BART64", "256": "BART256", "1024": "BART1024", "4096": "BART4096"}
    rows = []
    for s in motion_scenes(r):
        source = LITERATURE["dasilva_2013"]["models"].get(theirs.get(s.split("/")[0].rsplit("_", 1)[1]), {})
        rows.append([whole(r.get(f"{s}/build", "faces"))] + [shown(r.get(f"{s}/{q}")) for q in ("refit", "walk", "impacts",
                                                                                                "frame")] +
                    [whole(r.get(f"{s}/impacts", "impacts")), whole(r.get(f"{s}/halves/from_fronts", "nodes")),
                     shown(source.get("stealing_gts450_ms")), whole(source.get("front_nodes"))])
    return table(["faces, ms", "refit", "walk", "`self_impacts`", "frame", "impacts", "front nodes",
                  "da Silva 2013, GTS 450, its own scene",
                  "its front nodes"], rows) + made_on(r)


RULES = {"feature_trees": "feature_trees", "representatives": "representative_triangles", "orphan_sets": "orphan_sets"}


def pair_rules(r):
    rows = []
    for scene in r.parts("", 0):
        if not r.names(f"{scene}/feature_trees/"):
            continue
        for rule, name in RULES.items():
            rows.append([scene if rule == "feature_trees" else "", f"`{name}`"] +
                        [shown(r.get(f"{scene}/{rule}/{s}")) for s in ("index", "refit", "walk", "boxes", "tests",
                                                                       "impacts")])
    return table(["scene, ms", "rule", "index", "refit", "walk", "boxes", "tests", "impacts"], rows, 2) + made_on(r)


@in_table("pair-rules-cpu")
def pair_rules_cpu(results):
    return pair_rules(results["cpu/pair_rules"])


@in_table("pair-rules-cuda")
def pair_rules_cuda(results):
    return pair_rules(results["cuda/pair_rules"])


@in_table("pair-rules-counts")
def pair_rules_counts(results):
    r = results["cpu/pair_rules"]
    rows = []
    for scene in r.parts("", 0):
        one, orphans = f"{scene}/representatives/impacts", f"{scene}/orphan_sets/impacts"
        rows.append([scene, whole(r.get(one, "pairs_of_faces")), whole(r.get(orphans, "looked_at")),
                     whole(r.get(one, "pairs_of_features")),
                     whole(r.get(orphans, "pairs_of_features")), whole(r.get(f"{scene}/feature_trees/impacts", "overlap")),
                     whole(r.get(orphans, "orphans")), whole(r.get(orphans, "orphans_overlap"))])
    return table(["scene", "pairs of faces", "that share no vertex", "pairs of features, representatives", "orphan sets",
                  "whose boxes overlap", "orphans", "whose boxes overlap"], rows) + made_on(r)


@in_table("schedules")
def schedules(results):
    r = results["cuda/schedules"]
    rows = []
    for scene in dict.fromkeys(n.split("/")[0] for n in r.rows if n.endswith("/eighth")):
        for part, name in (("all", "all"), ("eighth", "an eighth")):
            rows.append([scene if part == "all" else "", name] + [shown(r.get(f"{scene}/{s}/{part}")) for s in SCHEDULES])
    return table(["scene, ms", "blocks"] + [s.replace("_", " ") for s in SCHEDULES], rows, 2) + made_on(r)


# --- what tests write: docs/results -----------------------------------------------------------------------------------------

def from_tests(page):
    """The rows of the first table of a page of docs/results, as dicts by the head, of float and double side by side."""
    lines = [line for line in (ROOT / "docs" / "results" / page).read_text(encoding="utf-8").split("\n")
             if line.startswith("|")]
    cells = [[c.strip() for c in line.strip("|").split("|")] for line in lines]
    rows = [dict(zip(cells[0], row)) for row in cells[2:]]
    return {f: {r["scalar"]: r for r in rows if r["family"] == f} for f in dict.fromkeys(r["family"] for r in rows)}


def family_errors(page, late):
    def cells(row):
        missed, phantom = (int(v) for v in row["fast"].split(" / "))
        decided = float(row["filter"]) + (float(row["late"]) if late else 0)
        return [f"{missed:,} / {phantom:,}", f"{decided:.3f}".rstrip("0").rstrip("."), row["wrong"]]

    rows = [[family] + cells(both["float"]) + cells(both["double"]) for family, both in from_tests(page).items()]
    what = "filter and late stage" if late else "filter"
    return table(["family"] + [f"{s}: {c}" for s in SCALARS for c in ("`fast`, missed / phantom", f"{what}, %",
                                                                      "`filtered` and `exact`, wrong")],
                 rows)


@in_table("sphere-families")
def sphere_families(results):
    return family_errors("sphere-triangle.md", False)


@in_table("triangle-families")
def triangle_families(results):
    return family_errors("triangle-triangle.md", True)


# --- from the least scene to the richest ------------------------------------------------------------------------------------

@in_table("footprint")
def footprint(results):
    r, cuda, compiled = results["cpu/footprint"], results["cuda/footprint"], results["cpu/footprint_build"]
    rows = []
    for name in r.rows:
        each = r.get(name, "elements")
        rows.append([name.replace("/", ": ", 1), whole(each), f"{r.get(name, 'set_bytes') / each:.0f}",
                     whole(r.get(name, "index_bytes") / 1024),
                     shown(r.get(name)), shown(cuda.get(name)), shown(compiled.get(name, "gcc_seconds")),
                     whole(compiled.get(name, "gcc_megabytes")),
                     whole((compiled.get(name, "gcc_code") or 0) / 1024)] + [whole(compiled.get(name,
                                                                                                f"nvcc_{k}"))
                                                                             for k in ("seconds", "registers", "stack")])
    head = ["scene: question", "elements", "bytes of each", "trees, KiB", "one core, ms", "device, ms", "g++, s", "g++, MB",
            "code, KiB",
            "nvcc, s", "registers", "stack"]
    return filled(head, rows) + made_on(r) + made_on(cuda) + made_on(compiled)


@in_table("compile-cost")
def compile_cost(results):
    r = results["cpu/footprint_build"]
    rows = [[name.replace("/", ": ", 1)] + [shown(r.get(name, f"{c}_seconds")) for c in ("gcc", "nvcc")] +
            [whole(r.get(name, f"{c}_megabytes")) for c in ("gcc", "nvcc")] for name in r.rows]
    head = ["program", "g++: seconds of a processor", "nvcc", "g++: MB of memory", "nvcc"]
    return filled(head, rows) + made_on(r)


# --- README -----------------------------------------------------------------------------------------------------------------

def paragraph(text):
    return textwrap.wrap(" ".join(text.split()), 125, break_long_words=False, break_on_hyphens=False) + [""]


def machine(r):
    return r.context["device"] if "device" in r.context else f"{r.context['machine']}, one core, {r.context['compiler'].split(' (')[0]}"


@in_table("cost-spheres")
def cost_spheres(results):
    cpu, cuda, theirs = results["cpu/spheres_mesh"], results["cuda/spheres_mesh"], LITERATURE["lee_hsieh_2019"]["whole_scene_ms"]
    slow, quick = theirs.values()
    rows = []
    for r, policy in ((cpu, "serial"), (cuda, "cuda")):
        for index in ("bvh", "grid", "embree"):
            if r.get(f"all/{index}/{policy}") is None:
                continue
            name = "Embree point queries, not exact" if index == "embree" else LABELS[index]
            both = [r.get(f"arithmetic/{index}/float/{a}") for a in ("filtered", "fast")]
            rows.append([machine(r) if index == "bvh" else "", name, shown(r.get(f"build/{index}/{policy}")),
                         shown(r.get(f"pairs/{index}/{policy}/{SPHERES}")), shown(r.get(f"all/{index}/{policy}")),
                         quotient(*both)])
    return paragraph(f"""The scene of Lee and Hsieh 2019, who took {whole(quick)} ms on a GPU and {slow / 60000:.1f} minutes by brute
        force on one core: a torus of {TRIANGLES:,} triangles and {SPHERES:,} spheres of radius 3, of which
        {whole(cpu.get('all/bvh/serial', 'pairs'))} pairs touch. Float, `filtered` (so exact), sorted pairs.""") + \
        table(["machine", "index", "build, ms", "query, ms", "both, ms", "`filtered` over `fast`"], rows, 2)


@in_table("cost-triangles")
def cost_triangles(results):
    cpu, cuda, theirs = results["cpu/triangles"], results["cuda/triangles"], LITERATURE["maffina_2012"]
    n = "20000000"
    count = cuda.get(f"one/count/filtered/float/1/cuda/{n}")
    times = f"{quotient(count, cuda.get(f'one/count/fast/float/1/cuda/{n}'))}"

    def both(a, peer=False):
        return " (".join(shown(rate(cpu, f"pair/{a}/{'double' if peer else 'float'}/{p}")) for p in ("1.7", "20")) + ")"

    others = "".join(f", {name} {both(p, True)}" for p, name in (("cgal", "CGAL's exact predicates"),
                                                                 ("fcl", "FCL")) if f"pair/{p}/double/20" in cpu.rows)
    return paragraph(f"""One triangle against 20 million (Maffina 2012: {whole(theirs['one_core_ms'][n])} ms on one core,
        {whole(theirs['gpu_ms'][n])} ms on a GTX 590), float, 1 % hits, exact: `count` takes {shown(count)} ms on the
        {cuda.context['device']}, where reading the same bytes takes {shown(cuda.get(f'read/float/cuda/{n}'))} ms, and `filtered`
        costs {times} times `fast`. One core decides {both('filtered')} million distinct pairs a second with 1.7 % hits (20 %),
        `fast` {both('fast')}{others}, in one run.""")


@in_table("cost-meshes")
def cost_meshes(results):
    cpu, layouts, cuda = results["cpu/meshes"], results["cpu/builders"], results["cuda/meshes"]
    batch = "batch/1000/cuda"
    embree = [cpu.get(f"unsorted/embree_{q}/serial") for q in ("low", "medium")]
    peers_say = f"Embree with the same test at its leaves {shown(min(embree))}, unsorted; " if all(embree) else ""
    if cpu.get("unsorted/fcl_obb/serial"):
        peers_say += f"FCL {shown(cpu.get('unsorted/fcl_obb/serial'))}; "
    return paragraph(f"""Two meshes of 345,944 triangles with a BVH each: {whole(cpu.get('pairs/baked/serial', 'pairs'))} pairs, sorted and
        exact, take {shown(cpu.get('pairs/baked/serial'))} ms on one core, {shown(layouts.get('pairs/baked/sah/wide'))} with wide
        trees ({peers_say[:-2]}), and {shown(cuda.get('pairs/baked/cuda'))} ms on the {cuda.context['device']}. A tree takes
        {shown(cpu.get('build/bvh/serial'))} and {shown(cuda.get('build/bvh/cuda/345944'))} ms to build. 1,000 posed pairs of meshes of
        2,766 triangles, in one call on the device, take {shown(cuda.get(batch))} ms and have {whole(cuda.get(batch, 'pairs'))} pairs of
        triangles.""")


@in_table("cost-wrong")
def cost_wrong(results):
    parts = []
    for page, what in (("sphere-triangle.md", "spheres and triangles"), ("triangle-triangle.md", "two triangles")):
        rows = [row for both in from_tests(page).values() for row in both.values()]
        wrong, pairs = sum(int(r["wrong"]) for r in rows), sum(int(r["pairs"]) for r in rows)
        parts.append(f"of {pairs / 1e6:,.0f} million pairs of {what} ({len(rows) // 2} families, [table](docs/results/{page})) {wrong}")
    r = results["cpu/trade"]
    at = [r.get(f"triangle_triangle/touching/{s}/fast", "wrong_per_million") for s in SCALARS]
    return paragraph(f"""Pairs that were built to break it, in float and double, were each decided by rational arithmetic as well.
        `filtered` and `exact` got wrong: {'; '.join(parts)}. `fast` errs where shapes nearly touch: for two triangles one rounding
        step from contact in {at[0] / 1e4:.0f} % (float) and {at[1] / 1e4:.0f} % (double) of pairs.""")


@in_table("cost-motion")
def cost_motion(results):
    cpu, cuda = results["cpu/motion"], results["cuda/motion"]
    at = next(s for s in motion_scenes(cuda) if s.startswith("cloth-ball/"))
    return paragraph(f"""In motion: a cloth of {whole(cuda.get(f'{at}/build', 'faces'))} triangles that folds over a ball, one step of a
        simulation against itself, {whole(cuda.get(f'{at}/impacts', 'impacts'))} impacts with exact times: {shown(cpu.get('stage/cloth-ball/float/self_impacts'))}
        ms on one core, {shown(cuda.get(f'{at}/frame'))} ms with the refit on the {cuda.context['device']}.""")


# --- docs/choosing.md -------------------------------------------------------------------------------------------------------

def choosing():
    """Values that are times of single rows."""
    rows = {"serial": ("cpu/meshes", "pairs/posed/serial"),
            "cuda": ("cuda/meshes", "pairs/posed/cuda"), "cuda-small": ("cuda/meshes_2766", "pairs/posed/cuda"),
            "two-trees": ("cpu/builders", "pairs/posed/linear/standard"),
            "one-tree": ("cpu/builders", "one_sided/linear/standard"),
            "both-at-once": ("cpu/descents", "walk/linear/both_at_once"),
            "larger-first": ("cpu/descents", "walk/linear/larger_first")}
    for builder in BUILDERS:
        name = builder.replace("_", "-")
        rows[f"{name}-build"] = ("cpu/builders", f"build/{builder}/serial")
        rows[name] = ("cpu/builders", f"pairs/posed/{builder}/standard")
    for layout in ("standard", "wide", "oriented", "quantised", "leafless"):
        rows[layout] = ("cpu/builders", f"pairs/posed/sah/{layout}")
    for name, (source, row) in rows.items():
        VALUES[f"choosing-{name}"] = lambda results, s=source, n=row: needed(results[s].get(n))
    for a in ARITHMETICS:
        for kind in ("random", "touching"):
            VALUES[f"choosing-{a}-{kind}"] = lambda results, n=f"triangle_triangle/{kind}/float/{a}": needed(results["cpu/trade"].get(n, "ns"))
        VALUES[f"choosing-{a}-wrong"] = lambda results, n=f"triangle_triangle/touching/float/{a}": whole(
            results["cpu/trade"].get(n, "wrong_per_million"))


def needed(value):
    if value is None:
        raise KeyError("a row")
    return shown(value)


choosing()
