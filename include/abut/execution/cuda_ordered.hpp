// SPDX-License-Identifier: MIT
#pragma once

// for_each_ordered of `cuda` and what it needs: a thread for each index, and the least of all indices in device
// memory.

#include <cstddef>
#include <cstdint>

#include <cuda_runtime.h>

#include <abut/execution/cuda.hpp>
#include <abut/execution/cuda_loops.hpp>
#include <abut/execution/cuda_verbs.hpp>
#include <abut/execution/ordered.hpp>

namespace abut::execution {

namespace detail {

struct value_at {
    const least_value* values;
    ABUT_HD least_value operator()(std::size_t i) const { return values[i]; }
};

/// Small blocks, since walks are of uneven length; and so many at a time that no thread has more than 64 registers: walks
/// wait for memory, and what needs more registers is called out of line.
inline constexpr unsigned ordered_block = 128, ordered_blocks_at_a_time = 8;

template <class Walk, class Sink>
__global__ void __launch_bounds__(ordered_block, ordered_blocks_at_a_time)
    for_each_ordered_kernel(std::size_t n, Walk walk, Sink sink) {
    const std::size_t i = std::size_t{blockIdx.x} * ordered_block + threadIdx.x;
    if (i < n) sink.begin(i);
    if (i < n) {
        walk(i, sink);
        sink.end(i);
    }
    sink.close();
}

}  // namespace detail

template <>
class best_of_all<device_space> {
public:
    /// Of one thread. The least value of all threads is one word; each warp leaves its own least value, with its key.
    struct sink {
        std::uint64_t* word;
        least_value* of_warps;
        least_value mine{};

        __device__ void begin(std::size_t) {}
        __device__ void offer(double value, std::uint64_t key) {
            mine.offer(value, key);
            if (value < bound()) atomic_min(word, static_cast<std::uint64_t>(__double_as_longlong(value)));
        }
        [[nodiscard]] __device__ double bound() const {
            return __longlong_as_double(static_cast<long long>(atomic_load(word)));
        }
        __device__ void end(std::size_t) {}
        /// Called by all threads of a block.
        __device__ void close() {
            for (int away = 16; away > 0; away /= 2) {
                const double value = __shfl_down_sync(0xffffffff, mine.value, away);
                const std::uint64_t key = __shfl_down_sync(0xffffffff, mine.key, away);
                mine.offer(value, key);
            }
            if (threadIdx.x % detail::warp_size != 0) return;
            of_warps[(std::size_t{blockIdx.x} * detail::ordered_block + threadIdx.x) / detail::warp_size] = mine;
        }
    };

    explicit best_of_all(const cuda& on, double bound = least_value{}.value) : bound_(bound), word_(on, 1) {
        fill(on, word_.data(), 1, ABUT_BIT_CAST(std::uint64_t, bound));
    }
    [[nodiscard]] least_value least() const { return least_; }
    /// What it began with: all that is not above is worth looking at.
    [[nodiscard]] double bound() const { return bound_; }
    /// What was found otherwise.
    void offer(const least_value& found) { least_.offer(found.value, found.key); }

    [[nodiscard]] sink make_sink(std::size_t) { return {word_.data(), of_warps_.data()}; }
    void begin(const cuda& on, std::size_t n) {
        const std::size_t blocks = (n + detail::ordered_block - 1) / detail::ordered_block;
        of_warps_ = buffer<least_value, device_space>(on, blocks * (detail::ordered_block / detail::warp_size));
    }
    /// A template, so that its kernels are compiled only where it is called.
    template <class Policy>
    void end(const Policy& on) {
        least_ = reduce(on, of_warps_.size(), least_, lesser_value{}, detail::value_at{of_warps_.data()});
    }

private:
    least_value least_{};
    double bound_;
    buffer<std::uint64_t, device_space> word_;
    buffer<least_value, device_space> of_warps_;
};

template <class Walk, class Best>
void for_each_ordered(const cuda& on, std::size_t n, const Walk& walk, Best& best) {
    if (n == 0) return;
    const detail::current_device scope(on);
    best.begin(on, n);
    const auto blocks = static_cast<unsigned>((n + detail::ordered_block - 1) / detail::ordered_block);
    detail::for_each_ordered_kernel<<<blocks, detail::ordered_block, 0, on.stream>>>(n, walk, best.make_sink(0));
    detail::check_launch("for_each_ordered");
    best.end(on);
}

}  // namespace abut::execution
