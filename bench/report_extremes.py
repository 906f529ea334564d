# SPDX-License-Identifier: MIT
"""The tables of bench/extremes.cpp and bench/extremes.cu, answers and worst costs over the number range, and of
bench/trade_scenes.cpp, what whole scenes lose to `fast`."""

from report_core import *  # noqa: F403

PAIR_KINDS = {"triangle_triangle": "triangle, triangle", "sphere_triangle": "sphere, triangle", "vertex_face": "vertex, face in motion",
              "edge_edge": "edge, edge in motion"}
OTHER_KINDS = {"box_triangle": "box, triangle", "plane_triangle": "plane, triangle", "capsule_triangle": "capsule, triangle",
               "segment_triangle": "segment, triangle", "point_triangle": "point, triangle", "ray_triangle": "ray, triangle",
               "sphere_sphere": "sphere, sphere", "box_capsule": "box, capsule", "box_segment": "box, segment",
               "hull_hull": "hull, hull (4 points each)"}
EXTREMES = {"scaled": "scaled", "moved": "moved from the origin", "flattened": "flattened", "snapped": "snapped to a lattice",
            "spread": "spread of exponents", "undecided": "share undecided by the filter",
            "unresolved": "share left to the last stage"}


def other_kinds(r):
    """Those that were measured."""
    return {kind: name for kind, name in OTHER_KINDS.items() if r.names(f"pair/{kind}/")}


def worst(r, rows, key):
    """The greatest value and the step at which it is."""
    found = [(r.get(n, key), n) for n in rows if r.get(n, key) is not None]
    return max(found) if found else (None, "")


def total(r, rows, key):
    """None where it was not measured."""
    found = [r.get(n, key) for n in rows if r.get(n, key) is not None]
    return sum(found) if found else None


def step(name):
    """A row's step, EXTREME VALUE."""
    return name.split("/", 3)[-1].replace("/", " ")


def pairs_at_extremes(r):
    rows = []
    for kind, name in {**PAIR_KINDS, **OTHER_KINDS}.items():
        for scalar in SCALARS:
            steps = r.names(f"pair/{kind}/{scalar}/")
            if not steps:
                continue
            compared = sum(r.get(n, "sample") or 0 for n in steps)
            wrong = [total(r, steps, f"{a}_wrong") for a in ARITHMETICS]
            ns, at = worst(r, steps, "filtered_ns")
            fast = [r.get(n, "fast_ns") for n in steps]
            slowest, there = worst(r, steps, "filtered_worst_ns")
            rows.append([name, scalar, whole(len(steps)), whole(compared)] + [whole(w) for w in wrong] +
                        [shown(sorted(fast)[len(fast) // 2]), shown(ns), step(at), shown(slowest and slowest / 1000), step(there)])
    head = ["pairs", "", "steps", "compared", "`fast` wrong", "`filtered` wrong", "`exact` wrong", "`fast`, median of steps, ns",
            "`filtered`, worst step, ns", "where", "`filtered`, slowest pair, us", "where"]
    return filled(head, rows, 2)


def scenes_at_extremes(r):
    rows = []
    for kind in r.parts("scene/", 1):
        for scalar in SCALARS:
            steps = r.names(f"scene/{kind}/{scalar}/")
            if steps:
                sums = [sum(r.get(n, key) or 0 for n in steps) for key in
                        ["truth"] + [f"{a}_{how}" for a in ARITHMETICS for how in ("lost", "invented")]]
                ratio = max((r.get(n, "filtered_ms") / r.get(n, "fast_ms"), n) for n in steps if r.get(n, "fast_ms"))
                rows.append([kind, scalar, whole(len(steps))] + [whole(s) for s in sums] +
                            [f"{ratio[0]:.2f}", ratio[1].split("/", 3)[-1].replace("/", " ")])
    head = ["scene", "", "steps", "pairs"] + [f"`{a}` {how}" for a in ARITHMETICS for how in ("lost", "invented")]
    return table(head + ["`filtered` / `fast`, worst", "where"], rows, 2)


def at_extremes(r, where, caption):
    """The second figure is there once the other kinds were measured."""
    figure = [f"![{caption}](figures/extremes-others-{where}.svg)", ""] if other_kinds(r) else []
    return ["Single pairs:", ""] + pairs_at_extremes(r) + figure + ["Whole queries:", ""] + scenes_at_extremes(r) + made_on(r)


@in_table("extremes-cpu")
def extremes_cpu(results):
    return at_extremes(results["cpu/extremes"], "cpu", "What filtered takes at the extremes, other pairs")


@in_table("extremes-cuda")
def extremes_cuda(results):
    return at_extremes(results["cuda/extremes"], "cuda", "What filtered takes at the extremes on a device, other pairs")


@in_table("trade-scenes")
def trade_scenes(results):
    r = results["cpu/trade_scenes"]
    rows = []
    for name in r.names("scene/") + r.names("ccd/"):
        if not name.endswith("/float"):
            continue
        what = "pairs" if name.startswith("scene/") else "impacts"
        cells = []
        for at in (name, name.removesuffix("float") + "double"):
            found, off = r.get(at, what), r.get(at, "time_error")
            cells += [whole(found), whole(r.get(at, "lost")), f"{100 * r.get(at, 'lost') / found:.1f}", whole(r.get(at, "invented")),
                      "" if off is None else f"{off:.1g}"]
        rows.append([", ".join(name.split("/")[1:-1]).replace("_", " "), what] + cells)
    head = ["scene", ""] + [f"{s}{c}" for s in ("", "double: ") for c in ("there are", "lost", "%", "invented", "times off by")]
    return ["What `fast` makes of whole scenes, in float and then in double; times are parts of the step:", ""] + \
        table(head, rows, 2) + made_on(r)


@in_table("trade-frames")
def trade_frames(results):
    r = results["cpu/trade_scenes"]

    def frame(value):
        return "never" if value < 0 else whole(value)

    rows = []
    for name in r.names("frames/"):
        _, scene, scalar = name.split("/")
        row = r.rows[name]
        off, apart = row.get("time_error"), row.get("apart")
        rows.append([scene, scalar, whole(row["frames"]), whole(row["frames_that_differ"]), frame(row["first_that_differs"]),
                     whole(row.get("pairs", row.get("impacts"))), whole(row["lost"]), whole(row["invented"]), whole(row["most_in_a_frame"]),
                     "" if off is None else f"{off:.1g}", "" if apart is None else frame(row["apart_after"]),
                     "" if apart is None else f"{100 * apart:.0f}", whole(row.get("touch_at_end")), whole(row.get("filtered_touch_at_end"))])
    head = ["what moves", "", "frames", "differ", "first", "contacts or impacts", "lost", "invented", "most in a frame",
            "times off by, of a frame", "two cloths differ after frame", "apart at the end, % of a side", "pairs through the ball: `fast`",
            "`filtered`"]
    return ["The same of scenes that move:", ""] + table(head, rows, 2) + made_on(r)


@in_table("trade-contacts")
def trade_contacts(results):
    r = results["cpu/trade_scenes"]
    rows = []
    for name in r.names("frames/"):
        row = r.rows[name]
        if "deepest" in row:
            depths = [row[key] for key in ("deepest", "deepest_lost", "deepest_invented")]
            rows.append(name.split("/")[1:] + [whole(row["pairs"])] + [f"{d:.2g}" for d in depths] +
                        [whole(row["changed"]), whole(row["normal_degrees"])])
    head = ["what moves", "", "contacts", "deepest", "deepest that is lost", "deepest that is invented",
            "other bits in both", "sum of normals turns by, degrees"]
    return ["What it does to contacts; depths are thousandths of the mesh's extent:", ""] + table(head, rows, 2) + made_on(r)
