// SPDX-License-Identifier: MIT
//
// usage: bench_fronts_cuda [OUT.json [FOLDER...]]
//
// bench/fronts.cpp on CUDA: the same scenes, queries and rows, of 40 frames. A time is taken with CUDA events around the
// whole call.

#include <algorithm>
#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "fronts_scene.hpp"

int main(int argc, char** argv) {
    return bench::run("bench_fronts_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        const std::vector<std::string> folders(argv + std::min(argc, 2), argv + argc);
        const auto time = [&](const auto& work) { return static_cast<double>(out.once(work)); };
        const auto note = [&](const std::string& name, const bench::counters& row) { out.note(name, row); };
        fronts_scene::race_scenes(on, time, note, folders, 40);
    });
}
