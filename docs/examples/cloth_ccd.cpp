// SPDX-License-Identifier: MIT
//
// A cloth in motion on the processor. cloth_ccd.cu is the same program on a GPU; all but the policy is in cloth_ccd.hpp.

#include <abut/abut.hpp>

#include "cloth_ccd.hpp"
#include "program.hpp"

namespace {

struct program : example::host_program {
    static constexpr const char* name = "cloth_ccd";
    static constexpr bool has_conservative = true;
    using arithmetics = example::types<abut::filtered, abut::exact, abut::conservative, abut::fast>;
};

}  // namespace

int main(int argc, char** argv) { return cloth_ccd::main<program>(argc, argv); }
