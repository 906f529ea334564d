// SPDX-License-Identifier: MIT
//
// The peer: FCL's separating-axis test in double, as its traversal of meshes calls it. Its answers are not exact.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

#include "../triangle_scene.hpp"

namespace {

namespace scene = triangle_scene;

struct corners {
    fcl::Vector3d of[6];
};

fcl::Vector3d point(const abut::vec3<float>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// The same pairs as ours in float, widened before the clock starts.
void decide_all(benchmark::State& state, const scene::hit_share& share) {
    std::vector<corners> pairs;
    for (std::uint64_t i = 0; i < scene::pair_count; ++i) {
        const auto [a, b] = scene::random_pair<float>(share.spread, i);
        pairs.push_back({{point(a.a), point(a.b), point(a.c), point(b.a), point(b.b), point(b.c)}});
    }
    std::size_t hits = 0;
    for (auto _ : state) {
        hits = 0;
        for (const auto& [p] : pairs) {
            hits += fcl::detail::Intersect<double>::intersect_Triangle(p[0], p[1], p[2], p[3], p[4], p[5]) ? 1 : 0;
        }
        benchmark::DoNotOptimize(hits);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(pairs.size()) * static_cast<std::int64_t>(state.iterations()));
    state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(pairs.size());
}

[[maybe_unused]] const bool registered = [] {
    for (const auto& share : scene::pair_shares) {
        benchmark::RegisterBenchmark((std::string("pair/fcl/double/") + share.percent).c_str(), decide_all, share)
            ->Unit(benchmark::kMillisecond)
            ->Repetitions(11)
            ->ReportAggregatesOnly(true)
            ->MinTime(0.01);
    }
    return true;
}();

}  // namespace
