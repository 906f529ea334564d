// SPDX-License-Identifier: MIT
#pragma once

// for_each_descendant of `cuda` (execution/policy.hpp) by schedule::shared_list: work that makes work, level by level, in
// blocks (cuda_descent.hpp). Three kernels: one block begins, until there is an item for each block; each block goes on for
// a few steps; then the blocks fetch what there is as they run out of work, because nobody knows how much an item has below
// it.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <cuda_runtime.h>

#include <abut/execution/cuda_descent.hpp>
#include <abut/execution/cuda_loops.hpp>
#include <abut/execution/schedule.hpp>

namespace abut::execution {

namespace detail {

/// A block's memory, and the last items that it fetched, and whether there may be more.
template <class Expand>
struct list_expansion : expansion<Expand> {
    unsigned first, fetched, left;
};

/// Items on their way from one kernel to the next: how many there are, and how many have been fetched.
template <class Item>
struct item_list {
    Item* data;
    unsigned* counts;
};

template <class Expand>
__global__ void __launch_bounds__(block_size)
    start_kernel(item_list<typename Expand::item> list, unsigned seeds, Expand expand) {
    const unsigned i = blockIdx.x * block_size + threadIdx.x;
    if (i < seeds) list.data[i] = expand.seed(i);
    if (i < 6) list.counts[i] = i == 0 ? seeds : 0;
}

/// When a block leaves the rest to the next kernel: it holds that many items, or has done that many steps; but not while the
/// list has more for it.
struct expansion_limit {
    unsigned items, steps;  ///< no number of steps is too many if `steps` is 0
    unsigned deals;         ///< one in how many items is dealt out evenly at the start
};

/// Expands the items of `from` until `limit`; what is left goes to `to`, which has room for all that blocks hold.
template <class Expand, class Judge, class Late, class... Sinks>
__global__ void __launch_bounds__(block_size)
    expand_kernel(item_list<typename Expand::item> from, item_list<typename Expand::item> to, expansion_limit limit,
                  Expand expand, Judge judge, Late late, Sinks... sinks) {
    using memory = list_expansion<Expand>;
    constexpr unsigned fetch_below = block_size / 2;
    extern __shared__ __align__(16) unsigned char shared_memory[];
    memory& mine = *reinterpret_cast<memory*>(shared_memory);
    const unsigned total = from.counts[0];

    // Some items are dealt out at once; the rest is fetched, a few at a time.
    const unsigned even = total / gridDim.x / limit.deals + (limit.deals == 1 ? 1 : 0);
    const unsigned share = even < fetch_below ? even : fetch_below, dealt = share * gridDim.x;
    const unsigned rest = dealt < total ? total - dealt : 0, part = rest / (8 * gridDim.x) + 1;
    const unsigned portion = part < fetch_below ? part : fetch_below;
    const auto fetch = [&] {
        const unsigned first = dealt + atomicAdd(from.counts + 1, portion);
        mine.first = first;
        mine.left = first + portion < total;
        mine.fetched = first < total ? (total - first < portion ? total - first : portion) : 0;
    };
    // Neighbours in the list are alike, and no block should have all that have much below them. The prime is larger than the
    // list: each item is taken once.
    const auto take = [&](unsigned place) {
        constexpr std::uint64_t prime = 2654435761;
        return from.data[place * prime % total];
    };

    if (threadIdx.x == 0) mine.count = mine.found = mine.fetched = 0, mine.left = rest > 0;
    __syncthreads();
    if (threadIdx.x < share && threadIdx.x * gridDim.x + blockIdx.x < total) {
        mine.items[threadIdx.x] = take(threadIdx.x * gridDim.x + blockIdx.x);
        atomicAdd(&mine.count, 1u);
    }
    __syncthreads();
    for (unsigned step = 0;; ++step) {
        unsigned count = mine.count;
        const unsigned fetched = mine.fetched;
        const bool over = block_is_over(late, sinks...), more = mine.left != 0;
        if (threadIdx.x < fetched) mine.items[count + threadIdx.x] = take(mine.first + threadIdx.x);
        count += fetched;
        const unsigned width = step_width<memory>(count);
        const bool stop =
            (count == 0 && !more) || over || (!more && (count >= limit.items || (limit.steps > 0 && step >= limit.steps)));
        __syncthreads();
        if (stop) {
            if (threadIdx.x == 0) mine.count = over ? 0 : count;
            break;
        }
        // Fetched items arrive while this step waits for its nodes.
        expand_newest(mine, count, width, expand, [&] {
            if (threadIdx.x != block_size - 1) return;
            mine.fetched = 0;
            if (more && count - width < fetch_below) fetch();
        });
        if (mine.found >= enough_candidates<Sinks...>) judge_waiting(mine, judge, late, sinks...);
    }
    __syncthreads();
    judge_waiting(mine, judge, late, sinks...);
    if (threadIdx.x == 0) mine.first = mine.count > 0 ? atomicAdd(to.counts, mine.count) : 0;
    __syncthreads();
    for (unsigned k = threadIdx.x; k < mine.count; k += block_size) to.data[mine.first + k] = mine.items[k];
    close_all(sinks...);
}

/// Work of unknown depth, from `seeds` seeds on, which are not 0.
template <class Expand, class Judge, class... Queues>
std::uint64_t descend(const cuda& on, const scheduled<schedule::shared_list>& how, unsigned seeds, const Expand& expand,
                      const Judge& judge, Queues&... queues) {
    using item = typename Expand::item;
    using memory = list_expansion<Expand>;
    constexpr unsigned bytes = sizeof(memory), never = static_cast<unsigned>(-1);
    const auto launch = [&](auto late_sink, auto... sinks) {
        constexpr auto kernel = expand_kernel<Expand, Judge, decltype(late_sink), decltype(sinks)...>;
        const unsigned blocks = blocks_to_run<kernel, sizeof(memory)>(on, how);
        const std::size_t begun_at = seeds, spread_at = begun_at + memory::capacity;
        buffer<item, device_space> items(on, spread_at + memory::capacity * std::size_t{blocks});
        buffer<unsigned, device_space> counts(on, 6);
        const item_list<item> seed{items.data(), counts.data()}, begun{items.data() + begun_at, counts.data() + 2},
            spread{items.data() + spread_at, counts.data() + 4};
        start_kernel<<<blocks_for(seeds), block_size, 0, on.stream>>>(seed, seeds, expand);
        const bool few = seeds < blocks;
        if (few) kernel<<<1, block_size, bytes, on.stream>>>(seed, begun, {1024, 0, 1}, expand, judge, late_sink, sinks...);
        const item_list<item>& all = few ? begun : seed;
        kernel<<<blocks, block_size, bytes, on.stream>>>(all, spread, {1024, 8, 1}, expand, judge, late_sink, sinks...);
        kernel<<<blocks, block_size, bytes, on.stream>>>(spread, begun, {never, 0, 2}, expand, judge, late_sink, sinks...);
        check_launch("for_each_descendant");
        if (how.report != nullptr) {
            unsigned found[6];
            download(on, counts.data(), 6, found);
            *how.report = {.ran = schedule::shared_list,
                           .workers = blocks,
                           .transferred = std::uint64_t{found[0]} + found[2] + found[4],
                           .rounds = few ? 3u : 2u};
        }
    };
    return judge_and_finish<typename Expand::candidate>(on, any_number, judge, launch, queues...);
}

}  // namespace detail

}  // namespace abut::execution
