// SPDX-License-Identifier: MIT
#pragma once

// The verbs of `cuda` (execution/policy.hpp lists them). Reductions, scans, sorts and selections are CUB's; the three
// loops are kernels of our own, because their shape decides the speed of everything above.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>
#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>

#include <abut/execution/cuda.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::execution {

namespace detail {

inline constexpr int block_size = 256;
inline constexpr unsigned warp_size = 32;
/// Rows of for_each_tiled that a thread holds at a time.
inline constexpr int rows_of_a_thread = 3;

inline __device__ unsigned lane_id() {
    unsigned lane;
    asm("mov.u32 %0, %%laneid;" : "=r"(lane));
    return lane;
}

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

/// Whether a flag among the sinks is raised, the same answer for all threads of the block.
template <class... Sinks>
__device__ bool block_is_over(const Sinks&... sinks) {
    if constexpr ((is_flag<Sinks> || ...)) {
        return __syncthreads_or(threadIdx.x == 0 && is_over(sinks...)) != 0;
    } else {
        return false;
    }
}

/// Whether lane 0 sees a flag among the sinks raised: only that lane asks, because all warps of a device ask one address.
template <class... Sinks>
__device__ bool warp_is_over(unsigned lane, const Sinks&... sinks) {
    return lane == 0 && is_over(sinks...);
}

/// Candidates of one block, in shared memory; the ones that find no room are late.
template <class Candidate, class Late>
struct candidate_sink {
    static constexpr unsigned capacity = 2048;
    Candidate* data;
    unsigned* count;
    Late late;
    __device__ void push(const Candidate& candidate) const {
        // The counter rests once it is past the capacity: it cannot wrap around, whatever the number of candidates.
        const unsigned slot = atomic_load(count) < capacity ? atomicAdd(count, 1u) : capacity;
        if (slot < capacity) {
            data[slot] = candidate;
        } else {
            late.push(candidate);
        }
    }
};

/// Three steps of very different width: tests, of which one in a hundred may pass; walks, of uneven length; decisions, which
/// come up at uneven times. Each step hands what it found to the next through shared memory, so that each runs with its
/// lanes full. Few walkers are spread over all warps, since each waits for memory most of its time.
template <class Test, class Walk, class Decide, class Late, class... Sinks>
__global__ void __launch_bounds__(block_size)
    for_each_candidate_kernel(std::size_t n, Test test, Walk walk, Decide decide, Late late, Sinks... sinks) {
    using emitter = candidate_sink<typename Walk::candidate, Late>;
    constexpr int rows = 4;  // tests in flight for each thread
    __shared__ std::size_t selected[(rows + 1) * block_size];
    __shared__ typename Walk::candidate candidates[emitter::capacity];
    __shared__ unsigned waiting, found;
    if (threadIdx.x == 0) waiting = found = 0;
    __syncthreads();

    const auto walk_and_decide = [&](bool mine, unsigned slot) {
        const std::size_t i = mine ? selected[slot] : 0;
        __syncthreads();
        if (mine) walk(i, emitter{candidates, &found, late}, sinks...);
        __syncthreads();
        const unsigned count = found < emitter::capacity ? found : emitter::capacity;
        for (unsigned k = threadIdx.x; k < count; k += block_size) decide(candidates[k], late, sinks...);
        __syncthreads();
        if (threadIdx.x == 0) found = 0;
    };

    constexpr std::size_t step = std::size_t{rows} * block_size;
    for (std::size_t first = blockIdx.x * step; first < n; first += gridDim.x * step) {
        if (block_is_over(sinks...)) break;
        bool pass[rows];
#pragma unroll
        for (int row = 0; row < rows; ++row) {
            const std::size_t i = first + static_cast<unsigned>(row * block_size) + threadIdx.x;
            pass[row] = i < n && test(i);
        }
#pragma unroll
        for (int row = 0; row < rows; ++row) {
            const std::size_t i = first + static_cast<unsigned>(row * block_size) + threadIdx.x;
            if (pass[row]) selected[atomicAdd(&waiting, 1u)] = i;
        }
        __syncthreads();
        for (unsigned left = waiting; left >= block_size; left -= block_size) {
            walk_and_decide(true, left - block_size + threadIdx.x);
            if (threadIdx.x == 0) waiting = left - block_size;
        }
        __syncthreads();
    }
    if (waiting > 0) {
        const unsigned spread = block_size / waiting;
        walk_and_decide(threadIdx.x % spread == 0 && threadIdx.x / spread < waiting, threadIdx.x / spread);
    }
    close_all(sinks...);
}

/// Pairs of a row and a column that passed, of one warp. They wait until a whole warp can decide.
struct waiting_pairs {
    static constexpr unsigned capacity = 2 * warp_size;
    std::uint32_t row[capacity];
    std::uint32_t column[capacity];
};

/// All rows against all columns. A block keeps a tile of columns in shared memory while rows stream by; a thread holds
/// several rows, so that a column read once serves them all and enough loads are under way. The cheap test leaves few pairs:
/// they wait in shared memory until the lanes of a warp can decide one each, since a warp takes as long for one as for all.
template <class Tile, class... Sinks>
__global__ void __launch_bounds__(block_size, 3)
    for_each_tiled_kernel(std::size_t n, std::size_t m, Tile tile, Sinks... sinks) {
    using column = typename Tile::column;
    constexpr int rows = rows_of_a_thread;
    constexpr unsigned warps = block_size / warp_size, all = 0xffffffff;
    __shared__ alignas(16) unsigned char memory[block_size * sizeof(column)];
    __shared__ waiting_pairs waiting_of_warp[warps];
    column* const staged = reinterpret_cast<column*>(memory);
    const unsigned lane = threadIdx.x % warp_size;
    waiting_pairs& waiting = waiting_of_warp[threadIdx.x / warp_size];
    const std::size_t step = std::size_t{block_size} * rows;

    for (std::size_t first = std::size_t{blockIdx.y} * block_size; first < m; first += std::size_t{gridDim.y} * block_size) {
        const unsigned width = m - first < block_size ? static_cast<unsigned>(m - first) : block_size;
        __syncthreads();
        if (threadIdx.x < width) staged[threadIdx.x] = tile.load_column(first + threadIdx.x);
        __syncthreads();

        unsigned count = 0;  // the same in all lanes
        const auto decide = [&](unsigned slot) {
            const std::size_t i = waiting.row[slot];
            const unsigned j = waiting.column[slot];
            tile(tile.load_row(i), i, staged[j], first + j, sinks...);
        };
        for (std::size_t base = blockIdx.x * step; base < n; base += gridDim.x * step) {
            const bool stop = warp_is_over(lane, sinks...);
            decltype(tile.reach_of(tile.load_row(0))) reach[rows];
#pragma unroll
            for (int k = 0; k < rows; ++k) {
                const std::size_t i = base + static_cast<unsigned>(k * block_size) + threadIdx.x;
                reach[k] = tile.reach_of(tile.load_row(i < n ? i : n - 1));
            }
            if (__any_sync(all, stop)) break;
            for (unsigned j = 0; j < width; ++j) {
                unsigned passed = 0;
#pragma unroll
                for (int k = 0; k < rows; ++k) passed |= static_cast<unsigned>(tile.passes(reach[k], staged[j])) << k;
                if (!__any_sync(all, passed != 0)) continue;
#pragma unroll
                for (int k = 0; k < rows; ++k) {
                    const std::size_t i = base + static_cast<unsigned>(k * block_size) + threadIdx.x;
                    const bool mine = (passed >> k & 1) != 0 && i < n;
                    const unsigned lanes = __ballot_sync(all, mine);
                    if (mine) {
                        const unsigned slot = count + static_cast<unsigned>(__popc(lanes & ((1u << lane) - 1)));
                        waiting.row[slot] = static_cast<std::uint32_t>(i);
                        waiting.column[slot] = j;
                    }
                    count += static_cast<unsigned>(__popc(lanes));
                    if (count < warp_size) continue;
                    __syncwarp();
                    count -= warp_size;
                    decide(count + lane);
                    __syncwarp();
                }
            }
        }
        __syncwarp();
        if (lane < count) decide(lane);
    }
    close_all(sinks...);
}

/// settle(c, sinks...) for every c that the kernel before has pushed into `late`.
template <class Settle, class Late, class... Sinks>
__global__ void __launch_bounds__(block_size)
    settle_kernel(Settle settle, counter_delivery deliver, Late late, Sinks... sinks) {
    const std::uint64_t pushed = atomic_load(late.count), count = pushed < late.capacity ? pushed : late.capacity;
    constexpr std::uint64_t step = block_size;
    for (std::uint64_t i = blockIdx.x * step + threadIdx.x; i < count; i += gridDim.x * step) {
        if (is_over(sinks...)) break;
        settle(late.data[i], sinks...);
    }
    close_all(sinks...);
    deliver();
}

inline int multiprocessors(int device) {
    int count = 0;
    check(cudaDeviceGetAttribute(&count, cudaDevAttrMultiProcessorCount, device), "cudaDeviceGetAttribute");
    return count;
}

/// Blocks of `Kernel` that fill the device once, by the runtime's occupancy calculator. Asked once for each device: the
/// question takes as long as a launch.
template <auto Kernel>
std::size_t resident_blocks(const cuda& on) {
    constexpr int remembered = 64;
    static std::atomic<std::size_t> answers[remembered];
    const int device = device_of(on);
    if (device < remembered && answers[device] != 0) return answers[device];
    int blocks = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, Kernel, block_size, 0),
          "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
    const std::size_t answer =
        static_cast<std::size_t>(std::max(blocks, 1)) * static_cast<std::size_t>(multiprocessors(device));
    if (device < remembered) answers[device] = answer;
    return answer;
}

inline unsigned blocks_for(std::size_t n) { return static_cast<unsigned>((n + block_size - 1) / block_size); }

inline void check_launch(const char* kernel) { check(cudaGetLastError(), kernel); }

/// The second kernel follows the first at once: the host need not know how much was left. That is little as a rule.
template <class Settle, class Late, class... Sinks>
void launch_settle(const cuda& on, const Settle& settle, const counter_delivery& deliver, const Late& late,
                   const Sinks&... sinks) {
    constexpr auto kernel = settle_kernel<Settle, Late, Sinks...>;
    kernel<<<static_cast<unsigned>(resident_blocks<kernel>(on)), block_size, 0, on.stream>>>(settle, deliver, late,
                                                                                             sinks...);
    check_launch("settle");
}

/// Runs `launch(deliver, sinks...)` with a sink of each queue, over counters that are 0, reads what they have become, and
/// runs again while a queue found that it was too small. The last kernel of `launch` calls `deliver`.
template <class Launch, class... Queues>
void gather(const cuda& on, const Launch& launch, Queues&... queues) {
    static_assert(sizeof...(Queues) <= loop_counters::most);
    loop_counters& counters = loop_counters::of_this_thread(device_of(on));
    const counter_delivery deliver{counters.words(), counters.read(), sizeof...(Queues)};
    bool complete = false;
    while (!complete) {
        counters.begin(on.stream);
        [&]<std::size_t... K>(std::index_sequence<K...>) {
            launch(deliver, queues.make_sink(counters.words() + K)...);
        }(std::index_sequence_for<Queues...>{});
        counters.end(on.stream);
        complete = true;
        std::size_t k = 0;
        ((complete &= queues.settle(on, counters.read()[k++])), ...);
    }
}

}  // namespace detail

template <class T>
void upload(const cuda& on, const T* from, std::size_t n, T* to) {
    if (n == 0) return;
    const detail::current_device scope(on);
    detail::check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyHostToDevice, on.stream), "cudaMemcpyAsync");
}

template <class T>
void copy(const cuda& on, const T* from, std::size_t n, T* to) {
    if (n == 0) return;
    const detail::current_device scope(on);
    detail::check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDeviceToDevice, on.stream), "cudaMemcpyAsync");
}

template <class T>
void download(const cuda& on, const T* from, std::size_t n, T* to) {
    const detail::current_device scope(on);
    if (n > 0) {
        const std::size_t bytes = n * sizeof(T);
        void* const through = bytes <= detail::pinned_scratch::bytes ? detail::pinned_scratch::of_this_thread() : to;
        detail::check(cudaMemcpyAsync(through, from, bytes, cudaMemcpyDeviceToHost, on.stream), "cudaMemcpyAsync");
        detail::check(cudaStreamSynchronize(on.stream), "cudaStreamSynchronize");
        if (through != to) std::memcpy(static_cast<void*>(to), through, bytes);
    }
}

// The queues in device memory: a sink counts in a word of device memory, and `settle` is told what it counted.

template <class T>
class work_queue<T, device_space> {
public:
    struct sink {
        T* data;
        std::uint64_t capacity;
        std::uint64_t* count;
        /// The lanes of a warp that push together count together.
        __device__ void push(const T& value) const {
            const unsigned lanes = __activemask();
            const int leader = __ffs(static_cast<int>(lanes)) - 1;
            const unsigned lane = detail::lane_id();
            std::uint64_t first = 0;
            if (static_cast<int>(lane) == leader) first = atomic_add(count, static_cast<std::uint64_t>(__popc(lanes)));
            const std::uint64_t slot = __shfl_sync(lanes, first, leader) + __popc(lanes & ((1u << lane) - 1));
            if (slot < capacity) data[slot] = value;
        }
        __device__ void close() const {}
    };

    explicit work_queue(const cuda& on, std::size_t expected = 0) : items_(on, std::max<std::size_t>(expected, 4096)) {}

    work_queue(const cuda& on, const std::vector<T>& values) : items_(on, values.size()), size_(values.size()) {
        upload(on, values.data(), values.size(), items_.data());
        synchronize(on);
    }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] T* data() { return items_.data(); }
    [[nodiscard]] const T* data() const { return items_.data(); }
    [[nodiscard]] buffer<T, device_space> take() {
        items_.shrink(std::exchange(size_, 0));
        return std::move(items_);
    }
    void absorb(const cuda& on, work_queue& more) {
        buffer<T, device_space> mine = take(), others = more.take();
        items_ = joined(on, mine, others);
        size_ = items_.size();
    }

    [[nodiscard]] sink make_sink(std::uint64_t* count) { return {items_.data(), items_.size(), count}; }
    [[nodiscard]] bool settle(const cuda& on, std::uint64_t count) {
        if (count > items_.size()) {
            items_ = {};  // first give back, then take: both never need to fit at once
            items_ = buffer<T, device_space>(on, count + count / 8);  // what overflows a block varies from run to run
            return false;
        }
        size_ = count;
        return true;
    }

private:
    buffer<T, device_space> items_;
    std::size_t size_ = 0;
};

template <>
class work_count<device_space> {
public:
    struct sink {
        std::uint64_t* total;
        std::uint64_t mine = 0;
        __device__ void add(std::uint32_t k) { mine += k; }
        /// The lanes of a warp that end together add once.
        __device__ void close() const {
            const unsigned lanes = __activemask();
            std::uint64_t sum = mine;
            if (lanes == 0xffffffff) {
#pragma unroll
                for (int away = 16; away > 0; away /= 2) sum += __shfl_down_sync(lanes, sum, away);
                if (detail::lane_id() != 0) return;
            }
            if (sum > 0) atomic_add(total, sum);
        }
    };

    explicit work_count(const cuda&) {}
    [[nodiscard]] std::uint64_t total() const { return total_; }
    template <class Queue>
    void absorb(const cuda&, const Queue& more) {
        total_ += more.size();
    }
    [[nodiscard]] sink make_sink(std::uint64_t* sum) { return {sum}; }
    [[nodiscard]] bool settle(const cuda&, std::uint64_t sum) {
        total_ = sum;
        return true;
    }

private:
    std::uint64_t total_ = 0;
};

template <>
class work_flag<device_space> {
public:
    struct sink {
        std::uint64_t* word;
        __device__ void raise() const { atomic_store(reinterpret_cast<std::uint32_t*>(word), 1); }
        [[nodiscard]] __device__ bool raised() const {
            return atomic_load(reinterpret_cast<const std::uint32_t*>(word)) != 0;
        }
        __device__ void close() const {}
    };

    explicit work_flag(const cuda&) {}
    [[nodiscard]] bool raised() const { return raised_; }
    template <class Queue>
    void absorb(const cuda&, const Queue& more) {
        raised_ |= more.size() > 0;
    }
    [[nodiscard]] sink make_sink(std::uint64_t* word) { return {word}; }
    [[nodiscard]] bool settle(const cuda&, std::uint64_t word) {
        raised_ = word != 0;
        return true;
    }

private:
    bool raised_ = false;
};

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

template <class Test, class Walk, class Decide, class Settle, class Late, class... Queues>
void for_each_candidate(const cuda& on, std::size_t n, const Test& test, const Walk& walk, const Decide& decide,
                        const Settle& settle, Late& late, Queues&... queues) {
    if (n == 0) return;
    const detail::current_device scope(on);
    const auto launch = [&](const detail::counter_delivery& deliver, auto late_sink, auto... sinks) {
        constexpr auto kernel =
            detail::for_each_candidate_kernel<Test, Walk, Decide, decltype(late_sink), decltype(sinks)...>;
        const std::size_t blocks = std::min(detail::resident_blocks<kernel>(on), std::size_t{detail::blocks_for(n)});
        kernel<<<static_cast<unsigned>(blocks), detail::block_size, 0, on.stream>>>(n, test, walk, decide, late_sink,
                                                                                    sinks...);
        detail::check_launch("for_each_candidate");
        detail::launch_settle(on, settle, deliver, late_sink, sinks...);
    };
    detail::gather(on, launch, late, queues...);
}

template <class Tile, class Settle, class Late, class... Queues>
void for_each_tiled(const cuda& on, std::size_t n, std::size_t m, const Tile& tile, const Settle& settle, Late& late,
                    Queues&... queues) {
    if (n == 0 || m == 0) return;
    const detail::current_device scope(on);
    const auto launch = [&](const detail::counter_delivery& deliver, auto late_sink, auto... sinks) {
        constexpr std::size_t rows = std::size_t{detail::block_size} * detail::rows_of_a_thread;
        constexpr auto kernel = detail::for_each_tiled_kernel<Tile, decltype(late_sink), decltype(sinks)...>;
        // As many blocks as the device holds at a time, for rows first; where there are few rows, columns are shared out.
        const std::size_t room = detail::resident_blocks<kernel>(on);
        const std::size_t across = std::min(room, (n + rows - 1) / rows);
        const std::size_t down = std::min({room / across + 1, std::size_t{detail::blocks_for(m)}, std::size_t{65535}});
        const dim3 blocks(static_cast<unsigned>(across), static_cast<unsigned>(down));
        kernel<<<blocks, detail::block_size, 0, on.stream>>>(n, m, tile, late_sink, sinks...);
        detail::check_launch("for_each_tiled");
        detail::launch_settle(on, settle, deliver, late_sink, sinks...);
    };
    detail::gather(on, launch, late, queues...);
}

namespace detail {

/// CUB's protocol: ask for the size of its scratch, then run with it.
template <class Call>
void with_scratch(const cuda& on, const char* name, const Call& call) {
    const current_device scope(on);
    std::size_t bytes = 0;
    check(call(nullptr, bytes), name);
    buffer<unsigned char, device_space> scratch(on, std::max<std::size_t>(bytes, 1));
    check(call(static_cast<void*>(scratch.data()), bytes), name);
}

}  // namespace detail

template <class T, class Combine, class F>
void reduce_into(const cuda& on, std::size_t n, T* out, T init, const Combine& combine, const F& f) {
    const thrust::counting_iterator<std::size_t> indices(0);
    detail::with_scratch(on, "cub::DeviceReduce::TransformReduce", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceReduce::TransformReduce(scratch, bytes, indices, out, n, combine, f, init, on.stream);
    });
}

template <class T, class Combine, class F>
T reduce(const cuda& on, std::size_t n, T init, const Combine& combine, const F& f) {
    buffer<T, device_space> out(on, 1);
    reduce_into(on, n, out.data(), init, combine, f);
    download(on, out.data(), 1, &init);
    return init;
}

template <class T>
void exclusive_scan(const cuda& on, T* values, std::size_t n) {
    const detail::current_device scope(on);
    detail::check(cudaMemsetAsync(values + n, 0, sizeof(T), on.stream), "cudaMemsetAsync");
    detail::with_scratch(on, "cub::DeviceScan::ExclusiveSum", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceScan::ExclusiveSum(scratch, bytes, values, values, n + 1, on.stream);
    });
}

template <class Key>
void sort_keys(const cuda& on, buffer<Key, device_space>& keys, int bits) {
    if (keys.size() < 2) return;
    buffer<Key, device_space> other(on, keys.size());
    cub::DoubleBuffer<Key> both(keys.data(), other.data());
    detail::with_scratch(on, "cub::DeviceRadixSort::SortKeys", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortKeys(scratch, bytes, both, keys.size(), 0, bits, on.stream);
    });
    if (both.Current() != keys.data()) keys.swap(other);
}

template <class Key, class Value>
void sort_by_key(const cuda& on, buffer<Key, device_space>& keys, buffer<Value, device_space>& values, int bits) {
    if (keys.size() < 2) return;
    buffer<Key, device_space> other_keys(on, keys.size());
    buffer<Value, device_space> other_values(on, keys.size());
    cub::DoubleBuffer<Key> both_keys(keys.data(), other_keys.data());
    cub::DoubleBuffer<Value> both_values(values.data(), other_values.data());
    detail::with_scratch(on, "cub::DeviceRadixSort::SortPairs", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortPairs(scratch, bytes, both_keys, both_values, keys.size(), 0, bits, on.stream);
    });
    if (both_keys.Current() != keys.data()) keys.swap(other_keys);
    if (both_values.Current() != values.data()) values.swap(other_values);
}

template <class Test, class Index>
std::size_t compact(const cuda& on, std::size_t n, const Test& test, Index* out) {
    if (n == 0) return 0;
    buffer<std::uint64_t, device_space> kept(on, 1);
    const thrust::counting_iterator<Index> indices(0);
    detail::with_scratch(on, "cub::DeviceSelect::If", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceSelect::If(scratch, bytes, indices, out, kept.data(), n, test, on.stream);
    });
    std::uint64_t count = 0;
    download(on, kept.data(), 1, &count);
    return count;
}

namespace detail {

template <class T>
struct store {
    T* out;
    T value;
    __device__ void operator()(std::size_t i) const { out[i] = value; }
};

}  // namespace detail

template <class T>
void fill(const cuda& on, T* out, std::size_t n, const T& value) {
    for_each_index(on, n, detail::store<T>{out, value});
}

}  // namespace abut::execution
