# SPDX-License-Identifier: MIT
"""The tables of queries of sets at rest, of their trees, and of memory."""

from report_core import *  # noqa: F403


# --- spheres against a mesh -------------------------------------------------------------------------------------------------

SPHERES, TRIANGLES, VERTICES = 1703244, 62976, 31488
SIZES = ("2766", "27674", "138376", "345944")
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


def without_waiting(r):
    """Calls into a stream, beside those that wait; nothing where there are none."""
    if not r.names("async/"):
        return []
    waits = {"pairs": "pairs/bvh/cuda/1703244", "count": "count/bvh/cuda/1703244"}
    rows = [[f"`{query}`", shown(r.get(name))] + [shown(r.get(f"async/{query}/{what}"))
                                                  for what in ("read", "ended", "captured", "enqueue")]
            for query, name in waits.items()]
    return ["The whole scene by calls that do not wait, in ms:", ""] + \
        table(["query", "the call that waits", "asynchronous, and `wait`", "until the stream ends", "from a graph",
               "the host's thread, until the call returns"], rows)


@in_table("spheres-cuda")
def spheres_cuda(results):
    r = results["cuda/spheres_mesh"]
    return spheres_mesh(r) + without_waiting(r)


@in_table("spheres-sources")
def spheres_sources(results):
    cpu, cuda, theirs = results["cpu/spheres_mesh"], results["cuda/spheres_mesh"], LITERATURE["lee_hsieh_2019"]
    n = 2**20
    rows = [[f"Lee and Hsieh: {name}", shown(ms), ""] for name, ms in theirs["whole_scene_ms"].items()]
    rows += [[f"Lee and Hsieh: {name}", "", shown(ms)] for name, ms in theirs["spheres_2_20_ms"].items()]
    rows.append(["Lee and Hsieh: that preparation, one core", "", shown(theirs["spheres_2_20_preparation_ms"])])
    for r in (cpu, cuda):
        for policy in policies(r):
            for index in ("none", "grid", "bvh"):
                both = [r.get(f"pairs/{index}/{policy}/{spheres}") for spheres in (SPHERES, n)]
                if r.get(f"all/{index}/{policy}") is not None:
                    built = shown(r.get(f"all/{index}/{policy}"))
                    rows.append([f"abut: {LABELS[index]}, {policy}, with its build", built, ""])
                if any(both):
                    rows.append([f"abut: {LABELS[index]}, {policy}, query alone"] + [shown(t) for t in both])
    most = max(int(name.split("/")[3]) for name in cpu.names("pairs/none/serial/"))
    ours = [r.get(f"pairs/none/{policy}/{most}") for r, policy in ((cpu, "serial"), (cuda, "cuda"))]
    faster = [[f"Lee and Hsieh, 2^20 spheres, {name}", shown(times)]
              for name, times in theirs["brute_force_speedup_2_20"].items()]
    return [f"The figures of the source, of its own machine ({theirs['machine']}), and ours, in ms:", ""] + \
        table(["", "whole scene", "2^20 spheres"], rows) + \
        ["Brute force, how many times as fast as on one core:", ""] + \
        table(["", "times"], faster + [[f"abut, {most:,} spheres, device", quotient(*ours, 0)]])


# --- nearest points and validation ------------------------------------------------------------------------------------------

@in_table("nearest-cpu")
def nearest_cpu(results):
    r = results["cpu/nearest"]
    lines = []
    for question, title, names in (
            ("nearest", "the nearest triangle", {"embree": "Embree, point queries", "fcpw": "FCPW, in vectors of AVX2", "bvh": "`make_bvh`",
                                                 "sah": "`make_bvh`, `sah`",
                                                 "wide_sah": "`wide`, of a `sah` tree",
                                                 "oriented_sah": "`oriented`, of a `sah` tree"}),
            ("nearest_vertex", "the nearest vertex", {"nanoflann": "nanoflann", "bvh": "`make_bvh` of `vertices(mesh)`",
                                                      "sah": "the same, `sah`"}),
            ("nearest_few", "the 8 nearest of them", {"nanoflann": "nanoflann", "bvh": "`make_bvh` of `points`"})):
        if not r.parts(f"{question}/", 3):
            continue
        points = min(int(n) for n in r.parts(f"{question}/", 3))
        peer = r.get(f"{question}/{next(iter(names))}/serial/{points}")
        rows = []
        for index, name in names.items():
            ms = r.get(f"{question}/{index}/serial/{points}")
            if ms is not None:
                wrong = r.get(f"{question}/{index}/serial/{points}", "wrong")
                rows.append([name, shown(ms), shown(points / ms / 1e3), quotient(ms, peer), "" if wrong is None else f"{wrong:,.0f}"])
        lines += [f"For {points:,} points {title}, one core, ms:", ""] + \
            table(["", "ms", "million points a second", "over the first", "wrong shapes, of a peer"], rows)
    return lines + made_on(r)


QUESTIONS = {"nearest": "far from a torus", "nearest_tube": "in its tube", "nearest_close": "close to the torus",
             "nearest_mesh_box": "in the box of a scan", "nearest_mesh_close": "close to the scan"}


@in_table("nearest-layouts")
def nearest_layouts(results):
    r = results["cpu/nearest"]
    names = {"bvh": "`make_bvh`", "sah": "`make_bvh`, `sah`", "wide_sah": "`wide`, of a `sah` tree",
             "oriented_sah": "`oriented`, of a `sah` tree"}
    rows = []
    for question, where in QUESTIONS.items():
        ms = {index: r.get(f"{question}/{index}/serial/100000") for index in names}
        if any(value is None for value in ms.values()):
            continue
        rows.append([where] + [f"{ms[index] / 100:.2f}" for index in names] + [quotient(ms["wide_sah"], min(ms.values()))])
    return ["A point, one core, us:", ""] + table(["points"] + list(names.values()) + ["`wide` over the least"], rows) + made_on(r)


@in_table("nearest-cuda")
def nearest_cuda(results):
    r = results["cuda/nearest"]
    names = {"bvh": "`make_bvh`", "ploc": "`ploc`", "quantised": "`quantised`", "oriented": "`oriented`, of `ploc`",
             "plain": "a plain walk in float"}
    rows = [[f"{int(n):,}, {where}"] + [shown(r.get(f"{question}/{i}/cuda/{n}")) for i in names]
            for question, where in QUESTIONS.items() for n in r.parts(f"{question}/", 3)]
    floor_ms = r.get(f"nearest/bvh/cuda/{SPHERES}", "floor_ms")
    return ["For so many points the nearest triangle, ms:", ""] + table(["points"] + list(names.values()), rows) + \
        [f"To read the scene and to write the answers once takes {shown(floor_ms)} ms at the speed of a read loop.", ""] + \
        made_on(r)


# --- distances --------------------------------------------------------------------------------------------------------------

SCENES = {"robot": "robot in a room", "scan": "scan of 27,674 triangles", "large_scan": "scan of 345,944 triangles", "torus": "torus"}


def distance_rows(r, names):
    """A row for each scene and kind, in microseconds a pose; the first of `names` is the peer."""
    for scene in r.parts("distance/", 1):
        for kind in r.parts(f"distance/{scene}/", 2):
            start = f"distance/{scene}/{kind}"
            poses = max(int(r.get(name, "poses") or 0) for name in r.names(start + "/"))
            yield scene, kind, poses, [None if r.get(f"{start}/{n}") is None else r.get(f"{start}/{n}") * 1e3 / poses for n in names]


@in_table("distance-cpu")
def distance_cpu(results):
    r = results["cpu/distance"]
    names = {"fcl": "FCL, double", "fcl_float": "FCL, float", "bvh": "`make_bvh`", "oriented": "`oriented`",
             "oriented_double": "`oriented`, double", "oriented_openmp": "`oriented`, openmp", "any": "`any`, `oriented`"}
    rows = []
    for scene, kind, poses, times in distance_rows(r, names):
        peer = min(t for t in times[:2] if t is not None) if times[0] is not None else None
        rows.append([SCENES[scene], kind, f"{poses:,}"] + [shown(t) for t in times] + [quotient(min(times[2:4]), peer)])
    return ["Microseconds a pose; one core, but for openmp:", ""] + \
        table(["scene", "poses", "number"] + list(names.values()) + ["the faster tree over the faster FCL"], rows) + made_on(r)


@in_table("distance-cuda")
def distance_cuda(results):
    r = results["cuda/distance"]
    names = {"bvh": "a call for each pose", "list": "all poses in one call", "oriented": "`oriented`, a call for each pose",
             "oriented_list": "`oriented`, all in one call"}
    rows = [[SCENES[scene], kind, f"{poses:,}"] + [shown(t) for t in times]
            for scene, kind, poses, times in distance_rows(r, names)]
    return ["Microseconds a pose:", ""] + filled(["scene", "poses", "number"] + list(names.values()), rows) + made_on(r)


# --- within a distance, and convex hulls ------------------------------------------------------------------------------------

@in_table("within-cpu")
def within_cpu(results):
    r = results["cpu/within"]
    names = {"trees": "`within` of two trees", "unsorted": "the same, not sorted", "count": "`count_within`",
             "self": "`self_within`", "nanoflann": "nanoflann, rounded, not sorted", "floor": "to write the pairs once"}
    clouds = [(c, n) for c in r.parts("points/trees/", 2) for n in r.parts(f"points/trees/{c}/", 3)]
    rows = [["pairs"] + [whole(r.get(f"points/trees/{c}/{n}", "pairs")) for c, n in clouds]]
    rows += [[f"{name}, ms"] + [shown(r.get(f"points/{call}/{c}/{n}")) for c, n in clouds] for call, name in names.items()]
    calls = r.parts("mesh/", 1)
    heads = [f"`within`, {c.removeprefix('within_')}" if c.startswith("within_") else f"`{c}`" for c in calls]
    meshes = [[scene.replace("_", " ")] + [shown(r.get(f"mesh/{call}/{scene}")) for call in calls]
              for scene in r.parts("mesh/", 2)]
    return ["Points with points, one core:", ""] + table([""] + [f"{c}, {n} neighbours" for c, n in clouds], rows) + \
        ["Two meshes, ms; distances are shares of the mesh's width:", ""] + \
        table(["scene"] + heads, meshes) + made_on(r)


@in_table("hulls-cpu")
def hulls_cpu(results):
    r = results["cpu/hulls"]
    names = {"fast": "`intersects`, `fast`", "filtered": "`filtered`", "exact": "`exact`", "fcl_libccd": "FCL, libccd",
             "fcl_indep": "FCL, its own"}
    bodies = r.parts("intersects/", 2)
    rows = [["touch, of 1,000"] + [whole(r.get(f"intersects/filtered/{b}", "hits")) for b in bodies]]
    for question, label in (("intersects", ""), ("distance", "`distance`: ")):
        for how, name in (names if question == "intersects" else {"abut": "abut", "fcl_libccd": names["fcl_libccd"],
                                                                  "fcl_indep": names["fcl_indep"]}).items():
            times = [r.get(f"{question}/{how}/{b}") for b in bodies]
            if any(times):
                rows.append([f"{label}{name}, ns"] + [shown(t and 1e3 * t) for t in times])  # of 1,000 pairs, in ms
    return ["Two hulls at a time, one core, double:", ""] + \
        table([""] + [b.replace("_", " ") for b in bodies], rows) + made_on(r)


RAYS = {"coherent": "from a camera", "scattered": "scattered"}


@in_table("raycast-cpu")
def raycast_cpu(results):
    r = results["cpu/raycast"]
    names = {"embree/float": "Embree", "embree_robust/float": "Embree, robust", "tinybvh/float": "tinybvh, eight children, spatial splits", "bvh/filtered": "`make_bvh`", "sah/filtered": "`make_bvh`, `sah`",
             "wide_sah/filtered": "`wide`, of a `sah` tree", "wide_in_order/filtered": "the same, faces in the order of leaves",
             "sah/fast": "`make_bvh`, `sah`, by `fast`"}
    rays = r.get("raycast/coherent/sah/filtered/serial", "rays")

    def rows_of(question, names):
        rows = []
        for index, name in names.items():
            if r.get(f"{question}/coherent/{index}/serial") is None:
                continue  # an older run, or a peer that is not there
            row = [name]
            for kind in RAYS:
                ms, wrong = r.get(f"{question}/{kind}/{index}/serial"), r.get(f"{question}/{kind}/{index}/serial", "wrong")
                peers = [r.get(f"{question}/{kind}/{peer}/float/serial") for peer in ("embree", "tinybvh")]
                row += [shown(ms)] + [quotient(ms, peer) if peer else "" for peer in peers] + ["" if wrong is None else f"{int(wrong):,}"]
            rows.append(row)
        return rows

    head = [""] + [h for kind in RAYS.values() for h in (f"{kind}, ms", "over Embree", "over tinybvh", "wrong")]
    any_names = {"embree/float": "Embree, `rtcOccluded1`", "embree_robust/float": "Embree, robust", "tinybvh/float": "tinybvh, `IsOccluded`",
                 "wide_sah/filtered": "`raycast_any`, `wide`, of a `sah` tree"}
    rows, others = rows_of("raycast", names), rows_of("occluded", any_names) + rows_of("all", {"wide_sah/filtered": "`raycast_all`, the same"})
    inside, cgal = (r.get(f"inside/points/{i}/serial") for i in ("wide_sah/filtered", "cgal/double"))
    return [f"First hits of {int(rays):,} rays in a mesh of 345,944 triangles, one core, ms:", ""] + table(head, rows) + \
        ["Of the same rays, whether they meet anything, and all that they meet:", ""] + table(head, others) + \
        [f"For 100,000 points `inside` takes {shown(inside)} ms with that tree, {quotient(inside, cgal)} of what CGAL's "
         f"`Side_of_triangle_mesh` takes in double.", ""] + made_on(r)


@in_table("raycast-cuda")
def raycast_cuda(results):
    r = results["cuda/raycast"]
    names = {"bvh/filtered": "`make_bvh`", "ploc/filtered": "`ploc`", "ploc/fast": "`ploc`, by `fast`",
             "plain": "a plain walk in float, `ploc`"}
    rays = r.get("raycast/coherent/bvh/filtered/cuda", "items")
    rows = []
    for index, name in names.items():
        row = [name]
        for kind in RAYS:
            ms = r.get(f"raycast/{kind}/{index}/cuda")
            row += [shown(ms), shown(rays / ms / 1e3)]
        rows.append(row)
    floor_ms = r.get("raycast/coherent/bvh/filtered/cuda", "floor_ms")
    head = [""] + [h for kind in RAYS.values() for h in (f"{kind}, ms", "million rays a second")]
    return [f"First hits of {int(rays):,} rays in a mesh of 345,944 triangles:", ""] + table(head, rows) + \
        [f"To read the tree and the rays and to write the hits once takes {shown(floor_ms)} ms at the speed of a read loop.", ""] + made_on(r)


BODIES = {"build": "`make_bodies`", "refit": "`refit`", "refit_from_host": "`refit`, poses in host memory",
          "near": "near pairs of bodies alone", "pairs": "`pairs`", "unsorted": "`pairs`, not sorted", "count": "`count`",
          "any": "`any`", "contacts": "`contacts`", "fast": "`pairs<fast>`", "ploc": "`pairs`, trees by `ploc`",
          "stealing": "`pairs` by lazy stealing", "list": "`pairs` of a list",
          "frame": "`refit` and `pairs`"}


def bodies_rows(r, policies):
    """Milliseconds by what is asked, for each policy and number of bodies; and what there is to find."""
    columns = [(p, n) for n in r.parts("bodies/", 3) for p in policies if r.get(f"bodies/pairs/{p}/{n}") is not None]
    rows = [[name] + [shown(r.get(f"bodies/{row}/{p}/{n}")) for p, n in columns] for row, name in BODIES.items()]
    found = [f"{int(n):,} bodies: {whole(r.get(f'bodies/pairs/{p}/{n}', 'near'))} pairs of boxes meet, "
             f"{whole(r.get(f'bodies/pairs/{p}/{n}', 'pairs'))} pairs of triangles touch" for p, n in columns
             if p == policies[0]]
    return columns, [row for row in rows if any(row[1:])], "; ".join(found) + "."


@in_table("bodies-cpu")
def bodies_cpu(results):
    r = results["cpu/bodies"]
    columns, rows, found = bodies_rows(r, ("serial", "openmp"))
    return [found, ""] + table(["ms"] + [f"{int(n):,} bodies, `{p}`" for p, n in columns], rows) + made_on(r)


@in_table("bodies-cuda")
def bodies_cuda(results):
    r = results["cuda/bodies"]
    columns, rows, found = bodies_rows(r, ("cuda",))
    floor = ["what has to be read and written at least once, for a frame"] + \
        [shown(r.get(f"bodies/frame/{p}/{n}", "floor_ms")) for p, n in columns]
    return [found, ""] + table(["ms"] + [f"{int(n):,} bodies" for p, n in columns], rows + [floor]) + made_on(r)


def of_all_devices(r):
    """What the column of all devices is called."""
    return f"of {whole(r.get('devices', 'count'))} devices"


@in_table("devices-cuda")
def devices_cuda(results):
    r = results["cuda/devices"]
    columns = [c for c in ("cuda", "one_device", "one_named_twice", "all_devices") if any(n.endswith(c) for n in r.rows)]
    heads = {"cuda": "`cuda`", "one_device": "`cuda_devices` of that device", "one_named_twice": "of that device named twice",
             "all_devices": of_all_devices(r)}
    scenes = (("trees", "two trees, copied"), ("look_up", "spheres look in a tree, copied"), ("divided", "two trees, divided"),
              ("bodies", "100,000 bodies"), ("tori", "a torus moves through another"))
    rows = []
    for scene, name in scenes:
        for query in ("pairs", "count", "impacts"):
            if r.names(f"devices/{query}/{scene}/"):
                rows.append([name, f"`{query}`"] + [shown(r.get(f"devices/{query}/{scene}/{c}")) for c in columns])
    return ["ms; all data on the devices before:", ""] + \
        table(["scene", "query"] + [heads[c] for c in columns], rows, 2) + made_on(r)


def large_scenes(r, scenes):
    """Rows of scenes on all devices, against what `cuda` takes for the whole ones."""
    rows = []
    for scene, whole_scene, name in scenes:
        for query, title in (("count", "`count`"), ("pairs", "`pairs`"), ("build_and_pairs", "both `make_bvh` and `pairs`")):
            one, team = (r.get(f"devices_large/{query}/{whole_scene}/{c}") for c in ("cuda", "one_device"))
            here = f"devices_large/{query}/{scene}/all_devices"
            if r.get(here) is not None:
                rows.append([name, title, shown(one), quotient(team, one) if scene == whole_scene else "", shown(r.get(here)),
                             quotient(r.get(here), one), quotient(r.get(here, "busiest"), 1)])
    head = ["scene", "query", "`cuda`", "`cuda_devices` of it, over `cuda`", of_all_devices(r), "over `cuda`", "busiest"]
    keep = [i for i in range(len(head)) if any(row[i] for row in rows)]
    return table([head[i] for i in keep], [[row[i] for i in keep] for row in rows], 2)


@in_table("devices-large-cuda")
def devices_large_cuda(results):
    r = results["cuda/devices_large"]
    floor_ms = r.get("devices_large/count/one/cuda", "floor_ms")
    return ["ms, and over `cuda` on one device:", ""] + \
        large_scenes(r, (("one", "one", "1 triangle against 2,000,000,000, divided"), ("mesh", "mesh", "two meshes, copied"),
                         ("corner", "corner", "a crowded corner, copied"))) + \
        [f"To read the 72 GB once takes one device {shown(floor_ms)} ms at the speed of a read loop over 1 GiB.", ""] + made_on(r)


@in_table("devices-divided-cuda")
def devices_divided_cuda(results):
    r = results["cuda/devices_divided"]
    return ["ms, both arguments divided, and over `cuda` on one device, which has all:", ""] + \
        large_scenes(r, (("mesh_divided", "mesh", "two meshes"), ("corner_divided", "corner", "a crowded corner"))) + made_on(r)


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

KINDS = {"baked": "pre-transformed", "posed": "posed"}  # of the turned mesh: in names of results, and in tables


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
    return table(["ms", "build of one tree", "pre-transformed", "posed", "pairs"], rows) + made_on(r)


ANY_SCENES = {"hit": "hit", "graze": "graze", "near_miss": "near miss", "shells": "shells"}


@in_table("any")
def any_scenes(results):
    r = results["cpu/any"]
    rows = []
    for tree, name in (("linear", "linear BVH"), ("sah", "SAH"), ("sah_wide", "SAH, wide"),
                       ("sah_oriented", "SAH, oriented"),
                       ("sah_kdop18", "SAH, 18 planes"), ("embree_low", "Embree, low quality"),
                       ("embree_medium", "Embree, medium quality"), ("fcl_obb", "FCL, oriented boxes")):
        for kind in KINDS:
            times = [r.get(f"any/{s}/{kind}/{tree}") for s in ANY_SCENES]
            if times[0] is not None:
                rows.append([f"{name}, {KINDS[kind]}"] + [shown(None if t is None else 1e3 * t) for t in times])
    pairs = [whole(r.get(f"any/{s}/baked/linear", "pairs")) for s in ANY_SCENES]
    return table(["us"] + list(ANY_SCENES.values()), [["pairs that touch"] + pairs] + rows) + made_on(r)


TRAVERSALS = {"one_first": "one first", "larger_first": "larger first", "alternate": "alternate",
              "both_at_once": "both at once",
              "breadth_first": "breadth first, from the roots"}


def descents_of(results, n):
    return results["cpu/descents" if n == SIZES[-1] else f"cpu/descents_{n}"]


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
    theirs = LITERATURE["backman_2011"]
    tests = [theirs["box_tests_per_depth"][n] for n in SIZES]
    ours = [(descents_of(results, n), n, "sah") for n in SIZES] + [(descents_of(results, SIZES[-1]), SIZES[-1], "linear")]
    at = descents_of(results, SIZES[-1]).parts("depth/linear/", 2)
    rows = [[d] + [whole(of.get(d)) for of in tests] + [whole(r.get(f"depth/{b}/{d}", "boxes")) for r, _, b in ours] for d in at]
    rows.append(["all"] + [whole(theirs["sizes"][n]["box_tests"]) for n in SIZES] +
                [whole(r.get(f"walk/{b}/both_at_once", "boxes")) for r, _, b in ours])
    rows.append(["pairs of triangles left"] + [whole(theirs["sizes"][n]["triangle_pairs"]) for n in SIZES] +
                [whole(r.get(f"walk/{b}/both_at_once", "leaves")) for r, _, b in ours])
    return table(["depth"] + [f"source, {int(n):,} triangles" for n in SIZES] + [f"here, {int(n):,}, `{b}`" for _, n, b in ours],
                 rows) + made_on(results["cpu/descents"])


@in_table("meshes-cuda")
def meshes_cuda(results):
    r = results["cuda/meshes"]
    asked = {"pairs": "pairs, sorted", "unsorted": "unsorted", "fast_unsorted": "`fast`, unsorted", "count": "count",
             "any": "any",
             "boxes": "box pairs alone", "contacts": "contacts"}
    rows = [[shows] + [shown(r.get(f"{q}/{kind}/cuda")) for q in asked] for kind, shows in KINDS.items()]
    near = ["pairs", "unsorted", "fast", "count", None, "boxes", None]
    beside = [shown(r.get(f"near/{q}/cuda")) if q else "" for q in near]
    rows.append([f"nearly on itself, {whole(r.get('near/pairs/cuda', 'pairs'))} pairs"] + beside)
    lines = table(["ms"] + list(asked.values()), rows)
    lines += [f"An empty call takes {shown(r.get('floor/call'))} ms; sorted pairs with one of the trees built in the call "
              f"{shown(r.get('pairs/baked_with_build/cuda'))} ms.", ""]
    rows = [[n.split("/", 1)[1].removesuffix("/cuda").replace("_", " ").replace("/", ", from depth "),
             shown(r.get(n))] for n in r.names("traversal/")]
    lines += ["By other traversals, pre-transformed and unsorted:", ""] + table(["traversal", "ms"], rows)
    rows = [[n.split("/")[1], shown(r.get(n)), whole(r.get(n, "pairs"))] for n in r.names("batch/") if "one_by_one" not in n]
    rows.append([f"{rows[-1][0]}, one by one", shown(r.get("batch/1000/one_by_one/cuda")),
                 whole(r.get("batch/1000/one_by_one/cuda", "pairs"))])
    lines += ["Posed pairs of a small mesh in one call:", ""] + table(["pairs of meshes", "ms", "pairs of triangles"], rows)
    rows = [[f"{int(n):,}", shown(r.get(f"build/bvh/cuda/{n}")),
             shown(r.get(f"sort/cuda/{n}"))] for n in r.parts("build/bvh/cuda/", 3)]
    return lines + ["Build of a linear BVH:", ""] + table(["triangles", "build, ms", "sort of its codes alone"], rows) + \
        made_on(r, f"; {r.context.get('mesh', 'the mesh above')}" if "mesh" in r.context else "")


def of_size(results, kind, n):
    return results[f"{kind}/meshes" if n == SIZES[-1] else f"{kind}/meshes_{n}"]


def near_phase(r, policy):
    """What contacts take beyond the walk of both trees."""
    both, walk = r.get(f"contacts/posed/{policy}"), r.get(f"boxes/posed/{policy}")
    return both - walk if both and walk else None


@in_table("sizes")
def sizes(results):
    middle, near = [], []
    for n in SIZES:
        theirs = LITERATURE["backman_2011"]["sizes"][n]
        cpu, cuda = [of_size(results, kind, n) for kind in ("cpu", "cuda")]
        size = f"{int(n):,}"
        middle.append([size] + [shown(ms) for ms in (
            theirs["middle_cpu_ms"], theirs["middle_gpu_ms"], cpu.get("boxes/posed/serial"), cuda.get("boxes/posed/cuda"),
            cpu.get("build/bvh/serial"), cuda.get(f"build/bvh/cuda/{n}"))])
        near.append([size] + [shown(ms) for ms in (
            theirs["near_cpu_ms"], theirs["near_gpu_ms"], near_phase(cpu, "serial"), near_phase(cuda, "cuda"),
            cpu.get("contacts/posed/serial"), cuda.get("contacts/posed/cuda"))])
    head = ["triangles", "source: processor", "source: GPU"]
    lines = ["Middle phase, the walk of two trees, and the build of one, in ms:", ""]
    lines += filled(head + ["walk: one core", "walk: device", "build: one core", "build: device"], middle)
    lines += ["Near phase, in ms: of ours what `contacts` takes beyond the walk, and then all that it takes:", ""]
    lines += filled(head + ["near phase: one core", "near phase: device", "contacts: one core", "contacts: device"], near)
    for kind in ("cpu", "cuda"):  # sizes may have been measured at different times
        of = {}
        for n in SIZES:
            of.setdefault(tuple(made_on(of_size(results, kind, n))), []).append(f"{int(n):,}")
        for said, sizes_of_it in of.items():
            lines += [line if len(of) == 1 or not line else f"{' and '.join(sizes_of_it)} triangles: {line}" for line in said]
    return lines


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
        rows.append([f"`{b}`"] + [shown(r.get(f"{what}/{b}/serial")) for what in ("build", "refit", "convert/wide")] +
                    [f"{r.get(at, key):.1f} / {r.get(wide, key):.1f}" for key in ("sah_cost", "mean_depth",
                                                                                  "greatest_depth")])
    for quality in ("low", "medium"):
        if r.get(f"build/embree_{quality}/serial") is not None:
            rows.append([f"Embree, {quality} quality", shown(r.get(f"build/embree_{quality}/serial"))] + [""] * 5)
    return table(["ms", "build", "refit", "conversion to `wide`", "`sah_cost`: as built / `wide`", "mean depth", "greatest depth"],
                 rows) + made_on(r)


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
    return table(["ms", "pre-transformed, unsorted", "pre-transformed", "posed", "bare", "bytes a triangle"], rows) + made_on(r)


@in_table("volumes")
def volumes(results):
    r, any_r = results["cpu/builders"], results["cpu/any"]
    rows = []
    for name, in_any in (("standard", "sah"), ("wide", "sah_wide"), ("oriented", "sah_oriented"), ("kdop18", "sah_kdop18"),
                         ("sphere", None)):
        cells = [shown(r.get(f"convert/{name}/sah/serial")), shown(r.get(f"unsorted/baked/sah/{name}")),
                 shown(r.get(f"pairs/posed/sah/{name}"))]
        for s in ANY_SCENES:
            pair = [in_any and any_r.get(f"any/{s}/{kind}/{in_any}") for kind in KINDS]
            cells.append(" / ".join(shown(1e3 * t) for t in pair) if all(pair) else "")
        rows.append([f"`{name}`"] + cells)
    return table(["", "conversion, ms", "pairs, pre-transformed, unsorted, ms", "posed, ms"] +
                 [f"any, {s}, pre-transformed / posed, us" for s in ANY_SCENES.values()], rows) + made_on(r)


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


# --- from the least scene to the richest ------------------------------------------------------------------------------------

@in_table("footprint")
def footprint(results):
    r, cuda, compiled = results["cpu/footprint"], results["cuda/footprint"], results["cpu/footprint_build"]
    rows, of_nvcc = [], ("seconds", "kernels", "registers", "stack", "instructions")
    for name in r.rows:
        each = r.get(name, "elements")
        rows.append([name.replace("/", ": ", 1), whole(each), f"{r.get(name, 'set_bytes') / each:.0f}",
                     whole(r.get(name, "index_bytes") / 1024),
                     shown(r.get(name)), shown(cuda.get(name)), shown(r.get(name, "test_ns")),
                     shown(1e6 * test / cuda.get(f"{name}/test", "tests")) if (test := cuda.get(f"{name}/test")) else "",
                     shown(compiled.get(name, "gcc_seconds")),
                     whole(compiled.get(name, "gcc_megabytes")),
                     whole((compiled.get(name, "gcc_code") or 0) / 1024)] +
                    [whole(compiled.get(name, f"nvcc_{k}")) for k in of_nvcc])
        measured = [compiled.get(name, f"nvcc_{k}") is not None for k in of_nvcc]
        if any(measured) and not all(measured):
            raise KeyError(f"{name}: {of_nvcc[measured.index(False)]}")
    head = ["scene: question", "elements", "bytes of each", "trees, KiB", "one core, ms", "device, ms", "one core: a test, ns",
            "device: a test, ns", "g++, s", "g++, MB", "code, KiB", "nvcc, s", "kernels", "registers", "stack", "instructions"]
    return filled(head, rows) + made_on(r) + made_on(cuda) + made_on(compiled)


@in_table("compile-cost")
def compile_cost(results):
    r = results["cpu/footprint_build"]
    rows = [[name.replace("/", ": ", 1)] + [shown(r.get(name, f"{c}_seconds")) for c in ("gcc", "nvcc")] +
            [whole(r.get(name, f"{c}_megabytes")) for c in ("gcc", "nvcc")] for name in r.rows]
    head = ["program", "g++: seconds of a processor", "nvcc", "g++: MB of memory", "nvcc"]
    return filled(head, rows) + made_on(r)


# --- equal values -----------------------------------------------------------------------------------------------------------

FORMS = ("bvh", "sah", "least_ids", "wide", "oriented", "quantised", "posed", "one_posed", "rows", "rows_of_b", "rows_posed", "list", "bodies")
ASKED = ("nearest_few", "nearest", "raycast_detailed", "raycast")


@in_table("equal")
def equal(results):
    r = results["cpu/equal"]
    pairs, rows = {}, {}
    for name in r.rows:
        scene, form, n = name.split("/")
        asked = next((a for a in ASKED if form.startswith(a)), None)
        if asked is None:
            pairs.setdefault((scene, n), {})[form] = name
        else:
            rows.setdefault((scene, asked, n), {})[form[len(asked) + 1:]] = name

    def over(of, form):
        return f"{r.get(of[form], 'over'):.2f}" if form in of else ""
    head = ["`distance` of", "each", "first call, ms", "later, ms", "without ties, ms", "trees made, ms"] + [f.replace("_", " ") for f in FORMS]
    body = [[scene.replace("_", ", "), whole(int(n)), shown(r.get(of["bvh"], "ms_first")), shown(r.get(of["bvh"])),
             shown(r.get(of["bvh"], "ms_without")), shown(r.get(of["bvh"], "ms_made"))] + [over(of, f) for f in FORMS]
            for (scene, n), of in pairs.items()]
    lines = table(head, body)
    layouts = ("", "wide", "oriented", "quantised", "posed", "bodies")
    head = ["1,000 rows", "", "shapes", "ms", "without ties, ms"] + [f or "bvh" for f in layouts]
    body = [[f"`{asked}`".replace("nearest_few", "nearest, 8"), scene, whole(int(n)), shown(r.get(of[""])), shown(r.get(of[""], "ms_without"))] +
            [over(of, f) for f in layouts] for (scene, asked, n), of in rows.items()]
    return lines + table(head, body, 2) + made_on(r)
