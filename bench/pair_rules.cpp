// SPDX-License-Identifier: MIT
//
// usage: bench_pair_rules --scenes=FOLDER --benchmark_enable_random_interleaving=true --benchmark_out=cpu.json
//
// Impacts within meshes, on one core, by each rule of pairs (bench/pair_rules_scene.hpp). Names are SCENE/RULE/STAGE; times
// are of the processor. The counters of the stage impacts tell how many pairs each rule meets.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/pair_rules.hpp>

#include "google.hpp"
#include "pair_rules_scene.hpp"

namespace {

using abut::pair_rule;

template <class Work>
void add(const std::string& name, const bench::counters& says, const Work& work) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [work, says](benchmark::State& state) {
                                     for (auto _ : state) benchmark::DoNotOptimize(work());
                                     for (const auto& [key, value] : says) state.counters[key] = value;
                                 })
        ->Unit(benchmark::kMillisecond)
        ->Repetitions(3)
        ->ReportAggregatesOnly(true)
        ->MinTime(0.01);
}

template <pair_rule Rule>
void add_rule(const std::string& scene, const pair_rules::step& step) {
    const abut::serial on;
    const auto index = abut::make_impact_index<Rule>(on, step);
    const auto counts = pair_rules::count_pairs(index);
    const std::string name = scene + "/" + pair_rules::name_of(Rule) + "/";
    add(name + "index", {}, [=] { return abut::make_impact_index<Rule>(on, step).size(); });
    add(name + "refit", {}, [=] { return refit(on, index, step).size(); });
    add(name + "walk", {}, [=] { return pair_rules::walk(on, index); });
    add(name + "boxes", {}, [=] { return pair_rules::boxes(on, index); });
    add(name + "tests", {}, [=] { return pair_rules::tests(on, index); });
    const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
    const bench::counters met{{"pairs_of_faces", number(counts.faces)},
                              {"looked_at", number(counts.looked_at)},
                              {"pairs_of_features", number(counts.features)},
                              {"overlap", number(counts.overlapping)},
                              {"orphans", number(counts.orphans)},
                              {"orphans_overlap", number(counts.overlapping_orphans)}};
    add(name + "impacts", met, [=] { return self_impacts(on, index).size(); });
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string folder = bench::take_argument(argc, argv, "--scenes");
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
        return bench::run_registered("bench_pair_rules", argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        return 1;
    }
}
