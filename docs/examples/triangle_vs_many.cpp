// SPDX-License-Identifier: MIT
//
// One triangle against many on the processor. triangle_vs_many.cu is the same program with a GPU beside it; all but the
// policies is in triangle_vs_many.hpp.

#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "program.hpp"
#include "triangle_vs_many.hpp"

namespace {

struct program : example::host_program {
    static constexpr const char* name = "triangle_vs_many";
    static std::vector<std::string> policies() { return {"serial", "openmp"}; }
};

}  // namespace

int main(int argc, char** argv) { return triangle_vs_many::main<program>(argc, argv); }
