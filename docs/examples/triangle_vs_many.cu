// SPDX-License-Identifier: MIT
//
// One triangle against many on the processor and on a GPU, compared. triangle_vs_many.cpp is the same program without the
// GPU; all but the policies is in triangle_vs_many.hpp.

#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "program_cuda.hpp"
#include "triangle_vs_many.hpp"

namespace {

struct program : example::cuda_program {
    static constexpr const char* name = "triangle_vs_many_cuda";
    static constexpr const char* note =
        "\nThis program has CUDA, in float and filtered; triangle_vs_many has double, fast and exact too.\n";
    static constexpr bool has_threads = true;

    static std::vector<std::string> policies() { return {"serial", "openmp", "cuda"}; }
    static void require_device(const std::string& policy) {
        if (policy == "cuda") cuda_program::require_device(policy);
    }
    template <class Run>
    static void with_policy(const std::string& policy, int threads, const Run& run) {
        if (policy == "cuda") return run(abut::cuda{});
        example::host_program::with_policy(policy, threads, run);
    }
};

}  // namespace

int main(int argc, char** argv) { return triangle_vs_many::main<program>(argc, argv); }
