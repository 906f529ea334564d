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

struct program {
    static constexpr const char* name = "triangle_vs_many";
    static constexpr const char* note = "";
    using scalars = example::types<float, double>;
    using arithmetics = example::types<abut::filtered, abut::fast, abut::exact>;

    static std::vector<std::string> policies() { return {"serial", "openmp"}; }
    static void require_device(const std::string&) {}
    template <class Run>
    static void with_policy(const triangle_vs_many::settings& s, const std::string& policy, const Run& run) {
        if (policy == "serial") return run(abut::serial{});
        run(abut::openmp{.threads = s.threads});
    }
};

}  // namespace

int main(int argc, char** argv) { return triangle_vs_many::main<program>(argc, argv); }
