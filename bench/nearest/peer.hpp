// SPDX-License-Identifier: MIT
#pragma once

// What the peers of bench/nearest.cpp share: their rows.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "../../docs/examples/scene.hpp"

namespace nearest_peer {

/// How many of the triangles are not the nearest, by abut::exact; of two that are as near each is right. In bench/nearest.cpp: a peer whose
/// source is compiled for a newer processor compiles nothing of abut's queries.
std::size_t wrong_ids(const scene::surface<float>& mesh, const std::vector<abut::vec3<float>>& points,
                      const std::vector<std::uint32_t>& named);

/// The counters of a row.
inline void note(benchmark::State& state, std::size_t points, double sum_of_distances) {
    state.counters["points"] = static_cast<double>(points);
    state.counters["mean_distance"] = sum_of_distances / static_cast<double>(points);
}

/// Rows NAME/POINTS, of run(state, points).
inline bool add(const std::string& name, void (*run)(benchmark::State&, std::size_t)) {
    for (const std::size_t n : {std::size_t{100'000}, scene::sphere_count}) {
        benchmark::RegisterBenchmark((name + "/" + std::to_string(n)).c_str(), run, n)
            ->Repetitions(5)
            ->ReportAggregatesOnly(true)
            ->Unit(benchmark::kMillisecond)
            ->Iterations(1);
    }
    return true;
}

}  // namespace nearest_peer
