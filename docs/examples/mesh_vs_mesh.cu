// SPDX-License-Identifier: MIT
//
// A mesh against a mesh on a GPU. mesh_vs_mesh.cpp is the same program on the processor; all but the policy is in
// mesh_vs_mesh.hpp. It is compiled for fewer combinations, because each costs a good deal of compile time.

#include <string>
#include <vector>

#include <cuda_runtime_api.h>

#include <abut/cuda.hpp>

#include "mesh_vs_mesh.hpp"
#include "program.hpp"

namespace {

struct program {
    static constexpr const char* name = "mesh_vs_mesh_cuda";
    static constexpr const char* note =
        "\nThis program runs on CUDA, in float and filtered; mesh_vs_mesh has double, fast and exact too.\n";
    static constexpr bool has_threads = false;
    using scalars = example::types<float>;
    using arithmetics = example::types<abut::filtered>;

    static std::vector<std::string> policies() { return {"cuda"}; }
    static void require_device() {
        int devices = 0;
        const cudaError_t outcome = cudaGetDeviceCount(&devices);
        if (outcome == cudaSuccess && devices > 0) return;
        throw abut::error(std::string("no CUDA device can be used here: ") + cudaGetErrorString(outcome));
    }
    template <class Run>
    static void with_policy(const mesh_vs_mesh::settings&, const Run& run) {
        run(abut::cuda{});
    }
};

}  // namespace

int main(int argc, char** argv) { return mesh_vs_mesh::main<program>(argc, argv); }
