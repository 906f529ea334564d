// SPDX-License-Identifier: MIT
#pragma once

// The main of the benchmarks on the pair of meshes of bench/meshes_scene.hpp: --mesh=FILE chooses the mesh.

#include <cstdio>
#include <exception>
#include <string>

#include "google.hpp"
#include "mesh_file.hpp"
#include "meshes_scene.hpp"

namespace meshes_scene {

/// Makes the pair, lets `add` and the peers register their benchmarks, and runs them. Returns the exit status.
template <class Add>
int run(const char* program, int argc, char** argv, const Add& add) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--mesh");
        const mesh_pair pair = make_pair(path.empty() ? unit_torus() : read_surface(path));
        the_pair = &pair;
        benchmark::AddCustomContext("mesh", path.empty() ? "torus" : path.substr(path.find_last_of('/') + 1));
        add();
        for (const auto register_peer : peers()) register_peer();
        return bench::run_registered(program, argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        return 1;
    }
}

}  // namespace meshes_scene
