// SPDX-License-Identifier: MIT
//
// A mesh against a mesh on the processor. mesh_vs_mesh.cu is the same program on a GPU; all but the policy is in
// mesh_vs_mesh.hpp.

#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "mesh_vs_mesh.hpp"
#include "program.hpp"

namespace {

struct program {
    static constexpr const char* name = "mesh_vs_mesh";
    static constexpr const char* note = "";
    static constexpr bool has_threads = true;
    using scalars = example::types<float, double>;
    using arithmetics = example::types<abut::filtered, abut::fast, abut::exact>;

    static std::vector<std::string> policies() { return {"openmp", "serial"}; }
    static void require_device() {}
    template <class Run>
    static void with_policy(const mesh_vs_mesh::settings& s, const Run& run) {
        if (s.policy == "serial") return run(abut::serial{});
        run(abut::openmp{.threads = s.threads});
    }
};

}  // namespace

int main(int argc, char** argv) { return mesh_vs_mesh::main<program>(argc, argv); }
