// SPDX-License-Identifier: MIT
#pragma once

// What the kernels of for_each_descendant of `cuda` share, whatever their schedule (execution/schedule.hpp): a block keeps
// items in shared memory and takes the newest at a time, one for each thread, so that a step costs one wait for memory
// however many items are in it, and the items never outgrow their room. Candidates wait until there is one for each thread.

#include <cstddef>
#include <cstdint>

#include <cuda_runtime.h>

#include <abut/execution/cuda_loops.hpp>
#include <abut/execution/schedule.hpp>

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
};

/// How many of `count` items a step takes: one for each thread, or fewer where what they make might find no room.
template <class Memory>
__device__ unsigned step_width(unsigned count) {
    const unsigned room = count + Memory::reserve < Memory::capacity ? Memory::capacity - Memory::reserve - count : 0;
    const unsigned fit = room / Memory::most > 0 ? room / Memory::most : 1;
    const unsigned width = count < block_size ? count : block_size;
    return width < fit ? width : fit;
}

/// Expands the newest `width` of `count` items. All threads call it, after a barrier behind which none reads the count any
/// more. `meanwhile` is called by each while their loads are on their way. Ends with a barrier.
template <class Expand, class Meanwhile>
__device__ void expand_newest(expansion<Expand>& mine, unsigned count, unsigned width, const Expand& expand,
                              const Meanwhile& meanwhile) {
    using memory = expansion<Expand>;
    using item = typename Expand::item;
    const bool works = threadIdx.x < width;
    const item at = works ? mine.items[count - width + threadIdx.x] : item{};
    if (threadIdx.x == 0) mine.count = count - width;
    __syncthreads();
    meanwhile();
    made<item, typename Expand::candidate, memory::most> children;
    if (works) expand(at, children);
    append(children.items, children.item_mask, mine.items, &mine.count);
    append(children.candidates, children.candidate_mask, mine.candidates, &mine.found);
    __syncthreads();
}

/// Judges all candidates that wait. Begins where no thread writes any, and ends with a barrier.
template <class Expand, class Judge, class Late, class... Sinks>
__device__ void judge_waiting(expansion<Expand>& mine, const Judge& judge, Late& late, Sinks&... sinks) {
    for (unsigned k = threadIdx.x; k < mine.found; k += block_size) {
        if (!judge(mine.candidates[k], sinks...)) late.push(mine.candidates[k]);
    }
    __syncthreads();
    if (threadIdx.x == 0) mine.found = 0;
    __syncthreads();
}

/// How many candidates have to wait before they are judged: as many as fill the block. An early end is worth more than full
/// lanes.
template <class... Sinks>
inline constexpr unsigned enough_candidates = (is_flag<Sinks> || ...) ? 1 : block_size;

/// Blocks that fill the device once, or as many as the caller allows.
template <auto Kernel, unsigned Shared>
unsigned blocks_to_run(const cuda& on, const schedule_options& how) {
    const std::size_t room = resident_blocks<Kernel, Shared>(on);
    const unsigned resident = room > 0 ? static_cast<unsigned>(room) : 1;  // where there is none, the launch says so
    return how.most_blocks > 0 && how.most_blocks < resident ? how.most_blocks : resident;
}

}  // namespace detail

}  // namespace abut::execution
