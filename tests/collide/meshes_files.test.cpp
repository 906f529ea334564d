// SPDX-License-Identifier: MIT

#include "collide/mesh_cases.hpp"

#include <abut/io/read.hpp>

#include "io/support.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("meshes against meshes: the robot of FCL's tests in its room", "", float, double) {
    using T = TestType;
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    const auto env = io::read_mesh<T>(*folder / "env.obj"), rob = io::read_mesh<T>(*folder / "rob.obj");
    check_env_and_rob<T>(serial{}, env, rob, 60);
    check_env_and_rob<T>(openmp{.threads = 3}, env, rob, 20);
}

TEMPLATE_TEST_CASE("meshes against meshes: a scan against itself", "", float, double) {
    using T = TestType;
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    const auto scan = io::read_mesh<T>(*folder / "armadillo_2766.ply");
    check_scan<T>(serial{}, scan, 12);
    check_scan<T>(openmp{.threads = 3}, scan, 6);
}

}  // namespace abut::test
