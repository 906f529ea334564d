// SPDX-License-Identifier: MIT

#include "collide/mesh_file_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("meshes against meshes: the robot of FCL's tests in its room", "", float, double) {
    check_robot_file<TestType>(serial{}, 60);
    check_robot_file<TestType>(openmp{.threads = 3}, 20);
}

TEMPLATE_TEST_CASE("meshes against meshes: a scan against itself", "", float, double) {
    check_scan_file<TestType>(serial{}, 12);
    check_scan_file<TestType>(openmp{.threads = 3}, 6);
}

}  // namespace abut::test
