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


@in_table("device-queries")
def device_queries(results):
    """What bench/solids.cu, sweep.cu, turning.cu and arm.cu measure, each of its own run."""
    solids, sweep, turning, arm, cloth = (results[f"cuda/{name}"] for name in ("solids", "sweep", "turning", "arm", "cloth_step"))
    rows = []
    for key, title in (("pairs", "`pairs`"), ("crossings", "`crossings`"), ("any", "`any`"), ("overlaps", "`overlaps`"), ("relation", "`relation`")):
        rows.append([title, "two scans of 345,944 faces that cross", "1", shown(solids.get(f"{key}/cuda")),
                     whole(solids.get(f"{key}/cuda", "differ")) if key == "crossings" else ""])
    for rays, title in (("coherent", "along a camera's rays"), ("scattered", "along scattered rays")):
        ray = sweep.get(f"raycast/{rays}/cuda")
        rows.append(["`raycast`", f"segments {title}, at a scan", whole(sweep.get(f"raycast/{rays}/cuda", "items")), shown(ray), ""])
        for shapes in ("balls", "capsules"):
            name = f"sweep/{rays}/{shapes}/cuda"
            rows.append([f"`sweep`, {sweep.get(name) / ray:,.1f} of `raycast`", f"{shapes} {title}, at a scan", whole(sweep.get(name, "items")),
                         shown(sweep.get(name)), whole(sweep.get(name, "differ"))])
    for kind, title in (("short", "edges of a road map"), ("long", "to any pose, begin free"), ("anywhere", "from any pose to any other")):
        for name, title_of in (("cuda", "`first_meetings`"), ("cuda_any", "`any_each`")):
            key = f"{kind}/{name}"
            rows.append([title_of, f"a robot in a room: {title}", whole(turning.get(key, "items")), shown(turning.get(key)),
                         whole(turning.get(key, "differ")) if name == "cuda" else ""])
    for where, title in (("room", "a room of 100 boxes"), ("mesh", "a mesh of 20,000 triangles")):
        key = f"states/{where}/cuda"
        rows.append(["`any_each`", f"states of an arm of eight links in {title}", whole(arm.get(key, "items")), shown(arm.get(key)),
                     whole(arm.get(key, "wrong"))])
    of_cloth = f"a recorded step of a cloth of {whole(cloth.get('impacts', 'faces'))} triangles, {whole(cloth.get('impacts', 'impacts'))} impacts"
    for key, title in (("frame", "`refit` and `self_impacts`"), ("graph/frame", "the same as one graph"), ("safe_step", "`safe_self_step`"),
                       ("graph/safe_step", "the same as one graph"), ("graph/all", "all of these as one graph")):
        rows.append([title, of_cloth, "1", shown(cloth.get(key)), whole(1 - cloth.get("graph/same", "same")) if key == "graph/all" else ""])
    rows.append(["`self_impacts`", f"eleven such cloths, {whole(cloth.get('million/impacts', 'faces'))} triangles", "1",
                 shown(cloth.get("million/impacts")), ""])
    head = ["query", "scene", "questions in one call", "ms", "answers that differ from the host's"]
    return table(head, rows, 2) + made_on(solids)
