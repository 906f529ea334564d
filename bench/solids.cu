// SPDX-License-Identifier: MIT
//
// usage: bench_solids_cuda [OUT.json [MESH]]
//
// bench/solids.cpp on CUDA, of MESH (PLY or OBJ, or a torus) and its copy, turned by 0.4 and moved by a tenth of its width. Names:
//
//   pairs/cuda, crossings/cuda    which faces meet, and what they have in common; differ: 1 if crossings are not the host's, bit for bit
//   any/cuda, overlaps/cuda, relation/cuda    of meshes that are known to be solids
//
// Each figure is the median of 21 runs (fewer of long ones), taken with CUDA events around the whole call.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <abut/cuda.hpp>
#include <abut/collide/crossings.hpp>
#include <abut/collide/relation.hpp>

#include "cuda_table.hpp"
#include "mesh_file.hpp"
#include "../docs/examples/scene.hpp"

int main(int argc, char** argv) {
    const std::string path = argc > 2 ? argv[2] : "";
    return bench::run("bench_solids_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        const auto s = path.empty() ? scene::torus<float>() : bench::read_surface<scene::surface<float>>(path);
        float low = s.vertices[0].x, high = low;
        for (const auto& p : s.vertices) low = std::min(low, p.x), high = std::max(high, p.x);
        const float d = (high - low) / 10, c = std::cos(0.4F), n = std::sin(0.4F);
        std::vector<abut::vec3<float>> moved;
        for (const auto& p : s.vertices) moved.push_back({c * p.x - n * p.y + d, n * p.x + c * p.y + d / 2, p.z + d / 3});
        using device_mesh = abut::mesh<float, abut::device_space>;
        const auto a = make_bvh(on, device_mesh(on, s.vertices, s.faces)), b = make_bvh(on, device_mesh(on, moved, s.faces));
        const abut::serial host;
        const auto host_a = make_bvh(host, abut::mesh<float>(s.vertices, s.faces)),
                   host_b = make_bvh(host, abut::mesh<float>(moved, s.faces));
        const double differ = to_host(crossings(on, a, b)) == to_host(crossings(host, host_a, host_b)) ? 0 : 1;
        const auto add = [&](const char* name, const auto& ask) { out.add(name, 0, ask); };
        add("pairs/cuda", [&] { return bench::counters{{"pairs", static_cast<double>(pairs(on, a, b).size())}}; });
        add("crossings/cuda", [&] {
            return bench::counters{{"crossings", static_cast<double>(crossings(on, a, b).size())}, {"differ", differ}};
        });
        add("any/cuda", [&] { return bench::counters{{"found", any(on, a, b) ? 1.0 : 0.0}}; });
        add("overlaps/cuda", [&] { return bench::counters{{"found", overlaps(on, a, b, {.known_solid = true}) ? 1.0 : 0.0}}; });
        add("relation/cuda", [&] { return bench::counters{{"found", static_cast<double>(relation(on, a, b, {.known_solid = true}))}}; });
    });
}
