// SPDX-License-Identifier: MIT
//
// Spheres against a mesh on a GPU. spheres_vs_mesh.cpp is the same program on the processor; all but the policy is in
// spheres_vs_mesh.hpp.

#include <abut/cuda.hpp>

#include "spheres_vs_mesh.hpp"
#include "program_cuda.hpp"

namespace {

struct program : example::cuda_program {
    static constexpr const char* name = "spheres_vs_mesh_cuda";
    static constexpr const char* note =
        "\nThis program runs on CUDA, in float and filtered; spheres_vs_mesh has double, fast and exact too.\n";
};

}  // namespace

int main(int argc, char** argv) { return spheres_vs_mesh::main<program>(argc, argv); }
