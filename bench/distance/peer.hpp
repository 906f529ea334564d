// SPDX-License-Identifier: MIT
#pragma once

// What bench/distance.cpp and its peers share: the scenes and their rows.

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "../distance_scene.hpp"

namespace distance_peer {

using distance_scene::pose;
using distance_scene::scene;

/// Who adds rows of a scene.
using adder = void (*)(const scene&);
inline std::vector<adder>& peers() {
    static std::vector<adder> all;
    return all;
}

/// Rows distance/SCENE/KIND/NAME, KIND being apart or touching: ms a pose, of ask(pose), which gives a distance.
template <class Ask>
void add(const scene& s, const std::string& name, const Ask& ask) {
    const auto add_kind = [&](const std::string& kind, const std::vector<pose>& poses) {
        if (poses.empty()) return;
        benchmark::RegisterBenchmark(("distance/" + s.name + "/" + kind + "/" + name).c_str(),
                                     [&poses, ask](benchmark::State& state) {
                                         double sum = 0;
                                         for (auto _ : state) {
                                             sum = 0;
                                             for (const pose& p : poses) sum += ask(p);
                                         }
                                         state.counters["poses"] = static_cast<double>(poses.size());
                                         state.counters["mean_distance"] = sum / static_cast<double>(poses.size());
                                     })
            ->Repetitions(5)
            ->ReportAggregatesOnly(true)
            ->Unit(benchmark::kMillisecond)
            ->Iterations(1);
    };
    add_kind("apart", s.apart);
    add_kind("touching", s.touching);
}

}  // namespace distance_peer
