// SPDX-License-Identifier: MIT
//
// Spheres against a mesh on the processor. spheres_vs_mesh.cu is the same program on a GPU; all but the policy is in
// spheres_vs_mesh.hpp.

#include <abut/abut.hpp>

#include "spheres_vs_mesh.hpp"
#include "program.hpp"

namespace {

struct program : example::host_program {
    static constexpr const char* name = "spheres_vs_mesh";
};

}  // namespace

int main(int argc, char** argv) { return spheres_vs_mesh::main<program>(argc, argv); }
