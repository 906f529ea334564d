// SPDX-License-Identifier: MIT
//
// Clashes of the parts of a scene, on a GPU. clash.cpp is the same program on the processor; all but the policy is in clash.hpp.

#include <abut/cuda.hpp>

#include "clash.hpp"
#include "program_cuda.hpp"

namespace {

struct program : example::cuda_program {
    static constexpr const char* name = "clash_cuda";
    static constexpr const char* note = "\nThis program runs on CUDA, in float; clash has double too.\n";
};

}  // namespace

int main(int argc, char** argv) { return clash::main<program>(argc, argv); }
