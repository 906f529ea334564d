// SPDX-License-Identifier: MIT
//
// A mesh against a mesh on a GPU. mesh_vs_mesh.cpp is the same program on the processor; all but the policy is in
// mesh_vs_mesh.hpp.

#include <abut/cuda.hpp>

#include "mesh_vs_mesh.hpp"
#include "program_cuda.hpp"

namespace {

struct program : example::cuda_program {
    static constexpr const char* name = "mesh_vs_mesh_cuda";
    static constexpr const char* note =
        "\nThis program runs on CUDA, in float and filtered; mesh_vs_mesh has double, fast and exact too.\n";
};

}  // namespace

int main(int argc, char** argv) { return mesh_vs_mesh::main<program>(argc, argv); }
