# SPDX-License-Identifier: MIT
"""The plots of docs/figures, from the same results as the tables (bench/report.py). PLOTS holds functions by file name.

Text is text, the background is transparent and colours are of middle lightness, so that a plot can be read on white and on
black. The same results give the same bytes.
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402

from report_core import ARITHMETICS, LITERATURE, SCALARS  # noqa: E402
from report_extremes import EXTREMES, PAIR_KINDS, other_kinds  # noqa: E402
from report_motion import motion_scenes  # noqa: E402
from report_predicates import HULLS, IN_MOTION, IN_TIME, INPUTS, OTHERS, PREDICATES, SOLIDS, WITHIN, \
    WITH_HULLS, family_ratios, kinds_with_families  # noqa: E402
from report_queries import ANY_SCENES, BUILDERS, SIZES, SPHERES, descents_of, of_size, policies  # noqa: E402
from report_scaling import DEALS, Model, rank_counts, sizes  # noqa: E402

GREY = "#888888"
COLOURS = {"fast": "#d9773f", "filtered": "#3f8fd9", "exact": "#3fa66b", "resolve": "#b05fc7", "conservative": "#c7a52e"}
SERIES = ("#3f8fd9", "#d9773f", "#3fa66b", "#b05fc7", "#c7a52e", "#d9587f", "#5fb8b8", "#8f7ee0")
MARKS = {"random": "o", "touching": "X", "lattice": "s"}
PLOTS = {}

matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "abut", "font.size": 10, "font.family": "sans-serif", "text.color": GREY,
    "axes.edgecolor": GREY, "axes.labelcolor": GREY, "axes.titlecolor": GREY, "axes.titlesize": 10.5, "xtick.color": GREY,
    "ytick.color": GREY, "legend.frameon": False, "axes.grid": True, "grid.color": GREY, "grid.alpha": 0.25,
    "axes.facecolor": "none", "figure.facecolor": "none", "savefig.facecolor": "none", "axes.spines.top": False,
    "axes.spines.right": False, "legend.fontsize": 9})


def plot(name):
    def add(make):
        PLOTS[name] = make
        return make
    return add


def draw(results, folder, verbose=False, also_png=None):
    """Writes those plots that there are results for, and returns their names."""
    folder.mkdir(parents=True, exist_ok=True)
    drawn = []
    for name, make in PLOTS.items():
        try:
            figure = make(results)
        except Exception as problem:  # a plot less is no reason to have none
            if verbose:
                print(f"no {name}.svg: {problem}")
            continue
        finally:
            plt.close("all")
        figure.savefig(folder / f"{name}.svg", bbox_inches="tight", metadata={"Date": None, "Creator": None})
        if also_png:
            figure.savefig(also_png / f"{name}.png", dpi=80, bbox_inches="tight")
        drawn.append(f"{name}.svg")
    return drawn


def of_machine(r):
    c = r.context
    return c["device"] if "device" in c else f"one core, {c['machine']}"


def grid(count, columns=3, width=9.6, height=2.7, **more):
    rows = -(-count // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(width, height * rows), squeeze=False, constrained_layout=True,
                                **more)
    for spare in axes.flat[count:]:
        spare.set_visible(False)
    return figure, list(axes.flat[:count])


def below(figure, handles, columns):
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0), ncol=columns)


def beside(figure, handles):
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(1, 0.95))


# --- speed against wrong answers --------------------------------------------------------------------------------------------

def few_ticks(low, high):
    """Round numbers for an axis of logarithms: two at least, without labels that meet."""
    for steps in ((1, 3), (1, 2, 5), (1, 3, 5, 7), (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8)):
        ticks = [s * 10.0**e for e in range(-12, 13) for s in steps if low <= s * 10.0**e <= high]
        if len(ticks) > 1:
            return ticks
    return [low, high]


def trade(r, million_a_second, predicates=PREDICATES, arithmetics=ARITHMETICS):
    predicates = {p: name for p, name in predicates.items() if r.names(p + "/")}
    figure, axes = grid(len(predicates), min(3, len(predicates)), sharey=True)
    for axis, (predicate, name) in zip(axes, predicates.items()):
        for scalar in SCALARS:
            for kind in INPUTS:
                for a in arithmetics:
                    at = f"{predicate}/{kind}/{scalar}/{a}"
                    if at not in r.rows:
                        continue
                    wrong = r.get(at, "wrong_per_million")
                    axis.plot(million_a_second(r, at), max(wrong, 0.3), MARKS[kind], color=COLOURS[a],
                              markersize=8 if scalar == "double" else 6,
                              fillstyle="full" if scalar == "float" else "none", clip_on=False)
        axis.set_title(name)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_ylim(0.2, 1e6)
        axis.set_yticks([0.3, 10, 1e3, 1e5], ["0", "10", "1,000", "100,000"])
        axis.minorticks_off()
        low, high = axis.get_xlim()
        axis.set_xlim(low, high)
        axis.set_xticks(few_ticks(low, high))
        axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda v, _: f"{v:,g}"))
        axis.set_xlabel("million pairs a second")
    for axis in axes[::3]:
        axis.set_ylabel("wrong answers per million")
    handles = [Line2D([], [], marker="o", linestyle="", color=COLOURS[a], label=a) for a in arithmetics]
    handles += [Line2D([], [], marker=m, linestyle="", color=GREY, label=k) for k, m in MARKS.items()]
    handles += [Line2D([], [], marker="o", linestyle="", color=GREY, fillstyle=f, label=s) for s,
                f in (("float", "full"), ("double", "none"))]
    below(figure, handles, 8)
    figure.suptitle(f"Throughput against wrong answers: {of_machine(r)}", color=GREY)
    return figure


@plot("trade-cpu")
def trade_cpu(results):
    return trade(results["cpu/trade"], lambda r, name: 1e3 / r.get(name, "ns"))


@plot("trade-cuda")
def trade_cuda(results):
    return trade(results["cuda/trade"], lambda r, name: r.get(name, "pairs") / r.get(name) / 1e3)


@plot("trade-others-cpu")
def trade_others_cpu(results):
    return trade(results["cpu/trade_others"], lambda r, name: 1e3 / r.get(name, "ns"), {**OTHERS, **WITHIN, **IN_MOTION}, IN_TIME)


@plot("trade-solids-cpu")
def trade_solids_cpu(results):
    return trade(results["cpu/trade_others"], lambda r, name: 1e3 / r.get(name, "ns"), SOLIDS)


@plot("trade-hulls-cpu")
def trade_hulls_cpu(results):
    return trade(results["cpu/trade_others"], lambda r, name: 1e3 / r.get(name, "ns"), HULLS)


@plot("trade-others-cuda")
def trade_others_cuda(results):
    return trade(results["cuda/trade_others"], lambda r, name: r.get(name, "pairs") / r.get(name) / 1e3, OTHERS)


@plot("trade-solids-cuda")
def trade_solids_cuda(results):
    return trade(results["cuda/trade_solids"], lambda r, name: r.get(name, "pairs") / r.get(name) / 1e3, SOLIDS)


@plot("trade-hulls-cuda")
def trade_hulls_cuda(results):
    return trade(results["cuda/trade_hulls"], lambda r, name: r.get(name, "pairs") / r.get(name) / 1e3, WITH_HULLS)


def motion(r, scenes, points):
    """points(r, kind, scene, scalar, arithmetic) are million candidates a second, missed and phantom per million; or nothing."""
    figure, axes = grid(2, 2, height=3.2, sharey=True)
    marks = dict(zip(scenes, "oXs^Dv"))
    drawn = 0
    for axis, kind, title in zip(axes, ("vertex_face", "edge_edge"), ("vertex, face", "edge, edge")):
        for scene, mark in marks.items():
            for scalar in SCALARS:
                for a in IN_TIME:
                    speed, missed, phantom = points(r, kind, scene, scalar, a)
                    if speed is None or missed is None:
                        continue
                    axis.plot(speed, max(missed + phantom, 0.3), mark, color=COLOURS[a], clip_on=False,
                              fillstyle="full" if scalar == "float" else "none", markersize=7)
                    drawn += 1
        axis.set_title(title)
        axis.set_yscale("log")
        axis.set_ylim(0.2, 1e6)
        axis.set_yticks([0.3, 10, 1e3, 1e5], ["0", "10", "1,000", "100,000"])
        axis.minorticks_off()
        axis.set_xlim(0)
        axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda v, _: f"{v:,g}"))
        axis.set_xlabel("million candidates a second")
    if drawn == 0:
        raise LookupError("no answers were compared")
    axes[0].set_ylabel("wrong answers per million")
    handles = [Line2D([], [], marker="o", linestyle="", color=COLOURS[a], label=a) for a in ("fast", "conservative",
                                                                                             "filtered")]
    handles += [Line2D([], [], marker=m, linestyle="", color=GREY, label=s) for s, m in marks.items()]
    handles += [Line2D([], [], marker="o", linestyle="", color=GREY, fillstyle=f, label=s) for s,
                f in (("float", "full"), ("double", "none"))]
    below(figure, handles, 5 if len(handles) > 8 else 8)
    figure.suptitle(f"Features in motion, candidates of scenes: {of_machine(r)}", color=GREY)
    return figure


@plot("trade-within-cuda")
def trade_within_cuda(results):
    return trade(results["cuda/trade_within"], lambda r, name: r.get(name, "pairs") / r.get(name) / 1e3, WITHIN)


@plot("trade-motion")
def trade_motion(results):
    r = results["cpu/motion"]

    def points(r, kind, scene, scalar, a):
        at = f"time/{scene}/{scalar}/{kind}/{a}"
        speed = r.get(at, "items_per_second")
        return speed and speed / 1e6, r.get(at, "missed_per_million"), r.get(at, "phantom_per_million")
    return motion(r, r.parts("time/", 1), points)


@plot("trade-motion-cuda")
def trade_motion_cuda(results):
    def points(r, kind, scene, scalar, a):
        at = f"{scene}/{scalar}/{kind}/{a}/"
        first = r.get(at + "first")
        speed = first and r.get(at + "first", "items") / (first + (r.get(at + "second") or 0)) / 1e3
        return speed, r.get(at + "wrong", "missed_per_million"), r.get(at + "wrong", "phantom_per_million")
    r = results["cuda/motion"]
    return motion(r, list(dict.fromkeys(s.split("/")[0] for s in motion_scenes(r))), points)


def cost(r, time):
    figure, axes = grid(2, 2, height=3.4, sharey=True)
    for axis, scalar in zip(axes, SCALARS):
        labels, at = [], 0
        for predicate, name in PREDICATES.items():
            for kind in INPUTS:
                base = time(r, f"{predicate}/{kind}/{scalar}/fast")
                for a in ("filtered", "exact"):
                    axis.plot(time(r, f"{predicate}/{kind}/{scalar}/{a}") / base, at, MARKS[kind], color=COLOURS[a],
                              markersize=6)
            labels.append(name)
            at += 1
        axis.axvline(1, color=COLOURS["fast"], linewidth=1.2)
        axis.set_yticks(range(len(labels)), labels)
        axis.set_xscale("log")
        axis.xaxis.set_major_locator(matplotlib.ticker.LogLocator(10, (1, 2, 5), numticks=20))
        axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda v, _: f"{v:,g}"))
        axis.minorticks_off()
        axis.set_xlabel("time over that of fast")
        axis.set_title(scalar)
    axes[0].invert_yaxis()
    handles = [Line2D([], [], marker="o", linestyle="", color=COLOURS[a], label=a) for a in ("filtered", "exact")]
    handles += [Line2D([], [], marker=m, linestyle="", color=GREY, label=k) for k, m in MARKS.items()]
    below(figure, handles, 5)
    figure.suptitle(f"What certainty costs: {of_machine(r)}", color=GREY)
    return figure


@plot("cost-cpu")
def cost_cpu(results):
    return cost(results["cpu/trade"], lambda r, name: r.get(name, "ns"))


@plot("cost-cuda")
def cost_cuda(results):
    return cost(results["cuda/trade"], lambda r, name: r.get(name))


def family_cost(r):
    names = r.parts("family/", 3)
    if not names:
        raise LookupError("no families")
    figure, (axis,) = grid(1, 1, height=7.5)
    for scalar, fill in zip(SCALARS, ("full", "none")):
        for a in ("filtered", "exact"):
            ratio = [r.get(f"family/fast/{scalar}/{f}", "items_per_second") / v if (v := r.get(f"family/{a}/{scalar}/{f}",
                                                                                               "items_per_second"))
                     else None for f in names]
            if any(ratio):
                axis.plot(ratio, range(len(names)), "o", color=COLOURS[a], fillstyle=fill, label=f"{a}, {scalar}")
    axis.axvline(1, color=COLOURS["fast"], linewidth=1.2)
    axis.set_yticks(range(len(names)), names)
    axis.invert_yaxis()
    axis.set_xscale("log")
    axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda v, _: f"{v:,g}"))
    axis.set_xlabel("time over that of fast")
    axis.legend()
    axis.set_title(f"Two triangles, families of the tests: {of_machine(r)}")
    return figure


@plot("families-cpu")
def families_cpu(results):
    return family_cost(results["cpu/triangles"])


@plot("families-kinds")
def families_kinds(results):
    """From the least to the greatest of all families of a kind of pairs, and the middle one."""
    r = results["cpu/families"]
    kinds = kinds_with_families(r)
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 0.24 * len(kinds) + 1.2), sharey=True, sharex=True, constrained_layout=True)
    for axis, scalar in zip(axes, SCALARS):
        for a, shift in (("filtered", -0.15), ("exact", 0.15)):
            of_kinds = [sorted(ratio for ratio, _ in family_ratios(r, kind, scalar, a)) for kind in kinds]
            at = [row + shift for row in range(len(kinds))]
            axis.hlines(at, [x[0] for x in of_kinds], [x[-1] for x in of_kinds], color=COLOURS[a], linewidth=1.5)
            axis.plot([x[len(x) // 2] for x in of_kinds], at, ".", color=COLOURS[a])
        axis.axvline(1, color=COLOURS["fast"], linewidth=1.2)
        axis.set_xscale("log")
        axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda v, _: f"{v:,g}"))
        axis.set_xlabel("time over that of fast")
        axis.set_title(scalar)
    axes[0].set_yticks(range(len(kinds)), [kind.replace("_", " ") for kind in kinds])
    axes[0].set_ylim(len(kinds), -1)
    handles = [Line2D([], [], color=COLOURS[a], marker=".", label=a) for a in ("filtered", "exact")]
    below(figure, handles, 2)
    figure.suptitle(f"Pairs of all kinds: least, middle and greatest of the families of the tests, {of_machine(r)}", color=GREY)
    return figure


@plot("families-cuda")
def families_cuda(results):
    return family_cost(results["cuda/triangles"])


BY_POWER = ("scaled", "moved", "flattened", "snapped")
# Of narrow columns.
SHORT_TITLES = {"moved": "moved from\nthe origin", "flattened": "flattened", "snapped": "snapped\nto a lattice",
                "spread": "spread of\nexponents", "undecided": "undecided by\nthe filter", "unresolved": "left to the\nlast stage"}


def at_steps(r, kind, scalar, what):
    """What `filtered` takes, by the value of the step; the range of double is more than an axis can hold, and its powers of
    ten are not."""
    points = [(float(n.split("/")[-1]), r.get(n, "filtered_ns")) for n in r.names(f"pair/{kind}/{scalar}/{what}/")]
    if what in BY_POWER:
        points = [(math.log10(x), y) for x, y in points if x > 0]
    return sorted((x, y) for x, y in points if y)


def of_steps(what):
    return "power of ten" if what in BY_POWER else "powers of two" if what == "spread" else "share"


def extremes(r):
    figure, axes = grid(len(EXTREMES), 3, height=2.6)
    for axis, (what, title) in zip(axes, EXTREMES.items()):
        for index, kind in enumerate(PAIR_KINDS):
            for scalar, style in zip(SCALARS, ("-", "--")):
                points = at_steps(r, kind, scalar, what)
                if points:
                    axis.plot(*zip(*points), style, marker=".", color=SERIES[index])
        axis.set_title(title)
        axis.set_yscale("log")
        axis.set_xscale("log" if what == "spread" else "linear")
        axis.set_xlabel(of_steps(what))
        axis.minorticks_off()
        axis.set_ylabel("filtered, ns a pair")
    handles = [Line2D([], [], color=SERIES[i], label=name) for i, name in enumerate(PAIR_KINDS.values())]
    handles += [Line2D([], [], color=GREY, linestyle=s, label=t) for s, t in zip(("-", "--"), SCALARS)]
    below(figure, handles, 6)
    figure.suptitle(f"What filtered takes at the extremes: {of_machine(r)}", color=GREY)
    return figure


def extremes_of_others(r):
    """A row for each kind, and a column for each extreme: two of what is scaled, since the range of double is so much wider."""
    kinds = other_kinds(r)
    if not kinds:
        raise LookupError("no other kinds")
    columns = [("scaled", (scalar,), f"scaled,\n{scalar}") for scalar in SCALARS]
    columns += [(what, SCALARS, title) for what, title in SHORT_TITLES.items()]
    figure, axes = plt.subplots(len(kinds), len(columns), figsize=(12.8, 1.05 * len(kinds) + 0.9), squeeze=False, sharey=True,
                                sharex="col", constrained_layout=True)
    for row, (kind, name) in zip(axes, kinds.items()):
        for axis, (what, scalars, _) in zip(row, columns):
            for scalar, style, colour in zip(SCALARS, ("-", "--"), SERIES):
                points = at_steps(r, kind, scalar, what) if scalar in scalars else ()
                if points:
                    axis.plot(*zip(*points), style, marker=".", markersize=4, linewidth=1.2, color=colour)
            axis.set_yscale("log")
            axis.set_xscale("log" if what == "spread" else "linear")
            axis.yaxis.set_major_locator(matplotlib.ticker.LogLocator(10, numticks=20))
            axis.minorticks_off()
            axis.tick_params(labelsize=8, left=False, bottom=False)
        row[0].set_ylabel(name.replace(", ", ",\n", 1).replace(" (", "\n("), rotation=0, ha="right", va="center")
    for axis, (what, _, title) in zip(axes[0], columns):
        axis.set_title(title)
    for axis, (what, _, _) in zip(axes[-1], columns):
        axis.set_xlabel(of_steps(what))
    handles = [Line2D([], [], color=c, linestyle=s, label=t) for c, s, t in zip(SERIES, ("-", "--"), SCALARS)]
    below(figure, handles, 2)
    figure.supylabel("filtered, ns a pair", color=GREY, fontsize=10)
    figure.suptitle(f"What filtered takes at the extremes: {of_machine(r)}", color=GREY)
    return figure


@plot("extremes-cpu")
def extremes_cpu(results):
    return extremes(results["cpu/extremes"])


@plot("extremes-cuda")
def extremes_cuda(results):
    return extremes(results["cuda/extremes"])


@plot("extremes-others-cpu")
def extremes_others_cpu(results):
    return extremes_of_others(results["cpu/extremes"])


@plot("extremes-others-cuda")
def extremes_others_cuda(results):
    return extremes_of_others(results["cuda/extremes"])


# --- scaling ----------------------------------------------------------------------------------------------------------------

def log_log(axis, x, y):
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.minorticks_off()


def there(results, *names):
    found = [results[name] for name in names if name in results]
    if not found:
        raise LookupError(f"none of {', '.join(names)}")
    return found


@plot("scaling-spheres")
def scaling_spheres(results):
    figure, axes = grid(1, 1, height=4.2)
    axis, colour = axes[0], iter(SERIES)
    for r in there(results, "cpu/spheres_mesh", "cuda/spheres_mesh"):
        for policy in policies(r):
            if policy == "openmp":
                continue
            for index, style in (("none", ":"), ("grid", "--"), ("bvh", "-")):
                points = sorted((int(n.split("/")[3]), r.get(n)) for n in r.names(f"pairs/{index}/{policy}/"))
                label = {"none": "brute force", "grid": "buckets", "bvh": "BVH"}[index]
                axis.plot(*zip(*points), style, color=next(colour), marker=".", label=f"abut, {label}, {policy}")
    theirs = LITERATURE["lee_hsieh_2019"]
    for (name, ms), mark in zip(theirs["whole_scene_ms"].items(), "Pv"):
        axis.plot(SPHERES, ms, mark, color=GREY, markersize=8, label=f"Lee and Hsieh: {name}")
    for (name, ms), mark in zip(theirs["spheres_2_20_ms"].items(), "s^dD"):
        axis.plot(2**20, ms, mark, color=GREY, markersize=6, fillstyle="none", label=f"Lee and Hsieh: {name}")
    log_log(axis, "spheres, against 62,976 triangles", "query, sorted pairs, ms")
    beside(figure, figure.axes[0].get_legend_handles_labels()[0])
    return figure


@plot("scaling-triangles")
def scaling_triangles(results):
    figure, axes = grid(1, 1, height=4.2)
    axis, colour = axes[0], iter(SERIES)
    for r, policy in zip(there(results, "cpu/triangles", "cuda/triangles"), ("serial", "cuda")):
        for what, label, style in ((f"read/float/{policy}", "a loop that only reads", ":"),
                                   (f"one/count/fast/float/1/{policy}", "fast", "--"),
                                   (f"one/count/filtered/float/1/{policy}", "filtered", "-"),
                                   (f"one/copied/filtered/float/1/{policy}", "filtered, with the copy", "-.")):
            points = sorted((int(n.split("/")[-1]), r.get(n)) for n in r.names(what + "/"))
            if points:
                axis.plot(*zip(*points), style, color=next(colour), marker=".", label=f"{label}, {policy}")
    theirs = LITERATURE["maffina_2012"]
    for key, label, mark in (("one_core_ms", "Maffina 2012, one core", "o"), ("gpu_ms", "Maffina 2012, GTX 590", "s"),
                             ("four_gpus_ms", "Maffina 2012, 4 GPUs", "D")):
        axis.plot([int(n) for n in theirs[key]], list(theirs[key].values()), mark, color=GREY, markersize=8,
                  fillstyle="none", label=label)
    log_log(axis, "triangles, against one", "count, 1 % hits, ms")
    beside(figure, figure.axes[0].get_legend_handles_labels()[0])
    return figure


@plot("scaling-meshes")
def scaling_meshes(results):
    figure, axes = grid(3, 3, height=3.6)
    n, theirs = [int(s) for s in SIZES], [LITERATURE["backman_2011"]["sizes"][s] for s in SIZES]
    for axis, phase, title in zip(axes, ("middle", "near"), ("Middle phase, posed", "Near phase, posed")):
        for key, label, mark in (("cpu", "Bäckman 2011, processor", "o"), ("gpu", "Bäckman 2011, 8800 GTS", "s")):
            axis.plot(n, [t[f"{phase}_{key}_ms"] for t in theirs], mark, color=GREY, fillstyle="none", markersize=6,
                      label=label)
        index = 0
        for kind, policy, where in (("cpu", "serial", "one core"), ("cuda", "cuda", "device")):
            rows = [of_size(results, kind, s) for s in SIZES]
            walk = [r.get(f"boxes/posed/{policy}") for r in rows]
            if None in walk:
                continue
            if phase == "middle":
                axis.plot(n, walk, color=SERIES[index], marker=".", label=f"abut: walk, {where}")
                index += 1
                continue
            for query in ("pairs", "contacts"):  # what is beyond the walk
                axis.plot(n, [max(r.get(f"{query}/posed/{policy}") - w, 1e-3) for r, w in zip(rows, walk)],
                          color=SERIES[index], marker=".",
                          label=f"abut: {query}, {where}")
                index += 1
        log_log(axis, "triangles of each mesh", "ms")
        axis.set_title(title)
        axis.legend(fontsize=6.5)
    for s, mark in zip(reversed(SIZES), "osd^"):
        depths = LITERATURE["backman_2011"]["box_tests_per_depth"][s]
        axes[2].plot([int(d) for d in depths], list(depths.values()), mark, color=GREY, fillstyle="none", markersize=4,
                     label=f"Bäckman 2011, {int(s):,}")
    for index, n in enumerate(reversed(SIZES)):
        r = descents_of(results, n)
        points = sorted((int(name.split("/")[2]), r.get(name, "boxes")) for name in r.names("depth/sah/"))
        axes[2].plot(*zip(*points), color=SERIES[index], marker=".", label=f"abut, {int(n):,}, sah")
    axes[2].set_yscale("log")
    axes[2].set_xlabel("depth")
    axes[2].set_ylabel("tests of boxes")
    axes[2].legend(fontsize=6.5)
    axes[2].set_title("Tests per depth")
    return figure


@plot("scaling-motion")
def scaling_motion(results):
    figure, axes = grid(1, 1, height=4.2)
    axis, theirs = axes[0], LITERATURE["dasilva_2013"]["models"]
    for key, label, mark in (("stealing_gts450_ms", "lazy work stealing, GTS 450", "o"),
                             ("stealing_gt520_ms", "lazy work stealing, GT 520", "s"),
                             ("gproximity_gts450_ms", "gProximity, GTS 450", "^"),
                             ("gproximity_gt520_ms", "gProximity, GT 520", "v")):
        points = [(m["triangles"], m[key]) for m in theirs.values() if key in m]
        axis.plot(*zip(*points), mark, color=GREY, fillstyle="none", label=f"da Silva 2013: {label}")
    for index, (r, label) in enumerate(zip(there(results, "cuda/motion_flying", "cuda/motion"),
                                           ("small things flying about", "simulations"))):
        points = [(r.get(f"{s}/build", "faces"), r.get(f"{s}/frame"), s) for s in motion_scenes(r)]
        axis.plot([p[0] for p in points], [p[1] for p in points], "." if label == "simulations" else ".-", markersize=10,
                  color=SERIES[index],
                  label=f"abut: {label}")
        for x, y, s in points if label == "simulations" else ():
            axis.annotate(s.split("/")[0], (x, y), xytext=(0, 6), textcoords="offset points", ha="center", fontsize=7.5,
                          color=SERIES[index])
    log_log(axis, "triangles", "a frame: refit and impacts, ms")
    beside(figure, figure.axes[0].get_legend_handles_labels()[0])
    return figure


@plot("scaling-distributed")
def scaling_distributed(results):
    r = results["cpu/distributed"]
    m, large = Model(r), sizes(r)[-1]
    figure, axes = grid(4, 2, height=3.9)

    axis, counts = axes[0], rank_counts(r, f"pairs/curve/{large}")
    for index, deal in enumerate(DEALS):
        work = [r.get(f"pairs/{deal}/{large}/{k}", "work_ms") for k in counts]
        axis.plot(counts, work, color=SERIES[index], marker="s", fillstyle="none", label=f"{DEALS[deal]}: work of a rank")
        clock = [(k, t) for k in counts if (t := r.get(f"pairs/{deal}/{large}/{k}"))]
        axis.plot(*zip(*clock), "o", color=SERIES[index], label=f"{DEALS[deal]}: by the clock")
    one = r.get(f"pairs/curve/{large}/1", "work_ms")
    axis.plot(counts, [one / k for k in counts], ":", color=GREY, label="1 / ranks")
    axis.plot(counts, [1e3 * m.seconds("pairs", large / k, k) for k in counts], "--", color=GREY, label="model, along the curve")
    log_log(axis, "ranks", "pairs, ms")
    axis.set_xticks(counts, [str(k) for k in counts])
    axis.yaxis.set_major_locator(matplotlib.ticker.LogLocator(10, (1, 2, 5)))
    axis.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda v, _: f"{v:,g}"))
    axis.set_title(f"Measured: {large:,} triangles and spheres, {r.context['cores']} cores")

    axis = axes[1]
    many = [(int(n.split("/")[1]), int(n.split("/")[2]), r.rows[n]) for n in r.names("parts/")]
    for index, (key, mark, label) in enumerate((("sent_shapes", "o", "sent"), ("least_shapes", "^", "least possible"))):
        points = sorted((whole / k, row[key] / k) for whole, k, row in many if k >= 64)
        axis.plot(*zip(*points), mark, color=SERIES[index], label=label)
    steps = [10**(e / 8) for e in range(16, 65)]
    axis.plot(steps, [m.law(n) for n in steps], "--", color=GREY, label="model")
    axis.plot(steps, steps, ":", color=GREY, label="all of them")
    log_log(axis, "spheres of a part", "spheres that it sends")
    axis.set_title("Counted: what pairs sends, 64 parts or more")

    ranks = [10**(e / 8) for e in range(33)]
    axes[2].set_title("Model, strong: pairs, shapes in all")
    axes[3].set_title("Model, weak: queries, shapes a rank")
    for index, total in enumerate((1e8, 1e10, 1e12)):
        there = [k for k in ranks if total / k <= 1e9]  # more shapes than a rank holds
        axes[2].plot(there, [m.seconds("pairs", total / k, k) for k in there], color=SERIES[index],
                     label=f"$10^{{{math.log10(total):.0f}}}$")
        axes[2].plot(there, [m.seconds("pairs", total / k, 1) for k in there], ":", color=SERIES[index])
    axes[2].plot([], [], ":", color=GREY, label="own shapes alone")
    for index, query in enumerate(("pairs", "nearest", "redistribute")):
        for n, style in ((1e6, "--"), (1e8, "-")):
            axes[3].plot(ranks, [m.seconds(query, n, k) for k in ranks], style, color=SERIES[index],
                         label=f"{query}, $10^{{{math.log10(n):.0f}}}$")
    for axis in axes[2:]:
        log_log(axis, "ranks", "s")
    for axis in (axes[0], axes[3]):  # room for what is said above the lines
        axis.set_ylim(top=20 * axis.get_ylim()[1])
    for axis in axes:
        axis.legend(fontsize=6.5)
    return figure


# --- stages and memory ------------------------------------------------------------------------------------------------------

@plot("stages-triangles")
def stages_triangles(results):
    r = results["cpu/triangles"]
    stages = {"first": "filter", "late": "late", "word": "64 bits", "one_limb": "1 limb", "two_limbs": "2 limbs",
              "any_span": "any span"}
    names = r.parts("family/", 3)
    if not names:
        raise LookupError("no families")
    figure, axes = grid(2, 2, height=7.5, sharey=True)
    for axis, scalar in zip(axes, SCALARS):
        left = [0.0] * len(names)
        for index, (key, label) in enumerate(stages.items()):
            part = [100 * (r.get(f"family/filtered/{scalar}/{f}", key) or 0) for f in names]
            axis.barh(range(len(names)), part, left=left, color=SERIES[index], label=label)
            left = [a + b for a, b in zip(left, part)]
        axis.set_title(scalar)
        axis.set_xlabel("pairs decided, %")
        axis.grid(False)
    axes[0].set_yticks(range(len(names)), names)
    axes[0].invert_yaxis()
    handles = axes[0].get_legend_handles_labels()[0]
    below(figure, handles, 6)
    figure.suptitle("Which stage of filtered decides two triangles, by family", color=GREY)
    return figure


@plot("stages-motion")
def stages_motion(results):
    r = results["cpu/motion"]
    kinds = [n for n in r.names("look/")]
    keys = {"no_by_volume": "no: volume", "no_by_direction": "no: direction", "no_by_areas": "no: areas", "yes": "yes",
            "open": "left to later stages"}
    figure, axes = grid(1, 1, height=0.6 + 0.34 * len(kinds))
    axis, left = axes[0], [0.0] * len(kinds)
    for index, (key, label) in enumerate(keys.items()):
        part = [100 * (r.get(n, key) or 0) for n in kinds]
        axis.barh(range(len(kinds)), part, left=left, color=SERIES[index], label=label)
        left = [a + b for a, b in zip(left, part)]
    axis.set_yticks(range(len(kinds)), [n.removeprefix("look/").replace("/", ", ").replace("_", "-") for n in kinds])
    axis.invert_yaxis()
    axis.grid(False)
    axis.set_xlabel("candidates, by what the first look says, %")
    below(figure, axis.get_legend_handles_labels()[0], 5)
    return figure


@plot("memory")
def memory(results):
    r = results["cpu/builders"]
    figure, axes = grid(1, 1, height=3.8)
    axis = axes[0]
    for index, builder in enumerate(BUILDERS):
        for layout, mark in (("standard", "o"), ("quantised", "s"), ("leafless", "^"), ("wide", "D")):
            at = f"pairs/baked/{builder}/{layout}"
            if at in r.rows:
                axis.plot(r.get(at, "bytes_per_shape"), r.get(at), mark, color=SERIES[index], markersize=8)
    axis.set_xlabel("bytes of the tree for a triangle")
    axis.set_ylabel("sorted pairs of two meshes, ms")
    axis.set_ylim(0)
    axis.set_xlim(0)
    handles = [Line2D([], [], marker="o", linestyle="", color=SERIES[i], label=b) for i, b in enumerate(BUILDERS)]
    handles += [Line2D([], [], marker=m, linestyle="", color=GREY, label=n) for n,
                m in (("standard", "o"), ("quantised", "s"), ("leafless", "^"), ("wide", "D"))]
    beside(figure, handles)
    axis.set_title(f"Memory against time, 345,944 triangles: {of_machine(r)}")
    return figure


@plot("any")
def any_scenes(results):
    r = results["cpu/any"]
    trees = {"linear": "linear BVH", "sah_wide": "SAH, wide", "sah_oriented": "SAH, oriented", "embree_low": "Embree, low",
             "fcl_obb": "FCL"}
    figure, axes = grid(1, 1, height=3.4)
    for index, (tree, name) in enumerate(trees.items()):
        times = [r.get(f"any/{s}/baked/{tree}") for s in ANY_SCENES]
        if all(times):
            axes[0].plot(range(len(times)), [1e3 * t for t in times], "o", color=SERIES[index], label=name)
    axes[0].set_xticks(range(len(ANY_SCENES)), list(ANY_SCENES.values()))
    axes[0].set_yscale("log")
    axes[0].set_ylabel("any, us")
    beside(figure, figure.axes[0].get_legend_handles_labels()[0])
    axes[0].set_title(f"Whether two meshes touch: {of_machine(r)}")
    return figure
