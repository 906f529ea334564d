# SPDX-License-Identifier: MIT
"""The tables of docs/results/scaling.md: what bench/cores.cpp and bench/distributed.cpp measured, and a model of costs on many ranks."""

import math

from report_core import *  # noqa: F403

STAGES = {"redistribute": "`redistribute`, one set", "build": "`make_bvh`", "pairs": "`pairs`", "count": "`count`",
          "nearest": "`nearest`"}
DEALS = {"random": "at random", "curve": "along the curve"}
# Assumed, and not measured: one way of a short message, and what a rank sends in a second, on a network of a cluster.
LATENCY, BANDWIDTH = 2e-6, 10e9
# Bytes of a shape of b and its id; of a point and its answer.
MESSAGES = {"pairs": 20, "nearest": 44}
CAME = 1  # assumed: what came costs as much as what is here
BLOCK = 64  # shapes with a box of their own: block_size of parts.hpp
TERMS = ("own shapes", "imbalance", "looking through shapes", "shapes that came", "per rank", "bytes", "latency")


def rank_counts(r, name):
    return sorted(int(n.split("/")[-1]) for n in r.names(name + "/"))


def sizes(r):
    return sorted({int(n.split("/")[2]) for n in r.names("pairs/")})


def ascending(rows):
    """Values at some numbers of ranks, as a function of any: straight between them over the logarithm, and then flat."""
    rows = sorted(rows)

    def at(ranks):
        for (low, a), (high, b) in zip(rows, rows[1:]):
            if ranks <= high:
                return a + (b - a) * max(0.0, math.log(ranks / low) / math.log(high / low))
        return rows[-1][1]
    return at


class Model:
    """Seconds of the slowest rank, by terms: with n shapes of each kind a rank, on so many ranks."""

    def __init__(self, r, latency=LATENCY, bandwidth=BANDWIDTH):
        self.latency, self.bandwidth = latency, bandwidth

        def per_shape(stage, deal, depth):
            each = sorted(1e-3 * r.get(f"{stage}/{deal}/{n}/1", "work_ms") / (n * (math.log2(n) if depth else 1))
                          for n in sizes(r))
            return each[len(each) // 2]
        # A walk of a tree goes down log2 n levels.
        self.pairs, self.nearest = (per_shape(s, "curve", True) for s in ("pairs", "nearest"))
        self.redistribute = per_shape("redistribute", "random", False)
        (self.shape_block, self.shape, self.point_block, self.made_block, self.point, self.part, self.code) = (
            1e-9 * r.get(f"local/{s}", "ns")
            for s in ("shape_block", "shape", "point_block", "made_block", "point", "part", "code"))
        self.code /= math.log2(sizes(r)[len(sizes(r)) // 2])  # a step of a search
        # What is sent: some of a part's surface.
        parts = [(int(n.split("/")[1]), int(n.split("/")[2]), n) for n in r.names("parts/")]
        parts = [(whole / k, k, r.rows[name]) for whole, k, name in parts]
        many = [(n, row["sent_shapes"] / k) for n, k, row in parts if k >= 64]
        # Least squares of relative errors.
        self.surface = sum(n**(2 / 3) / s for n, s in many) / sum(n**(4 / 3) / s**2 for n, s in many)
        # Blocks reach beyond what is sent by their own size, so the share of that falls as parts grow.
        beyond = sorted((BLOCK * row["near_blocks"] / row["sent_shapes"] - 1) * n**(1 / 3) for n, k, row in parts if k >= 64)
        self.beyond = beyond[len(beyond) // 2]
        # The rank that sends most, and the one with most neighbours, of the largest scene.
        large = max(n * k for n, k, _ in parts)
        large = [p for p in parts if p[0] * p[1] == large]
        self.most_sent = ascending([(1, 0.0)] + [(k, row["most_sent_shapes"] / self.law(n)) for n, k, row in large])
        self.neighbours = ascending([(1, 0.0)] + [(k, row["most_neighbours"]) for n, k, row in large])
        # Of k equal shares of things that fall at random the largest is beyond the mean by so many standard deviations.
        spread = sorted((row["imbalance"] - 1) / math.sqrt(2 * math.log(k) / n) for n, k, row in parts)
        self.spread = spread[len(spread) // 2]
        # What is left of a rank's work, over what came: it holds also what two busy cores cost each other, so it is shown alone.
        self.left = {}
        for query, bytes_each in MESSAGES.items():
            costs = []
            for n in sizes(r):
                for k in rank_counts(r, f"{query}/curve/{n}")[1:]:
                    row, here = r.rows[f"{query}/curve/{n}/{k}"], n / k
                    own = self.own(query) * math.log2(here)
                    sent = row["most_bytes"] / bytes_each
                    looking = self.looking(query, here, k - 1, k - 1, sent)
                    costs.append((1e-3 * row["work_ms"] - own * here - looking) / (own * sent))
            self.left[query] = (min(costs), max(costs))
        end = f"curve/{sizes(r)[-1]}/{rank_counts(r, f'pairs/curve/{sizes(r)[-1]}')[-1]}"
        self.points = r.get("nearest/" + end, "bytes") / 44 / (r.get("pairs/" + end, "bytes") / 20)

    def own(self, query):
        return {"pairs": self.pairs, "nearest": self.nearest}[query]

    def law(self, n):
        return self.surface * n**(2 / 3)

    def looking(self, query, n, far, near, sent):
        """The search for what goes to `far` other ranks, of which `near` are near."""
        blocks, in_near_blocks = n / BLOCK, sent * (1 + self.beyond / n**(1 / 3))
        if query == "pairs":  # to count and to pack
            return 2 * (near * blocks * self.shape_block + in_near_blocks * self.shape)
        return blocks * (far * self.point_block + near * self.made_block) + in_near_blocks * self.point

    def terms(self, query, n, ranks):
        depth, rounds, far = math.log2(max(n, 2)), 2 * math.ceil(math.log2(ranks)), ranks - 1
        sent, near = min(self.law(n) * self.most_sent(ranks), n * far), min(self.neighbours(ranks), far)
        uneven = self.spread * math.sqrt(2 * math.log(ranks) / n)
        if query == "pairs":
            own = self.pairs * n * depth
            return (own, own * uneven, self.looking(query, n, far, near, sent), CAME * self.pairs * sent * depth,
                    2 * far * self.part, (20 * sent + 832 * far) / self.bandwidth, (6 * rounds + 4 * near) * self.latency)
        if query == "nearest":
            own = self.nearest * n * depth
            points = self.points * sent
            return (own, own * uneven, self.looking(query, n, far, near, points), CAME * self.nearest * points * depth, 0.0,
                    (44 * points + 424 * far) / self.bandwidth, (6 * rounds + far + 2 * near) * self.latency)
        own = self.redistribute * n
        return (own, 0.0, 0.0, 0.0, 65 * far * self.code * depth,
                ((44 * n if far else 0) + (416 + 2 * 64 * 8) * far) / self.bandwidth,
                (72 * rounds + 4 * far) * self.latency)

    def seconds(self, query, n, ranks):
        return sum(self.terms(query, n, ranks))

    def ranks_where(self, query, term, n):
        """The least number of ranks, of two digits, at which a term takes as long as the own shapes; None up to a million."""
        for power in range(6):
            for digits in range(10, 100):
                ranks = digits * 10**power // 10
                if ranks > 1 and self.terms(query, n, ranks)[TERMS.index(term)] >= self.terms(query, n, 1)[0]:
                    return ranks
        return None


# --- cores

OPERATIONS = {"arithmetic": "additions in registers", "build": "`make_bvh` of 345,960 triangles", "build_and_pairs": "`make_bvh` and sorted `pairs`, spheres in a mesh",
              "pairs": "sorted `pairs` of these", "unsorted": "unsorted `pairs` of these",
              "meshes_unsorted": "unsorted `pairs` of two meshes", "meshes_count": "`count` of two meshes",
              "validate": "`validate` of 27,648 triangles", "sort_keys": "sort of 345,944 keys",
              "sort_few_keys": "sort of 40,000 keys", "exclusive_scan": "prefix sums of 4,000,000 numbers",
              "compact": "compaction of 4,000,000 numbers", "gather": "gathering 32 MB from all threads"}


def core_counts(r):
    return sorted({int(name.split("/")[2]) for name in r.names("build/openmp/")} - {1})


@in_table("cores")
def cores(results):
    r = results["cpu/cores"]
    rows = []
    for operation, name in OPERATIONS.items():
        serial, bound = r.get(f"{operation}/serial/quiet"), r.get(f"{operation}/modelled/16")
        if serial:
            rows.append([name, shown(serial)] + [quotient(serial, r.get(f"{operation}/openmp/{k}/quiet"), 1) for k in core_counts(r)] +
                        [quotient(serial, bound, 1)])
    return table(["", "`serial`, ms", *(f"{k} threads" for k in core_counts(r)), "bound for 16"], rows) + \
        made_on(r, f"; {r.context['cores']} cores")


@in_table("cores-busy")
def cores_busy(results):
    r = results["cpu/cores_busy"]
    rows = []
    for operation, name in OPERATIONS.items():
        serial = r.get(f"{operation}/serial/busy")
        if serial:
            rows.append([name, shown(serial)] + [quotient(r.get(f"{operation}/openmp/{k}/busy"), serial) for k in core_counts(r)])
    return table(["", "`serial`, ms", *(f"{k} threads" for k in core_counts(r))], rows) + made_on(r, f"; {r.context['cores']} cores")


# --- ranks

def seconds(value):
    return f"{value:.2g}" if value < 100 else whole(value)


def two(value):
    return f"{value:.2f}"


@in_table("scaling-ranks")
def scaling_ranks(results):
    r = results["cpu/distributed"]
    least, large = sizes(r)[0], sizes(r)[-1]
    rows = []
    for deal, name in DEALS.items():
        for stage, call in STAGES.items():
            if not r.names(f"{stage}/{deal}/"):
                continue

            def at(n, ranks, key="ms"):
                return r.get(f"{stage}/{deal}/{n}/{ranks}", key)
            rows.append([name, call, shown(at(large, 1)), shown(at(large, 2)), quotient(at(large, 1), at(large, 2))] +
                        [quotient(at(large, 1, "work_ms"), at(large, k, "work_ms")) for k in (2, 4, 8)] +
                        [quotient(at(2 * least, 2), at(least, 1))] +
                        [quotient(at(k * least, k, "work_ms"), at(least, 1, "work_ms")) for k in (2, 4)])
    return table(["dealt", "", "1 rank, ms", "2 ranks, ms", "speedup", "work, 2 ranks", "4", "8", "weak, 2 ranks", "work, 2", "4"],
                 rows, 2) + made_on(r, f"; {large:,} triangles and as many spheres; weak: {least:,} of each a rank")


@in_table("scaling-bytes")
def scaling_bytes(results):
    r = results["cpu/distributed"]
    large = sizes(r)[-1]
    rows = []
    for deal, name in DEALS.items():
        for k in rank_counts(r, f"pairs/{deal}/{large}"):
            if k == 1:
                continue
            end = f"{deal}/{large}/{k}"
            row = r.rows["pairs/" + end]
            rows.append([name, whole(k), whole(row["bytes"] / k), whole(row["most_bytes"]), whole(row["least_bytes"] / k),
                         quotient(row["bytes"], row["least_bytes"], 1), whole(row["most_messages"]), whole(row["gathered_bytes"]),
                         two(row["imbalance"]), whole(r.get("nearest/" + end, "bytes") / k)] +
                        [whole(r.get("redistribute/" + end, "bytes") / k) if deal == "random" else ""])
    return table(["dealt", "ranks", "bytes a rank", "most", "least possible", "over least", "messages", "gathered, bytes",
                  "imbalance", "`nearest`, bytes a rank", "`redistribute`, bytes a rank"], rows, 1) + \
        made_on(r, f"; {large:,} triangles and as many spheres; the first columns are of `pairs`")


@in_table("scaling-parts")
def scaling_parts(results):
    r = results["cpu/distributed"]
    rows = []
    for name in r.names("parts/"):
        n, k = (int(x) for x in name.split("/")[1:])
        row = r.rows[name]
        rows.append([whole(n), whole(k), whole(n / k), whole(row["sent_shapes"] / k), whole(row["most_sent_shapes"]),
                     whole(row["least_shapes"] / k), quotient(row["sent_shapes"], row["least_shapes"], 1),
                     f"{row['neighbours'] / k:.1f}", whole(row["most_neighbours"]), whole(n / k / BLOCK),
                     shown(row["near_blocks"] / row["neighbours"]), two(row["imbalance"])])
    return table(["spheres", "parts", "of a part", "sent by a part", "most", "least possible", "over least", "neighbours", "most",
                  "blocks of a part", "near a neighbour", "imbalance"], rows, 0) + made_on(r)


@in_table("scaling-costs")
def scaling_costs(results):
    r = results["cpu/distributed"]
    m = Model(r)
    rows = [["own shapes, `pairs`", f"{1e9 * m.pairs:.0f} ns n log2 n"],
            ["own shapes, `nearest`", f"{1e9 * m.nearest:.0f} ns n log2 n"],
            ["own shapes, `redistribute`", f"{1e9 * m.redistribute:.0f} ns n"],
            ["a block of shapes; a shape in a near block", f"{1e9 * m.shape_block:.1f} ns; {1e9 * m.shape:.1f} ns"],
            ["a block of points, mostly by a far part; a point in a near block",
             f"{1e9 * m.point_block:.1f} ns; {1e9 * m.point:.1f} ns"],
            ["making a block of points", f"{1e9 * m.made_block:.0f} ns"], ["two parts", f"{1e9 * m.part:.1f} ns"],
            ["a code, by one step of a search", f"{1e9 * m.code:.1f} ns"],
            ["shapes that a part sends, mean of many parts", f"{m.surface:.1f} n^(2/3)"],
            ["shapes in near blocks over shapes that are sent", f"1 + {m.beyond:.1f} / n^(1/3)"],
            ["a shape that came over one's own, assumed", f"{CAME:.0f}"],
            *([f"what is left of a rank's work over that, `{q}`, on 2, 4 and 8 ranks", f"{low:.1f} to {high:.1f}"]
              for q, (low, high) in m.left.items()),
            ["points that `nearest` sends over shapes that `pairs` sends", two(m.points)],
            ["imbalance of P parts", f"1 + {m.spread:.2f} sqrt(2 ln P / n)"],
            ["a short message, and bandwidth, here between two ranks", 
             f"{1e3 * r.get('link/8'):.1f} us, {1.048576 / r.get('link/1048576'):.1f} GB/s"],
            ["the same on a cluster, assumed", f"{1e6 * LATENCY:.0f} us, {1e-9 * BANDWIDTH:.0f} GB/s"]]
    return table(["what", "cost"], rows) + made_on(r, "; n shapes of each kind a rank")


@in_table("scaling-terms")
def scaling_terms(results):
    m = Model(results["cpu/distributed"])
    rows = []
    for n in (10**5, 10**6, 10**8):
        for query in ("pairs", "nearest", "redistribute"):
            terms = m.terms(query, n, 10**4)
            rows.append([whole(n), f"`{query}`"] + [seconds(t) if t else "" for t in terms] +
                        [seconds(sum(terms)), f"{100 * m.seconds(query, n, 1) / sum(terms):.0f}"])
    return table(["shapes a rank", "seconds", *TERMS, "all", "weak efficiency, %"], rows, 2)


@in_table("scaling-limits")
def scaling_limits(results):
    m = Model(results["cpu/distributed"])
    rows = []
    for query, term, what in (("nearest", "looking through shapes", "looks at its blocks of points for each rank"),
                              ("nearest", "shapes that came", "answers about points that came"),
                              ("nearest", "latency", "tells each rank a number, one after another"),
                              ("pairs", "looking through shapes", "looks at blocks for each neighbour, and at shapes in near ones, twice"),
                              ("pairs", "shapes that came", "asks about shapes that came"),
                              ("pairs", "per rank", "compares its boxes with each rank's"),
                              ("pairs", "bytes", "sends shapes, and gathers all ranks' boxes"),
                              ("redistribute", "latency", "messages to each rank, one after another; 63 reductions"),
                              ("redistribute", "per rank", "searches its codes 65 times for each rank"),
                              ("redistribute", "bytes", "sends shapes, and reduces a number for each rank 64 times")):
        found = [m.ranks_where(query, term, n) for n in (10**5, 10**6, 10**8)]
        rows.append([f"`{query}`", what] + [whole(p) if p else "-" for p in found])
    return table(["", "what it does", "100,000 shapes a rank", "1,000,000", "100,000,000"], rows, 2)


def share_of_own(query, term):
    """What a term takes over the own shapes, with a million of them on each of 10,000 ranks."""
    def percent(results):
        terms = Model(results["cpu/distributed"]).terms(query, 10**6, 10**4)
        return f"{100 * terms[TERMS.index(term)] / terms[0]:.0f}"
    return percent


def boxes_of_a_rank(results):
    """Bytes of boxes that a query of two sets gathers for each rank."""
    r = results["cpu/distributed"]
    most, less = (r.get(f"pairs/curve/{sizes(r)[-1]}/{k}", "gathered_bytes") for k in (8, 4))
    return (most - less) / 4


VALUES["scaling-boxes-query"] = lambda results: whole(boxes_of_a_rank(results))
VALUES["scaling-boxes-set"] = lambda results: whole(boxes_of_a_rank(results) / 2)
VALUES["scaling-boxes-all"] = lambda results: f"{1e-6 * 10**4 * boxes_of_a_rank(results):.0f}"
VALUES["scaling-nearest-limit"] = lambda results: whole(
    Model(results["cpu/distributed"]).ranks_where("nearest", "looking through shapes", 10**6))
VALUES["scaling-most-neighbours"] = lambda results: whole(
    max(row["most_neighbours"] for name, row in results["cpu/distributed"].rows.items() if name.startswith("parts/")))
VALUES["scaling-came-nearest"] = share_of_own("nearest", "shapes that came")
VALUES["scaling-came-pairs"] = share_of_own("pairs", "shapes that came")
VALUES["scaling-pairs-looking"] = share_of_own("pairs", "looking through shapes")
