# SPDX-License-Identifier: MIT
"""The tables of features in motion, and of schedules."""

from report_core import *  # noqa: F403


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
                missed, phantom = (r.get(at + "wrong", f"{key}_per_million") for key in ("missed", "phantom"))
                cells += [shown(r.get(at + "first")) + (f" + {second}" if second else ""),
                          whole(r.get(at + "first", "left")),
                          whole(r.get(at + "second", "found")),
                          "" if missed is None else f"{whole(missed)} / {whole(phantom)}"]
            rows.append([s, name] + cells)
    head = [f"`{a}`: {what}" for a in ("fast", "filtered", "conservative") for what in ("first + second, ms", "left",
                                                                                        "found", "missed / phantom")]
    plot = ["![Throughput against wrong answers per million, in motion, device](figures/trade-motion-cuda.svg)", ""]
    compared = any(n.endswith("/wrong") for n in r.rows)
    return (plot if compared else []) + filled(["scene", ""] + head, rows, 2) + \
        made_on(r, "; missed and phantom are per million candidates, by `exact`" if compared else "")


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
            theirs = LITERATURE["dasilva_2013"]["models"].get(s.split("/")[0], {}) if kind == "vertex_face" else {}
            rows.append([s, name] + [shown(t) for t in parts] +
                        [quotient(parts[0], parts[-1], 1), quotient(parts[1], parts[-1])] +
                        [shown(theirs.get(f"{who}_speedup")) for who in ("stealing", "gproximity")])
    return table(["scene", "ms", "1/8 of the blocks", "1/4", "1/2", "all", "gain from 1/8", "gain from 1/4",
                  "da Silva 2013, stealing, 4 multiprocessors over 1", "its gProximity"], rows, 2) + made_on(r)


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
