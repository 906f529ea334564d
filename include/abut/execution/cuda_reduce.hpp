// SPDX-License-Identifier: MIT
#pragma once

// Reductions of `cuda`. They are our own: what is reduced, and how, is another type in each query, so that nothing could be
// compiled once, and CUB's kernels take ten times as long to compile. Values are added up in the same order on each device.

#include <algorithm>
#include <cstddef>

#include <cuda_runtime.h>

#include <abut/execution/buffer.hpp>
#include <abut/execution/cuda.hpp>
#include <abut/execution/cuda_loops.hpp>

namespace abut::execution {

namespace detail {

/// Threads of a block, whose sums have to find room in shared memory.
template <class T>
inline constexpr unsigned fold_block = sizeof(T) <= 128 ? block_size : 2 * warp_size;
/// Values that a thread asks for before it waits for the first of them.
template <class T>
inline constexpr unsigned fold_rows = sizeof(T) <= 16 ? 4 : 2;
/// More blocks would leave more sums than one block adds up quickly.
inline constexpr std::size_t most_fold_blocks = 1024;

/// Each block leaves the sum of its share of values, or of sums that blocks have left.
template <class T, class Combine, class F>
__global__ void __launch_bounds__(fold_block<T>)
    fold_kernel(std::size_t n, const T* sums_before, T* out, T init, Combine combine, F f) {
    constexpr unsigned rows = fold_rows<T>;
    alignas(T) __shared__ unsigned char room[fold_block<T> * sizeof(T)];
    T* const sums = reinterpret_cast<T*>(room);
    const std::size_t stride = std::size_t{gridDim.x} * fold_block<T>;
    T sum = init;
    ABUT_ROLLED
    for (std::size_t i = std::size_t{blockIdx.x} * fold_block<T> + threadIdx.x; i < n; i += rows * stride) {
        T value[rows];
#pragma unroll
        for (unsigned row = 0; row < rows; ++row) {
            const std::size_t at = i + row * stride;
            value[row] = init;
            if (at < n) value[row] = sums_before != nullptr ? sums_before[at] : static_cast<T>(f(at));
        }
#pragma unroll
        for (unsigned row = 0; row < rows; ++row) {
            if (i + row * stride < n) sum = combine(sum, value[row]);
        }
    }
    sums[threadIdx.x] = sum;
    ABUT_ROLLED
    for (unsigned half = fold_block<T> / 2; half > 0; half /= 2) {
        __syncthreads();
        if (threadIdx.x < half) sums[threadIdx.x] = sum = combine(sum, sums[threadIdx.x + half]);
    }
    if (threadIdx.x == 0) out[blockIdx.x] = sum;
}

}  // namespace detail

template <class T, class Combine, class F>
void reduce_into(const cuda& on, std::size_t n, T* out, T init, const Combine& combine, const F& f) {
    constexpr unsigned threads = detail::fold_block<T>, tile = threads * detail::fold_rows<T>;
    const detail::current_device scope(on);
    const auto blocks = static_cast<unsigned>(std::min(n / tile, detail::most_fold_blocks));
    const auto fold = [&](unsigned grid, std::size_t count, const T* sums_before, T* to) {
        detail::fold_kernel<T, Combine, F><<<grid, threads, 0, on.stream>>>(count, sums_before, to, init, combine, f);
        detail::check_launch("reduce");
    };
    if (blocks <= 4) return fold(1, n, nullptr, out);
    buffer<T, device_space> sums(on, blocks);
    fold(blocks, n, nullptr, sums.data());
    fold(1, blocks, sums.data(), out);
}

}  // namespace abut::execution
