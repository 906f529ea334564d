// SPDX-License-Identifier: MIT
#pragma once

// The end of a main on Google Benchmark: its arguments are read, what is registered runs, and the file of --benchmark_out
// gets the context of bench/results.hpp.

#include <benchmark/benchmark.h>

#include "results.hpp"

namespace bench {

/// Returns the exit status.
inline int run_registered(const char* program, int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    for (const auto& [key, value] : context(program)) {
        if (key != "date") benchmark::AddCustomContext(key, value);  // it is there
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

}  // namespace bench
