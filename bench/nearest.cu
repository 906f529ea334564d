// SPDX-License-Identifier: MIT
//
// usage: bench_nearest_cuda [OUT.json]
//
// bench/nearest.cpp on CUDA: the same scene and the same names, policy cuda, all data resident on the device before the
// clock starts. Each figure is the median of 21 runs after two that are not counted, taken with CUDA events around the whole
// call. The floor is what has to be read and written at least once.

#include <cstddef>
#include <string>

#include <abut/cuda.hpp>

#include "../docs/examples/scene.hpp"
#include "cuda_table.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;

template <class Index>
void add(const abut::cuda& on, const char* name, const Index& index, double index_bytes, table& out) {
    for (const std::size_t n : {std::size_t{100'000}, scene::sphere_count}) {
        const abut::points<float, abut::device_space> points(on, scene::centers<float>(n));
        const double least = index_bytes + (12.0 + 20.0) * static_cast<double>(n);
        out.add(joined({"nearest", name, "cuda", std::to_string(n)}), least, [&] {
            return counters{{"points", static_cast<double>(abut::nearest(on, index, points).size())}};
        });
    }
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_nearest_cuda", argc, argv, [](const abut::cuda& on, table& out) {
        const auto surface = scene::torus<float>();
        const abut::mesh<float, abut::device_space> mesh(on, surface.vertices, surface.faces);
        const double mesh_bytes = 12.0 * static_cast<double>(surface.vertices.size() + surface.faces.size());
        const auto tree = abut::make_bvh(on, mesh);
        const auto joined_tree = abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::ploc});
        add(on, "bvh", tree, mesh_bytes + static_cast<double>(tree.bytes()), out);
        add(on, "ploc", joined_tree, mesh_bytes + static_cast<double>(joined_tree.bytes()), out);
        const auto turned = abut::oriented(on, joined_tree);
        add(on, "oriented", turned, mesh_bytes + static_cast<double>(turned.bytes()), out);
        const auto small = abut::quantised(on, tree);
        add(on, "quantised", small, mesh_bytes + static_cast<double>(small.bytes()), out);
    });
}
