// SPDX-License-Identifier: MIT
//
// usage: bench_pair_rules --scenes=FOLDER --benchmark_enable_random_interleaving=true
//
// Impacts within meshes, on one core, by each rule of pairs (bench/pair_rules_scene.hpp). Names are SCENE/RULE/STAGE; times
// are of the processor, and `least` is the one that other programs disturb least. Prints how many pairs each rule meets
// first.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "pair_rules_scene.hpp"

namespace {

using abut::pair_rule;

template <class Work>
void add(const std::string& name, const Work& work) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [work](benchmark::State& state) {
                                     for (auto _ : state) benchmark::DoNotOptimize(work());
                                 })
        ->Unit(benchmark::kMillisecond)
        ->Repetitions(5)
        ->ReportAggregatesOnly(true)
        ->MinTime(0.01)
        ->ComputeStatistics("least", [](const std::vector<double>& t) { return *std::min_element(t.begin(), t.end()); });
}

template <pair_rule Rule>
void add_rule(const std::string& scene, const pair_rules::step& step) {
    const abut::serial on;
    const auto index = abut::make_impact_index<Rule>(on, step);
    const auto counts = pair_rules::count_pairs(index);
    const auto print = [](const char* what, std::uint64_t n) {
        std::printf("  %llu %s", static_cast<unsigned long long>(n), what);
    };
    std::printf("%s/%s:", scene.c_str(), pair_rules::name_of(Rule));
    if (counts.faces > 0) {
        print("pairs of faces,", counts.faces);
        print("looked at;", counts.looked_at);
    }
    print("pairs of features,", counts.features);
    print("overlap;", counts.overlapping);
    print("orphans,", counts.orphans);
    print("overlap;", counts.overlapping_orphans);
    print("pass the tests,", pair_rules::tests(on, index));
    print("impacts\n", self_impacts(on, index).size());
    std::fflush(stdout);
    const std::string name = scene + "/" + pair_rules::name_of(Rule) + "/";
    add(name + "index", [=] { return abut::make_impact_index<Rule>(on, step).size(); });
    add(name + "refit", [=] { return refit(on, index, step).size(); });
    add(name + "walk", [=] { return pair_rules::walk(on, index); });
    add(name + "boxes", [=] { return pair_rules::boxes(on, index); });
    add(name + "tests", [=] { return pair_rules::tests(on, index); });
    add(name + "impacts", [=] { return self_impacts(on, index).size(); });
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string folder = pair_rules::take_folder(argc, argv);
        benchmark::Initialize(&argc, argv);
        if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
        for (const std::string scene : pair_rules::scenes) {
            if (!std::filesystem::exists(folder + "/" + scene)) {
                std::printf("%s: not in --scenes=%s\n", scene.c_str(), folder.c_str());
                continue;
            }
            const auto step = pair_rules::read_step(folder + "/" + scene);
            add_rule<pair_rule::feature_trees>(scene, step);
            add_rule<pair_rule::representative_triangles>(scene, step);
            add_rule<pair_rule::orphan_sets>(scene, step);
        }
        benchmark::RunSpecifiedBenchmarks();
        benchmark::Shutdown();
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        return 1;
    }
}
