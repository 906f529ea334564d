// SPDX-License-Identifier: MIT
//
// Clashes of the parts of a scene, on the processor. clash.cu is the same program on a GPU; all but the policy is in clash.hpp.

#include <abut/abut.hpp>

#include "clash.hpp"
#include "program.hpp"

namespace {

struct program : example::host_program {
    static constexpr const char* name = "clash";
};

}  // namespace

int main(int argc, char** argv) { return clash::main<program>(argc, argv); }
