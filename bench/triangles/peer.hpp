// SPDX-License-Identifier: MIT
#pragma once

// What the peers that decide pairs one by one have in common: the same pairs as ours in float, made theirs before the clock
// starts.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "../triangle_scene.hpp"

namespace triangle_scene {

/// Registers pair/NAME/double/PERCENT for each share of hits. theirs(pair) is what decide(theirs) -> bool takes.
template <class Theirs, class Decide>
bool register_peer(const char* name, const Theirs& theirs, const Decide& decide) {
    for (const auto& share : pair_shares) {
        const auto run = [&share, theirs, decide](benchmark::State& state) {
            std::vector<decltype(theirs(triangle_pair<float>{}))> pairs;
            for (std::uint64_t i = 0; i < pair_count; ++i) pairs.push_back(theirs(random_pair<float>(share.spread, i)));
            std::size_t hits = 0;
            for (auto _ : state) {
                hits = 0;
                for (const auto& pair : pairs) hits += decide(pair) ? 1 : 0;
                benchmark::DoNotOptimize(hits);
            }
            state.SetItemsProcessed(static_cast<std::int64_t>(pairs.size()) * static_cast<std::int64_t>(state.iterations()));
            state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(pairs.size());
        };
        benchmark::RegisterBenchmark((std::string("pair/") + name + "/double/" + share.percent).c_str(), run)
            ->Unit(benchmark::kMillisecond)
            ->Repetitions(11)
            ->ReportAggregatesOnly(true)
            ->MinTime(0.01);
    }
    return true;
}

}  // namespace triangle_scene
