// SPDX-License-Identifier: MIT
#pragma once

// The verbs of `serial` and `openmp` (execution/policy.hpp lists them), one implementation for both and for any
// range_policy. What is not here is in execution/generic.hpp.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <abut/execution/buffer.hpp>
#include <abut/execution/generic.hpp>
#include <abut/execution/host_descent.hpp>
#include <abut/execution/host_loops.hpp>
#include <abut/execution/host_stealing.hpp>
#include <abut/execution/parallel.hpp>
#include <abut/execution/roles.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::execution {

template <range_policy Policy, class F, class Queue, class... Queues>
void for_each_index(const Policy& on, std::size_t n, const F& f, Queue& queue, Queues&... queues) {
    constexpr bool plays = index_functor<F, sink_of<Queue>, sink_of<Queues>...>;
    static_assert(plays, "abut: for_each_index: the functor is no index_functor for these queues (execution/roles.hpp)");
    if constexpr (plays) {
        const auto loop = [&](std::size_t begin, std::size_t end, const auto& over, auto&... sinks) {
            for (std::size_t i = begin; i < end && !over(); ++i) f(i, sinks...);
        };
        detail::gather(on, n, detail::grain_of(on, n), loop, queue, queues...);
    }
}

namespace detail {

// The loops over candidates, which are no part of a policy's functions for the same reason.

template <class Walk, class Judge>
struct candidate_loop {
    const Walk& walk;
    const Judge& judge;

    template <class Over, class... Sinks>
    void operator()(std::size_t begin, std::size_t end, const Over& over, Sinks&... sinks) const {
        using candidate = typename Walk::candidate;
        open_candidates<candidate, Sinks...> open;
        const push_at_once emitter{[&](const candidate& c) {
            if (!judge(c, sinks...)) open.add(c, judge, sinks...);
        }};
        for (std::size_t i = begin; i < end && !over(); ++i) {
            if (!walk.may_find(i)) continue;
            typename Walk::cursor at;
            walk(i, at, emitter, sinks...);
        }
        open.finish(judge, sinks...);
    }
};

}  // namespace detail

template <range_policy Policy, class Walk, class Judge, class... Queues>
    requires candidate_walk<Walk, sink_of<Queues>...> && candidate_judge<Judge, typename Walk::candidate, sink_of<Queues>...>
std::uint64_t for_each_candidate(const Policy& on, std::size_t n, const Walk& walk, const Judge& judge, Queues&... queues) {
    detail::gather(on, n, detail::grain_of(on, n), detail::candidate_loop<Walk, Judge>{walk, judge}, queues...);
    return 0;
}

namespace detail {

template <class Tile>
struct tile_loop {
    std::size_t m;
    const Tile& tile;

    template <class Over, class... Sinks>
    void operator()(std::size_t begin, std::size_t end, const Over& over, Sinks&... sinks) const {
        constexpr std::size_t columns = 256;
        typename Tile::column staged[columns];
        open_candidates<typename Tile::candidate, Sinks...> open;
        for (std::size_t first = 0; first < m; first += columns) {
            const std::size_t width = std::min(columns, m - first);
            for (std::size_t j = 0; j < width; ++j) staged[j] = tile.load_column(first + j);
            for (std::size_t i = begin; i < end && !over(); ++i) {
                const auto row = tile.load_row(i);
                auto reach = tile.reach_of(row);
                for (std::size_t j = 0; j < width; ++j) {
                    if (!tile.passes(reach, staged[j]) || tile(row, i, staged[j], first + j, sinks...)) continue;
                    open.add(tile.candidate_of(i, first + j), tile, sinks...);
                }
            }
        }
        open.finish(tile, sinks...);
    }
};

}  // namespace detail

template <range_policy Policy, class Tile, class... Queues>
    requires tile_functor<Tile, sink_of<Queues>...>
std::uint64_t for_each_tiled(const Policy& on, std::size_t n, std::size_t m, const Tile& tile, Queues&... queues) {
    constexpr std::size_t pairs_of_a_thread = 16384;
    const std::size_t grain = std::max<std::size_t>(pairs_of_a_thread / (m + 1), 64);
    detail::gather(on, n, grain, detail::tile_loop<Tile>{m, tile}, queues...);
    return 0;
}

}  // namespace abut::execution
