// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/random_mesh_cases.hpp"

namespace abut::test {

TEST_CASE("meshes against meshes: cuda") { check_all_meshes<float>(cuda{}); }

TEST_CASE("meshes against meshes: no pair is lost in random runs: cuda") {
    check_random_runs<float>([](draws& d, const auto& scene, const pair_list& expected, std::string& told) {
        return random_runs::run(cuda{}, d, scene, expected, told);
    });
}

}  // namespace abut::test
