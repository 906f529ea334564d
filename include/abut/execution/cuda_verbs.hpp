// SPDX-License-Identifier: MIT
#pragma once

// The verbs of `cuda` (execution/policy.hpp lists them). Reductions, scans, sorts and selections are CUB's; the loops are in
// execution/cuda_loops.hpp.

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
