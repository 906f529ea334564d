// SPDX-License-Identifier: MIT
//
// usage: bench_footprint [--json=OUT.json] [--runs=N]
//
// Scenes from the least to the richest (bench/footprint_scene.hpp), on one core: milliseconds of the query, bytes of sets
// and trees for each element, and nanoseconds of an elementary test, of pairs whose boxes meet. bench/footprint.py compiles
// each of them alone, and says how long that takes and how large it is.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "footprint_scene.hpp"
#include "results.hpp"

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const int runs = std::stoi(bench::take_argument(argc, argv, "--runs", "11"));
        bench::results out("bench_footprint");
        const auto median = [runs](const auto& work) {
            std::vector<double> times;
            for (int i = 0; i < runs; ++i) {
                const auto start = std::chrono::steady_clock::now();
                work();
                times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
            }
            std::sort(times.begin(), times.end());
            return times[times.size() / 2];
        };
        footprint::for_each_scene(abut::serial{}, [&](const char* name, footprint::prepared made, const auto&... tests) {
            const double ms = median([&] { made.of.answer = made.ask(); });
            const auto& of = made.of;
            bench::counters row{{"ms", ms},
                                {"answer", of.answer},
                                {"elements", of.elements},
                                {"set_bytes", of.set_bytes},
                                {"index_bytes", of.index_bytes}};
            (row.emplace_back("tests", count_of(tests)), ...);
            (row.emplace_back("test_ns", 1e6 * median([&] { run(tests); }) / count_of(tests)), ...);
            out.add(name, row);
        });
        if (!path.empty()) out.write(path);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_footprint: %s\n", problem.what());
        return 1;
    }
}
