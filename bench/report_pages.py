# SPDX-License-Identifier: MIT
"""The paragraphs of README, the values of docs/choosing.md, and values within sentences."""

import math

from report_core import *  # noqa: F403
from report_motion import motion_scenes
from report_predicates import from_tests
from report_queries import BUILDERS, LABELS, SIZES, SPHERES, TRIANGLES, of_size


# --- README, docs/results/costs.md --------------------------------------------------------------------------------------------------

def paragraph(text):
    return textwrap.wrap(" ".join(text.split()), 125, break_long_words=False, break_on_hyphens=False) + [""]


def machine(r):
    return r.context["device"] if "device" in r.context else f"{r.context['machine']}, one core, {r.context['compiler'].split(' (')[0]}"


@in_table("cost-peers")
def cost_peers(results):
    """README's table: of each peer one kind of work, how long abut takes over it, and what either gets wrong."""
    rows = []

    def add(work, peer, over, ours, theirs, link):
        rows.append([f"[{work}]({link})", peer, f"{over:.2f}", ours, theirs])

    def wrong(r, name, of):
        return f"{whole(r.get(name, 'wrong'))} of {whole(of)}"

    pairs = results["cpu/peers"]
    for pair, work in (("box_box", "two turned boxes: do they touch"), ("hull66_hull66", "two hulls of 66 points: do they touch")):
        ties = [wrong(pairs, f"ties/{pair}/{name}", pairs.get(f"ties/{pair}/abut", "of")) + " that just touch or just do not" for name in ("abut", "Coal")]
        add(work, "Coal", pairs.get(f"boolean/{pair}/Coal", "over"), *ties, "results/peers.md")
    states = {name: pairs.get(f"states/mesh/{name}", "ns") for name in ("abut", "Coal_boxes", "Coal_tree")}
    best = min(("Coal_boxes", "Coal_tree"), key=states.get)
    add("an arm of eight links and a mesh", "Coal", states["abut"] / states[best], *(wrong(pairs, f"states/mesh/{name}", pairs.get("states/mesh/abut", "of"))
                                                                                   for name in ("abut", best)), "results/peers.md")
    triangles = results["cpu/triangles"]
    for peer, name in (("cgal", "CGAL's exact predicates"), ("fcl", "FCL")):
        add("two triangles: do they touch", name, triangles.get("pair/filtered/double/20") / triangles.get(f"pair/{peer}/double/20"), "exact",
            "exact" if peer == "cgal" else "not counted", "results/costs.md")
    distance = results["cpu/distance"]
    add("distance of two scans that are apart", "FCL", distance.get("distance/scan/apart/oriented") / distance.get("distance/scan/apart/fcl"),
        "not counted", "not counted", "results/distance.md#distances")
    rays = results["cpu/raycast"]
    for peer, name in (("embree", "Embree"), ("tinybvh", "tinybvh")):
        at = [f"raycast/coherent/{of}/serial" for of in ("wide_sah/filtered", f"{peer}/float")]
        add("first hits of a camera's rays", name, rays.get(at[0]) / rays.get(at[1]), *(wrong(rays, row, rays.get(row, "rays")) for row in at),
            "results/rays.md")
    near = results["cpu/nearest"]
    for peer, name in (("fcpw", "FCPW"), ("embree", "Embree")):
        row = f"nearest/{peer}/serial/100000"
        points = whole(near.get(row, "points"))
        add("nearest triangles of points far away", name, near.get("nearest/oriented_sah/serial/100000") / near.get(row), f"0 of {points}",
            f"{whole(near.get(row, 'wrong'))} of {points}", "results/distance.md#nearest-points")
    winding = results["cpu/winding"]
    row = "armadillo_345944/libigl/2"
    add("winding numbers, as near to the true ones", "libigl", winding.get(row, "like"), *(f"{winding.get(row, 'rms'):.0e} off",) * 2, "results/winding.md")
    times = results["cpu/impact_times"]
    ours, theirs = (f"cloth-ball/vertex_face/{name}" for name in ("abut", "ACCD"))
    add("when a vertex meets a face", "IPC Toolkit", times.get(ours, "ns") / times.get(theirs, "ns"),
        *(f"{whole(times.get(row, 'phantom'))} that do not, {times.get(row, 'early'):.0e} early" for row in (ours, theirs)), "results/impact-times.md")
    ways = results["cpu/turning"]
    ours, theirs = "short/abut", "short/fcl_naive"
    add("motions of a robot that turns", "FCL", ways.get(ours) / ways.get(theirs), f"{whole(ways.get(ours, 'missed'))} of 1,000",
        f"{whole(ways.get(theirs, 'phantom'))} that do not meet, {whole(ways.get(theirs, 'late'))} late", "results/turning.md")
    return table(["work", "beside", "time of `abut` over it", "`abut` gets wrong", "it gets wrong"], rows, 2)


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
    return paragraph(f"""**Spheres and a mesh.** A torus of {TRIANGLES:,} triangles and {SPHERES:,} spheres of radius 3, the scene of Lee and
        Hsieh 2019. {whole(cpu.get('all/bvh/serial', 'pairs'))} pairs touch. They report {whole(quick)} ms on a GPU, and
        {slow / 60000:.1f} minutes by brute force on one core. The table is of sorted pairs in float, by `filtered`: they are exact. A build
        and a query in one call, "both", are timed by themselves. The last column is the time of `filtered` over that of `fast`.""") + \
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
    return paragraph(f"""**One triangle against 20 million,** in float, with 1 % hits. `count` takes {shown(count)} ms on the
        {cuda.context['device']}, and {times} times what `fast` takes. Reading the same bytes takes
        {shown(cuda.get(f'read/float/cuda/{n}'))} ms. Maffina 2012 took {whole(theirs['gpu_ms'][n])} ms on a GTX 590, and
        {whole(theirs['one_core_ms'][n])} ms on one core. Pairs that all differ, with 1.7 % hits (with 20 %): one core decides
        {both('filtered')} million a second ({cpu.context['machine']}). In the same run: `fast` {both('fast')}{others}.""")


@in_table("cost-meshes")
def cost_meshes(results):
    cpu, cuda = results["cpu/meshes"], results["cuda/meshes"]
    batch = "batch/1000/cuda"
    embree = [cpu.get(f"unsorted/embree_{q}/serial") for q in ("low", "medium")]
    peers_say = f" Embree with the same test at its leaves takes {shown(min(embree))} on one core, unsorted." if all(embree) else ""
    if cpu.get("unsorted/fcl_obb/serial"):
        peers_say += f" FCL takes {shown(cpu.get('unsorted/fcl_obb/serial'))}."
    baked, posed = [[shown(r.get(f"pairs/{how}/{policy}")) for r, policy in ((cpu, "serial"), (cuda, "cuda"))]
                    for how in ("baked", "posed")]
    return paragraph(f"""**Two meshes** of 345,944 triangles with a tree each have {whole(cpu.get('pairs/baked/serial', 'pairs'))} pairs. Sorted and
        exact, they take {baked[0]} ms on one core ({cpu.context['machine']}), and {baked[1]} ms on the {cuda.context['device']}; under a
        pose {posed[0]} and {posed[1]} ms.{peers_say} A tree takes
        {shown(cpu.get('build/bvh/serial'))} ms to build on the core, and {shown(cuda.get('build/bvh/cuda/345944'))} on the device. 1,000
        posed pairs of meshes of 2,766 triangles, in one call on the device, take {shown(cuda.get(batch))} ms. They have
        {whole(cuda.get(batch, 'pairs'))} pairs of triangles.""")


@in_table("cost-wrong")
def cost_wrong(results):
    parts = []
    for page, what in (("sphere-triangle.md", "spheres and triangles"), ("triangle-triangle.md", "two triangles")):
        rows = [row for both in from_tests(page).values() for row in both.values()]
        wrong, pairs = sum(int(r["wrong"]) for r in rows), sum(int(r["pairs"]) for r in rows)
        parts.append(f"{wrong} of {pairs / 1e6:,.0f} million pairs of {what} ([{len(rows) // 2} families](results/{page}))")
    r = results["cpu/trade"]
    at = [r.get(f"triangle_triangle/touching/{s}/fast", "wrong_per_million") for s in SCALARS]
    return paragraph(f"""**Wrong answers.** Pairs were built to break the arithmetic, in float and double, and compared with rational numbers.
        `filtered` and `exact` decided {' and '.join(parts)} wrongly. `fast` errs where shapes nearly touch. Of two triangles one
        rounding step from contact it is wrong in {at[0] / 1e4:.0f} % (float) and {at[1] / 1e4:.0f} % (double).""")


@in_table("cost-motion")
def cost_motion(results):
    cpu, cuda = results["cpu/motion"], results["cuda/motion"]
    at = next(s for s in motion_scenes(cuda) if s.startswith("cloth-ball/"))
    return paragraph(f"""**In motion.** A cloth of {whole(cuda.get(f'{at}/build', 'faces'))} triangles folds over a ball. One step of it against
        itself has {whole(cuda.get(f'{at}/impacts', 'impacts'))} impacts. With their times they take
        {shown(cpu.get('stage/cloth-ball/float/self_impacts'))} ms on one core ({cpu.context['machine']}), and
        {shown(cuda.get(f'{at}/frame'))} ms, with the refit, on the {cuda.context['device']}.""")


# --- docs/benchmarks.md, docs/results -----------------------------------------------------------------------------------------

# The results of each page of docs/results that a program fills.
RESULTS_OF = {
    "trade": ["cpu/trade", "cpu/trade_others", "cuda/trade", "cuda/trade_others", "cuda/trade_solids", "cuda/trade_within", "cuda/trade_hulls"],
    "spheres": ["cpu/spheres_mesh", "cuda/spheres_mesh"],
    "triangles": ["cpu/triangles", "cpu/families", "cpu/ties", "cuda/triangles", "cuda/ties"],
    "distance": ["cpu/nearest", "cpu/distance", "cpu/within", "cuda/nearest", "cuda/distance"],
    "trees": ["cpu/builders", "cpu/fronts", "cuda/builders", "cuda/fronts"],
    "convex": ["cpu/hulls"],
    "rays": ["cpu/raycast", "cuda/raycast"],
    "bodies": ["cpu/bodies", "cuda/bodies"],
    "meshes": ["cpu/meshes", "cpu/any", "cpu/descents", "cpu/validate", "cuda/meshes", "cuda/schedules", "cuda/validate"],
    "motion": ["cpu/motion", "cpu/pair_rules", "cuda/motion", "cuda/motion_flying", "cuda/pair_rules"],
    "extremes": ["cpu/extremes", "cuda/extremes"],
    "scaling": ["cpu/cores", "cpu/cores_busy", "cpu/distributed"],
    "devices": ["cuda/devices", "cuda/devices_large", "cuda/devices_divided"],
    "on-a-device": ["cuda/solids", "cuda/sweep", "cuda/turning", "cuda/arm", "cuda/cloth_step"],
    "footprint": ["cpu/footprint", "cpu/footprint_build", "cuda/footprint"],
}


def measured(page):
    """The head of a page: which commands measure it, and on which machines that was done."""
    def make(results):
        lines, there = ["```sh"], [results[name] for name in RESULTS_OF[page]]
        for kind in ("cpu", "cuda"):
            names = [name.split("/")[1] for name in RESULTS_OF[page] if name.startswith(kind)]
            lines += [f"sh cmake/report.sh --into-docs --{kind} {' '.join(f'--only {name}' for name in names)}"] if names else []
        where = dict.fromkeys(r.context["device"] if "device" in r.context else r.context["machine"] for r in there)
        dates = sorted(r.context["date"] for r in there)
        when = dates[0] if dates[0] == dates[-1] else f"{dates[0]} to {dates[-1]}"
        return lines + ["```", ""] + paragraph(f"Measured on: {'; '.join(where)}; {when}. Each table says which. How: [benchmarks](benchmarks.md#how-it-is-measured).")
    return make


for of_page in RESULTS_OF:
    in_table(f"measured-{of_page}")(measured(of_page))


@in_table("results-pairs")
def results_pairs(results):
    """How many pairs of each family the pages have that tests write whole."""
    pages = {}
    for path in sorted((ROOT / "docs" / "results").glob("*.md")):
        if "\n<!-- checksum: " in path.read_text(encoding="utf-8"):
            counts = {int(row["pairs"]) for both in from_tests(path.name).values() for row in both.values()}
            pages.setdefault(" to ".join(whole(n) for n in sorted({min(counts), max(counts)})), []).append(path.stem)
    parts = [f"{pairs} in {', '.join(f'[{name}](results/{name}.md)' for name in names)}" for pairs, names in pages.items()]
    return paragraph(f"Pairs of each family and scalar: {'; '.join(parts)}.")


def value(name):
    def add(make):
        VALUES[name] = make
        return make
    return add


# --- docs/choosing.md -------------------------------------------------------------------------------------------------------

def choosing():
    """Values that are times of single rows."""
    rows = {"serial": ("cpu/meshes", "pairs/posed/serial"),
            "cuda": ("cuda/meshes", "pairs/posed/cuda"), "cuda-small": ("cuda/meshes_2766", "pairs/posed/cuda"),
            "two-trees": ("cpu/builders", "pairs/posed/linear/standard"),
            "one-tree": ("cpu/builders", "one_sided/linear/standard"),
            "openmp": ("cpu/meshes", "pairs/posed/openmp"), "serial-small": ("cpu/meshes_2766", "pairs/posed/serial"),
            "impacts-conservative": ("cpu/motion", "stage/cloth-ball/float/self_impacts_conservative"),
            "impacts-filtered": ("cpu/motion", "stage/cloth-ball/float/self_impacts"),
            "spheres-grid": ("cuda/spheres_mesh", "all/grid/cuda"), "spheres-bvh": ("cuda/spheres_mesh", "all/bvh/cuda"),
            "spheres-none-small": ("cuda/spheres_mesh", "break_even/none/4096/18432"),
            "spheres-bvh-small": ("cuda/spheres_mesh", "break_even/bvh/4096/18432"),
            "spheres-none-core": ("cpu/spheres_mesh", "break_even/none/8/8192"),
            "spheres-bvh-core": ("cpu/spheres_mesh", "break_even/bvh/8/8192"),
            "front": ("cuda/fronts", "cloth-funnel/2/self/boxes"),
            "any": ("cuda/meshes", "any/posed/cuda"), "count": ("cuda/meshes", "count/posed/cuda"),
            "unsorted": ("cuda/meshes", "unsorted/posed/cuda"), "pairs": ("cuda/meshes", "pairs/posed/cuda"),
            "contacts": ("cuda/meshes", "contacts/posed/cuda"),
            "equal-ms": ("cuda/footprint", "spheres/count, equal radii"),
            "own-ms": ("cuda/footprint", "spheres/count, own radii"),
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
        for shape in ("sphere", "box"):
            VALUES[f"choosing-{shape}-{a}"] = lambda results, n=f"{shape}_{shape}/random/float/{a}": needed(
                results["cpu/trade_others"].get(n, "ns"))
    VALUES["choosing-double-cpu"] = lambda results: needed(
        results["cpu/trade"].get("triangle_triangle/random/double/filtered", "ns"))
    for scalar in SCALARS:
        VALUES[f"choosing-{scalar}-cuda"] = lambda results, n=f"triangle_triangle/random/{scalar}/filtered": needed(
            1e6 * results["cuda/trade"].get(n) / results["cuda/trade"].get(n, "pairs"))
    VALUES["choosing-front-without"] = lambda results: needed(
        results["cuda/fronts"].get("cloth-funnel/2/self/boxes", "without_ms"))
    for radii in ("equal", "own"):
        VALUES[f"choosing-{radii}-bytes"] = lambda results, n=f"spheres/count, {radii} radii": whole(
            results["cuda/footprint"].get(n, "set_bytes") / results["cuda/footprint"].get(n, "elements"))


@value("choosing-sah-pays")
def sah_pays(results):
    """How often a tree has to be asked until the better one has made up for its build."""
    r = results["cpu/builders"]
    job = [r.get(f"pairs/posed/{b}/standard") for b in ("linear", "sah")]
    return whole(math.ceil((r.get("build/sah/serial") - r.get("build/linear/serial")) / (job[0] - job[1])))


@value("choosing-wide-pays")
def wide_pays(results):
    r = results["cpu/builders"]
    return whole(math.ceil(r.get("convert/wide/sah/serial") /
                           (r.get("pairs/posed/sah/standard") - r.get("pairs/posed/sah/wide"))))


def needed(value):
    if value is None:
        raise KeyError("a row")
    return shown(value)


choosing()


# --- values within sentences ------------------------------------------------------------------------------------------------

@value("devices-large-pairs")
def devices_large_pairs(results):
    return needed(results["cuda/devices_large"].get("devices_large/pairs/mesh/cuda"))


@value("devices-team")
def devices_team(results):
    """By how many per cent one device, named by `cuda_devices`, differs from `cuda` in large scenes, at most."""
    r = results["cuda/devices_large"]
    return whole(math.ceil(max(100 * abs(r.get(n) / r.get(n.replace("one_device", "cuda")) - 1) for n in r.rows
                               if n.endswith("/one_device"))))


@value("devices-team-short")
def devices_team_short(results):
    """The same of short queries, in us."""
    r = results["cuda/devices"]
    return whole(math.ceil(max(1e3 * abs(r.get(n) - r.get(n.replace("one_device", "cuda")))
                               for scene in ("trees", "look_up") for n in r.rows if n.endswith(f"/{scene}/one_device"))))


@value("extremes-motion")
def extremes_motion(results):
    r = results["cpu/extremes"]
    return needed(max(r.get(n, "filtered_ns") for kind in ("vertex_face", "edge_edge")
                      for n in r.names(f"pair/{kind}/double/spread/")) / 1e6)


def worst_at_rest(results):
    """The pair at rest, of exponents far apart, that takes most on a device."""
    r = results["cuda/extremes"]
    return max((n for n in r.rows if "/spread/" in n and n.split("/")[1] not in ("vertex_face", "edge_edge")),
               key=lambda n: r.get(n, "filtered_ns"))


for name, source, column in (("extremes-device", "cuda", "filtered_ns"), ("extremes-device-fast", "cuda", "fast_ns"),
                             ("extremes-core", "cpu", "filtered_ns")):
    VALUES[name] = lambda results, s=source, c=column: needed(results[f"{s}/extremes"].get(worst_at_rest(results), c))
VALUES["trade-left"] = lambda results: shown(
    100 * (1 - results["cpu/trade"].get("triangle_triangle/random/float/filtered", "filter_decides")))


@value("motion-left")
def motion_left(results):
    r = results["cpu/motion"]
    looks = [r.rows[n] for n in r.names("look/")]
    return whole(sum(row["candidates"] * (row["open_late"] + row["no_time"]) for row in looks))


@value("motion-ruled-out")
def motion_ruled_out(results):
    """Per cent of the candidates to which the first look says no."""
    r = results["cpu/motion"]
    looks = [r.rows[n] for n in r.names("look/")]
    no = sum(row["candidates"] * sum(row[f"no_by_{k}"] for k in ("volume", "direction", "areas")) for row in looks)
    return f"{100 * no / sum(row['candidates'] for row in looks):.0f}"


@value("trade-funnel-off")
def trade_funnel_off(results):
    return f"{100 * results['cpu/trade_scenes'].get('ccd/cloth-funnel/float', 'time_error'):.0f}"


def device_pays(row):
    """The least size from which on a device takes less time than one core."""
    def least(results):
        faster = [of_size(results, "cuda", n).get(row("cuda", n)) < of_size(results, "cpu", n).get(row("serial", n))
                  for n in SIZES]
        return f"{int(next(n for i, n in enumerate(SIZES) if all(faster[i:]))):,}"
    return least


VALUES["device-pays-walk"] = device_pays(lambda policy, n: f"boxes/posed/{policy}")
VALUES["device-pays-build"] = device_pays(
    lambda policy, n: f"build/bvh/cuda/{n}" if policy == "cuda" else "build/bvh/serial")


@value("build-over-refit-cpu")
def build_over_refit_cpu(results):
    r = results["cpu/builders"]
    return f"{r.get('build/linear/serial') / r.get('refit/linear/serial'):.1f}"


@value("build-over-refit-cuda")
def build_over_refit_cuda(results):
    r = results["cuda/builders"]
    return f"{r.get('build/mesh') / r.get('refit/mesh'):.1f}"


@value("kdop-conversion")
def kdop_conversion(results):
    r = results["cpu/builders"]
    return f"{r.get('convert/kdop18/sah/serial') / r.get('convert/oriented/sah/serial'):.2f}"
