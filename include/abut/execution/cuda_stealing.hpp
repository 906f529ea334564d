// SPDX-License-Identifier: MIT
#pragma once

// for_each_descendant of `cuda` by schedules in which blocks take work from each other, in one kernel: lazy_work_stealing,
// and others whose rules are elsewhere (experimental/cuda_work_stealing.hpp). The deques and the count by which blocks
// learn that there is nothing left are stealing.hpp's, which says why neither needs that all blocks run at a time. A
// block's threads agree by barriers alone, and lanes of a warp by instructions that say so. What a block writes for others
// is ordered thus: its threads write, a barrier, one thread releases; and one thread of another block acquires, a barrier,
// its threads read.

#include <cstddef>
#include <cstdint>

#include <cuda_runtime.h>

#include <abut/execution/cuda_descent.hpp>
#include <abut/execution/cuda_loops.hpp>
#include <abut/execution/schedule.hpp>
#include <abut/execution/stealing.hpp>

namespace abut::execution {

namespace detail {

/// What the blocks of a kernel share.
template <class Item>
struct stealing_pool {
    deque_words* words;  ///< of each block
    Item* items;         ///< `capacity` of each block
    work_left* left;
    worker_counts* sum;  ///< or null
    std::uint32_t capacity, seeds, portion;

    [[nodiscard]] __device__ Item* items_of(unsigned block) const { return items + std::size_t{block} * capacity; }
};

/// How a block keeps and steals, of the lazy schedule: its newest items stay in shared memory, and it steals from as many
/// deques as a warp has lanes, a little from each, since what it has stolen nobody can steal from it.
template <schedule Schedule>
struct stealing_rule {
    static_assert(
        Schedule == schedule::lazy_work_stealing,
        "abut: this schedule of a device is in another header: include <abut/experimental/cuda_work_stealing.hpp>");
    /// With more items than `most`, the oldest go to the deque, all but `keep`.
    static constexpr unsigned most = 2 * block_size, keep = block_size;
    /// From how many deques it steals at a time, all that a warp has lanes or one, and how many items from each.
    static constexpr unsigned victims = warp_size, steal = 64;
};

/// A range that was stolen and still lies where it was.
struct stolen_range {
    unsigned victim;
    item_range places;
};

template <class Expand, class Rule>
struct stealing_memory : expansion<Expand> {
    worker_counts counts;
    deque_owner own;
    work_part part;
    item_range now;  ///< what thread 0 has found: items
    bool are_seeds, is_done;
    unsigned next_stolen, end_stolen;
    stolen_range stolen[Rule::victims];
};

/// The deques are empty, and nobody has taken a seed.
template <class Item>
__global__ void __launch_bounds__(block_size) start_stealing_kernel(stealing_pool<Item> pool, unsigned workers) {
    const unsigned i = blockIdx.x * block_size + threadIdx.x;
    if (i < workers) pool.words[i] = {};
    if (i == 0) {
        *pool.left = {pool.seeds, 0};
        if (pool.sum != nullptr) *pool.sum = {};
    }
}

// Functions of a block: all its threads call them, at a place where none of them writes shared memory, and they end with a
// barrier.

/// Brings ranges that have been stolen to the block's stack, as many as a step takes.
template <class Rule, class Memory, class Item>
__device__ void transfer_stolen(Memory& mine, const stealing_pool<Item>& pool) {
    constexpr unsigned threads = Rule::victims > 1 ? warp_size : block_size;  // that copy a range
    const unsigned next = mine.next_stolen, end = mine.end_stolen, lane = threadIdx.x % threads;
    unsigned last = next, total = 0;
    for (; last < end && total + mine.stolen[last].places.count <= block_size; ++last) {
        const stolen_range from = mine.stolen[last];
        if ((last - next) % (block_size / threads) == threadIdx.x / threads) {
            const Item* const items = pool.items_of(from.victim) + from.places.first;
            for (unsigned k = lane; k < from.places.count; k += threads) mine.items[total + k] = items[k];
        }
        total += from.places.count;
    }
    __syncthreads();
    if (threadIdx.x < last - next) {
        const stolen_range from = mine.stolen[next + threadIdx.x];
        give_back_places(pool.words + from.victim, from.places.count);
    }
    if (threadIdx.x == 0) {
        mine.count = total;
        mine.next_stolen = last;
        mine.counts.stolen += total;
        if constexpr (Rule::victims > 1) {
            mine.counts.transfers += 1;
            mine.counts.transferred += total;
        }
    }
    __syncthreads();
}

/// Fills a stack that is empty: from the block's own deque, with seeds, or with what it has stolen before. False if there is
/// none of these.
template <class Rule, class Memory, class Expand>
__device__ bool take_own(Memory& mine, const stealing_pool<typename Expand::item>& pool, const Expand& expand) {
    if (threadIdx.x == 0) {
        mine.now = mine.own.take(block_size);
        mine.are_seeds = mine.now.count == 0;
        if (mine.are_seeds) mine.now = mine.part.take_seeds();
    }
    __syncthreads();
    const item_range now = mine.now;
    if (now.count > 0) {
        if (threadIdx.x < now.count) {
            const unsigned at = now.first + threadIdx.x;
            mine.items[threadIdx.x] = mine.are_seeds ? expand.seed(at) : pool.items_of(blockIdx.x)[at];
        }
        if (threadIdx.x == 0) mine.count = now.count;
        __syncthreads();
        return true;
    }
    if (mine.next_stolen < mine.end_stolen) {
        transfer_stolen<Rule>(mine, pool);
        return true;
    }
    __syncthreads();
    return false;
}

/// A warp looks into the deques of 32 other blocks, and steals from one of them, or from all that have something. Leaves in
/// mine.stolen what it got.
template <class Rule, class Memory, class Item>
__device__ void look_in_deques(Memory& mine, const stealing_pool<Item>& pool, unsigned start) {
    constexpr unsigned all = 0xffffffff;
    const unsigned lane = threadIdx.x, victim = (start + lane) % gridDim.x;
    const bool sees = lane < gridDim.x && victim != blockIdx.x && deque_size(pool.words + victim) > 0;
    const unsigned seen = __ballot_sync(all, sees);
    if (lane == 0) {
        if (seen != 0) mine.part.become_busy();
        mine.is_done = seen == 0 && mine.part.is_all_done();
    }
    __syncwarp();  // the block is busy before a lane takes anything: what lane 0 did is ordered before what they do
    const bool steals = Rule::victims > 1 ? sees : lane + 1 == static_cast<unsigned>(__ffs(static_cast<int>(seen)));
    item_range range{0, 0};
    if (steals) range = steal(pool.words + victim, Rule::steal);
    const unsigned got = __ballot_sync(all, range.count > 0);
    if (range.count > 0) mine.stolen[__popc(got & ((1u << lane) - 1))] = {victim, range};
    if (lane != 0) return;
    const auto steals_done = static_cast<unsigned>(__popc(got));
    mine.counts.steals += steals_done;
    if (got == 0) {
        mine.counts.failed_steals += 1;
        mine.part.become_idle();
    }
    mine.next_stolen = 0;
    mine.end_stolen = steals_done;
}

/// Fills a stack that is empty with what other blocks have, as soon as one has some. False if there is nothing left
/// anywhere, or over() says that there is no need to go on.
template <class Rule, class Memory, class Item, class Over>
__device__ bool steal_some(Memory& mine, const stealing_pool<Item>& pool, const Over& over) {
    const long long since = clock64();
    if (threadIdx.x == 0) mine.part.become_idle();
    // Blocks look in different places, and each looks everywhere in its turn.
    unsigned start = (blockIdx.x + static_cast<unsigned>(since)) * 2654435761u % gridDim.x, pause = 32;
    bool found = false;
    while (!over()) {
        if (threadIdx.x < warp_size) look_in_deques<Rule>(mine, pool, start);
        __syncthreads();
        found = mine.end_stolen > 0;
        if (found || mine.is_done) break;
        // Who waits asks less and less often, so as not to be in the way of those who work.
        if (threadIdx.x == 0) __nanosleep(pause);
        pause = pause < 1024 ? 2 * pause : pause;
        start = (start + warp_size) % gridDim.x;
        __syncthreads();
    }
    if (threadIdx.x == 0) mine.counts.idle_time += static_cast<std::uint64_t>(clock64() - since);
    if (!found) {
        __syncthreads();
        return false;
    }
    transfer_stolen<Rule>(mine, pool);
    return true;
}

/// Puts the oldest items of the stack into the block's deque if they are more than the rule says, as far as there is room.
/// What finds none stays: a stack never outgrows its own (cuda_descent.hpp).
template <class Rule, class Memory, class Item>
__device__ void offer_oldest(Memory& mine, const stealing_pool<Item>& pool) {
    const unsigned count = mine.count;
    if (count <= Rule::most) return;
    const unsigned surplus = count - Rule::keep;
    if (mine.own.room() < surplus) {
        __syncthreads();
        if (threadIdx.x == 0) mine.own.make_room();
        __syncthreads();
    }
    const unsigned room = mine.own.room(), some = surplus < room ? surplus : room, rest = count - some;
    Item* const to = pool.items_of(blockIdx.x) + mine.own.bottom;
    for (unsigned k = threadIdx.x; k < some; k += block_size) to[k] = mine.items[k];
    for (unsigned first = 0; some > 0 && first < rest; first += block_size) {
        const unsigned k = first + threadIdx.x;
        const Item moved = k < rest ? mine.items[some + k] : Item{};
        __syncthreads();
        if (k < rest) mine.items[k] = moved;
        __syncthreads();
    }
    __syncthreads();
    if (threadIdx.x == 0) {
        mine.count = rest;
        mine.counts.overflows += some < surplus ? 1 : 0;
        if (some > 0) {
            mine.own.publish(some);
            mine.counts.offers += 1;
        }
    }
    __syncthreads();
}

/// Expands all seeds and what comes of them.
template <class Rule, class Expand, class Judge, class Late, class... Sinks>
__global__ void __launch_bounds__(block_size)
    stealing_kernel(stealing_pool<typename Expand::item> pool, Expand expand, Judge judge, Late late, Sinks... sinks) {
    using memory = stealing_memory<Expand, Rule>;
    static_assert(sizeof(memory) <= 65536, "every device since compute capability 7.5 lets a block have 64 KiB");
    extern __shared__ __align__(16) unsigned char shared_memory[];
    memory& mine = *reinterpret_cast<memory*>(shared_memory);
    const long long begun = clock64();
    if (threadIdx.x == 0) {
        mine.count = mine.found = mine.next_stolen = mine.end_stolen = 0;
        mine.counts = {};
        mine.own = {pool.words + blockIdx.x, pool.capacity, 0, 0};
        mine.part = {pool.left, pool.seeds, pool.portion, false, true};
    }
    __syncthreads();
    const auto over = [&] { return block_is_over(late, sinks...); };
    for (;;) {
        const bool ends = over(), has = !ends && (mine.count > 0 || take_own<Rule>(mine, pool, expand));
        // Also before the block waits for what others have.
        if (mine.found >= (has ? enough_candidates<Sinks...> : 1)) judge_waiting(mine, judge, late, sinks...);
        if (ends || (!has && !steal_some<Rule>(mine, pool, over))) break;
        const unsigned count = mine.count, width = step_width<memory>(count);
        __syncthreads();
        if (threadIdx.x == 0) {
            mine.counts.steps += 1;
            mine.counts.items += width;
        }
        expand_newest(mine, count, width, expand, [] {});
        offer_oldest<Rule>(mine, pool);
    }
    if (threadIdx.x == 0 && pool.sum != nullptr) {
        mine.counts.time = static_cast<std::uint64_t>(clock64() - begun);
        mine.counts.add_to(pool.sum);
    }
    close_all(sinks...);
}

template <schedule Schedule, class Expand, class Judge, class... Queues>
    requires(Schedule == schedule::work_stealing || Schedule == schedule::lazy_work_stealing)
std::uint64_t descend(const cuda& on, const scheduled<Schedule>& how, unsigned seeds, const Expand& expand,
                      const Judge& judge, Queues&... queues) {
    using rule = stealing_rule<Schedule>;
    using item = typename Expand::item;
    using memory = stealing_memory<Expand, rule>;
    const auto launch = [&](auto late_sink, auto... sinks) {
        constexpr auto kernel = stealing_kernel<rule, Expand, Judge, decltype(late_sink), decltype(sinks)...>;
        const unsigned blocks = blocks_to_run<kernel, sizeof(memory)>(on, how);
        const unsigned capacity = how.queue_capacity > 0 ? how.queue_capacity : 4096;
        const unsigned even = seeds / (4 * blocks) + 1, portion = even < block_size ? even : block_size;
        buffer<item, device_space> items(on, std::size_t{blocks} * capacity);
        buffer<deque_words, device_space> words(on, blocks);
        buffer<work_left, device_space> left(on, 1);
        buffer<worker_counts, device_space> sum(on, how.report != nullptr ? 1 : 0);
        const stealing_pool<item> pool{words.data(), items.data(), left.data(), sum.data(), capacity, seeds, portion};
        start_stealing_kernel<<<blocks_for(blocks), block_size, 0, on.stream>>>(pool, blocks);
        kernel<<<blocks, block_size, sizeof(memory), on.stream>>>(pool, expand, judge, late_sink, sinks...);
        check_launch("for_each_descendant");
        if (how.report != nullptr) {
            worker_counts found{};
            download(on, sum.data(), 1, &found);
            *how.report = report_of(Schedule, blocks, found);
        }
    };
    return judge_and_finish<typename Expand::candidate>(on, any_number, judge, launch, queues...);
}

}  // namespace detail

}  // namespace abut::execution
