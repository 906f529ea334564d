// SPDX-License-Identifier: MIT
#pragma once

// The loops of `cuda` (execution/policy.hpp lists them), kernels of our own, because their shape decides the speed of
// everything above.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <cuda_pipeline_primitives.h>
#include <cuda_runtime.h>

#include <abut/execution/cuda.hpp>
#include <abut/execution/cuda_queue.hpp>
#include <abut/execution/generic.hpp>
#include <abut/execution/group.hpp>
#include <abut/execution/roles.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::execution {

namespace detail {

inline constexpr int block_size = 256;
inline constexpr unsigned warp_size = 32;
inline constexpr std::uint64_t any_number = ~std::uint64_t{0};

/// A thread's last word to its sinks: what they have gathered in registers goes to memory.
template <class... Sinks>
__device__ void close_all(Sinks&... sinks) {
    (sinks.close(), ...);
}

template <class F>
__global__ void __launch_bounds__(block_size) for_each_kernel(std::size_t n, F f) {
    const std::size_t i = std::size_t{blockIdx.x} * block_size + threadIdx.x;
    if (i < n) f(i);
}

/// Where the last kernel of a loop leaves the counters: the block that ends last copies them to the host and zeroes them.
struct counter_delivery {
    std::uint64_t* words;  // `count` of them, and one that counts blocks
    std::uint64_t* to;
    unsigned count;

    __device__ void operator()() const {
        __shared__ bool last;
        __syncthreads();
        if (threadIdx.x == 0) {
            __threadfence();  // of the whole block: the barrier came before
            const std::uint64_t blocks = std::uint64_t{gridDim.x} * gridDim.y;
            last = atomicAdd(reinterpret_cast<unsigned long long*>(words + count), 1ull) + 1 == blocks;
        }
        __syncthreads();
        if (!last || threadIdx.x > count) return;
        __threadfence();
        if (threadIdx.x < count) to[threadIdx.x] = atomic_load(words + threadIdx.x);
        words[threadIdx.x] = 0;
    }
};

template <class F, class... Sinks>
__global__ void __launch_bounds__(block_size)
    for_each_gather_kernel(std::size_t n, F f, counter_delivery deliver, Sinks... sinks) {
    const std::size_t i = std::size_t{blockIdx.x} * block_size + threadIdx.x;
    if (i < n) f(i, sinks...);
    close_all(sinks...);
    deliver();
}

/// Candidates of one block, in shared memory, with room for some of each walk when it is full.
template <class Candidate>
struct candidate_sink {
    static constexpr unsigned capacity = 2048, spare = 2;
    Candidate* data;
    unsigned* count;
    __device__ void push(const Candidate& candidate) const { data[atomicAdd(count, 1u)] = candidate; }
    [[nodiscard]] __device__ bool is_full() const { return atomic_load(count) > capacity - spare * block_size; }
};

/// A block is a group, or has some of a warp each, four if their memory has room: each of its threads runs the functor, and
/// takes its share of each step. Of warps that work by themselves each multiprocessor has 16 at a time, with 128 registers a
/// thread. 24 of them, with 80, were slower: they kept in memory what had no room in registers.
template <class F>
inline constexpr unsigned group_block = group_size_of<F> == group_size                        ? group_size
                                        : 4 * sizeof(typename F::shared) <= std::size_t{48} * 1024 ? 4 * subgroup_size
                                                                                              : 2 * subgroup_size;
template <class F>
__global__ void __launch_bounds__(group_block<F>, group_size_of<F> == group_size ? 1 : 512 / group_block<F>)
    for_each_group_kernel(std::size_t n, F f) {
    constexpr unsigned size = group_size_of<F>;
    __shared__ typename F::shared shared[group_block<F> / size];
    const std::size_t first = std::size_t{blockIdx.x} * group_block<F> + threadIdx.x / size * size;
    if (first < n) f(group<typename F::shared, size>(first, shared[threadIdx.x / size]));
}

/// Whether a flag among the sinks is raised, the same answer for all threads of the block. Each is asked by another warp,
/// since they are far away, and one after another took as long as all the rest of a step.
template <class... Sinks>
__device__ bool block_is_over(const Sinks&... sinks) {
    static_assert(sizeof...(sinks) <= block_size / warp_size);
    if constexpr ((may_stop<Sinks> || ...)) {
        unsigned first = 0;
        bool over = false;
        (..., (over |= threadIdx.x == first && is_over(sinks), first += warp_size));
        return __syncthreads_or(over) != 0;
    } else {
        return false;
    }
}

/// Whether lane 0 sees a flag among the sinks raised: only that lane asks, because all warps of a device ask one address.
template <class... Sinks>
__device__ bool warp_is_over(unsigned lane, const Sinks&... sinks) {
    return lane == 0 && is_over(sinks...);
}

/// Three steps of very different width: tests, of which one in a hundred may pass; walks, of uneven length; decisions, which
/// come up at uneven times. Each step hands what it found to the next through shared memory, so that each runs with its
/// lanes full. Few walkers are spread over all warps, since each waits for memory most of its time. Where candidates have no
/// room, walks rest until these are judged. Walks wait for memory: four blocks at a time, of 64 registers a thread, hide
/// more of that than three.
template <class Walk, class Judge, class Late, class... Sinks>
__global__ void __launch_bounds__(block_size, 4)
    for_each_candidate_kernel(std::size_t n, Walk walk, Judge judge, Late late, Sinks... sinks) {
    using candidate = typename Walk::candidate;
    using emitter = candidate_sink<candidate>;
    constexpr int rows = 4;  // tests in flight for each thread
    __shared__ std::size_t selected[(rows + 1) * block_size];
    __shared__ candidate candidates[emitter::capacity];
    __shared__ unsigned waiting, found;
    if (threadIdx.x == 0) waiting = found = 0;
    __syncthreads();

    const auto walk_and_judge = [&](bool mine, unsigned slot) {
        const std::size_t i = mine ? selected[slot] : 0;
        typename Walk::cursor at;
        bool more = false;
        do {
            __syncthreads();
            if (mine) mine = walk(i, at, emitter{candidates, &found}, sinks...);
            __syncthreads();
            const unsigned count = found;
            for (unsigned k = threadIdx.x; k < count; k += block_size) {
                if (!judge(candidates[k], sinks...)) late.push(candidates[k]);
            }
            more = __syncthreads_or(mine && !is_over(late, sinks...)) != 0;
            if (threadIdx.x == 0) found = 0;
        } while (more);
    };

    constexpr std::size_t step = std::size_t{rows} * block_size;
    for (std::size_t first = blockIdx.x * step; first < n; first += gridDim.x * step) {
        if (block_is_over(late, sinks...)) break;
        bool pass[rows];
#pragma unroll
        for (int row = 0; row < rows; ++row) {
            const std::size_t i = first + static_cast<unsigned>(row * block_size) + threadIdx.x;
            pass[row] = i < n && walk.may_find(i);
        }
#pragma unroll
        for (int row = 0; row < rows; ++row) {
            const std::size_t i = first + static_cast<unsigned>(row * block_size) + threadIdx.x;
            if (pass[row]) selected[atomicAdd(&waiting, 1u)] = i;
        }
        __syncthreads();
        for (unsigned left = waiting; left >= block_size; left -= block_size) {
            walk_and_judge(true, left - block_size + threadIdx.x);
            if (threadIdx.x == 0) waiting = left - block_size;
        }
        __syncthreads();
    }
    if (waiting > 0) {
        const unsigned spread = block_size / waiting;
        walk_and_judge(threadIdx.x % spread == 0 && threadIdx.x / spread < waiting, threadIdx.x / spread);
    }
    close_all(sinks...);
}

/// Pairs of a row and a column that passed, of one warp. They wait until a whole warp can decide.
struct waiting_pairs {
    static constexpr unsigned capacity = 2 * warp_size;
    std::uint32_t row[capacity];
    std::uint32_t column[capacity];
};

/// What for_each_tiled keeps in shared memory. Where columns are few, loading rows is what takes time, and they `stream`:
/// then a warp has two batches of rows here, one at hand and one on its way, and the rows of its waiting pairs.
template <class Tile>
struct tile_memory {
    using column = typename Tile::column;
    using row = typename Tile::row;
    static constexpr unsigned warps = block_size / warp_size;
    /// Rows that a thread holds at a time.
    static constexpr unsigned rows = sizeof(row) <= 48 ? 3 : 1;
    static constexpr unsigned batch = warp_size * rows, batch_bytes = batch * sizeof(row);
    static_assert(batch_bytes % 16 == 0 && alignof(row) <= 16);
    static constexpr unsigned waiting_bytes = waiting_pairs::capacity * sizeof(row);

    static constexpr std::size_t few = 32;
    ABUT_HD static constexpr unsigned width(bool stream) { return stream ? few : block_size; }
    ABUT_HD static constexpr unsigned column_bytes(bool stream) {
        return (width(stream) * unsigned{sizeof(column)} + 15) / 16 * 16;
    }
    ABUT_HD static constexpr unsigned bytes(bool stream) {
        return column_bytes(stream) + (stream ? warps * (2 * batch_bytes + waiting_bytes) : 0);
    }
    static constexpr unsigned most_bytes = bytes(true) > bytes(false) ? bytes(true) : bytes(false);
};

/// All rows against all columns. A block keeps a tile of columns in shared memory while rows go by; a thread holds several
/// rows, so that a column read once serves them all and enough loads are under way. The cheap test leaves few pairs: they
/// wait in shared memory until the lanes of a warp can decide one each, since a warp takes as long for one as for all.
/// Rows stream if `rows_in_memory` is where they lie one after another: a warp's next batch comes while it is busy with this
/// one. Strided loads into registers would not: they cost a third more time than reading does.
template <class Tile, class Late, class... Sinks>
__global__ void __launch_bounds__(block_size, 2)
    for_each_tiled_kernel(std::size_t n, std::size_t m, Tile tile, const typename Tile::row* rows_in_memory, Late late,
                          Sinks... sinks) {
    using column = typename Tile::column;
    using row = typename Tile::row;
    using candidate = typename Tile::candidate;
    using memory = tile_memory<Tile>;
    constexpr unsigned all = 0xffffffff;
    constexpr bool may_end = may_stop<Late> || (may_stop<Sinks> || ...);
    extern __shared__ __align__(16) unsigned char shared_memory[];
    __shared__ waiting_pairs waiting_of_warp[memory::warps];
    constexpr unsigned rows = memory::rows;
    const bool stream = rows_in_memory != nullptr;
    const unsigned lane = threadIdx.x % warp_size, warp = threadIdx.x / warp_size, width = memory::width(stream);
    column* const staged = reinterpret_cast<column*>(shared_memory);
    unsigned char* const mine = shared_memory + memory::column_bytes(stream) +
                                (stream ? warp * (2 * memory::batch_bytes + memory::waiting_bytes) : 0);
    row* const waiting_rows = reinterpret_cast<row*>(mine + 2 * memory::batch_bytes);
    waiting_pairs& waiting = waiting_of_warp[warp];
    const std::size_t step = std::size_t{gridDim.x} * memory::warps * memory::batch;

    const auto fetch = [&](std::size_t base, unsigned slot) {
        if (stream && base + memory::batch <= n) {
            const auto* const from = reinterpret_cast<const unsigned char*>(rows_in_memory + base);
            unsigned char* const to = mine + slot * memory::batch_bytes;
#pragma unroll
            for (unsigned at = 0; at < memory::batch_bytes; at += warp_size * 16) {
                const unsigned piece = at + lane * 16;
                if (piece < memory::batch_bytes) __pipeline_memcpy_async(to + piece, from + piece, 16);
            }
        }
        __pipeline_commit();
    };

    for (std::size_t first = std::size_t{blockIdx.y} * width; first < m; first += std::size_t{gridDim.y} * width) {
        const unsigned columns = m - first < width ? static_cast<unsigned>(m - first) : width;
        __syncthreads();
        if (threadIdx.x < columns) staged[threadIdx.x] = tile.load_column(first + threadIdx.x);
        __syncthreads();

        unsigned count = 0, unasked = 0, decisions = 0;  // the same in all lanes
        bool over = false;
        const auto decide = [&](unsigned place) {
            const std::size_t i = waiting.row[place], j = waiting.column[place];
            unasked = 0;
            if (!tile(stream ? waiting_rows[place] : tile.load_row(i), i, staged[j], first + j, sinks...)) {
                late.push(tile.candidate_of(i, first + j));
            }
        };
        std::size_t base = (std::size_t{blockIdx.x} * memory::warps + warp) * memory::batch;
        const unsigned look_up = stream ? 4 : 1;  // a batch of a stream is soon done, and asking takes its time
        fetch(base, 0);
        for (unsigned slot = 0; base < n && !over; base += step, slot ^= 1) {
            const bool ask = unasked++ % look_up == 0, stop = ask && warp_is_over(lane, late, sinks...);
            __syncwarp();  // all lanes have read what is overwritten now
            fetch(base + step, slot ^ 1);
            __pipeline_wait_prior(1);
            __syncwarp();
            const bool whole = stream && base + memory::batch <= n;
            const row* const batch = reinterpret_cast<const row*>(mine + slot * memory::batch_bytes) + lane;
            const auto load = [&](unsigned k) {
                const std::size_t i = base + k * warp_size + lane;
                return whole ? batch[k * warp_size] : tile.load_row(i < n ? i : n - 1);
            };
            decltype(tile.reach_of(load(0))) reach[rows];
#pragma unroll
            for (unsigned k = 0; k < rows; ++k) reach[k] = tile.reach_of(load(k));
            if constexpr (may_end) over = __any_sync(all, stop) != 0;
            for (unsigned j = 0; j < columns && !over; ++j) {
                unsigned passed = 0;
#pragma unroll
                for (unsigned k = 0; k < rows; ++k) {
                    passed |= static_cast<unsigned>(tile.passes(reach[k], staged[j])) << k;
                }
                if (!__any_sync(all, passed != 0)) continue;
#pragma unroll
                for (unsigned k = 0; k < rows; ++k) {
                    const std::size_t i = base + k * warp_size + lane;
                    const bool waits = (passed >> k & 1) != 0 && i < n;
                    const unsigned lanes = __ballot_sync(all, waits);
                    if (waits) {
                        const unsigned place = count + static_cast<unsigned>(__popc(lanes & ((1u << lane) - 1)));
                        waiting.row[place] = static_cast<std::uint32_t>(i);
                        waiting.column[place] = j;
                        if (stream) waiting_rows[place] = load(k);
                    }
                    count += static_cast<unsigned>(__popc(lanes));
                    if (count < warp_size) continue;
                    // Where most pairs touch, a batch has hundreds of decisions. The answer comes while one is made.
                    const bool asks = may_end && ++decisions % 4 == 0, stops = asks && warp_is_over(lane, late, sinks...);
                    __syncwarp();
                    count -= warp_size;
                    decide(count + lane);
                    __syncwarp();
                    if constexpr (may_end) over |= __any_sync(all, stops) != 0;
                }
            }
        }
        __pipeline_wait_prior(0);
        __syncwarp();
        if (lane < count) decide(lane);
    }
    close_all(sinks...);
}

/// A judge's last word on what a loop left open, if all of it found room.
template <class Judge, class Late, class... Sinks>
__global__ void __launch_bounds__(block_size)
    finish_kernel(Judge judge, counter_delivery deliver, Late late, Sinks... sinks) {
    const std::uint64_t pushed = atomic_load(late.count), count = pushed <= late.capacity ? pushed : 0;
    const std::uint64_t step = std::uint64_t{gridDim.x} * block_size;
    for (std::uint64_t i = std::uint64_t{blockIdx.x} * block_size + threadIdx.x; i < count; i += step) {
        if (is_over(sinks...)) break;
        judge.finish(late.data[i], sinks...);
    }
    close_all(sinks...);
    deliver();
}

/// Reads how many indices there are when it starts.
template <class F, class... Sinks>
__global__ void __launch_bounds__(block_size)
    for_each_indirect_kernel(const std::uint32_t* n, F f, counter_delivery deliver, Sinks... sinks) {
    const std::size_t count = *n, step = std::size_t{gridDim.x} * block_size;
    for (std::size_t i = std::size_t{blockIdx.x} * block_size + threadIdx.x; i < count; i += step) {
        if (is_over(sinks...)) break;
        f(i, sinks...);
    }
    if constexpr (sizeof...(Sinks) > 0) {
        close_all(sinks...);
        deliver();
    }
}

inline int multiprocessors(int device) {
    int count = 0;
    check(cudaDeviceGetAttribute(&count, cudaDevAttrMultiProcessorCount, device), "cudaDeviceGetAttribute");
    return count;
}

/// Blocks of `Kernel` that fill the device once, by the runtime's occupancy calculator, each with `Shared` bytes besides
/// what it declares itself; no launch of it takes more than `MostShared`. 0 where the device has not so much. Asked once for
/// each device: the question takes as long as a launch.
template <auto Kernel, unsigned Shared = 0, unsigned MostShared = Shared>
std::size_t resident_blocks(const cuda& on) {
    constexpr int remembered = 64;
    static std::atomic<std::size_t> answers[remembered];
    const int device = device_of(on);
    if (device < remembered && answers[device] != 0) return answers[device];
    const current_device scope(device);
    int blocks = 0;
    if (cudaFuncSetAttribute(Kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, int{MostShared}) != cudaSuccess) {
        cudaGetLastError();  // the refusal is an answer, and no error of the next call
        return 0;
    }
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, Kernel, block_size, Shared),
          "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
    const std::size_t answer =
        static_cast<std::size_t>(std::max(blocks, 1)) * static_cast<std::size_t>(multiprocessors(device));
    if (device < remembered) answers[device] = answer;
    return answer;
}

inline unsigned blocks_for(std::size_t n) { return static_cast<unsigned>((n + block_size - 1) / block_size); }

inline void check_launch(const char* kernel) { check(cudaGetLastError(), kernel); }

/// Runs `launch(deliver, sinks...)` with a sink of each queue. Does not wait.
template <class Launch, class... Queues>
void launch_once(const counter_delivery& deliver, const Launch& launch, Queues&... queues) {
    [&]<std::size_t... K>(std::index_sequence<K...>) { launch(deliver, queues.make_sink(deliver.words + K)...); }
    (std::index_sequence_for<Queues...>{});
}

/// Runs `launch(deliver, sinks...)` with a sink of each queue, over counters that are 0, reads what they have become, and
/// runs again while a queue found that it was too small: only the last run counts. The last kernel of `launch` calls
/// `deliver`.
template <class Launch, class... Queues>
void gather(const cuda& on, const Launch& launch, Queues&... queues) {
    static_assert(sizeof...(Queues) <= loop_counters::most);
    loop_counters& counters = loop_counters::of_this_thread(device_of(on));
    const counter_delivery deliver{counters.words(), counters.read(), sizeof...(Queues)};
    bool complete = false;
    while (!complete) {
        counters.begin(on.stream);
        launch_once(deliver, launch, queues...);
        counters.end(on.stream);
        const std::uint64_t* const counts = counters.read();
        std::size_t k = 0;
        complete = (queues.has_room(counts[k++]) && ...);
        k = 0;
        complete ? (queues.take_in(counts[k++]), ...) : (queues.make_room(on, counts[k++]), ...);
    }
}

}  // namespace detail

template <class F>
void for_each_index(const cuda& on, std::size_t n, const F& f) {
    if (n == 0) return;
    const detail::current_device scope(on);
    detail::for_each_kernel<<<detail::blocks_for(n), detail::block_size, 0, on.stream>>>(n, f);
    detail::check_launch("for_each_index");
}

template <class F, class Queue, class... Queues>
void for_each_index(const cuda& on, std::size_t n, const F& f, Queue& queue, Queues&... queues) {
    if (n == 0) return;
    const detail::current_device scope(on);
    const auto launch = [&](const detail::counter_delivery& deliver, auto... sinks) {
        detail::for_each_gather_kernel<<<detail::blocks_for(n), detail::block_size, 0, on.stream>>>(n, f, deliver, sinks...);
        detail::check_launch("for_each_index");
    };
    detail::gather(on, launch, queue, queues...);
}

/// The blocks that a device holds at a time share the indices, however many these are.
template <class F, class... Queues>
void for_each_indirect(const cuda& on, const std::uint32_t* n, const F& f, Queues&... queues) {
    const detail::current_device scope(on);
    const auto launch = [&](const detail::counter_delivery& deliver, auto... sinks) {
        constexpr auto kernel = detail::for_each_indirect_kernel<F, decltype(sinks)...>;
        const auto blocks = static_cast<unsigned>(detail::resident_blocks<kernel>(on));
        kernel<<<blocks, detail::block_size, 0, on.stream>>>(n, f, deliver, sinks...);
        detail::check_launch("for_each_indirect");
    };
    if constexpr (sizeof...(Queues) == 0) {
        launch(detail::counter_delivery{nullptr, nullptr, 0});
    } else {
        detail::gather(on, launch, queues...);
    }
}

template <class F>
void for_each_group(const cuda& on, std::size_t n, const F& f) {
    static_assert(group_functor<F>, "abut: for_each_group: the functor is no group_functor (execution/roles.hpp)");
    if constexpr (group_functor<F>) {
        if (n == 0) return;
        const detail::current_device scope(on);
        constexpr unsigned block = detail::group_block<F>;
        const auto blocks = static_cast<unsigned>(n / block + (n % block != 0));
        detail::for_each_group_kernel<F><<<blocks, block, 0, on.stream>>>(n, f);
        detail::check_launch("for_each_group");
    }
}

namespace detail {

/// Whether the first of some queues is an async_queue.
template <class... Queues>
inline constexpr bool is_async_loop = false;
template <class First, class... More>
inline constexpr bool is_async_loop<First, More...> = is_async<First>;

template <class First, class... More>
const async_loop& loop_of(const First& first, const More&...) {
    return first.loop;
}

/// A loop that judges at most `pairs` candidates: launch(late_sink, sinks...) starts it. The kernel that finishes what it
/// leaves open follows at once: the host need not know how much that is, and it is little as a rule. Returns how many of
/// these found no room, and so were not finished. If the first queue is an async_queue, it returns 0 at once, and all counts
/// are left on the device.
template <class Candidate, class Judge, class Launch, class... Queues>
std::uint64_t judge_and_finish(const cuda& on, std::uint64_t pairs, const Judge& judge, const Launch& launch,
                               Queues&... queues) {
    using open = open_queue<Candidate, (is_flag<sink_of<Queues>> || ...)>;
    const auto both = [&](const counter_delivery& deliver, auto late_sink, auto... sinks) {
        launch(late_sink, sinks...);
        constexpr auto kernel = finish_kernel<Judge, decltype(late_sink), decltype(sinks)...>;
        kernel<<<static_cast<unsigned>(resident_blocks<kernel>(on)), block_size, 0, on.stream>>>(judge, deliver, late_sink,
                                                                                                 sinks...);
        check_launch("finish");
    };
    if constexpr (is_async_loop<Queues...>) {
        const async_loop& loop = loop_of(queues...);
        open late(loop.open, loop.open_capacity);
        launch_once(counter_delivery{loop.words, loop.counts, 1 + sizeof...(queues)}, both, late, queues...);
        return 0;
    } else {
        open late(on, pairs);
        do {
            gather(on, both, late, queues...);
        } while (!late.is_complete() && !is_over(queues...));
        return late.unfinished();
    }
}

}  // namespace detail

template <class Walk, class Judge, class... Queues>
    requires candidate_walk<Walk, sink_of<Queues>...> && candidate_judge<Judge, typename Walk::candidate, sink_of<Queues>...>
std::uint64_t for_each_candidate(const cuda& on, std::size_t n, const Walk& walk, const Judge& judge, Queues&... queues) {
    if (n == 0) return 0;
    const detail::current_device scope(on);
    const auto launch = [&](auto late_sink, auto... sinks) {
        constexpr auto kernel = detail::for_each_candidate_kernel<Walk, Judge, decltype(late_sink), decltype(sinks)...>;
        const std::size_t blocks = std::min(detail::resident_blocks<kernel>(on), std::size_t{detail::blocks_for(n)});
        kernel<<<static_cast<unsigned>(blocks), detail::block_size, 0, on.stream>>>(n, walk, judge, late_sink, sinks...);
        detail::check_launch("for_each_candidate");
    };
    return detail::judge_and_finish<typename Walk::candidate>(on, detail::any_number, judge, launch, queues...);
}

template <class Tile, class... Queues>
    requires tile_functor<Tile, sink_of<Queues>...>
std::uint64_t for_each_tiled(const cuda& on, std::size_t n, std::size_t m, const Tile& tile, Queues&... queues) {
    if (n == 0 || m == 0) return 0;
    const detail::current_device scope(on);
    const auto launch = [&](auto late_sink, auto... sinks) {
        using memory = detail::tile_memory<Tile>;
        constexpr auto kernel = detail::for_each_tiled_kernel<Tile, decltype(late_sink), decltype(sinks)...>;
        const auto* rows = m <= memory::few ? tile.rows_in_memory() : nullptr;
        if (reinterpret_cast<std::uintptr_t>(rows) % 16 != 0) rows = nullptr;
        // As many blocks as the device holds at a time, for rows first; where there are few rows, columns are shared out.
        std::size_t room = rows != nullptr ? detail::resident_blocks<kernel, memory::bytes(true), memory::most_bytes>(on)
                                           : detail::resident_blocks<kernel, memory::bytes(false), memory::most_bytes>(on);
        if (room == 0) {  // a device without the shared memory to stream: threads load rows themselves
            rows = nullptr;
            room = std::max(detail::resident_blocks<kernel, memory::bytes(false)>(on), std::size_t{1});
        }
        const bool stream = rows != nullptr;
        const std::size_t rows_of_block = memory::warps * memory::batch, width = memory::width(stream);
        const std::size_t across = std::min(room, (n + rows_of_block - 1) / rows_of_block);
        const std::size_t down = std::min({room / across + 1, (m + width - 1) / width, std::size_t{65535}});
        const dim3 blocks(static_cast<unsigned>(across), static_cast<unsigned>(down));
        kernel<<<blocks, detail::block_size, memory::bytes(stream), on.stream>>>(n, m, tile, rows, late_sink, sinks...);
        detail::check_launch("for_each_tiled");
    };
    return detail::judge_and_finish<typename Tile::candidate>(on, std::uint64_t{n} * m, tile, launch, queues...);
}

}  // namespace abut::execution
