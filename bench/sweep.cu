// SPDX-License-Identifier: MIT
//
// usage: bench_sweep_cuda [OUT.json [MESH]]
//
// bench/sweep.cpp on CUDA: about a million shapes a call, and a tree by ploc. Names:
//
//   raycast/RAYS/cuda            segments along the ways
//   sweep/RAYS/balls/cuda        balls along the same ways; `over` of raycast; of the first 2,000 rows those that `differ` from the
//   sweep/RAYS/capsules/cuda     host's, bit for bit; `hits` of the first 2,000. Capsules likewise
//
// Each figure is the median of 21 runs (fewer of long ones), taken with CUDA events around the whole call.

#include <cstddef>
#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "mesh_file.hpp"
#include "sweep_scene.hpp"

namespace {

constexpr std::size_t sweep_bench_side = 1024, few = 2000;

template <class Index, class HostIndex, class Shape>
void add_sweeps(const abut::cuda& on, bench::table& out, const std::string& name, double raycast_ms, const Index& index,
                const HostIndex& host_index, const std::vector<Shape>& shapes, const std::vector<abut::vec3<float>>& ways) {
    const abut::shapes<Shape> some(std::vector<Shape>(shapes.begin(), shapes.begin() + few));
    const abut::points<float> along(std::vector<abut::vec3<float>>(ways.begin(), ways.begin() + few));
    const auto expected = to_host(abut::sweep(abut::serial{}, host_index, some, along));
    const abut::shapes<Shape, abut::device_space> on_device(on, shapes);
    const abut::points<float, abut::device_space> ways_there(on, ways);
    const auto found = to_host(abut::sweep(on, index, on_device, ways_there));
    double differ = 0, hits = 0;
    for (std::size_t i = 0; i < few; ++i) {
        differ += !(found[i] == expected[i]);
        hits += found[i].id != abut::no_id;
    }
    const double ms = out.add(name, 0, [&] {
        (void)abut::sweep(on, index, on_device, ways_there);
        return bench::counters{{"items", static_cast<double>(shapes.size())}, {"hits", hits}, {"differ", differ}};
    });
    std::printf("%s over raycast %.2f\n", name.c_str(), ms / raycast_ms);
}

}  // namespace

int main(int argc, char** argv) {
    const std::string path = argc > 2 ? argv[2] : "";
    return bench::run("bench_sweep_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        const auto surface = path.empty() ? scene::torus<float>() : bench::read_surface<scene::surface<float>>(path);
        const abut::bvh_options how{.builder = abut::bvh_builder::ploc};
        const auto index = make_bvh(on, abut::mesh<float, abut::device_space>(on, surface.vertices, surface.faces), how);
        const auto host_index = make_bvh(abut::serial{}, abut::mesh<float>(surface.vertices, surface.faces), how);
        for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
            const sweep_scene::rows rows(surface, kind, sweep_bench_side);
            const std::string rays = raycast_scene::kinds[kind];
            const abut::segments<float, abut::device_space> lines(on, rows.lines);
            const double ms = out.add("raycast/" + rays + "/cuda", 0, [&] {
                (void)abut::raycast(on, index, lines);
                return bench::counters{{"items", static_cast<double>(lines.size())}};
            });
            add_sweeps(on, out, "sweep/" + rays + "/balls/cuda", ms, index, host_index, rows.balls, rows.ways);
            add_sweeps(on, out, "sweep/" + rays + "/capsules/cuda", ms, index, host_index, rows.capsules, rows.ways);
        }
    });
}
