// SPDX-License-Identifier: MIT
//
// usage: bench_raycast_cuda [OUT.json [MESH]]
//
// bench/raycast.cpp on CUDA: the same mesh (MESH, PLY or OBJ, or a torus), the same kinds of rays, 16 times as many, and the
// same names, policy cuda; all data resident on the device before the clock starts. Each figure is the median of 21 runs,
// taken with CUDA events around the whole call. The floor is what has to be read and written at least once.

#include <cstddef>
#include <string>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "mesh_file.hpp"
#include "raycast_scene.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;

template <abut::arithmetic A, class Index>
void add(const abut::cuda& on, table& out, const scene::surface<float>& surface, const char* name, const char* arithmetic,
         const Index& index) {
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const auto made = raycast_scene::rays_at(surface, kind, 4 * raycast_scene::default_side);
        const abut::rays<float, abut::device_space> rays(on, made);
        const double bytes = static_cast<double>(index.bytes()) + (24.0 + 8.0) * static_cast<double>(rays.size());
        out.add(joined({"raycast", raycast_scene::kinds[kind], name, arithmetic, "cuda"}), bytes, [&] {
            const auto found = abut::raycast<A>(on, index, rays);
            return counters{{"items", static_cast<double>(found.size())}};
        });
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string path = argc > 2 ? argv[2] : "";
    return bench::run("bench_raycast_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        const auto surface = path.empty() ? scene::torus<float>() : bench::read_surface<scene::surface<float>>(path);
        const abut::mesh<float, abut::device_space> mesh(on, surface.vertices, surface.faces);
        const auto linear = abut::make_bvh(on, mesh), joined_tree = abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::ploc});
        add<abut::filtered>(on, out, surface, "bvh", "filtered", linear);
        add<abut::filtered>(on, out, surface, "ploc", "filtered", joined_tree);
        add<abut::fast>(on, out, surface, "ploc", "fast", joined_tree);
    });
}
