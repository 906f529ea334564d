// SPDX-License-Identifier: MIT
//
// usage: bench_meshes [--mesh=FILE] --benchmark_enable_random_interleaving=true --benchmark_out=cpu.json
//
// A mesh against a turned copy of itself (bench/meshes_scene.hpp): FILE (PLY or OBJ), or a torus of 345,744 triangles.
// Names:
//
//   build/bvh/POLICY            a linear BVH over one of them; the peers build trees of their own (bench/meshes/)
//   QUERY/baked/POLICY          between two trees, the second over the turned copy: pairs, unsorted, count, any, contacts;
//   and
//                               boxes, the walk with a filter that refuses every pair
//   QUERY/posed/POLICY          the same, the second being the first tree under a pose
//   traversal/NAME              unsorted/baked on one core by each traversal but the default; breadth first with its depth
//   one_sided/pairs/POLICY      one tree, and the shapes of the other mesh
//   any/SCENE/KIND/BUILDER      whether anything touches, on one core, in the scenes of bench/any_scenes.hpp; counters hold
//                               the number of pairs and the answer. Of posed shells, the inner one has the identity as pose.
//                               Each of these, and of their peers, asks once before the clock starts, for the caches' sake

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/descent_rules.hpp>

#include "any_scenes.hpp"
#include "meshes_main.hpp"

namespace {

namespace scene = meshes_scene;

const char* name_of(const abut::serial&) { return "serial"; }
const char* name_of(const abut::openmp&) { return "openmp"; }

template <class Work>
void add(const std::string& name, bool threads, const Work& work) {
    auto* const b = benchmark::RegisterBenchmark(name.c_str(), [work](benchmark::State& state) { work(state); });
    b->Unit(benchmark::kMillisecond)->Repetitions(11)->ReportAggregatesOnly(true)->MinTime(0.01);
    if (threads) b->UseRealTime();
}

abut::mesh<float> mesh_of(const scene::surface& s) { return {s.vertices, s.faces}; }

/// Refuses every pair, but no compiler knows.
struct refuse_all {
    std::uint32_t wanted;
    bool operator()(std::uint32_t a, std::uint32_t) const { return a == wanted; }
};

template <class Policy>
void add_policy(const Policy& on) {
    const bool threads = std::same_as<Policy, abut::openmp>;
    const auto a = mesh_of(scene::the_pair->a), b = mesh_of(scene::the_pair->b);
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
    const auto posed_b = posed(tree_a, scene::the_pair->pose);
    const std::string policy = name_of(on);
    add("build/bvh/" + policy, threads, [on, a](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(make_bvh(on, a).size());
    });
    const auto add_queries = [&](const std::string& kind, const auto& other) {
        add("pairs/" + kind + "/" + policy, threads, [on, tree_a, other](benchmark::State& state) {
            std::size_t n = 0;
            for (auto _ : state) n = pairs(on, tree_a, other).size();
            state.counters["pairs"] = static_cast<double>(n);
        });
        add("unsorted/" + kind + "/" + policy, threads, [on, tree_a, other](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(pairs(on, tree_a, other, {.sorted = false}).size());
        });
        add("count/" + kind + "/" + policy, threads, [on, tree_a, other](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(count(on, tree_a, other));
        });
        add("any/" + kind + "/" + policy, threads, [on, tree_a, other](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(any(on, tree_a, other));
        });
        add("boxes/" + kind + "/" + policy, threads, [on, tree_a, other](benchmark::State& state) {
            const abut::query_options<refuse_all> none{.filter = {0xffffffff}};
            for (auto _ : state) benchmark::DoNotOptimize(count(on, tree_a, other, none));
        });
        add("contacts/" + kind + "/" + policy, threads, [on, tree_a, other](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(contacts(on, tree_a, other).size());
        });
    };
    add_queries("baked", tree_b);
    add_queries("posed", posed_b);
    add("one_sided/pairs/" + policy, threads, [on, tree_a, b](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(pairs(on, tree_a, b).size());
    });
}

template <abut::traversal Traversal>
void add_traversal(const std::string& name, int start_depth = 0) {
    const abut::serial on;
    const auto a = make_bvh(on, mesh_of(scene::the_pair->a)), b = make_bvh(on, mesh_of(scene::the_pair->b));
    const abut::query_options<abut::keep_all, Traversal> options{.sorted = false, .start_depth = start_depth};
    add("traversal/" + name, false, [on, a, b, options](benchmark::State& state) {
        for (auto _ : state) benchmark::DoNotOptimize(pairs(on, a, b, options).size());
    });
}

void add_traversals() {
    using enum abut::traversal;
    add_traversal<one_first>("one_first");
    add_traversal<larger_first>("larger_first");
    add_traversal<alternate>("alternate");
    for (const int depth : {0, 6}) add_traversal<breadth_first>("breadth_first/" + std::to_string(depth), depth);
}

/// One scene, with trees a and b of one kind.
template <class Tree>
void add_any_of(const scene::any_scene& s, const std::string& tree, const Tree& tree_a, const Tree& tree_b) {
    const abut::serial on;
    const auto add_query = [&](const char* kind, const auto& other) {
        add("any/" + s.name + "/" + kind + "/" + tree, false, [=, n = s.pairs](benchmark::State& state) {
            bool found = any(on, tree_a, other);
            for (auto _ : state) benchmark::DoNotOptimize(found = any(on, tree_a, other));
            state.counters["found"] = found ? 1 : 0;
            state.counters["pairs"] = static_cast<double>(n);
        });
    };
    add_query("baked", tree_b);
    add_query("posed", posed(s.is_copy() ? tree_a : tree_b, s.pair.pose));
}

void add_any() {
    const abut::serial on;
    for (const auto& s : scene::any_scenes) {
        const auto a = mesh_of(s.pair.a), b = mesh_of(s.pair.b);
        const abut::bvh_options sah{.builder = abut::bvh_builder::sah};
        const auto tree_a = make_bvh(on, a, sah), tree_b = make_bvh(on, b, sah);
        add_any_of(s, "linear", make_bvh(on, a), make_bvh(on, b));
        add_any_of(s, "sah", tree_a, tree_b);
        add_any_of(s, "sah_wide", wide(on, tree_a), wide(on, tree_b));
        add_any_of(s, "sah_oriented", oriented(on, tree_a), oriented(on, tree_b));
        add_any_of(s, "sah_kdop18", abut::bounded_by<abut::kdop<float, 18>>(on, tree_a),
                   abut::bounded_by<abut::kdop<float, 18>>(on, tree_b));
    }
}

}  // namespace

int main(int argc, char** argv) {
    return meshes_scene::run("bench_meshes", argc, argv, [] {
        add_policy(abut::serial{});
        add_policy(abut::openmp{});
        add_traversals();
        scene::any_scenes = scene::make_any_scenes(scene::the_pair->a);
        add_any();
    });
}
