// SPDX-License-Identifier: MIT
#pragma once

// Walks down trees as a policy takes them, and the pairs of leaves that they come to.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "catch.hpp"

namespace abut::test {

using id_pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Each pair of leaves that a walk comes to is a candidate. Of a tree with itself the smaller id may come first.
template <class Walk, bool SmallerFirst = false>
struct walked_pairs {
    using item = typename Walk::item;
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = Walk::most_children, most_depth = Walk::most_depth;
    Walk walk;
    std::size_t seeds() const { return walk.seeds(); }
    void prefetch(const item& at) const { walk.prefetch(at); }
    item seed(std::size_t i) const { return walk.seed(i); }
    template <class Emitter>
    void operator()(const item& at, Emitter&& emitter) const {
        walk.expand(
            at, [&](auto k, bool is, const item& next) { emitter.add(k, is, next); },
            [&](auto k, bool is, std::uint32_t i, std::uint32_t j) {
                if (SmallerFirst && j < i) std::swap(i, j);
                emitter.push(k, is, std::uint64_t{i} << 32 | j);
            });
    }
};

/// Each candidate is a hit.
struct keep_each {
    bool operator()(std::uint64_t pair, auto& hits, auto&...) const {
        hits.push(pair);
        return true;
    }
    void finish(std::uint64_t, auto&...) const { FAIL("nothing is left open"); }
};

/// What run(hits) pushes, sorted.
template <class Policy, class Run>
id_pairs gathered(const Policy& on, const Run& run) {
    execution::work_queue<std::uint64_t, host_space> hits(on);
    run(hits);
    id_pairs seen;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        seen.emplace_back(static_cast<std::uint32_t>(hits.data()[i] >> 32), static_cast<std::uint32_t>(hits.data()[i]));
    }
    std::sort(seen.begin(), seen.end());
    return seen;
}

}  // namespace abut::test
