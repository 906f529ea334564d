// SPDX-License-Identifier: MIT
#pragma once

// A stream of a test's own, and what is captured on it.

#include <cuda_runtime.h>

#include "support/catch.hpp"

namespace abut::test {

/// A stream that waits for what is in it before it goes.
struct own_stream {
    cudaStream_t stream = nullptr;
    own_stream() { REQUIRE(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking) == cudaSuccess); }
    own_stream(const own_stream&) = delete;
    own_stream& operator=(const own_stream&) = delete;
    ~own_stream() {
        cudaStreamSynchronize(stream);
        cudaStreamDestroy(stream);
    }
};

}  // namespace abut::test
