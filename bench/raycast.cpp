// SPDX-License-Identifier: MIT
//
// usage: bench_raycast [--mesh=FILE] --benchmark_enable_random_interleaving=true --benchmark_out=raycast.json
//
// For each of a million rays the triangle that it meets first: of a mesh (FILE, PLY or OBJ, or a torus). Names:
//
//   raycast/RAYS/INDEX/ARITHMETIC/POLICY    the query alone; the index is there. RAYS: raycast_scene.hpp
//
// The peer (bench/raycast/) is in the same run, where its package is there.

#include <cstddef>
#include <cstdio>
#include <exception>
#include <string>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "google.hpp"
#include "mesh_file.hpp"
#include "raycast/peer.hpp"

namespace {

template <abut::arithmetic A, class Policy, class Index>
void add(const char* index_name, const char* arithmetic, const char* policy, const Policy& on, const Index& index) {
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const abut::rays<float> rays(raycast_scene::rays_at(raycast_peer::mesh(), kind, raycast_scene::default_side));
        const std::string name = std::string("raycast/") + raycast_scene::kinds[kind] + "/" + index_name + "/" + arithmetic + "/" + policy;
        raycast_peer::add(name, [=](benchmark::State& state) {
            std::size_t hits = 0;
            for (auto _ : state) {
                const auto found = abut::raycast<A>(on, index, rays);
                state.PauseTiming();
                hits = 0;
                for (const auto& hit : found) hits += hit.id != abut::no_id;
                state.ResumeTiming();
            }
            raycast_peer::note(state, rays.size(), hits);
        });
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--mesh");
        raycast_peer::mesh() = path.empty() ? scene::torus<float>() : bench::read_surface<scene::surface<float>>(path);
        benchmark::AddCustomContext("mesh", path.empty() ? "torus" : path.substr(path.find_last_of('/') + 1));
        const abut::mesh<float> mesh(raycast_peer::mesh().vertices, raycast_peer::mesh().faces);
        const abut::serial on;
        const auto linear = abut::make_bvh(on, mesh), sah = abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::sah});
        const auto wide_sah = abut::wide(on, sah);
        add<abut::filtered>("bvh", "filtered", "serial", on, linear);
        add<abut::filtered>("sah", "filtered", "serial", on, sah);
        add<abut::filtered>("wide_sah", "filtered", "serial", on, wide_sah);
        add<abut::fast>("sah", "fast", "serial", on, sah);
        add<abut::filtered>("sah", "filtered", "openmp", abut::openmp{}, sah);
        for (const auto register_peer : raycast_peer::peers()) register_peer();
        return bench::run_registered("bench_raycast", argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        return 1;
    }
}
