// SPDX-License-Identifier: MIT
#pragma once

// for_each_descendant of `cuda` (execution/policy.hpp): work that makes work, level by level. A block keeps its items in
// shared memory and takes the newest at a time, one for each thread, so that a step costs one wait for memory however many
// items are in it, and the items never outgrow their room. Three kernels: one block begins, until there is an item for each
// block; each block goes on for a few steps; then the blocks fetch what there is as they run out of work, because nobody
// knows how much an item has below it.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <cuda_runtime.h>

#include <abut/execution/cuda_loops.hpp>

namespace abut::execution {

namespace detail {

/// What one item makes, in registers: places are constants to the compiler.
template <class Item, class Candidate, unsigned Most>
struct made {
    Item items[Most];
    Candidate candidates[Most];
    unsigned item_mask = 0, candidate_mask = 0;

    template <class Place>
    __device__ void add(Place, bool is, const Item& value) {
        items[Place::value] = value;
        item_mask |= static_cast<unsigned>(is) << Place::value;
    }
    template <class Place>
    __device__ void push(Place, bool is, const Candidate& value) {
        candidates[Place::value] = value;
        candidate_mask |= static_cast<unsigned>(is) << Place::value;
    }
};

/// Adds the values of the mask to an array in shared memory: those of one thread side by side, and beside its neighbours',
/// since they are likely to be alike. Called by whole warps.
template <unsigned Most, class T>
__device__ void append(const T (&values)[Most], unsigned mask, T* array, unsigned* count) {
    const unsigned lane = lane_id(), mine = static_cast<unsigned>(__popc(mask));
    unsigned sum = mine;
#pragma unroll
    for (unsigned away = 1; away < warp_size; away *= 2) {
        const unsigned before = __shfl_up_sync(0xffffffff, sum, away);
        if (lane >= away) sum += before;
    }
    const unsigned total = __shfl_sync(0xffffffff, sum, warp_size - 1);
    if (total == 0) return;
    unsigned first = 0;
    if (lane == 0) first = atomicAdd(count, total);
    first = __shfl_sync(0xffffffff, first, 0) + sum - mine;
#pragma unroll
    for (unsigned k = 0; k < Most; ++k) {
        if ((mask >> k & 1) != 0) array[first++] = values[k];
    }
}

/// A block's items and candidates. Both have room for what a step adds.
template <class Expand>
struct expansion {
    using item = typename Expand::item;
    using candidate = typename Expand::candidate;
    static constexpr unsigned most = Expand::most_children;  ///< items and candidates that one item makes
    static constexpr unsigned capacity = 40960 / sizeof(item), candidate_capacity = (most + 1) * block_size;
    /// For a descent one item at a time, when there is no room for more.
    static constexpr unsigned reserve = Expand::most_depth * (most - 1) + most;
    static_assert(reserve + (most + 1) * block_size <= capacity);
    static_assert(sizeof(candidate) <= 16, "every device since compute capability 7.5 lets a block have 64 KiB");

    item items[capacity];
    candidate candidates[candidate_capacity];
    unsigned count, found;
    unsigned first, fetched, left;  ///< the last items that the block fetched, and whether there may be more
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
    using memory = expansion<Expand>;
    using item = typename Expand::item;
    constexpr unsigned fetch_below = block_size / 2;
    extern __shared__ __align__(16) unsigned char shared_memory[];
    memory& mine = *reinterpret_cast<memory*>(shared_memory);
    const unsigned total = from.counts[0];

    const auto judge_all = [&] {
        for (unsigned k = threadIdx.x; k < mine.found; k += block_size) {
            if (!judge(mine.candidates[k], sinks...)) late.push(mine.candidates[k]);
        }
        __syncthreads();
        if (threadIdx.x == 0) mine.found = 0;
        __syncthreads();
    };
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
        const unsigned room = count + memory::reserve < memory::capacity ? memory::capacity - memory::reserve - count : 0;
        const unsigned fit = room / memory::most > 0 ? room / memory::most : 1;
        unsigned width = count < block_size ? count : block_size;
        width = width < fit ? width : fit;
        const bool stop =
            (count == 0 && !more) || over || (!more && (count >= limit.items || (limit.steps > 0 && step >= limit.steps)));
        __syncthreads();
        if (stop) {
            if (threadIdx.x == 0) mine.count = over ? 0 : count;
            break;
        }
        const bool works = threadIdx.x < width;
        const item at = works ? mine.items[count - width + threadIdx.x] : item{};
        if (threadIdx.x == 0) mine.count = count - width;
        __syncthreads();
        // Fetched items arrive while this step waits for its nodes.
        if (threadIdx.x == block_size - 1) {
            mine.fetched = 0;
            if (more && count - width < fetch_below) fetch();
        }
        made<item, typename Expand::candidate, memory::most> children;
        if (works) expand(at, children);
        append(children.items, children.item_mask, mine.items, &mine.count);
        append(children.candidates, children.candidate_mask, mine.candidates, &mine.found);
        __syncthreads();
        // An early end is worth more than full lanes.
        if (mine.found >= ((is_flag<Sinks> || ...) ? 1 : block_size)) judge_all();
    }
    __syncthreads();
    judge_all();
    if (threadIdx.x == 0) mine.first = mine.count > 0 ? atomicAdd(to.counts, mine.count) : 0;
    __syncthreads();
    for (unsigned k = threadIdx.x; k < mine.count; k += block_size) to.data[mine.first + k] = mine.items[k];
    close_all(sinks...);
}

}  // namespace detail

template <expander Expand, class Judge, class... Queues>
    requires candidate_judge<Judge, typename Expand::candidate, sink_of<Queues>...>
std::uint64_t for_each_descendant(const cuda& on, const Expand& expand, const Judge& judge, Queues&... queues) {
    using item = typename Expand::item;
    using memory = detail::expansion<Expand>;
    constexpr unsigned bytes = sizeof(memory), block = detail::block_size, never = static_cast<unsigned>(-1);
    const auto seeds = static_cast<unsigned>(expand.seeds());
    if (seeds == 0) return 0;
    const detail::current_device scope(on);
    const auto launch = [&](auto late_sink, auto... sinks) {
        constexpr auto kernel = detail::expand_kernel<Expand, Judge, decltype(late_sink), decltype(sinks)...>;
        const auto blocks = static_cast<unsigned>(detail::resident_blocks<kernel, sizeof(memory)>(on));
        const std::size_t begun_at = seeds, spread_at = begun_at + memory::capacity;
        buffer<item, device_space> items(on, spread_at + memory::capacity * std::size_t{blocks});
        buffer<unsigned, device_space> counts(on, 6);
        const detail::item_list<item> seed{items.data(), counts.data()}, begun{items.data() + begun_at, counts.data() + 2},
            spread{items.data() + spread_at, counts.data() + 4};
        detail::start_kernel<<<detail::blocks_for(seeds), block, 0, on.stream>>>(seed, seeds, expand);
        const bool few = seeds < blocks;
        if (few) kernel<<<1, block, bytes, on.stream>>>(seed, begun, {1024, 0, 1}, expand, judge, late_sink, sinks...);
        const detail::item_list<item>& all = few ? begun : seed;
        kernel<<<blocks, block, bytes, on.stream>>>(all, spread, {1024, 8, 1}, expand, judge, late_sink, sinks...);
        kernel<<<blocks, block, bytes, on.stream>>>(spread, begun, {never, 0, 2}, expand, judge, late_sink, sinks...);
        detail::check_launch("for_each_descendant");
    };
    return detail::judge_and_finish<typename Expand::candidate>(on, detail::any_number, judge, launch, queues...);
}

}  // namespace abut::execution
