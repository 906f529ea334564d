// SPDX-License-Identifier: MIT
#pragma once

// What bench/raycast.cpp and its peers share: the mesh, their rows, and what of a peer's answers is wrong.

#include <algorithm>
#include <cstddef>
#include <cstdint>
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

/// Rays of a kind, and the triangle that each meets first, by abut::exact. It and what follows are in bench/raycast.cpp: a peer whose
/// source is compiled for a newer processor compiles nothing of abut's queries.
struct truth {
    std::vector<abut::ray<float>> rays;
    std::vector<std::uint32_t> ids;
};
const truth& truth_of(std::size_t kind);

/// How many rays are told a miss, a hit or a triangle wrongly. Of triangles that are met at exactly the same time each is right.
std::size_t wrong_hits(std::size_t kind, const std::vector<std::uint32_t>& named);
std::size_t wrong_flags(std::size_t kind, const std::vector<std::uint8_t>& named);

inline void note(benchmark::State& state, std::size_t rays, std::size_t hits) {
    state.counters["rays"] = static_cast<double>(rays);
    state.counters["hits"] = static_cast<double>(hits);
}
/// The same, and what of it is wrong, unless ids are others.
inline void note_hits(benchmark::State& state, std::size_t kind, const std::vector<std::uint32_t>& named, bool has_ids = true) {
    note(state, named.size(), named.size() - static_cast<std::size_t>(std::count(named.begin(), named.end(), abut::no_id)));
    if (has_ids) state.counters["wrong"] = static_cast<double>(wrong_hits(kind, named));
}
inline void note_flags(benchmark::State& state, std::size_t kind, const std::vector<std::uint8_t>& named) {
    note(state, named.size(), named.size() - static_cast<std::size_t>(std::count(named.begin(), named.end(), std::uint8_t{0})));
    state.counters["wrong"] = static_cast<double>(wrong_flags(kind, named));
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
