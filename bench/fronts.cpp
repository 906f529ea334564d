// SPDX-License-Identifier: MIT
//
// usage: bench_fronts [--frames=N] [--json=OUT.json] [FOLDER...]
//
// Queries from a front (experimental/front.hpp) beside the same from the roots, on one core, for 40 frames, or N. Names:
//
//   sheet/STEP/QUERY        a rolled-up sheet of 100,352 triangles with a wave that runs along it; in a frame the fastest
//                           vertex moves by STEP edges
//   FOLDER/PARTS/QUERY      a step of a simulation (FOLDER/frame0.ply and frame1.ply) in so many equal parts, there and back
//
// Queries: self/pairs and two/pairs, where the other mesh is a copy at rest, moved a little; self/boxes and two/boxes, the
// same with a filter that refuses all, which leaves the walk; and self_impacts of the frame's motion. A row has medians with
// a front and without, the longest frame with a front but the first, pairs of nodes in the front at the end, how many were
// opened in a mean frame, pairs that the last frame found, and how often it began at the roots.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "fronts_scene.hpp"

namespace {

struct steady {
    template <class Work>
    double operator()(const Work& work) const {
        using clock = std::chrono::steady_clock;
        const auto begin = clock::now();
        work();
        return std::chrono::duration<double, std::milli>(clock::now() - begin).count();
    }
};

}  // namespace

int main(int argc, char** argv) {
    try {
        const int frames = std::max(std::stoi(bench::take_argument(argc, argv, "--frames", "40")), 2);
        const std::string path = bench::take_argument(argc, argv, "--json");
        bench::results out("bench_fronts");
        const auto note = [&](const std::string& name, const bench::counters& row) { out.add(name, row); };
        fronts_scene::race_scenes(abut::serial{}, steady{}, note, {argv + 1, argv + argc}, frames);
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_fronts: %s\n", problem.what());
        return 1;
    }
}
