// SPDX-License-Identifier: MIT
//
// usage: bench_footprint_cuda [OUT.json]
//
// The scenes of bench/footprint.cpp on CUDA, all data resident; SCENE/test is one elementary test a thread, of pairs whose
// boxes meet.

#include <abut/cuda.hpp>

#include "footprint_scene.hpp"

#ifdef FOOTPRINT_SCENE

// One query, and what a program needs around it: what footprint.py compiles.
int main() { return footprint::prepare<FOOTPRINT_SCENE>(abut::cuda{}).ask() >= 0 ? 0 : 1; }

#else

#include "cuda_table.hpp"

int main(int argc, char** argv) {
    return bench::run("bench_footprint_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        footprint::for_each_scene(on, [&](const char* name, const footprint::prepared& made, const auto&... tests) {
            out.add(name, 0, [&] {
                return bench::counters{{"answer", made.ask()},
                                       {"elements", made.of.elements},
                                       {"set_bytes", made.of.set_bytes},
                                       {"index_bytes", made.of.index_bytes}};
            });
            (out.add(bench::joined({name, "test"}), 0,
                     [&] {
                         run(tests);
                         return bench::counters{{"tests", count_of(tests)}};
                     }),
             ...);
        });
    });
}

#endif
