// SPDX-License-Identifier: MIT
//
// One triangle against many on the processor and on a GPU, compared. triangle_vs_many.cpp is the same program without the
// GPU; all but the policies is in triangle_vs_many.hpp. It is compiled for fewer combinations, because each costs a good
// deal of compile time.

#include <string>
#include <vector>

#include <cuda_runtime_api.h>

#include <abut/cuda.hpp>

#include "program.hpp"
#include "triangle_vs_many.hpp"

namespace {

struct program {
    static constexpr const char* name = "triangle_vs_many_cuda";
    static constexpr const char* note =
        "\nThis program has CUDA, in float and filtered; triangle_vs_many has double, fast and exact too.\n";
    using scalars = example::types<float>;
    using arithmetics = example::types<abut::filtered>;

    static std::vector<std::string> policies() { return {"serial", "openmp", "cuda"}; }
    static void require_device(const std::string& policy) {
        if (policy != "cuda") return;
        int devices = 0;
        const cudaError_t outcome = cudaGetDeviceCount(&devices);
        if (outcome == cudaSuccess && devices > 0) return;
        throw abut::error(std::string("no CUDA device can be used here: ") + cudaGetErrorString(outcome));
    }
    template <class Run>
    static void with_policy(const triangle_vs_many::settings& s, const std::string& policy, const Run& run) {
        if (policy == "serial") return run(abut::serial{});
        if (policy == "openmp") return run(abut::openmp{.threads = s.threads});
        run(abut::cuda{});
    }
};

}  // namespace

int main(int argc, char** argv) { return triangle_vs_many::main<program>(argc, argv); }
