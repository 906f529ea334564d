// SPDX-License-Identifier: MIT
#pragma once

// for_each_descendant of `cuda` by schedule::static_partition: rounds of two kernels. In the first each block works on its
// own queue in the device's memory, with a stack in shared memory, until it has nothing; when enough blocks have nothing, or
// as much as they can hold, the others leave as well, and write back what they have. The second deals all of that out
// evenly. The host waits for each round, to learn whether anything is left. No block waits for another one. Where nobody
// waits (async_queue) there are some rounds, and a last one in which no block leaves before it has nothing: so there is an end.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <cuda_runtime.h>

#include <abut/execution/cuda_descent.hpp>
#include <abut/execution/cuda_loops.hpp>
#include <abut/execution/schedule.hpp>
#include <abut/execution/stealing.hpp>

namespace abut::execution {

namespace detail {

inline constexpr unsigned most_queues = 4096;
/// Rounds of a loop that nobody waits for, before the last one. Scenes of cloth had up to six; what is left is done anyway, by
/// fewer blocks, and a round without work takes some microseconds.
inline constexpr int rounds_of_stream = 7;

/// A queue of each block: `capacity` places, of which the first `counts` hold items.
template <class Item>
struct block_queues {
    Item* items;
    unsigned* counts;
    unsigned capacity;

    [[nodiscard]] __device__ Item* items_of(unsigned block) const { return items + std::size_t{block} * capacity; }
};

/// What blocks say in a round, all 0 at its beginning.
struct round_state {
    std::uint64_t items, left, steps;  ///< expanded, written back, done by all blocks
    std::uint64_t overflows;           ///< blocks that had to go on, since what they had would not fit into their queue
    unsigned idle, full;               ///< blocks that have left, and such that hold as much as they can
    unsigned longest;                  ///< steps of the block that did most
};

/// When a block leaves: `votes` blocks have nothing or are full, and it has done `steps` steps, or holds `items` items, so
/// that a round is worth its kernels.
struct round_limit {
    unsigned votes, steps, items;
};

template <class Expand>
struct partition_memory : expansion<Expand> {
    unsigned left;  ///< in the queue
    bool may_leave;
};

template <class Expand>
__global__ void __launch_bounds__(block_size)
    deal_seeds_kernel(block_queues<typename Expand::item> to, unsigned queues, unsigned seeds, round_state* state,
                      Expand expand) {
    const unsigned i = blockIdx.x * block_size + threadIdx.x;
    if (i < seeds) to.items_of(i % queues)[i / queues] = expand.seed(i);
    if (i < queues) to.counts[i] = seeds / queues + (i < seeds % queues ? 1 : 0);
    if (i == 0) *state = {};
}

/// A round. A block that does not find room for what it has goes on, deep before wide, until it does; so the queues never
/// overflow, and as a block does some steps before it leaves, there is an end.
template <class Expand, class Judge, class Late, class... Sinks>
__global__ void __launch_bounds__(block_size)
    partition_kernel(block_queues<typename Expand::item> queues, round_limit limit, round_state* state, Expand expand,
                     Judge judge, Late late, Sinks... sinks) {
    using memory = partition_memory<Expand>;
    extern __shared__ __align__(16) unsigned char shared_memory[];
    memory& mine = *reinterpret_cast<memory*>(shared_memory);
    auto* const queue = queues.items_of(blockIdx.x);
    if (threadIdx.x == 0) {
        mine.count = mine.found = 0;
        mine.left = queues.counts[blockIdx.x];
        mine.may_leave = false;
    }
    __syncthreads();
    unsigned steps = 0;  // these are the same in all threads
    std::uint64_t expanded = 0;
    bool was_full = false, overflows = false;
    for (;; ++steps) {
        const bool over = block_is_over(late, sinks...), may_leave = mine.may_leave;
        unsigned count = mine.count, left = mine.left;
        const unsigned lacks = count < block_size ? block_size - count : 0, some = lacks < left ? lacks : left;
        left -= some;
        if (threadIdx.x < some) mine.items[count + threadIdx.x] = queue[left + threadIdx.x];
        count += some;
        const unsigned width = step_width<memory>(count), all = count + left;
        const bool fits = all <= queues.capacity, wants = may_leave && (steps >= limit.steps || all >= limit.items);
        overflows |= wants && !fits;
        const bool ends = count == 0 || over || (wants && fits);
        __syncthreads();
        if (mine.found >= (ends ? 1 : enough_candidates<Sinks...>)) judge_waiting(mine, judge, late, sinks...);
        if (ends) {
            if (threadIdx.x == 0) {
                mine.count = over ? 0 : count;
                mine.left = over ? 0 : left;
                if (was_full) atomicSub(&state->full, 1u);
                atomicAdd(&state->idle, 1u);
            }
            break;
        }
        const bool is_full = width < block_size && width < count;
        if (threadIdx.x == 0) {
            mine.left = left;
            if (is_full && !was_full) atomicAdd(&state->full, 1u);
        }
        was_full |= is_full;
        expanded += width;
        // The votes arrive while this step waits for its nodes.
        expand_newest(mine, count, width, expand, [&] {
            if (threadIdx.x != block_size - 1) return;
            const unsigned idle = atomic_load(&state->idle), full = atomic_load(&state->full);
            mine.may_leave = idle > 0 && idle + full >= limit.votes;
        });
    }
    __syncthreads();
    const unsigned count = mine.count, left = mine.left;
    for (unsigned k = threadIdx.x; k < count; k += block_size) queue[left + k] = mine.items[k];
    if (threadIdx.x == 0) {
        queues.counts[blockIdx.x] = left + count;
        add_relaxed(&state->items, expanded);
        add_relaxed(&state->left, std::uint64_t{left + count});
        add_relaxed(&state->steps, std::uint64_t{steps});
        if (overflows) add_relaxed(&state->overflows, std::uint64_t{1});
        atomicMax(&state->longest, steps);
    }
    close_all(sinks...);
}

/// Deals the items of all queues out, one to each queue in turn, and clears the state of the round. A block for each queue.
template <class Item>
__global__ void __launch_bounds__(block_size)
    balance_kernel(block_queues<Item> from, block_queues<Item> to, round_state* state) {
    __shared__ unsigned ends[most_queues], sums[block_size];
    const unsigned queues = gridDim.x, each = (queues + block_size - 1) / block_size, first = threadIdx.x * each;
    unsigned sum = 0;
    for (unsigned q = first; q < first + each && q < queues; ++q) ends[q] = sum += from.counts[q];
    sums[threadIdx.x] = sum;
    __syncthreads();
    for (unsigned away = 1; away < block_size; away *= 2) {
        const unsigned before = threadIdx.x >= away ? sums[threadIdx.x - away] : 0;
        __syncthreads();
        sums[threadIdx.x] += before;
        __syncthreads();
    }
    const unsigned before = threadIdx.x > 0 ? sums[threadIdx.x - 1] : 0, total = sums[block_size - 1];
    for (unsigned q = first; q < first + each && q < queues; ++q) ends[q] += before;
    __syncthreads();
    const unsigned count = total / queues + (blockIdx.x < total % queues ? 1 : 0);
    for (unsigned k = threadIdx.x; k < count; k += block_size) {
        const unsigned place = k * queues + blockIdx.x;
        unsigned q = 0;  // the first queue that ends behind this place
        for (unsigned rest = queues; rest > 0;) {
            const unsigned half = rest / 2;
            const bool is_before = ends[q + half] <= place;
            q = is_before ? q + half + 1 : q;
            rest = is_before ? rest - half - 1 : half;
        }
        to.items_of(blockIdx.x)[k] = from.items_of(q)[place - (q > 0 ? ends[q - 1] : 0)];
    }
    if (threadIdx.x != 0) return;
    to.counts[blockIdx.x] = count;
    if (blockIdx.x == 0) *state = {};
}

template <class Expand, class Judge, class... Queues>
std::uint64_t descend(const cuda& on, const scheduled<schedule::static_partition>& how, unsigned seeds, const Expand& expand,
                      const Judge& judge, Queues&... queues) {
    using item = typename Expand::item;
    using memory = partition_memory<Expand>;
    const auto launch = [&](auto late_sink, auto... sinks) {
        constexpr auto kernel = partition_kernel<Expand, Judge, decltype(late_sink), decltype(sinks)...>;
        const unsigned blocks = std::min(blocks_to_run<kernel, sizeof(memory)>(on, how), most_queues);
        const unsigned room = how.queue_capacity > 0 ? how.queue_capacity : memory::capacity;
        const unsigned capacity = std::max(room, seeds / blocks + 1);
        const std::size_t places = std::size_t{blocks} * capacity;
        buffer<item, device_space> items(on, 2 * places);
        buffer<unsigned, device_space> counts(on, std::size_t{2} * blocks);
        buffer<round_state, device_space> state(on, 1);
        block_queues<item> now{items.data(), counts.data(), capacity};
        block_queues<item> next{now.items + places, now.counts + blocks, capacity};
        const round_limit limit{std::max(blocks / 2, 1u), 8, 1024};
        const unsigned dealers = blocks_for(std::max(seeds, blocks));
        deal_seeds_kernel<<<dealers, block_size, 0, on.stream>>>(now, blocks, seeds, state.data(), expand);
        const auto run_round = [&](const round_limit& until) {
            kernel<<<blocks, block_size, sizeof(memory), on.stream>>>(now, until, state.data(), expand, judge, late_sink,
                                                                      sinks...);
            check_launch("for_each_descendant");
        };
        const auto balance = [&] {
            balance_kernel<<<blocks, block_size, 0, on.stream>>>(now, next, state.data());
            std::swap(now, next);
        };
        if constexpr (is_async_loop<Queues...>) {
            for (int round = 0; round < rounds_of_stream; ++round) {
                run_round(limit);
                balance();
            }
            run_round({~0u, ~0u, ~0u});
        } else {
            schedule_report report{.ran = schedule::static_partition, .workers = blocks};
            std::uint64_t longest = 0;
            for (;;) {
                run_round(limit);
                round_state round{};
                download(on, state.data(), 1, &round);
                report.rounds += 1;
                report.steps += round.steps;
                report.items += round.items;
                report.overflows += round.overflows;
                longest += round.longest;
                if (round.left == 0) break;
                balance();
                report.balances += 1;
                report.transferred += round.left;
            }
            const double possible = static_cast<double>(longest) * blocks;
            report.idle_share = possible > 0 ? 1 - static_cast<double>(report.steps) / possible : 0;
            if (how.report != nullptr) *how.report = report;
        }
    };
    return judge_and_finish<typename Expand::candidate>(on, any_number, judge, launch, queues...);
}

}  // namespace detail

}  // namespace abut::execution
