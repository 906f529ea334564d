// SPDX-License-Identifier: MIT

#include "collide/random_mesh_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("meshes against meshes: no pair is lost in random runs", "", float, double) {
    check_random_runs<TestType>([](draws& d, const auto& scene, const pair_list& expected, std::string& told) {
        const int threads = d.below(4);
        told = threads == 0 ? "serial; " : "openmp, " + std::to_string(threads) + " threads; ";
        return threads == 0 ? random_runs::run(serial{}, d, scene, expected, told)
                            : random_runs::run(openmp{.threads = threads}, d, scene, expected, told);
    });
}

}  // namespace abut::test
