// SPDX-License-Identifier: MIT
//
// A mesh against a mesh on the processor. mesh_vs_mesh.cu is the same program on a GPU; all but the policy is in
// mesh_vs_mesh.hpp.

#include <abut/abut.hpp>

#include "mesh_vs_mesh.hpp"
#include "program.hpp"

namespace {

struct program : example::host_program {
    static constexpr const char* name = "mesh_vs_mesh";
};

}  // namespace

int main(int argc, char** argv) { return mesh_vs_mesh::main<program>(argc, argv); }
