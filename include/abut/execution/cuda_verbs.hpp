// SPDX-License-Identifier: MIT
#pragma once

// The verbs of `cuda` (execution/policy.hpp lists them). Scans, sorts and selections are CUB's (execution/cuda_cub.hpp),
// compiled here or in the target abut::cuda_verbs; reductions are in execution/cuda_reduce.hpp, the loops in
// execution/cuda_loops.hpp, and what is left is execution/generic.hpp's.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <cuda_runtime.h>

#include <abut/config.hpp>
#include <abut/execution/cuda.hpp>
#include <abut/execution/cuda_compiled.hpp>
#include <abut/execution/cuda_loops.hpp>
#include <abut/execution/cuda_queue.hpp>
#include <abut/execution/cuda_reduce.hpp>
#include <abut/execution/cuda_schedules.hpp>
#include <abut/execution/generic.hpp>
#if !ABUT_CUDA_VERBS_COMPILED
#include <abut/execution/cuda_cub.hpp>
#endif

namespace abut::execution {

namespace detail {

/// What is sorted and added up are unsigned words, by any of their names; and of what a sort carries only the size matters:
/// buffers are aligned for any.
template <class T>
using word_of = std::conditional_t<
    !std::is_trivially_copyable_v<T>, T,
    std::conditional_t<sizeof(T) == 4, std::uint32_t, std::conditional_t<sizeof(T) == 8, std::uint64_t, T>>>;
template <class T>
using unsigned_word_of = std::conditional_t<std::unsigned_integral<T>, word_of<T>, T>;

/// A bit for each index, in words: whether it passes the test.
template <class Test>
__global__ void __launch_bounds__(block_size) test_kernel(std::size_t n, Test test, std::uint32_t* words) {
    const std::size_t i = std::size_t{blockIdx.x} * block_size + threadIdx.x;
    const bool passes = i < n && static_cast<bool>(test(i));
    const unsigned word = __ballot_sync(0xffffffff, passes);
    if (i % warp_size == 0 && i < n) words[i / warp_size] = word;
}

}  // namespace detail

template <class T>
void exclusive_scan(const cuda& on, T* values, std::size_t n) {
    using word = detail::unsigned_word_of<T>;
    constexpr bool can = detail::can_compile<word>;
    static_assert(can,
                  "abut: exclusive_scan: the target abut::cuda_verbs has it for 32 and 64 bit unsigned integers: for other "
                  "types include <abut/execution/cuda_cub.hpp> before this is used");
    if constexpr (can) {
        const detail::current_device scope(on);
        detail::check(cudaMemsetAsync(values + n, 0, sizeof(T), on.stream), "cudaMemsetAsync");
        detail::scan_of(on, reinterpret_cast<word*>(values), n + 1);
    }
}

template <class Key>
void sort_keys(const cuda& on, buffer<Key, device_space>& keys, int bits) {
    using word = detail::unsigned_word_of<Key>;
    constexpr bool can = detail::can_compile<word>;
    static_assert(can,
                  "abut: sort_keys: the target abut::cuda_verbs has it for 32 and 64 bit keys: for others include "
                  "<abut/execution/cuda_cub.hpp> before this is used");
    if constexpr (can) {
        if (keys.size() < 2) return;
        buffer<Key, device_space> other(on, keys.size());
        if (detail::sort_keys_of(on, reinterpret_cast<word*>(keys.data()), reinterpret_cast<word*>(other.data()),
                                 keys.size(), bits)) {
            keys.swap(other);
        }
    }
}

template <class Key, class Value>
void sort_by_key(const cuda& on, buffer<Key, device_space>& keys, buffer<Value, device_space>& values, int bits) {
    using word = detail::unsigned_word_of<Key>;
    using carried = detail::word_of<Value>;
    constexpr bool can = detail::can_compile<word, carried>;
    static_assert(can,
                  "abut: sort_by_key: the target abut::cuda_verbs has it for 32 and 64 bit keys with values of 4 and 8 "
                  "bytes: for others include <abut/execution/cuda_cub.hpp> before this is used");
    if constexpr (can) {
        if (keys.size() < 2) return;
        buffer<Key, device_space> other_keys(on, keys.size());
        buffer<Value, device_space> other_values(on, keys.size());
        const detail::moved_pairs moved = detail::sort_pairs_of(
            on, reinterpret_cast<word*>(keys.data()), reinterpret_cast<word*>(other_keys.data()),
            reinterpret_cast<carried*>(values.data()), reinterpret_cast<carried*>(other_values.data()), keys.size(), bits);
        if (moved.keys) keys.swap(other_keys);
        if (moved.values) values.swap(other_values);
    }
}

template <class Test, class Index>
std::size_t compact(const cuda& on, std::size_t n, const Test& test, Index* out) {
    using word = detail::unsigned_word_of<Index>;
    constexpr bool can = detail::can_compile<word>;
    static_assert(can,
                  "abut: compact: the target abut::cuda_verbs has it for 32 and 64 bit unsigned indices: for others include "
                  "<abut/execution/cuda_cub.hpp> before this is used");
    std::uint64_t count = 0;
    if constexpr (can) {
        if (n == 0) return 0;
        const detail::current_device scope(on);
        buffer<std::uint64_t, device_space> kept(on, 1);
        buffer<std::uint32_t, device_space> words(on, (n + detail::warp_size - 1) / detail::warp_size);
        const std::size_t blocks = (n + detail::block_size - 1) / detail::block_size;
        detail::test_kernel<<<static_cast<unsigned>(blocks), detail::block_size, 0, on.stream>>>(n, test, words.data());
        detail::check_launch("compact");
        detail::select_of(on, words.data(), n, reinterpret_cast<word*>(out), kept.data());
        download(on, kept.data(), 1, &count);
    }
    return count;
}

}  // namespace abut::execution
