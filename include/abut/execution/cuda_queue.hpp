// SPDX-License-Identifier: MIT
#pragma once

// The queues of execution/work_queue.hpp in device memory: a sink counts in a word of device memory. After the loop each
// queue is asked has_room(count), about what its word has become. If all have, each is told to take_in(count); if not, to
// make_room, and the loop runs again. And those words.

#include <algorithm>
#include <bit>
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

/// Memory of a device that stays from loop to loop. From the pool, where the rest of a query's memory comes from, large
/// pieces would come and go with every call, and split what others need.
class kept_room {
public:
    kept_room() = default;
    kept_room(const kept_room&) = delete;
    kept_room& operator=(const kept_room&) = delete;
    ~kept_room() { cudaFree(memory_); }

    /// Room for that many bytes, not initialised. It grows by powers of two. What it held before is lost.
    [[nodiscard]] void* at_least(int device, std::size_t bytes) {
        if (bytes > bytes_) {
            const current_device scope(device);
            cudaFree(std::exchange(memory_, nullptr));
            bytes_ = 0;
            const std::size_t more = std::bit_ceil(bytes);
            check(cudaMalloc(&memory_, more), "cudaMalloc");
            bytes_ = more;
        }
        return memory_;
    }
    /// The same, if the device has so much; else all stays as it is. Returns for how many bytes there is room.
    std::size_t grow(int device, std::size_t bytes) {
        if (bytes > bytes_) {
            const current_device scope(device);
            void* more = nullptr;
            const std::size_t size = std::bit_ceil(bytes);
            if (cudaMalloc(&more, size) == cudaSuccess) {
                cudaFree(std::exchange(memory_, more));
                bytes_ = size;
            } else {
                cudaGetLastError();  // the refusal is an answer, and no error of the next call
            }
        }
        return bytes_;
    }

private:
    void* memory_ = nullptr;
    std::size_t bytes_ = 0;
};

/// Counters of the loops with queues: some words of a device's memory that are 0 between calls, and page-locked words that a
/// kernel writes them to when it ends. One of each for each host thread, which waits for a loop before it starts another. So
/// a loop takes no filling and no copy besides its kernels. And room for what loops leave open (0), and for what of that is
/// then left for the host (1).
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
    [[nodiscard]] kept_room& room(int use) { return rooms_[use]; }

private:
    std::uint64_t *words_ = nullptr, *read_ = nullptr;
    bool clean_ = false;
    kept_room rooms_[2];
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
        T* data;
        std::uint64_t capacity;
        std::uint64_t* count;
        /// A place. The lanes of a warp that ask together count together.
        [[nodiscard]] __device__ std::uint64_t take_place() const {
            const unsigned lanes = __activemask();
            const int leader = __ffs(static_cast<int>(lanes)) - 1;
            const unsigned lane = detail::lane_id();
            std::uint64_t first = 0;
            if (static_cast<int>(lane) == leader) first = atomic_add(count, static_cast<std::uint64_t>(__popc(lanes)));
            return __shfl_sync(lanes, first, leader) + __popc(lanes & ((1u << lane) - 1));
        }
        __device__ void push(const T& value) const {
            const std::uint64_t at = take_place();
            if (at < capacity) data[at] = value;
        }
        __device__ void close() const {}
    };

    explicit work_queue(const cuda& on, std::size_t expected = 1 << 16) : items_(on, expected) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] T* data() { return items_.data(); }
    [[nodiscard]] const T* data() const { return items_.data(); }
    [[nodiscard]] buffer<T, device_space> take() {
        items_.shrink(std::exchange(size_, 0));
        return std::move(items_);
    }
    void clear() { size_ = 0; }

    [[nodiscard]] sink make_sink(std::uint64_t* count) { return {items_.data() + size_, items_.size() - size_, count}; }
    [[nodiscard]] bool has_room(std::uint64_t count) const { return count <= items_.size() - size_; }
    void take_in(std::uint64_t count) { size_ += count; }
    void make_room(const cuda& on, std::uint64_t count) {
        if (has_room(count)) return;
        const std::size_t room = size_ + count + count / 8;  // what overflows a block varies from run to run
        if (size_ == 0) items_ = {};                         // first give back, then take: both never need to fit at once
        buffer<T, device_space> larger(on, room);
        copy(on, items_.data(), size_, larger.data());
        items_ = std::move(larger);
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
    [[nodiscard]] sink make_sink(std::uint64_t* sum) { return {sum}; }
    [[nodiscard]] bool has_room(std::uint64_t) const { return true; }
    void take_in(std::uint64_t sum) { total_ += sum; }
    void make_room(const cuda&, std::uint64_t) {}

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
    [[nodiscard]] sink make_sink(std::uint64_t* word) { return {word}; }
    [[nodiscard]] bool has_room(std::uint64_t) const { return true; }
    void take_in(std::uint64_t word) { raised_ |= word != 0; }
    void make_room(const cuda&, std::uint64_t) {}

private:
    bool raised_ = false;
};

template <class F>
class work_visit<F, device_space> {
public:
    struct sink {
        F visitor;
        std::uint64_t* word;
        template <class T>
        __device__ void push(const T& value) const {
            if (!raised() && !visitor(value)) atomic_store(reinterpret_cast<std::uint32_t*>(word), 1);
        }
        [[nodiscard]] __device__ bool raised() const {
            return atomic_load(reinterpret_cast<const std::uint32_t*>(word)) != 0;
        }
        __device__ void close() const {}
    };

    work_visit(const cuda&, const F& visitor) : visitor_(visitor) {}
    [[nodiscard]] bool raised() const { return raised_; }
    [[nodiscard]] sink make_sink(std::uint64_t* word) { return {visitor_, word}; }
    [[nodiscard]] bool has_room(std::uint64_t) const { return true; }
    void take_in(std::uint64_t word) { raised_ |= word != 0; }
    void make_room(const cuda&, std::uint64_t) {}

private:
    F visitor_;
    bool raised_ = false;
};

template <class T>
class bounded_queue<T, device_space> : public work_queue<T, device_space> {
    using base = work_queue<T, device_space>;

public:
    bounded_queue(const cuda& on, std::size_t most) : base(on, std::min(most, std::size_t{1} << 16)), most_(most) {}

    /// Of the last loop.
    [[nodiscard]] bool overflowed() const { return overflowed_; }

    [[nodiscard]] bool has_room(std::uint64_t count) const { return base::has_room(count) || is_too_much(count); }
    void take_in(std::uint64_t count) {
        overflowed_ = is_too_much(count);
        if (!overflowed_) base::take_in(count);
    }

private:
    [[nodiscard]] bool is_too_much(std::uint64_t count) const { return count > most_ - base::size(); }

    std::size_t most_;
    bool overflowed_ = false;
};

/// The first values of many: those that find room stay, and all are counted. In memory of its own it grows up to `most` values,
/// for whose sake the loop runs again.
template <class T>
class capped_queue<T, device_space> {
public:
    using sink = typename work_queue<T, device_space>::sink;

    /// Two queues of one thread and one `use` share their memory (detail::kept_room).
    capped_queue(const cuda& on, std::uint64_t capacity, int use = 1, std::uint64_t most = most_open)
        : use_(use), most_(most) {
        (void)room(on).at_least(device_of(on), std::max(capacity * sizeof(T), std::size_t{1} << 20));
        take_room(on, 0);
    }
    /// In memory of the caller's, which has to outlive it.
    capped_queue(T* room, std::uint64_t capacity) : most_(capacity), items_(room), capacity_(capacity) {}
    /// Number of values that were pushed.
    [[nodiscard]] std::uint64_t pushed() const { return pushed_; }
    [[nodiscard]] std::uint64_t capacity() const { return capacity_; }
    [[nodiscard]] const T* data() const { return items_; }

    [[nodiscard]] sink make_sink(std::uint64_t* count) { return {items_, capacity_, count}; }
    [[nodiscard]] bool has_room(std::uint64_t count) const { return count <= capacity_ || capacity_ >= most_; }
    void take_in(std::uint64_t count) { pushed_ = count; }
    void make_room(const cuda& on, std::uint64_t count) {
        if (has_room(count)) return;
        take_room(on, std::min(count, most_));
        if (count > capacity_) most_ = capacity_;  // the device has no more, or none is to be had
    }

private:
    [[nodiscard]] detail::kept_room& room(const cuda& on) const {
        return detail::loop_counters::of_this_thread(device_of(on)).room(use_);
    }
    /// What there is, and at least `values` if the device has it.
    void take_room(const cuda& on, std::uint64_t values) {
        capacity_ = std::min<std::uint64_t>(room(on).grow(device_of(on), values * sizeof(T)) / sizeof(T), most_);
        items_ = static_cast<T*>(room(on).at_least(device_of(on), 0));
    }

    int use_ = 0;
    std::uint64_t most_;
    T* items_ = nullptr;
    std::uint64_t capacity_ = 0, pushed_ = 0;
};

/// The same, filled from the end of the caller's memory on: two share one room, of which nobody knows how much each needs.
template <class T>
class capped_queue_from_end<T, device_space> : public capped_queue<T, device_space> {
    using base = capped_queue<T, device_space>;

public:
    struct sink : base::sink {
        __device__ void push(const T& value) const {
            const std::uint64_t at = this->take_place();
            if (at < this->capacity) this->data[this->capacity - 1 - at] = value;
        }
    };
    using base::base;
    [[nodiscard]] sink make_sink(std::uint64_t* count) { return {base::make_sink(count)}; }
};

/// A queue that counts on where `count` says, and not in the loop's word, which stays 0: so several loops fill it, one after
/// another, and nobody waits between them. Whoever makes it zeroes the count.
template <class Queue>
struct counted_queue : Queue {
    std::uint64_t* count;
    [[nodiscard]] typename Queue::sink make_sink(std::uint64_t* = nullptr) { return Queue::make_sink(count); }
};

/// What a loop leaves open. Where one hit will do, the loop rests when there is enough to finish first. Where more is left open
/// than has room, the loop runs again with as much room as that takes, up to most_open values.
template <class T, bool AnyWillDo>
class open_queue : public capped_queue<T, device_space> {
    using base = capped_queue<T, device_space>;
    static constexpr std::uint64_t enough = std::uint64_t{1} << 14;

public:
    struct sink : base::sink {
        std::uint64_t stop_at;
        [[nodiscard]] __device__ bool raised() const requires AnyWillDo { return atomic_load(this->count) >= stop_at; }
    };

    /// For a loop over no more than `pairs` candidates.
    open_queue(const cuda& on, std::uint64_t pairs)
        : base(on, std::min(pairs, most_open_at_first), 0, std::min(pairs, most_open)) {}
    /// In memory of the caller's, for a loop that never rests.
    open_queue(T* room, std::uint64_t capacity) : base(room, capacity), patient_(true) {}

    [[nodiscard]] sink make_sink(std::uint64_t* count) {
        return {base::make_sink(count), patient_ ? ~std::uint64_t{0} : enough};
    }
    /// Whether the loop came to its end. If not, the next one will.
    [[nodiscard]] bool is_complete() {
        const bool complete = !AnyWillDo || patient_ || this->pushed() < enough;
        patient_ = true;
        return complete;
    }
    /// How many values found no room; then none of them has been finished.
    [[nodiscard]] std::uint64_t unfinished() const { return this->pushed() > this->capacity() ? this->pushed() : 0; }

private:
    bool patient_ = false;
};

}  // namespace abut::execution
