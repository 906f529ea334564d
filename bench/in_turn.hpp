// SPDX-License-Identifier: MIT
#pragma once

// A row that runs `fast`, `filtered` and `exact` in turn, so that all three see the same machine.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/abut.hpp>

#include "google.hpp"

namespace bench {

template <class T>
constexpr const char* scalar_name = sizeof(T) == 4 ? "float" : "double";

inline double median(std::vector<double>& times) {
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

/// `ask(A{})` returns the number of hits of so many items. Counters: the medians of processor times in ns of an item;
/// filtered_over_fast and exact_over_fast; and the share of hits.
template <class Ask>
void in_turn(benchmark::State& state, std::size_t items, const Ask& ask) {
    std::vector<double> fast, filtered, exact;
    std::uint64_t hits = 0, by_integers = 0;
    const auto timed = [&]<class A>(A, std::vector<double>& times) {
        const double start = processor_time();
        const std::uint64_t found = ask(A{});
        times.push_back((processor_time() - start) / static_cast<double>(items));
        return found;
    };
    for (auto _ : state) {
        benchmark::DoNotOptimize(timed(abut::fast{}, fast));
        hits = timed(abut::filtered{}, filtered);
        by_integers = timed(abut::exact{}, exact);
    }
    if (hits != by_integers) state.SkipWithError("filtered and exact disagree");
    state.counters["fast"] = median(fast);
    state.counters["filtered"] = median(filtered);
    state.counters["exact"] = median(exact);
    state.counters["filtered_over_fast"] = median(filtered) / median(fast);
    state.counters["exact_over_fast"] = median(exact) / median(fast);
    state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(items);
}

}  // namespace bench
