// SPDX-License-Identifier: MIT
//
// usage: bench_trade [--json=OUT.json] [--pairs=N] [--runs=N] [--which=triangles|others]
//
// Speed against wrong answers, of one pair at a time on one core: N pairs (65,536) of each predicate and input of
// bench/trade_pairs.hpp, or with `others` of bench/trade_others.hpp (all other pairs, distances), of
// hulls, and of features in motion. Names: PREDICATE/INPUT/SCALAR/ARITHMETIC, where ARITHMETIC is fast, filtered, exact, or
// resolve, the last stage of both alone, on a sixty-fourth of the pairs; in motion fast, conservative, filtered and exact,
// which tell times of impact, exact those of an eighth of the pairs. In a row:
//
//   ns                     of processor time for a pair, the median of N runs (9), in which the arithmetics take turns
//   hits                   the share that touches
//   wrong_per_million      answers that differ from unbounded integers (the oracles of tests/support, no formula of which is
//   missed_..., phantom_   the library's); of these, hits that were missed, and hits that are none
//   filter_decides         the share that floating point with an error bound decides

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/narrow/time_of_impact.hpp>

#include "../tests/support/hulls.hpp"
#include "../tests/support/motion_families.hpp"
#include "../tests/support/motion_oracle.hpp"
#include "../tests/support/rational.hpp"
#include "../tests/support/ray_oracle.hpp"
#include "../tests/support/shape_oracles.hpp"
#include "../tests/support/solid_pairs.hpp"
#include "../tests/support/within_pairs.hpp"
#include "results.hpp"
#include "trade_hulls.hpp"
#include "trade_others.hpp"
#include "trade_pairs.hpp"

namespace {

/// The sum of what answers are, which nobody needs and the compiler must not leave out.
volatile std::uint64_t sink = 0;

template <class Pairs, class Decide>
double ns_a_pair(const Pairs& pairs, std::size_t n, const Decide& decide) {
    const std::clock_t start = std::clock();
    std::uint64_t hits = 0;
    for (std::size_t i = 0; i < n; ++i) hits += decide(pairs[i]) ? 1 : 0;
    sink = sink + hits;
    return 1e9 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / static_cast<double>(n);
}

double median(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

struct size {
    std::size_t pairs;
    int runs;
};

/// What is asked about: hulls own their points here.
///@{
template <class S>
const S& seen(const S& s) {
    return s;
}
template <abut::scalar T>
abut::hull<T> seen(const abut::test::point_list<T>& points) {
    return abut::test::hull_over(points);
}
///@}

/// Calls f with the shapes in the order in which the pair has stages.
template <class Pair, class F>
auto in_order(const Pair& p, const F& f) {
    const auto& s = seen(p.s);
    const auto& t = seen(p.t);
    if constexpr (abut::decidable_pair<std::remove_cvref_t<decltype(s)>, std::remove_cvref_t<decltype(t)>>) {
        return f(s, t);
    } else {
        return f(t, s);
    }
}

template <abut::arithmetic A, class Pair>
bool answer_of(const Pair& p) {
    if constexpr (requires { p.distance; }) {
        return trade::answer<A>(p);
    } else {
        return abut::intersects<A>(seen(p.s), seen(p.t));
    }
}

/// Whether the filter decides.
template <class Pair>
bool filter_decides(const Pair& p) {
    if constexpr (requires { p.distance; }) {
        return abut::detail::decide_within<abut::filtered>(p.s, p.t, p.distance) != abut::verdict::unknown;
    } else {
        return in_order(
            p, [](const auto& s, const auto& t) { return abut::decide<abut::filtered>(s, t) != abut::verdict::unknown; });
    }
}

/// The last stage alone.
template <class Pair>
bool resolved(const Pair& p) {
    if constexpr (requires { p.distance; }) {
        return abut::detail::resolve_within(p.s, p.t, p.distance);
    } else {
        return in_order(p, [](const auto& s, const auto& t) { return abut::resolve(s, t); });
    }
}

/// Whether a ray meets a hull: as a segment, which ends where the hull has no point.
template <abut::scalar T>
bool ray_meets(const abut::ray<T>& r, const abut::test::point_list<T>& points) {
    using abut::test::integer_point;
    std::vector<T> values{r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y, r.direction.z};
    for (const abut::vec3<T>& p : points) values.insert(values.end(), {p.x, p.y, p.z});
    const std::vector<abut::test::integer> v = abut::test::to_integers(values);
    abut::test::integer beyond = 1;
    std::vector<integer_point> corners;
    for (std::size_t i = 6; i < v.size(); i += 3) {
        corners.push_back({v[i], v[i + 1], v[i + 2]});
        for (std::size_t k = 0; k < 3; ++k) beyond += abs(abut::test::integer(v[i + k] - v[k]));
    }
    const integer_point end{v[0] + beyond * v[3], v[1] + beyond * v[4], v[2] + beyond * v[5]};
    return abut::test::hulls_meet({{v[0], v[1], v[2]}, end}, corners);
}

/// By an oracle that shares no formula with the library.
template <class Pair>
bool truth_of(const Pair& p) {
    namespace oracle = abut::test::oracle;
    if constexpr (requires { p.distance; }) {
        return abut::test::exact_gap(p.s, p.t).compared_with(p.distance) <= 0;
    } else if constexpr (requires { p.s.direction; }) {
        return abut::test::first_time(p.s, p.t).has_value();
    } else if constexpr (requires { p.s.offset, p.t.offset; }) {
        return oracle::planes_meet(p.s, p.t);
    } else if constexpr (requires { oracle::intersects(p.s, p.t); }) {
        return oracle::intersects(p.s, p.t);
    } else {
        return oracle::within_distance(p.s, p.t, 0);
    }
}
template <abut::scalar T, class S>
bool truth_of(const trade::pair<abut::test::point_list<T>, S>& p) {
    namespace oracle = abut::test::oracle;
    if constexpr (std::same_as<S, abut::test::point_list<T>>) {
        return oracle::hulls_intersect<T>(p.s, p.t);
    } else if constexpr (requires { p.t.direction; }) {
        return ray_meets(p.t, p.s);
    } else if constexpr (requires { p.t.offset; }) {
        return oracle::plane_and_points(p.t, p.s, {0.0});
    } else if constexpr (requires { p.t.radius; }) {
        return oracle::within_distance(seen(p.s), p.t, 0);
    } else {
        return oracle::hulls_intersect<T>(p.s, abut::test::corners_of(p.t));
    }
}

/// Answers of the first n pairs compared with the truth, in a row.
template <class Pairs, class Decide>
bench::counters row_of(const Pairs& pairs, const std::vector<bool>& truth, std::size_t n, std::vector<double> ns,
                       const Decide& decide) {
    trade::tally tally;
    for (std::size_t i = 0; i < n; ++i) tally.add(decide(pairs[i]), truth[i]);
    return {{"ns", median(std::move(ns))},
            {"pairs", static_cast<double>(n)},
            {"hits", tally.share(tally.hits)},
            {"wrong_per_million", 1e6 * tally.share(tally.missed + tally.phantom)},
            {"missed_per_million", 1e6 * tally.share(tally.missed)},
            {"phantom_per_million", 1e6 * tally.share(tally.phantom)}};
}

template <class Predicate, abut::scalar T>
void add(bench::results& out, trade::input in, const size& of) {
    const std::size_t few = std::max<std::size_t>(of.pairs / 64, 1);
    std::vector<decltype(Predicate::template make<T>(in, 0))> pairs;
    std::vector<bool> truth;
    double decided = 0;
    for (std::uint64_t i = 0; i < of.pairs; ++i) {
        pairs.push_back(Predicate::template make<T>(in, i));
        truth.push_back(truth_of(pairs.back()));
        decided += filter_decides(pairs.back());
    }
    const auto fast = [](const auto& p) { return answer_of<abut::fast>(p); };
    const auto filtered = [](const auto& p) { return answer_of<abut::filtered>(p); };
    const auto exact = [](const auto& p) { return answer_of<abut::exact>(p); };
    const auto resolve = [](const auto& p) { return resolved(p); };
    std::vector<double> times[4];
    for (int run = 0; run < of.runs; ++run) {
        times[0].push_back(ns_a_pair(pairs, of.pairs, fast));
        times[1].push_back(ns_a_pair(pairs, of.pairs, filtered));
        times[2].push_back(ns_a_pair(pairs, of.pairs, exact));
        times[3].push_back(ns_a_pair(pairs, few, resolve));
    }
    const auto note = [&](const char* arithmetic, const std::vector<double>& ns, std::size_t n, const auto& decide) {
        bench::counters row = row_of(pairs, truth, n, ns, decide);
        if (decided > 0) row.emplace_back("filter_decides", decided / static_cast<double>(of.pairs));
        out.add(bench::joined({Predicate::name, trade::name_of(in), trade::scalar_name<T>, arithmetic}), row);
    };
    note("fast", times[0], of.pairs, fast);
    note("filtered", times[1], of.pairs, filtered);
    note("exact", times[2], of.pairs, exact);
    note("resolve", times[3], few, resolve);
}

/// A vertex and a face in motion, or two edges: whether they touch in the step.
template <abut::test::motion_kind Kind, abut::scalar T>
void add_motion(bench::results& out, const char* name, trade::input in, const size& of) {
    using abut::test::motion_family;
    const auto meeting = [](std::uint64_t i) { return i % 2 == 0 ? motion_family::random : motion_family::crossing; };
    const auto nearly = [](std::uint64_t i) { return i % 2 == 0 ? motion_family::nudged : motion_family::crossing_border; };
    std::vector<abut::test::motion<T>> pairs;
    std::vector<bool> truth;
    for (std::uint64_t i = 0; i < of.pairs; ++i) {
        const motion_family family = in == trade::input::random     ? meeting(i)
                                     : in == trade::input::touching ? nearly(i)
                                                                    : motion_family::lattice_4;
        pairs.push_back(abut::test::make_motion<T>(trade::seed, Kind, family, i));
        truth.push_back(abut::test::oracle::first_contact(Kind, pairs.back()).hit);
    }
    const auto touch_by = []<abut::motion_arithmetic A>(A) {
        return [](const abut::test::motion<T>& m) {
            const auto &p = m.t0, &q = m.t1;
            if constexpr (Kind == abut::test::motion_kind::vertex_face) {
                return abut::time_of_impact<A>(abut::motion<abut::vec3<T>>{p[0], q[0]},
                                               abut::motion<abut::triangle<T>>{{p[1], p[2], p[3]}, {q[1], q[2], q[3]}}) >= 0;
            } else {
                return abut::time_of_impact<A>(abut::motion<abut::segment<T>>{{p[0], p[1]}, {q[0], q[1]}},
                                               abut::motion<abut::segment<T>>{{p[2], p[3]}, {q[2], q[3]}}) >= 0;
            }
        };
    };
    const auto measure = [&](const char* arithmetic, std::size_t n, const auto& decide) {
        std::vector<double> times;
        for (int run = 0; run < of.runs; ++run) times.push_back(ns_a_pair(pairs, n, decide));
        out.add(bench::joined({name, trade::name_of(in), trade::scalar_name<T>, arithmetic}),
                row_of(pairs, truth, n, times, decide));
    };
    measure("fast", of.pairs, touch_by(abut::fast{}));
    measure("conservative", of.pairs, touch_by(abut::conservative{}));
    measure("filtered", of.pairs, touch_by(abut::filtered{}));
    measure("exact", std::max<std::size_t>(of.pairs / 8, 1), touch_by(abut::exact{}));
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const std::string which = bench::take_argument(argc, argv, "--which", "triangles");
        const size of{std::stoull(bench::take_argument(argc, argv, "--pairs", "65536")),
                      std::stoi(bench::take_argument(argc, argv, "--runs", "9"))};
        bench::results out("bench_trade");
        const auto add_both = [&]<class Predicate>(Predicate) {
            for (const trade::input in : trade::inputs) {
                add<Predicate, float>(out, in, of);
                add<Predicate, double>(out, in, of);
            }
        };
        if (which == "triangles") {
            trade::for_each_predicate(add_both);
        } else if (which == "others") {
            trade::for_each_other_predicate(add_both);
            trade::for_each_distance_predicate(add_both);
            trade::for_each_solid_predicate(add_both);
            trade::for_each_hull_predicate(add_both);
            for (const trade::input in : trade::inputs) {
                using abut::test::motion_kind;
                add_motion<motion_kind::vertex_face, float>(out, "vertex_face", in, of);
                add_motion<motion_kind::vertex_face, double>(out, "vertex_face", in, of);
                add_motion<motion_kind::edge_edge, float>(out, "edge_edge", in, of);
                add_motion<motion_kind::edge_edge, double>(out, "edge_edge", in, of);
            }
        } else {
            throw abut::error("--which is " + which + "; expected triangles or others");
        }
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_trade: %s\n", problem.what());
        return 1;
    }
}
