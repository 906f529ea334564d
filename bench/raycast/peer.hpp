// SPDX-License-Identifier: MIT
#pragma once

// What bench/raycast.cpp and its peers share: the mesh, and their rows.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "../raycast_scene.hpp"

namespace raycast_peer {

/// The mesh of the run.
inline scene::surface<float>& mesh() {
    static scene::surface<float> the_mesh;
    return the_mesh;
}
/// Peers register themselves here, and their rows once the mesh is there.
inline std::vector<void (*)()>& peers() {
    static std::vector<void (*)()> all;
    return all;
}

inline void note(benchmark::State& state, std::size_t rays, std::size_t hits) {
    state.counters["rays"] = static_cast<double>(rays);
    state.counters["hits"] = static_cast<double>(hits);
}
inline void add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
    benchmark::RegisterBenchmark(name.c_str(), run)
        ->Repetitions(5)
        ->ReportAggregatesOnly(true)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->Iterations(1);
}

}  // namespace raycast_peer
