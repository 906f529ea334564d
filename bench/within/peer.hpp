// SPDX-License-Identifier: MIT
#pragma once

// What bench/within.cpp and its peers share: clouds of points, radii, and the form of a row.

#include <cstddef>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "../../docs/examples/scene.hpp"

namespace within_peer {

struct cloud {
    const char* name;
    std::vector<abut::vec3<float>> points;
    double few, many;  ///< radii, with about one neighbour each, and about twenty
};

/// Points that fill a cube, and those of a surface.
inline const std::vector<cloud>& clouds() {
    static const std::vector<cloud> all{{"cube", scene::centers<float>(200'000), 9, 24},
                                        {"surface", scene::torus<float>().vertices, 2.2, 7}};
    return all;
}

/// Adds a row NAME/CLOUD/few or many; run(state, points, radius).
template <class Run>
void add(const std::string& name, const Run& run) {
    for (const cloud& c : clouds()) {
        for (const bool many : {false, true}) {
            const std::string row = name + "/" + c.name + (many ? "/many" : "/few");
            benchmark::RegisterBenchmark(row.c_str(),
                                         [&c, many, run](benchmark::State& state) { run(state, c, many ? c.many : c.few); })
                ->Repetitions(5)
                ->ReportAggregatesOnly(true)
                ->Unit(benchmark::kMillisecond);
        }
    }
}

inline void note(benchmark::State& state, std::size_t pairs) { state.counters["pairs"] = static_cast<double>(pairs); }

}  // namespace within_peer
