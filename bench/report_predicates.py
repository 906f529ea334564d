# SPDX-License-Identifier: MIT
"""The tables of single pairs: arithmetic, triangles, ties, and what tests write."""

from report_core import *  # noqa: F403


# --- speed against wrong answers --------------------------------------------------------------------------------------------

PREDICATES = {"triangle_triangle": "triangle, triangle", "segment_triangle": "segment, triangle",
              "sphere_triangle": "sphere, triangle", "capsule_triangle": "capsule, triangle",
              "box_triangle": "box, triangle", "plane_triangle": "plane, triangle"}
# Of bench/trade_others.hpp, and features in motion.
OTHERS = {"sphere_sphere": "sphere, sphere", "capsule_capsule": "capsule, capsule", "box_sphere": "box, sphere",
          "box_capsule": "box, capsule", "ray_triangle": "ray, triangle", "hull_hull": "hull, hull"}
WITHIN = {"triangles_within": "triangles within a distance", "capsules_within": "capsules within a distance"}
# The other pairs of shapes, of bench/trade_others.hpp as well, and those with a hull.
SOLIDS = {"point_point": "point, point", "point_segment": "point, segment", "point_triangle": "point, triangle",
          "point_sphere": "point, sphere", "point_capsule": "point, capsule", "segment_segment": "segment, segment",
          "sphere_segment": "sphere, segment", "segment_capsule": "segment, capsule", "sphere_capsule": "sphere, capsule",
          "box_point": "box, point", "box_segment": "box, segment", "box_box": "box, box", "plane_point": "plane, point",
          "plane_segment": "plane, segment", "plane_sphere": "plane, sphere", "plane_capsule": "plane, capsule",
          "plane_box": "plane, box", "plane_plane": "plane, plane"}
HULLS = {"hull_point": "hull, point", "hull_segment": "hull, segment", "hull_triangle": "hull, triangle",
         "hull_sphere": "hull, sphere", "hull_capsule": "hull, capsule", "hull_box": "hull, box", "hull_plane": "hull, plane",
         "hull_ray": "hull, ray"}
WITH_HULLS = {"hull_hull": OTHERS["hull_hull"], **HULLS}
IN_MOTION = {"vertex_face": "vertex, face in motion", "edge_edge": "edge, edge in motion"}
IN_TIME = ("fast", "conservative", "filtered", "exact")
INPUTS = ("random", "touching", "lattice")


def trade(r, ns, predicates=PREDICATES):
    rows = []
    for predicate, name in predicates.items():
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


@in_table("trade-others-cpu")
def trade_others_cpu(results):
    r = results["cpu/trade_others"]
    rows = []
    for predicate, name in IN_MOTION.items():
        for kind in INPUTS:
            for scalar in SCALARS:
                at = f"{predicate}/{kind}/{scalar}/"
                rows.append([f"{name}, {kind}", scalar] + [shown(r.get(at + a, "ns")) for a in IN_TIME] +
                            [f"{whole(r.get(at + a, 'missed_per_million'))} / {whole(r.get(at + a, 'phantom_per_million'))}"
                             for a in IN_TIME])
    pairs = r.get("sphere_sphere/random/float/fast", "pairs")
    more = []
    for figure, what, predicates in (("solids", "points, segments, boxes and planes", SOLIDS),
                                     ("hulls", "convex hulls and other shapes", HULLS)):
        more += [f"![Throughput against wrong answers per million, {what}, one core](figures/trade-{figure}-cpu.svg)", "",
                 f"The same of {what}:", ""] + trade(r, lambda r, n: r.get(n, "ns"), predicates)
    return ["![Throughput against wrong answers per million, other pairs, one core](figures/trade-others-cpu.svg)", "",
            "Time of a pair on one core, and wrong answers per million:", ""] + \
        trade(r, lambda r, n: r.get(n, "ns"), {**OTHERS, **WITHIN}) + more + \
        ["Time of impact of a pair, and whether there is one: missed and phantom per million:", ""] + \
        table(["pairs", ""] + [f"`{a}`, ns" for a in IN_TIME] + [f"`{a}`: missed / phantom" for a in IN_TIME], rows, 2) + \
        made_on(r, f"; {pairs:,} pairs a row")


def on_a_device(r, what, figure, predicates):
    pairs = r.get(next(iter(r.names(next(iter(predicates)) + "/"))), "pairs")
    return [f"![Throughput against wrong answers per million, {what}, device](figures/{figure}.svg)", "",
            "Time of a pair, all pairs of a row at once, one a thread; and wrong answers per million:", ""] + \
        trade(r, lambda r, n: r.get(n) and 1e6 * r.get(n) / pairs, predicates) + made_on(r, f"; {pairs:,} pairs a row")


@in_table("trade-others-cuda")
def trade_others_cuda(results):
    return on_a_device(results["cuda/trade_others"], "other pairs", "trade-others-cuda", OTHERS)


@in_table("trade-solids-cuda")
def trade_solids_cuda(results):
    return on_a_device(results["cuda/trade_solids"], "points, segments, boxes and planes", "trade-solids-cuda", SOLIDS)


@in_table("trade-within-cuda")
def trade_within_cuda(results):
    return on_a_device(results["cuda/trade_within"], "distances", "trade-within-cuda", WITHIN)


@in_table("trade-hulls-cuda")
def trade_hulls_cuda(results):
    return on_a_device(results["cuda/trade_hulls"], "convex hulls and other shapes", "trade-hulls-cuda", WITH_HULLS)


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


# --- triangles against triangles --------------------------------------------------------------------------------------------

STAGES = {"first": "filter", "late": "late", "word": "64 bits", "one_limb": "1 limb", "two_limbs": "2 limbs",
          "any_span": "any span"}
QUERIES = (("0", "any"), ("1", "count"), ("50", "count"), ("1", "any"), ("1", "pairs"), ("50", "pairs"), ("1", "unsorted"),
           ("50", "unsorted"))


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
        if "late" in stages:
            lines += ["(\"late\" is the stage between the filter and the integers. Of these, \"64 bits\" are of one word, and limbs are "
                      "words for each degree of the polynomial. \"any span\" is the last stage: numbers may be as far apart as "
                      "the type allows. See [stage](glossary.md#stage).)", ""]
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
        rows.append([f"{int(n):,}"] + [shown(theirs[f"{what}_ms"][n]) for what in ("one_core", "gpu", "four_gpus")] + [
                     shown(cpu.get(f"one/count/filtered/float/1/serial/{n}")),
                     shown(cuda.get(f"one/count/filtered/float/1/cuda/{n}")),
                     shown(cuda.get(f"one/copied/filtered/float/1/cuda/{n}"))])
    return [f"One triangle against many, of the source ({theirs['machine']}) and here, float, `filtered`, in ms:", ""] + \
        table(["triangles", "source, one core", "source, GPU", "source, 4 GPUs", "here, one core", "here, device",
               "here, with the copy"], rows)


# --- families of all kinds of pairs -----------------------------------------------------------------------------------------

def kinds_with_families(r):
    return list(dict.fromkeys(name.split("/")[0] for name in r.rows))


def family_ratios(r, kind, scalar, arithmetic):
    """Time over that of fast, and the row's name, of each family."""
    return [(r.get(name, f"{arithmetic}_over_fast"), name) for name in r.rows if name.startswith(f"{kind}/{scalar}/")]


@in_table("families-cpu")
def families_cpu(results):
    r = results["cpu/families"]
    rows = []
    for kind in kinds_with_families(r):
        cells = [kind.replace("_", " ")]
        for scalar in SCALARS:
            for a in ("filtered", "exact"):
                ratios = sorted(ratio for ratio, _ in family_ratios(r, kind, scalar, a))
                cells.append(" / ".join(shown(ratios[k]) for k in (0, len(ratios) // 2, -1)))
            worst = max((r.get(name, "filtered"), name.split("/")[2]) for _, name in family_ratios(r, kind, scalar, "filtered"))
            cells.append(f"{shown(worst[0] / 1000)}, {worst[1]}")
        rows.append(cells)
    head = ["pairs"] + [f"{s}: {c}" for s in SCALARS for c in ("`filtered` / `fast`", "`exact` / `fast`",
                                                               "slowest of `filtered`, us a pair")]
    return ["Least, middle and greatest of all families:", ""] + table(head, rows) + made_on(r)


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
