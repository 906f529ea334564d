// SPDX-License-Identifier: MIT
//
// usage: bench_fronts_cuda [OUT.json [FOLDER...]]
//
// bench/fronts.cpp on CUDA: the same scenes, queries and columns, of 40 frames. A time is taken with CUDA events around the
// whole call. OUT.json holds the floors alone; the rows are printed.

#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "fronts_scene.hpp"

int main(int argc, char** argv) {
    return bench::run("bench_fronts_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        std::vector<std::string> folders;
        for (int i = 2; i < argc; ++i) folders.emplace_back(argv[i]);
        const auto time = [&](const auto& work) { return static_cast<double>(out.once(work)); };
        fronts_scene::print_head("cuda");
        fronts_scene::race_scenes(on, time, folders, 40);
    });
}
