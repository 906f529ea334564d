// SPDX-License-Identifier: MIT
#pragma once

// The verbs of `cuda` (execution/policy.hpp lists them). Reductions, scans, sorts and selections are CUB's; the loops are in
// execution/cuda_loops.hpp, and what is left is execution/generic.hpp's.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>
#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>

#include <abut/execution/cuda.hpp>
#include <abut/execution/cuda_loops.hpp>
#include <abut/execution/cuda_queue.hpp>
#include <abut/execution/cuda_schedules.hpp>
#include <abut/execution/generic.hpp>

namespace abut::execution {

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

/// Few keys are sorted by counting, for each, the keys before it: quadratic work, but in one short kernel, where a radix
/// sort is five or more that wait for each other.
inline constexpr std::size_t few_keys = 8192;
inline constexpr unsigned ranks_of_warp = 4;

/// A warp ranks some keys; each lane compares them with every 32nd key.
template <class Key>
__global__ void __launch_bounds__(block_size) rank_kernel(unsigned n, const Key* keys, Key* out) {
    constexpr unsigned tile = 2048;
    __shared__ Key staged[tile];
    const unsigned lane = threadIdx.x % warp_size;
    const unsigned first = (blockIdx.x * block_size + threadIdx.x) / warp_size * ranks_of_warp;
    Key mine[ranks_of_warp];
    unsigned rank[ranks_of_warp]{};
#pragma unroll
    for (unsigned k = 0; k < ranks_of_warp; ++k) mine[k] = keys[first + k < n ? first + k : n - 1];
    for (unsigned base = 0; base < n; base += tile) {
        const unsigned width = n - base < tile ? n - base : tile;
        __syncthreads();
        for (unsigned j = threadIdx.x; j < width; j += block_size) staged[j] = keys[base + j];
        __syncthreads();
        // Of equal keys the one that comes first is before; its own key is not before any.
        const unsigned before = first > base ? (first - base < width ? first - base : width) : 0;
        unsigned j = lane;
#pragma unroll 8
        for (; j < before; j += warp_size) {
#pragma unroll
            for (unsigned k = 0; k < ranks_of_warp; ++k) rank[k] += static_cast<unsigned>(staged[j] <= mine[k]);
        }
        for (; j < width && base + j < first + ranks_of_warp; j += warp_size) {
#pragma unroll
            for (unsigned k = 0; k < ranks_of_warp; ++k) {
                rank[k] += static_cast<unsigned>(staged[j] < mine[k] || (staged[j] == mine[k] && base + j < first + k));
            }
        }
#pragma unroll 8
        for (; j < width; j += warp_size) {
#pragma unroll
            for (unsigned k = 0; k < ranks_of_warp; ++k) rank[k] += static_cast<unsigned>(staged[j] < mine[k]);
        }
    }
#pragma unroll
    for (unsigned k = 0; k < ranks_of_warp; ++k) {
        unsigned sum = rank[k];
#pragma unroll
        for (unsigned away = warp_size / 2; away > 0; away /= 2) sum += __shfl_xor_sync(0xffffffff, sum, away);
        if (lane == 0 && first + k < n) out[sum] = mine[k];
    }
}

}  // namespace detail

template <class T, class Combine, class F>
void reduce_into(const cuda& on, std::size_t n, T* out, T init, const Combine& combine, const F& f) {
    const thrust::counting_iterator<std::size_t> indices(0);
    detail::with_scratch(on, "cub::DeviceReduce::TransformReduce", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceReduce::TransformReduce(scratch, bytes, indices, out, n, combine, f, init, on.stream);
    });
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
    if (keys.size() <= detail::few_keys) {
        const detail::current_device scope(on);
        const auto n = static_cast<unsigned>(keys.size());
        constexpr unsigned ranks_of_block = detail::block_size / detail::warp_size * detail::ranks_of_warp;
        detail::rank_kernel<<<(n + ranks_of_block - 1) / ranks_of_block, detail::block_size, 0, on.stream>>>(n, keys.data(),
                                                                                                             other.data());
        detail::check_launch("sort_keys");
        keys.swap(other);
        return;
    }
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

}  // namespace abut::execution
