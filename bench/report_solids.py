# SPDX-License-Identifier: MIT
"""The tables of bench/solids.cpp: how two solids lie to each other."""

from report_core import *  # noqa: F403

RELATIONS = ["disconnected", "externally connected", "partially overlapping", "equal", "tangential part", "nontangential part",
             "tangential part, inverse", "nontangential part, inverse"]


@in_table("solids")
def solids(results):
    r = results["cpu/solids"]
    rows = []
    for mesh in r.parts("pair/", 1):
        for case in r.parts(f"pair/{mesh}/", 2):
            def of(key):
                return r.get(f"pair/{mesh}/{case}", key)
            rows.append([mesh.replace("_", ", "), case.replace("_", " "), RELATIONS[int(of("found"))], shown(of("any")),
                         shown(of("overlaps")), f"{of('over'):,.2f}", shown(of("relation")), shown(of("checked"))])
    head = ["a mesh and its copy", "", "relation", "any, ms", "overlaps, ms", "overlaps / any", "relation, ms", "if not known to be solids, ms"]
    lines = table(head, rows, 3)
    rows = []
    for mesh in r.parts("crossings/", 1):
        def of(key):
            return r.get(f"crossings/{mesh}", key)
        rows.append([mesh.replace("_", ", "), whole(of("faces")), shown(of("pairs")), shown(of("crossings")), f"{of('over'):,.2f}",
                     shown(of("curves")), whole(of("found")), whole(of("lines")), whole(of("open"))])
    lines += table(["a mesh and its copy, turned", "faces each", "pairs, ms", "crossings, ms", "crossings / pairs", "curves, ms", "crossings",
                    "curves", "open"], rows)
    rows = []
    for scene in r.parts("scene/", 1):
        def of(key):
            return r.get(f"scene/{scene}", key)
        rows.append([f"{whole(of('bodies'))} {scene}", whole(of("faces")), shown(of("touching")), shown(of("relation")),
                     whole(of("related")), whole(of("wrong"))])
    lines += table(["scene", "faces each", "touching_bodies, ms", "relation, ms", "not disconnected", "wrong"], rows)
    return lines + made_on(r)
