// SPDX-License-Identifier: MIT
//
// usage: bench_bodies --benchmark_enable_random_interleaving=true --benchmark_out=bodies.json
//
// A scene of many bodies (bench/bodies_scene.hpp). Names:
//
//   bodies/build/POLICY/BODIES      bodies of indices that are there
//   bodies/refit/POLICY/BODIES      to the next step
//   bodies/near/POLICY/BODIES       pairs of bodies whose boxes meet, sorted
//   bodies/pairs/POLICY/BODIES      pairs of triangles that touch, sorted; and `unsorted`, `count`, `any`, `contacts`
//   bodies/list/POLICY/BODIES       the same pairs of a list of posed indices, of which bodies are made for the call
//   bodies/frame/POLICY/BODIES      refit and pairs
//
// Counters: near, the pairs of bodies whose boxes meet; pairs, those of triangles that touch.

#include <cstddef>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "bodies_scene.hpp"
#include "google.hpp"

namespace {

constexpr std::size_t count_of_bodies = 10'000;

template <class Policy>
struct resident {
    using index = decltype(abut::make_bvh(std::declval<Policy>(), bodies_scene::shape(0)));

    bodies_scene::bodies scene = bodies_scene::make(count_of_bodies);
    std::vector<index> indices;
    std::vector<abut::posed_object<index>> list;
    abut::bodies<index> bodies;
    double near = 0, pairs = 0;

    explicit resident(const Policy& on)
        : indices(make_indices(on)), bodies(abut::make_bodies(on, indices, scene.kind, scene.now)) {
        for (std::size_t i = 0; i < count_of_bodies; ++i) list.push_back(abut::posed(indices[scene.kind[i]], scene.now[i]));
        near = static_cast<double>(bodies_scene::near(on, bodies));
        pairs = static_cast<double>(abut::count(on, bodies));
    }
    static std::vector<index> make_indices(const Policy& on) {
        std::vector<index> made;
        for (std::size_t k = 0; k < bodies_scene::kinds; ++k) made.push_back(abut::make_bvh(on, bodies_scene::shape(k)));
        return made;
    }
};

template <class Policy, class Work>
void add(const char* policy, const Policy& on, const char* name, const Work& work) {
    const std::string full = std::string("bodies/") + name + "/" + policy + "/" + std::to_string(count_of_bodies);
    benchmark::RegisterBenchmark(full.c_str(),
                                 [=](benchmark::State& state) {
                                     static resident<Policy> all(on);
                                     for (auto _ : state) benchmark::DoNotOptimize(work(on, all));
                                     state.counters["near"] = all.near;
                                     state.counters["pairs"] = all.pairs;
                                 })
        ->Repetitions(5)
        ->ReportAggregatesOnly(true)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->Iterations(1);
}

template <class Policy>
void add_all(const char* policy, const Policy& on) {
    const auto refitted = [](const auto& with, auto& all) { return abut::refit(with, all.bodies, all.scene.later); };
    add(policy, on, "build", [](const auto& with, auto& all) {
        return abut::make_bodies(with, all.indices, all.scene.kind, all.scene.now).size();
    });
    add(policy, on, "refit", [=](const auto& with, auto& all) { return refitted(with, all).size(); });
    add(policy, on, "near", [](const auto& with, auto& all) { return bodies_scene::near(with, all.bodies); });
    add(policy, on, "pairs", [](const auto& with, auto& all) { return abut::pairs(with, all.bodies).size(); });
    add(policy, on, "unsorted",
        [](const auto& with, auto& all) { return abut::pairs(with, all.bodies, {.sorted = false}).size(); });
    add(policy, on, "count", [](const auto& with, auto& all) { return abut::count(with, all.bodies); });
    add(policy, on, "any", [](const auto& with, auto& all) { return abut::any(with, all.bodies); });
    add(policy, on, "contacts", [](const auto& with, auto& all) { return abut::contacts(with, all.bodies).size(); });
    add(policy, on, "list", [](const auto& with, auto& all) { return abut::pairs(with, all.list).size(); });
    add(policy, on, "frame", [=](const auto& with, auto& all) { return abut::pairs(with, refitted(with, all)).size(); });
}

}  // namespace

int main(int argc, char** argv) {
    add_all("serial", abut::serial{});
    add_all("openmp", abut::openmp{});
    return bench::run_registered("bench_bodies", argc, argv);
}
