// SPDX-License-Identifier: MIT
//
// usage: bench_pair_rules_cuda --scenes=FOLDER [OUT.json]
//
// As bench/pair_rules.cpp, on a device.

#include <cstdio>
#include <filesystem>
#include <string>

#include <abut/cuda.hpp>
#include <abut/experimental/pair_rules.hpp>

#include "cuda_table.hpp"
#include "pair_rules_scene.hpp"

namespace {

using abut::pair_rule;

template <pair_rule Rule>
void add_rule(const abut::cuda& on, bench::table& out, const std::string& scene, const pair_rules::step& step) {
    const auto there = step.copied_to(on);
    const auto index = abut::make_impact_index<Rule>(on, there);
    const std::string name = scene + "/" + pair_rules::name_of(Rule) + "/";
    const auto add = [&](const char* stage, const auto& work) {
        out.add(name + stage, 0, [&] { return bench::counters{{"items", static_cast<double>(work())}}; });
    };
    add("index", [&] { return abut::make_impact_index<Rule>(on, there).size(); });
    add("refit", [&] { return refit(on, index, there).size(); });
    add("walk", [&] { return pair_rules::walk(on, index); });
    add("boxes", [&] { return pair_rules::boxes(on, index); });
    add("tests", [&] { return pair_rules::tests(on, index); });
    add("impacts", [&] { return self_impacts(on, index).size(); });
}

}  // namespace

int main(int argc, char** argv) {
    const std::string folder = bench::take_argument(argc, argv, "--scenes");
    return bench::run("bench_pair_rules_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        for (const std::string scene : pair_rules::scenes) {
            if (!std::filesystem::exists(folder + "/" + scene)) {
                std::printf("%s: not in --scenes=%s\n", scene.c_str(), folder.c_str());
                continue;
            }
            const auto step = pair_rules::read_step(folder + "/" + scene);
            add_rule<pair_rule::feature_trees>(on, out, scene, step);
            add_rule<pair_rule::representative_triangles>(on, out, scene, step);
            add_rule<pair_rule::orphan_sets>(on, out, scene, step);
        }
    });
}
