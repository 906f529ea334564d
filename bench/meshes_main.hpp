// SPDX-License-Identifier: MIT
#pragma once

// The main of the benchmarks on the pair of meshes of bench/meshes_scene.hpp: --mesh=FILE chooses the mesh.

#include <cstdio>
#include <exception>
#include <string>

#include <benchmark/benchmark.h>

#include "mesh_file.hpp"
#include "meshes_scene.hpp"

namespace meshes_scene {

/// Makes the pair, lets `add` and the peers register their benchmarks, and runs them. Returns the exit status.
template <class Add>
int run(int argc, char** argv, const Add& add) {
    try {
        const std::string path = bench::take_mesh_argument(argc, argv);
        benchmark::Initialize(&argc, argv);
        if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
        const mesh_pair pair = make_pair(path.empty() ? unit_torus() : read_surface(path));
        the_pair = &pair;
        benchmark::AddCustomContext("mesh", path.empty() ? "torus" : path);
        add();
        for (const auto register_peer : peers()) register_peer();
        benchmark::RunSpecifiedBenchmarks();
        benchmark::Shutdown();
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        return 1;
    }
}

}  // namespace meshes_scene
