// SPDX-License-Identifier: MIT
#pragma once

// What a device without memory does to a call, by a hog that leaves it less and less.

#include <cstddef>
#include <cstdio>
#include <new>
#include <stdexcept>

#include <abut/cuda.hpp>

#include "support/catch.hpp"

namespace abut::test {

/// Takes all memory of the device but some bytes, until the end of the scope.
class hog {
public:
    explicit hog(std::size_t but) {
        std::size_t free = 0, total = 0;
        // Not REQUIRE: of Catch2 3's in a constructor, cudafe++ of CUDA 13.0 does not come back.
        if (cudaMemGetInfo(&free, &total) != cudaSuccess) throw std::runtime_error("cudaMemGetInfo failed");
        // The system gives memory in pages of 2 MiB, and may keep some of what it calls free.
        for (std::size_t take = free > but ? free - but : 0; take > std::size_t{1} << 21; take -= std::size_t{1} << 21) {
            if (cudaMalloc(&taken_, take) == cudaSuccess) break;
            cudaGetLastError();
        }
    }
    hog(const hog&) = delete;
    hog& operator=(const hog&) = delete;
    ~hog() { cudaFree(taken_); }

private:
    void* taken_ = nullptr;
};

/// Runs `work`, which counts something, with more and more memory left. Each time it is the answer or std::bad_alloc. All
/// memory is given back, and afterwards the work succeeds.
template <class Work>
void check_out_of_device_memory(const char* what, const abut::cuda& on, const Work& work) {
    const auto expected = work();
    CHECK(expected > 0);
    release_memory(on);
    const memory_use before = memory_in_use(on);
    std::size_t failures = 0, successes = 0;
    for (std::size_t left = 0; successes < 2 && left < std::size_t{1} << 30; left += std::size_t{8} << 20) {
        CAPTURE(what, left);
        {
            const hog taken(left);
            try {
                const auto found = work();  // not within CHECK, which would catch what is thrown
                CHECK(found == expected);
                ++successes;
            } catch (const std::bad_alloc&) {
                ++failures;
            }
            synchronize(on);
            CHECK(cudaGetLastError() == cudaSuccess);
            CHECK(memory_in_use(on).used == before.used);
            release_memory(on);
        }
        CHECK(work() == expected);
        release_memory(on);
    }
    std::printf("%s: out of memory %zu times\n", what, failures);
    CHECK(failures > 3);
    CHECK(successes == 2);
}

}  // namespace abut::test
