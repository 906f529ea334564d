// SPDX-License-Identifier: MIT
//
// usage: bench_trade [--json=OUT.json] [--pairs=N] [--runs=N]
//
// Speed against wrong answers, of one pair at a time on one core: N pairs (65,536) of each predicate and input of
// bench/trade_pairs.hpp. Names: PREDICATE/INPUT/SCALAR/ARITHMETIC, where ARITHMETIC is fast, filtered, exact, or resolve,
// the last stage of both alone, on a sixty-fourth of the pairs. In a row:
//
//   ns                     of processor time for a pair, the median of N runs (9), in which the arithmetics take turns
//   hits                   the share that touches
//   wrong_per_million      answers that differ from unbounded integers (the oracles of tests/support, no formula of which is
//   missed_..., phantom_   the library's); of these, hits that were missed, and hits that are none
//   filter_decides         the share that floating point with an error bound decides

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "../tests/support/hulls.hpp"
#include "../tests/support/rational.hpp"
#include "../tests/support/shape_oracles.hpp"
#include "results.hpp"
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

template <class Predicate, abut::scalar T>
void add(bench::results& out, trade::input in, const size& of) {
    const std::size_t few = std::max<std::size_t>(of.pairs / 64, 1);
    std::vector<decltype(Predicate::template make<T>(in, 0))> pairs;
    std::vector<bool> truth;
    double decided = 0;
    for (std::uint64_t i = 0; i < of.pairs; ++i) {
        pairs.push_back(Predicate::template make<T>(in, i));
        const auto& [s, t] = pairs.back();
        truth.push_back(abut::test::oracle::intersects(s, t));
        decided += abut::decide<abut::filtered>(s, t) != abut::verdict::unknown;
    }
    const auto fast = [](const auto& p) { return abut::intersects<abut::fast>(p.s, p.t); };
    const auto filtered = [](const auto& p) { return abut::intersects<abut::filtered>(p.s, p.t); };
    const auto exact = [](const auto& p) { return abut::intersects<abut::exact>(p.s, p.t); };
    const auto resolve = [](const auto& p) { return abut::resolve(p.s, p.t); };
    std::vector<double> times[4];
    for (int run = 0; run < of.runs; ++run) {
        times[0].push_back(ns_a_pair(pairs, of.pairs, fast));
        times[1].push_back(ns_a_pair(pairs, of.pairs, filtered));
        times[2].push_back(ns_a_pair(pairs, of.pairs, exact));
        times[3].push_back(ns_a_pair(pairs, few, resolve));
    }
    const auto note = [&](const char* arithmetic, const std::vector<double>& ns, std::size_t n, const auto& decide) {
        trade::tally tally;
        for (std::size_t i = 0; i < n; ++i) tally.add(decide(pairs[i]), truth[i]);
        bench::counters row{{"ns", median(ns)},
                            {"pairs", static_cast<double>(n)},
                            {"hits", tally.share(tally.hits)},
                            {"wrong_per_million", 1e6 * tally.share(tally.missed + tally.phantom)},
                            {"missed_per_million", 1e6 * tally.share(tally.missed)},
                            {"phantom_per_million", 1e6 * tally.share(tally.phantom)}};
        if (decided > 0) row.emplace_back("filter_decides", decided / static_cast<double>(of.pairs));
        out.add(bench::joined({Predicate::name, trade::name_of(in), trade::scalar_name<T>, arithmetic}), row);
    };
    note("fast", times[0], of.pairs, fast);
    note("filtered", times[1], of.pairs, filtered);
    note("exact", times[2], of.pairs, exact);
    note("resolve", times[3], few, resolve);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const size of{std::stoull(bench::take_argument(argc, argv, "--pairs", "65536")),
                      std::stoi(bench::take_argument(argc, argv, "--runs", "9"))};
        bench::results out("bench_trade");
        trade::for_each_predicate([&]<class Predicate>(Predicate) {
            for (const trade::input in : trade::inputs) {
                add<Predicate, float>(out, in, of);
                add<Predicate, double>(out, in, of);
            }
        });
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_trade: %s\n", problem.what());
        return 1;
    }
}
