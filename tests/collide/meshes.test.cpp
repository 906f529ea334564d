// SPDX-License-Identifier: MIT

#include "collide/mesh_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("meshes against meshes", "", float, double) {
    SECTION("serial") { check_all_meshes<TestType>(serial{}); }
    SECTION("openmp") { check_all_meshes<TestType>(openmp{.threads = 3}); }
}

}  // namespace abut::test
