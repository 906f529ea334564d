// SPDX-License-Identifier: MIT
//
// A cloth in motion on a GPU. cloth_ccd.cpp is the same program on the processor; all but the policy is in cloth_ccd.hpp.

#include <abut/cuda.hpp>

#include "cloth_ccd.hpp"
#include "program_cuda.hpp"

namespace {

struct program : example::cuda_program {
    static constexpr const char* name = "cloth_ccd_cuda";
    static constexpr bool has_conservative = false;
    static constexpr const char* note =
        "\nThis program runs on CUDA, in float and filtered; cloth_ccd has double and the other arithmetics too.\n";
};

}  // namespace

int main(int argc, char** argv) { return cloth_ccd::main<program>(argc, argv); }
