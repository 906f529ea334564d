// SPDX-License-Identifier: MIT
//
// usage: bench_within [--meshes=FOLDER] --benchmark_enable_random_interleaving=true --benchmark_out=within.json
//
// All that is no farther apart than a distance, on one core, the indices being there. Names:
//
//   points/CALL/CLOUD/few or many  neighbours within a radius, of points that fill a cube or a surface; each point has about
//                                  one or twenty. CALL is trees (both ways, sorted by point), unsorted, count, or self (each
//                                  pair once, sorted)
//   points/floor/...               what the pairs of `trees` take to be written once, to memory that is there
//   mesh/CALL/SCENE                two meshes beside each other: pairs, any, distance, and within at a share of the mesh's
//                                  width: within_0, within_0.001 ...
//
// The peer (bench/within/) is in the same run, where its package is there.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "google.hpp"
#include "mesh_file.hpp"
#include "within/peer.hpp"

namespace {

using within_peer::cloud;
const abut::serial on;

template <class Ask>
void add_points(const char* name, const Ask& ask) {
    within_peer::add(std::string("points/") + name, [ask](benchmark::State& state, const cloud& c, double radius) {
        const auto tree = make_bvh(on, abut::points<float>(c.points));
        std::size_t found = 0;
        for (auto _ : state) found = ask(tree, radius);
        within_peer::note(state, found);
    });
}

void write_once(benchmark::State& state, const cloud& c, double radius) {
    const auto tree = make_bvh(on, abut::points<float>(c.points));
    std::vector<abut::index_pair> pairs(abut::count_within(on, tree, tree, radius));
    std::uint32_t k = 0;
    for (auto _ : state) {
        for (abut::index_pair& pair : pairs) pair = {k, k};
        ++k;
        benchmark::DoNotOptimize(pairs.data());
        benchmark::ClobberMemory();
    }
    within_peer::note(state, pairs.size());
}

struct surface {
    std::vector<abut::vec3<float>> vertices;
    std::vector<abut::face> faces;
};

template <class Ask>
void add_mesh(const std::string& name, const Ask& ask) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [ask](benchmark::State& state) {
                                     std::size_t found = 0;
                                     for (auto _ : state) found = ask();
                                     within_peer::note(state, found);
                                 })
        ->Repetitions(5)
        ->ReportAggregatesOnly(true)
        ->Unit(benchmark::kMillisecond);
}

/// A mesh and a turned copy of it, which are a little apart or touch.
void add_meshes(const std::string& scene, const surface& s) {
    const auto a = make_bvh(on, abut::mesh<float>(s.vertices, s.faces), {.builder = abut::bvh_builder::sah});
    const double width = static_cast<double>(a.bounds().upper.x) - static_cast<double>(a.bounds().lower.x);
    for (const bool beside : {true, false}) {
        const abut::rigid<float> pose{{0.6f, -0.8f, 0, 0.8f, 0.6f, 0, 0, 0, 1}, {float(width * (beside ? 0.9 : 0.02)), 0, 0}};
        const auto b = posed(a, pose);
        const std::string which = scene + (beside ? "_beside" : "_onto");
        add_mesh(bench::joined({"mesh", "pairs", which}), [=] { return abut::pairs(on, a, b).size(); });
        add_mesh(bench::joined({"mesh", "any", which}), [=] { return static_cast<std::size_t>(abut::any(on, a, b)); });
        add_mesh(bench::joined({"mesh", "distance", which}), [=] { return static_cast<std::size_t>(abut::distance(on, a, b).has_value()); });
        for (const char* share : {"0", "0.001", "0.01", "0.03"}) {
            const double d = std::stod(share) * width;
            add_mesh(bench::joined({"mesh", std::string("within_").append(share), which}), [=] { return abut::within(on, a, b, d).size(); });
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string folder = bench::take_argument(argc, argv, "--meshes");
    add_points("trees", [](const auto& tree, double r) { return abut::within(on, tree, tree, r).size(); });
    add_points("unsorted",
               [](const auto& tree, double r) { return abut::within(on, tree, tree, r, {.sorted = false}).size(); });
    add_points("count", [](const auto& tree, double r) { return abut::count_within(on, tree, tree, r); });
    add_points("self", [](const auto& tree, double r) { return abut::self_within(on, tree, r).size(); });
    within_peer::add("points/floor", write_once);
    const auto torus = scene::torus<float>();
    add_meshes("torus", {torus.vertices, torus.faces});
    if (!folder.empty()) {
        for (const char* name : {"armadillo_27674", "stanford-bunny"}) {
            add_meshes(name, bench::read_surface<surface>(folder + "/" + name + ".ply"));
        }
    }
    return bench::run_registered("bench_within", argc, argv);
}
