// SPDX-License-Identifier: MIT
//
// The peer: CGAL's test with exact predicates, which are filtered as ours are. Exact where no triangle is degenerate.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include "../triangle_scene.hpp"

namespace {

namespace scene = triangle_scene;
using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

kernel::Point_3 point(const abut::vec3<float>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
kernel::Triangle_3 theirs(const abut::triangle<float>& t) { return {point(t.a), point(t.b), point(t.c)}; }

/// The same pairs as ours in float, widened before the clock starts.
void decide_all(benchmark::State& state, const scene::hit_share& share) {
    std::vector<std::pair<kernel::Triangle_3, kernel::Triangle_3>> pairs;
    for (std::uint64_t i = 0; i < scene::pair_count; ++i) {
        const auto [a, b] = scene::random_pair<float>(share.spread, i);
        pairs.emplace_back(theirs(a), theirs(b));
    }
    std::size_t hits = 0;
    for (auto _ : state) {
        hits = 0;
        for (const auto& [a, b] : pairs) hits += CGAL::do_intersect(a, b) ? 1 : 0;
        benchmark::DoNotOptimize(hits);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(pairs.size()) * static_cast<std::int64_t>(state.iterations()));
    state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(pairs.size());
}

[[maybe_unused]] const bool registered = [] {
    for (const auto& share : scene::pair_shares) {
        benchmark::RegisterBenchmark((std::string("pair/cgal/double/") + share.percent).c_str(), decide_all, share)
            ->Unit(benchmark::kMillisecond)
            ->Repetitions(11)
            ->ReportAggregatesOnly(true)
            ->MinTime(0.01);
    }
    return true;
}();

}  // namespace
