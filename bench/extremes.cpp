// SPDX-License-Identifier: MIT
//
// usage: bench_extremes [--json=FILE] [--pairs=N] [--sample=N]
//
// Answers and speed at the extremes of the number range, on one thread: bench/extremes_scene.hpp says what the rows are. N
// pairs are timed at each step, 4096 unless said otherwise, and 1,000 compared with what is right. Of features in motion 256
// are timed and 64 compared.

#include <ctime>
#include <exception>

#include "extremes_scene.hpp"

namespace {

struct processor_time {
    template <class Work>
    double operator()(const abut::serial&, const Work& work) const {
        const std::clock_t start = std::clock();
        work();
        return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    }
};

}  // namespace

int main(int argc, char** argv) {
    try {
        return extremes_bench::run("bench_extremes", argc, argv, abut::serial{}, processor_time{}, {});
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_extremes: %s\n", problem.what());
        return 1;
    }
}
