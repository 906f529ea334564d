// SPDX-License-Identifier: MIT
#pragma once

// Pairs that a device makes and decides in a kernel of the test's own, against what the host makes and decides.

#include <abut/cuda.hpp>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "support/catch.hpp"

namespace abut::test {

/// The answer of each arithmetic for pair first + i of a family, in one byte, and a checksum of the generated input: a
/// device may neither decide nor generate differently from the host, bit for bit. `fast` may differ.
template <class T, class Pairs>
struct answers {
    Pairs pairs;
    std::size_t first;
    std::uint8_t* decisions;
    std::uint32_t* inputs;

    template <class Pair>
    static ABUT_HD std::uint32_t checksum(const Pair& pair) {
        std::uint32_t words[sizeof(Pair) / 4], sum = 0;
        std::memcpy(words, &pair, sizeof(Pair));
        for (const std::uint32_t word : words) sum = sum * 31 + word;
        return sum;
    }

    ABUT_HD void operator()(std::size_t i) const {
        const auto pair = pairs.make(first + i);
        const auto& [s, t] = pair;
        inputs[i] = checksum(pair);
        // In a kernel of the user's own the answer is whole: all stages, the widest too, run on the device.
        const int filtered_answer = intersects<filtered>(s, t), exact_answer = intersects<exact>(t, s);
        const int fast_answer = intersects<fast>(s, t);
        decisions[i] = static_cast<std::uint8_t>(filtered_answer | exact_answer << 1 | fast_answer << 2);
    }
};

struct decision_counts {
    std::size_t hits = 0;
    std::size_t wrong_fast = 0;  ///< of the device
};

template <class T, class Pairs>
decision_counts check_decisions(const Pairs& pairs, std::size_t n) {
    constexpr std::size_t most = 10'000'000;  // at a time
    const cuda on;
    std::size_t other_inputs = 0, other_decisions = 0, split = 0;
    decision_counts counts;
    for (std::size_t first = 0; first < n; first += most) {
        const std::size_t count = n - first < most ? n - first : most;
        execution::buffer_of<cuda, std::uint8_t> decisions(on, count);
        execution::buffer_of<cuda, std::uint32_t> inputs(on, count);
        for_each_index(on, count, answers<T, Pairs>{pairs, first, decisions.data(), inputs.data()});
        std::vector<std::uint8_t> device_decisions(count), host_decisions(count);
        std::vector<std::uint32_t> device_inputs(count), host_inputs(count);
        for_each_index(openmp{}, count, answers<T, Pairs>{pairs, first, host_decisions.data(), host_inputs.data()});
        decisions.read(device_decisions.data());
        inputs.read(device_inputs.data());
        for (std::size_t i = 0; i < count; ++i) {
            other_inputs += device_inputs[i] != host_inputs[i];
            const int device = device_decisions[i] & 3, touches = device & 1;
            other_decisions += device != (host_decisions[i] & 3);
            split += device != 0 && device != 3;
            counts.hits += touches;
            counts.wrong_fast += device_decisions[i] >> 2 != touches;
        }
    }
    std::printf(
        "%-18s %-6s n %zu, hits %5.1f %%, inputs that differ %zu, decisions that differ %zu, filtered against exact %zu\n",
        pairs.name().c_str(), sizeof(T) == 4 ? "float" : "double", n,
        100.0 * static_cast<double>(counts.hits) / static_cast<double>(n), other_inputs, other_decisions, split);
    std::fflush(stdout);
    CHECK(other_inputs == 0);
    CHECK(other_decisions == 0);
    CHECK(split == 0);
    return counts;
}

}  // namespace abut::test
