// SPDX-License-Identifier: MIT
#pragma once

// The sorts, scans and selections of `cuda`, made of CUB's. Programs that link the target abut::cuda_verbs find those of the
// usual types compiled there, and neither read nor compile CUB (execution/cuda_verbs.hpp); the target's one source is made
// of this header. Such a program includes it where it needs other types.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>
#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <abut/execution/cuda.hpp>
#include <abut/execution/cuda_compiled.hpp>
#include <abut/execution/cuda_loops.hpp>

namespace abut::execution::detail {

template <class... Types>
struct cub_of {};

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

template <class Key>
bool sort_keys_of(const cuda& on, Key* keys, Key* other, std::size_t n, int bits) {
    if (n <= few_keys) {
        const current_device scope(on);
        constexpr unsigned ranks_of_block = block_size / warp_size * ranks_of_warp;
        const auto count = static_cast<unsigned>(n);
        rank_kernel<<<(count + ranks_of_block - 1) / ranks_of_block, block_size, 0, on.stream>>>(count, keys, other);
        check_launch("sort_keys");
        return true;
    }
    cub::DoubleBuffer<Key> both(keys, other);
    with_scratch(on, "cub::DeviceRadixSort::SortKeys", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortKeys(scratch, bytes, both, n, 0, bits, on.stream);
    });
    return both.Current() != keys;
}

template <class Key, class Value>
moved_pairs sort_pairs_of(const cuda& on, Key* keys, Key* other_keys, Value* values, Value* other_values, std::size_t n,
                          int bits) {
    cub::DoubleBuffer<Key> both_keys(keys, other_keys);
    cub::DoubleBuffer<Value> both_values(values, other_values);
    with_scratch(on, "cub::DeviceRadixSort::SortPairs", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortPairs(scratch, bytes, both_keys, both_values, n, 0, bits, on.stream);
    });
    return {both_keys.Current() != keys, both_values.Current() != values};
}

template <class T>
void scan_of(const cuda& on, T* values, std::size_t n) {
    with_scratch(on, "cub::DeviceScan::ExclusiveSum", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceScan::ExclusiveSum(scratch, bytes, values, values, n, on.stream);
    });
}

/// Bit i of words.
struct bit_at {
    const std::uint32_t* words;
    __device__ bool operator()(std::size_t i) const { return (words[i / warp_size] >> i % warp_size & 1u) != 0; }
};

template <class Index>
void select_of(const cuda& on, const std::uint32_t* words, std::size_t n, Index* out, std::uint64_t* count) {
    const thrust::counting_iterator<Index> indices(0);
    const thrust::transform_iterator<bit_at, thrust::counting_iterator<std::size_t>, bool> wanted(
        thrust::counting_iterator<std::size_t>(0), bit_at{words});
    with_scratch(on, "cub::DeviceSelect::Flagged", [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceSelect::Flagged(scratch, bytes, indices, wanted, out, count, n, on.stream);
    });
}

}  // namespace abut::execution::detail
