// SPDX-License-Identifier: MIT
#pragma once

// Union-find that any number of threads may work on at a time, on hosts and devices: what is connected, by one loop over
// the connections in any order.
//
// The smallest member of a set is its root, and every other member points to a smaller one: unions hang the greater root
// below the smaller. So no cycle can come about in whatever order threads run, and roots depend on the connections alone.
// After J. Jaiganesh, M. Burtscher, A high-performance connected components implementation for GPUs (HPDC 2018), whose
// hooks by compare-and-swap and whose path halving these are.

#include <cstddef>
#include <cstdint>

#include <abut/config.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>

namespace abut::execution {

/// Sets of the numbers below n, over an array of n words that the caller keeps in the policy's memory.
struct disjoint_sets {
    std::uint32_t* parent;

    /// For one i in each call: makes i a set of its own.
    ABUT_HD void operator()(std::size_t i) const { parent[i] = static_cast<std::uint32_t>(i); }

    /// The smallest member of x's set, as far as unions have got by now. Halves the path that it walks. The plain store may
    /// undo another thread's shortcut, but only for one that leads to the same root.
    ABUT_HD std::uint32_t root(std::uint32_t x) const {
        std::uint32_t above = atomic_load(parent + x);
        while (above != x) {
            const std::uint32_t next = atomic_load(parent + above);
            if (next == above) return above;
            atomic_store(parent + x, next);
            x = next;
            above = atomic_load(parent + x);
        }
        return x;
    }

    ABUT_HD void unite(std::uint32_t x, std::uint32_t y) const {
        x = root(x);
        y = root(y);
        while (x != y) {
            const std::uint32_t lesser = x < y ? x : y, greater = x < y ? y : x;
            const std::uint32_t before = atomic_compare_exchange(parent + greater, greater, lesser);
            if (before == greater) return;
            // Another thread has hung it elsewhere: on from there.
            x = lesser;
            y = root(before);
        }
    }

    /// After all unions: whether x stands for its set.
    [[nodiscard]] ABUT_HD bool is_root(std::size_t x) const { return parent[x] == x; }
};

/// n sets of one member each, over `parents`.
template <execution_policy Policy>
disjoint_sets make_disjoint_sets(const Policy& on, buffer_of<Policy, std::uint32_t>& parents) {
    const disjoint_sets sets{parents.data()};
    for_each_index(on, parents.size(), sets);
    return sets;
}

}  // namespace abut::execution
