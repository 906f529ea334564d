// SPDX-License-Identifier: MIT
//
// usage: bench_nearest [--mesh=FILE.ply] --benchmark_enable_random_interleaving=true --benchmark_out=nearest.json
//
// For each of many points the nearest triangle, and the nearest vertex: the centres of the scene of Lee and Hsieh, 2019, and
// its torus. Names:
//
//   nearest/INDEX/POLICY/POINTS           the query alone; the index is there
//   nearest_close, nearest_tube           the same of points close to the torus, and in its tube
//   nearest_mesh_box, nearest_mesh_close  of points in the box of a mesh, and close to it
//   nearest_vertex/INDEX/POLICY/POINTS    the same of the torus's vertices
//   nearest_few/INDEX/POLICY/POINTS       the 8 nearest of the centres to each of them, after two calls that are not
//                                         counted: the process has the memory by then
//
// The peers (bench/nearest/) are in the same run, where their packages are there.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "../docs/examples/scene.hpp"
#include "google.hpp"
#include "nearest/peer.hpp"
#include "nearest_scene.hpp"

namespace {

const nearest_scene::surface& torus() {
    static const auto made = scene::torus<float>();
    return made;
}
abut::mesh<float> mesh_of(const nearest_scene::surface& of) { return {of.vertices, of.faces}; }

struct bvh {
    static constexpr const char* name = "bvh";
    static auto make(const auto& on, const auto& of) { return abut::make_bvh(on, mesh_of(of)); }
};
struct sah {
    static constexpr const char* name = "sah";
    static auto make(const auto& on, const auto& of) { return abut::make_bvh(on, mesh_of(of), {.builder = abut::bvh_builder::sah}); }
};
struct oriented_sah {
    static constexpr const char* name = "oriented_sah";
    static auto make(const auto& on, const auto& of) { return abut::oriented(on, sah::make(on, of)); }
};
struct wide_sah {
    static constexpr const char* name = "wide_sah";
    static auto make(const auto& on, const auto& of) { return abut::wide(on, sah::make(on, of)); }
};

struct bvh_of_vertices {
    static constexpr const char* name = "bvh";
    static auto make(const auto& on, const auto& of) { return abut::make_bvh(on, abut::vertices(mesh_of(of))); }
};
struct sah_of_vertices {
    static constexpr const char* name = "sah";
    static auto make(const auto& on, const auto& of) {
        return abut::make_bvh(on, abut::vertices(mesh_of(of)), {.builder = abut::bvh_builder::sah});
    }
};

template <class Index, class Policy>
void nearest(benchmark::State& state, Policy on, const nearest_scene::question& ask, std::size_t n) {
    const auto index = Index::make(on, *ask.mesh);
    const abut::points<float> points(ask.points(*ask.mesh, n));
    double sum = 0;
    for (auto _ : state) {
        const auto found = abut::nearest(on, index, points);
        state.PauseTiming();
        sum = 0;
        for (const auto& near : found) sum += static_cast<double>(near.distance);
        state.ResumeTiming();
    }
    state.counters["points"] = static_cast<double>(n);
    state.counters["mean_distance"] = sum / static_cast<double>(n);
}

template <class Policy>
void nearest_few(benchmark::State& state, Policy on, std::size_t n) {
    const abut::points<float> points(scene::centers<float>(n));
    const auto index = abut::make_bvh(on, points);
    double sum = 0;
    for (int i = 0; i < 2; ++i) benchmark::DoNotOptimize(abut::nearest(on, index, points, 8));
    for (auto _ : state) {
        const auto found = abut::nearest(on, index, points, 8);
        state.PauseTiming();
        sum = 0;
        for (const auto& near : found) sum += static_cast<double>(near.distance);
        state.ResumeTiming();
    }
    state.counters["points"] = static_cast<double>(n);
    state.counters["mean_distance"] = sum / static_cast<double>(8 * n);
}

void add_row(const std::string& name, std::size_t n, const auto& run) {
    benchmark::RegisterBenchmark((name + "/" + std::to_string(n)).c_str(), run)
        ->Repetitions(5)
        ->ReportAggregatesOnly(true)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->Iterations(1);
}

template <class Index, class Policy>
void add(const char* policy, const Policy& on, const nearest_scene::question& ask) {
    for (const std::size_t n : ask.counts) {
        add_row(ask.name + "/" + Index::name + "/" + policy, n,
                [=](benchmark::State& state) { nearest<Index>(state, on, ask, n); });
    }
}

}  // namespace

std::size_t nearest_peer::wrong_ids(const scene::surface<float>& mesh, const std::vector<abut::vec3<float>>& points,
                                    const std::vector<std::uint32_t>& named) {
    const abut::serial on;
    const auto index = abut::make_bvh(on, abut::mesh<float>(mesh.vertices, mesh.faces), {.builder = abut::bvh_builder::sah});
    const auto right = abut::nearest(on, index, abut::points<float>(points));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (named[i] == right[i].id) continue;
        const abut::mesh<float> both(mesh.vertices, {mesh.faces[named[i]], mesh.faces[right[i].id]});
        wrong += abut::nearest(on, both, abut::points<float>(std::vector{points[i]}))[0].id != 0;  // of two as near the least id
    }
    return wrong;
}

int main(int argc, char** argv) {
    const abut::serial on;
    for (const auto& ask : nearest_scene::questions(bench::take_argument(argc, argv, "--mesh"))) {
        add<bvh>("serial", on, ask);
        add<sah>("serial", on, ask);
        add<wide_sah>("serial", on, ask);
        add<oriented_sah>("serial", on, ask);
        if (ask.name == "nearest") add<bvh>("openmp", abut::openmp{}, ask);
    }
    const std::vector<std::size_t> counts{100'000, scene::sphere_count};
    const nearest_scene::question of_vertices{"nearest_vertex", counts, &torus(), nearest_scene::far_points};
    add<bvh_of_vertices>("serial", on, of_vertices);
    add<sah_of_vertices>("serial", on, of_vertices);
    for (const std::size_t n : counts) {
        add_row("nearest_few/bvh/serial", n, [=](benchmark::State& state) { nearest_few(state, on, n); });
    }
    return bench::run_registered("bench_nearest", argc, argv);
}
