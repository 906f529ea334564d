// SPDX-License-Identifier: MIT
//
// usage: bench_builders [--mesh=FILE] --benchmark_enable_random_interleaving=true --benchmark_out=cpu.json
//
// The scene of bench/meshes.cpp, by builders and layouts of trees. FILE is PLY or OBJ; without it a torus of 345,744
// triangles. Names:
//
//   build/BUILDER/POLICY             a tree over one mesh, of any builder
//   build/embree_QUALITY/serial      the peer's (bench/builders/)
//   refit/BUILDER/POLICY             such a tree around the turned mesh
//   convert/LAYOUT/POLICY            such a tree in another layout; convert/LAYOUT/BUILDER/POLICY depends on the builder.
//                                    Layouts by their names; oriented, sphere and kdop18 are trees of these volumes
//   pairs/baked/BUILDER/LAYOUT       pairs of two trees, sorted, on one core; counters hold what `quality` says of the first
//   unsorted/baked/BUILDER/LAYOUT    the same, unsorted, as the peer's unsorted/embree_QUALITY/serial
//   pairs/posed/BUILDER/LAYOUT       the same, the second being the first tree under a pose
//   one_sided/BUILDER/LAYOUT         one tree, and the shapes of the other mesh

#include <cstddef>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>
#include <abut/experimental/leafless.hpp>

#include "meshes_main.hpp"

namespace {

namespace scene = meshes_scene;

const char* name_of(const abut::serial&) { return "serial"; }
const char* name_of(const abut::openmp&) { return "openmp"; }

constexpr std::pair<const char*, abut::bvh_builder> builders[] = {{"linear", abut::bvh_builder::linear},
                                                                  {"mean_split", abut::bvh_builder::mean_split},
                                                                  {"sah", abut::bvh_builder::sah},
                                                                  {"ploc", abut::bvh_builder::ploc}};

template <class Work>
void add(const std::string& name, bool threads, const Work& work) {
    auto* const b = benchmark::RegisterBenchmark(name.c_str(), [work](benchmark::State& state) { work(state); });
    b->Unit(benchmark::kMillisecond)->Repetitions(11)->ReportAggregatesOnly(true)->MinTime(0.01);
    if (threads) b->UseRealTime();
}

template <class Policy>
void add_builds(const Policy& on, const abut::mesh<float>& a, const abut::mesh<float>& b) {
    const bool threads = std::same_as<Policy, abut::openmp>;
    for (const auto& [name, builder] : builders) {
        const abut::bvh_options options{.builder = builder};
        const std::string suffix = std::string(name) + "/" + name_of(on);
        add("build/" + suffix, threads, [=](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(make_bvh(on, a, options).size());
        });
        const auto tree = make_bvh(on, a, options);
        benchmark::DoNotOptimize(refit(on, tree, a).size());
        add("refit/" + suffix, threads, [=](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(refit(on, tree, b).size());
        });
    }
    const auto tree = make_bvh(on, a);
    add(std::string("convert/quantised/") + name_of(on), threads, [=](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(quantised(on, tree).size());
    });
    add(std::string("convert/leafless/") + name_of(on), threads, [=](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(leafless(on, tree).size());
    });
    for (const auto& [name, builder] : builders) {
        const auto from = make_bvh(on, a, {.builder = builder});
        add(std::string("convert/wide/") + name + "/" + name_of(on), threads, [=](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(wide(on, from).size());
        });
    }
}

template <class Tree>
void add_queries(const std::string& suffix, const Tree& a, const Tree& b) {
    const abut::serial on;
    const auto add_pairs = [&](const std::string& name, const auto& other) {
        add(name + suffix, false, [=](benchmark::State& state) {
            std::size_t n = 0;
            for (auto _ : state) n = pairs(on, a, other).size();
            const abut::bvh_quality q = quality(a);
            state.counters["pairs"] = static_cast<double>(n);
            state.counters["sah_cost"] = q.sah_cost;
            state.counters["greatest_depth"] = q.greatest_depth;
            state.counters["mean_depth"] = q.mean_depth;
            state.counters["overlap"] = q.overlap;
            state.counters["bytes_per_shape"] = q.bytes_per_shape;
        });
    };
    add("unsorted/baked/" + suffix, false, [=](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(pairs(on, a, b, {.sorted = false}).size());
    });
    add_pairs("pairs/baked/", b);
    add_pairs("pairs/posed/", posed(a, scene::the_pair->pose));
    add_pairs("one_sided/", b.set());
}

/// Of trees by the surface area heuristic.
template <class Volume, class Tree>
void add_volume(const std::string& name, const Tree& tree_a, const Tree& tree_b) {
    const abut::serial on;
    const auto a = abut::bounded_by<Volume>(on, tree_a), b = abut::bounded_by<Volume>(on, tree_b);
    add("unsorted/baked/sah/" + name, false, [=](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(pairs(on, a, b, {.sorted = false}).size());
    });
    add("pairs/posed/sah/" + name, false, [=, posed_a = posed(a, scene::the_pair->pose)](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(pairs(on, a, posed_a).size());
    });
    add("convert/" + name + "/sah/serial", false, [=](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(abut::bounded_by<Volume>(on, tree_a).size());
    });
}

void add_all() {
    const abut::mesh<float> a(scene::the_pair->a.vertices, scene::the_pair->a.faces);
    const abut::mesh<float> b(scene::the_pair->b.vertices, scene::the_pair->b.faces);
    const abut::serial on;
    add_builds(on, a, b);
    add_builds(abut::openmp{}, a, b);
    for (const auto& [name, builder] : builders) {
        const std::string start = std::string(name) + "/";
        const auto tree_a = make_bvh(on, a, {.builder = builder}), tree_b = make_bvh(on, b, {.builder = builder});
        add_queries(start + "standard", tree_a, tree_b);
        add_queries(start + "quantised", quantised(on, tree_a), quantised(on, tree_b));
        add_queries(start + "leafless", leafless(on, tree_a), leafless(on, tree_b));
        add_queries(start + "wide", wide(on, tree_a), wide(on, tree_b));
        if (builder == abut::bvh_builder::sah) {
            add_volume<abut::obb<float>>("oriented", tree_a, tree_b);
            add_volume<abut::sphere<float>>("sphere", tree_a, tree_b);
            add_volume<abut::kdop<float, 18>>("kdop18", tree_a, tree_b);
        }
    }
}

}  // namespace

int main(int argc, char** argv) { return meshes_scene::run("bench_builders", argc, argv, add_all); }
