// SPDX-License-Identifier: MIT
#pragma once

// What the example programs on a GPU share, beside program.hpp.

#include <string>
#include <vector>

#include <cuda_runtime_api.h>

#include <abut/cuda.hpp>

#include "program.hpp"

namespace example {

/// host_program's counterpart. It is compiled for fewer combinations, because each costs a good deal of compile time.
struct cuda_program {
    static constexpr bool has_threads = false;
    using scalars = types<float>;
    using arithmetics = types<abut::filtered>;

    static std::vector<std::string> policies() { return {"cuda"}; }
    static void require_device(const std::string&) {
        int devices = 0;
        const cudaError_t outcome = cudaGetDeviceCount(&devices);
        if (outcome == cudaSuccess && devices > 0) return;
        throw abut::error(std::string("no CUDA device can be used here: ") + cudaGetErrorString(outcome));
    }
    template <class Run>
    static void with_policy(const std::string&, int, const Run& run) {
        run(abut::cuda{});
    }
};

}  // namespace example
