// SPDX-License-Identifier: MIT
#pragma once

// What the benchmarks on CUDA that decide pairs of triangles one by one share: kernels that make the pairs of a family and
// decide them, and what is said of each row.

#include <cstddef>
#include <cstdint>

#include <cuda_runtime.h>

#include <abut/cuda.hpp>

#include "../tests/support/triangle_families.hpp"
#include "cuda_table.hpp"

namespace bench {

template <class T>
constexpr const char* scalar_name = sizeof(T) == 4 ? "float" : "double";

/// Which pairs touch, a byte each.
template <abut::arithmetic A, abut::scalar T>
struct decide_pair {
    const abut::test::triangle_pair<T>* pairs;
    std::uint8_t* touches;
    ABUT_HD void operator()(std::size_t i) const {
        touches[i] = static_cast<std::uint8_t>(abut::intersects<A>(pairs[i].a, pairs[i].b));
    }
};

template <abut::scalar T>
struct make_family_pair {
    std::uint64_t seed;
    abut::test::triangle_family family;
    abut::test::triangle_pair<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = abut::test::make_triangle_pair<T>(seed, family, i); }
};

struct byte_at {
    const std::uint8_t* bytes;
    ABUT_HD std::uint64_t operator()(std::size_t i) const { return bytes[i]; }
};
struct sum {
    ABUT_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

/// How many of the first n pairs touch.
inline double count_hits(const abut::cuda& on, std::size_t n, const std::uint8_t* touches) {
    return static_cast<double>(reduce(on, n, std::uint64_t{0}, sum{}, byte_at{touches}));
}

/// What a row says of n pairs: how many they are, the share that touches, and the kernel's registers and local memory.
template <abut::arithmetic A, abut::scalar T>
counters counters_of_pairs(std::size_t n, double hits) {
    cudaFuncAttributes kernel{};
    check(cudaFuncGetAttributes(&kernel, abut::execution::detail::for_each_kernel<decide_pair<A, T>>),
          "cudaFuncGetAttributes");
    return {{"items", static_cast<double>(n)},
            {"hits", hits / static_cast<double>(n)},
            {"registers", static_cast<double>(kernel.numRegs)},
            {"local_bytes", static_cast<double>(kernel.localSizeBytes)}};
}

}  // namespace bench
