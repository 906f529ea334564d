// SPDX-License-Identifier: MIT
//
// usage: bench_sweep [--mesh=FILE] --benchmark_enable_random_interleaving=true --benchmark_out=sweep.json
//
// For each of many shapes that go along vectors the triangle that it touches first: of a mesh (FILE, PLY or OBJ, or a torus).
// Beside as many segments along the same ways. Names:
//
//   raycast/RAYS/INDEX              segments, by raycast. RAYS: raycast_scene.hpp, three times as long as the mesh is far
//   sweep/RAYS/SHAPES/INDEX         balls, or capsules twice as long as thick; their radius is 2^-10 of the mesh's longest side
//
// `hits` are rows that meet something. `wrong`: of the first 2,000 rows those that differ from what integers alone say.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "google.hpp"
#include "mesh_file.hpp"
#include "sweep_scene.hpp"

namespace {

constexpr std::size_t sweep_bench_side = 316;

template <class Ask>
void add_sweep(const std::string& name, const Ask& ask, std::size_t wrong = 0) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        std::size_t hits = 0, rows = 0;
        for (auto _ : state) {
            const auto found = ask();
            state.PauseTiming();
            hits = 0, rows = found.size();
            for (const auto& hit : found) hits += hit.id != abut::no_id;
            state.ResumeTiming();
        }
        state.counters["rows"] = static_cast<double>(rows);
        state.counters["hits"] = static_cast<double>(hits);
        state.counters["wrong"] = static_cast<double>(wrong);
    })->Unit(benchmark::kMillisecond);
}

/// Of the first rows those of which integers alone say something else.
template <class Index, class Shape>
std::size_t wrong_sweeps(const Index& index, const std::vector<Shape>& shapes, const std::vector<abut::vec3<float>>& ways) {
    const std::size_t few = std::min<std::size_t>(2000, shapes.size());
    const abut::shapes<Shape> some(std::vector<Shape>(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(few)));
    const abut::points<float> along(std::vector<abut::vec3<float>>(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(few)));
    const auto found = to_host(abut::sweep(abut::serial{}, index, some, along));
    const auto right = to_host(abut::sweep<abut::exact>(abut::serial{}, index, some, along));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < few; ++i) wrong += !(found[i] == right[i]);
    return wrong;
}

template <class Index>
void add_sweeps(const char* index_name, const scene::surface<float>& mesh, const Index& index) {
    const abut::serial on;
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const sweep_scene::rows rows(mesh, kind, sweep_bench_side);
        const std::string rays = raycast_scene::kinds[kind];
        const abut::points<float> ways(rows.ways);
        add_sweep("raycast/" + rays + "/" + index_name,
                  [=, lines = abut::segments<float>(rows.lines)] { return abut::raycast(on, index, lines); });
        add_sweep("sweep/" + rays + "/balls/" + index_name,
                  [=, balls = abut::spheres<float>(rows.balls)] { return abut::sweep(on, index, balls, ways); },
                  wrong_sweeps(index, rows.balls, rows.ways));
        add_sweep("sweep/" + rays + "/capsules/" + index_name,
                  [=, capsules = abut::capsules<float>(rows.capsules)] { return abut::sweep(on, index, capsules, ways); },
                  wrong_sweeps(index, rows.capsules, rows.ways));
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--mesh");
        const auto mesh = path.empty() ? scene::torus<float>() : bench::read_surface<scene::surface<float>>(path);
        benchmark::AddCustomContext("mesh", path.empty() ? "torus" : path.substr(path.find_last_of('/') + 1));
        const abut::serial on;
        const auto sah = abut::make_bvh(on, abut::mesh<float>(mesh.vertices, mesh.faces), {.builder = abut::bvh_builder::sah});
        add_sweeps("sah", mesh, sah);
        add_sweeps("wide_sah", mesh, abut::wide(on, sah));
        return bench::run_registered("bench_sweep", argc, argv);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_sweep: %s\n", e.what());
        return 1;
    }
}
