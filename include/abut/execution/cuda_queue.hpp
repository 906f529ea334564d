// SPDX-License-Identifier: MIT
#pragma once

// The queues of execution/work_queue.hpp in device memory: a sink counts in a word of device memory, and `settle` is told
// what it counted. And those words.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <cuda_runtime.h>

#include <abut/execution/cuda.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::execution {

namespace detail {

/// Counters of the loops with queues: some words of a device's memory that are 0 between calls, and page-locked words that a
/// kernel writes them to when it ends. One of each for each host thread, which waits for a loop before it starts another. So
/// a loop takes no filling and no copy besides its kernels.
class loop_counters {
public:
    static constexpr unsigned most = 15;  // and one for the kernel's own use

    explicit loop_counters(int device) {
        const current_device scope(device);
        check(cudaMalloc(reinterpret_cast<void**>(&words_), (most + 1) * sizeof(std::uint64_t)), "cudaMalloc");
        check(cudaHostAlloc(reinterpret_cast<void**>(&read_), most * sizeof(std::uint64_t),
                            cudaHostAllocPortable | cudaHostAllocMapped),
              "cudaHostAlloc");
    }
    loop_counters(const loop_counters&) = delete;
    loop_counters& operator=(const loop_counters&) = delete;
    ~loop_counters() {
        cudaFree(words_);
        cudaFreeHost(read_);
    }

    [[nodiscard]] static loop_counters& of_this_thread(int device) {
        thread_local std::map<int, loop_counters> all;
        return all.try_emplace(device, device).first->second;
    }

    /// Before a loop: makes sure of the zeros, which a loop that failed may not have left.
    void begin(cudaStream_t stream) {
        if (!clean_) check(cudaMemsetAsync(words_, 0, (most + 1) * sizeof(std::uint64_t), stream), "cudaMemsetAsync");
        clean_ = false;
    }
    /// After a loop: waits for it.
    void end(cudaStream_t stream) {
        check(cudaStreamSynchronize(stream), "cudaStreamSynchronize");
        clean_ = true;
    }
    [[nodiscard]] std::uint64_t* words() { return words_; }
    [[nodiscard]] std::uint64_t* read() { return read_; }

private:
    std::uint64_t *words_ = nullptr, *read_ = nullptr;
    bool clean_ = false;
};

inline __device__ unsigned lane_id() {
    unsigned lane;
    asm("mov.u32 %0, %%laneid;" : "=r"(lane));
    return lane;
}

}  // namespace detail

template <class T>
class work_queue<T, device_space> {
public:
    struct sink {
        using value_type = T;
        T* data;
        std::uint64_t capacity;
        std::uint64_t* count;
        /// Takes k places, and returns the first.
        __device__ std::uint64_t reserve(std::uint64_t k) const { return atomic_add(count, k); }
        __device__ void put(std::uint64_t place, const T& value) const {
            if (place < capacity) data[place] = value;
        }
        /// The lanes of a warp that push together count together.
        __device__ void push(const T& value) const {
            const unsigned lanes = __activemask();
            const int leader = __ffs(static_cast<int>(lanes)) - 1;
            const unsigned lane = detail::lane_id();
            std::uint64_t first = 0;
            if (static_cast<int>(lane) == leader) first = reserve(static_cast<unsigned>(__popc(lanes)));
            put(__shfl_sync(lanes, first, leader) + __popc(lanes & ((1u << lane) - 1)), value);
        }
        __device__ void close() const {}
    };

    explicit work_queue(const cuda& on, std::size_t expected = 1 << 16) : items_(on, expected) {}

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
    void absorb(const cuda&, const work_count& more) { total_ += more.total_; }
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
    void absorb(const cuda&, const work_flag& more) { raised_ |= more.raised_; }
    [[nodiscard]] sink make_sink(std::uint64_t* word) { return {word}; }
    [[nodiscard]] bool settle(const cuda&, std::uint64_t word) {
        raised_ = word != 0;
        return true;
    }

private:
    bool raised_ = false;
};

}  // namespace abut::execution
