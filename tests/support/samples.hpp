// SPDX-License-Identifier: MIT
#pragma once

// How many samples a test draws, and how it spreads them over the machine's cores.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

namespace abut::test {

inline constexpr std::uint64_t sample_seed = 20190819;

/// Pairs for each family and scalar: the environment's ABUT_SAMPLES, or 5,000.
inline std::uint64_t sample_count() {
    const char* const text = std::getenv("ABUT_SAMPLES");
    const long long n = text == nullptr ? 0 : std::atoll(text);
    return n > 0 ? static_cast<std::uint64_t>(n) : 5000;
}

/// The family that tests of families on a device begin with: the environment's ABUT_FIRST_FAMILY, or 0. A long run that was
/// cut off goes on from there.
inline int first_family() {
    const char* const text = std::getenv("ABUT_FIRST_FAMILY");
    return text == nullptr ? 0 : std::atoi(text);
}

/// Whether at least that share of all is counted, but for what chance takes from a sample of that size: four standard
/// deviations. So it says yes of small samples that a large one would be refused for, and never no by chance.
inline bool is_share_above(double least, std::size_t counted, std::size_t total) {
    const auto all = static_cast<double>(total);
    return static_cast<double>(counted) >= least * all - 4 * std::sqrt(least * (1 - least) * all);
}

/// Fewer samples, a `part` of them, where an oracle takes its time; one at least.
inline std::uint64_t some_samples(std::uint64_t part) { return std::max<std::uint64_t>(sample_count() / part, 1); }

/// Runs `body(first, last, tally)` on pieces of [0, count) in as many threads as there are cores, each with a tally of its
/// own, and adds the tallies up.
template <class Tally, class Body>
Tally in_threads(std::uint64_t count, Body body) {
    const unsigned cores = std::thread::hardware_concurrency();
    const std::uint64_t threads = cores == 0 ? 1 : cores;
    std::vector<Tally> tallies(threads);
    std::vector<std::thread> running;
    for (std::uint64_t i = 0; i < threads; ++i) {
        running.emplace_back([&, i] { body(count * i / threads, count * (i + 1) / threads, tallies[i]); });
    }
    for (std::thread& t : running) t.join();
    Tally total{};
    for (const Tally& t : tallies) total += t;
    return total;
}

}  // namespace abut::test
