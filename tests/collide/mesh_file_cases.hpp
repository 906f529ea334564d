// SPDX-License-Identifier: MIT
#pragma once

// Real meshes against each other, on every policy.

#include <abut/io/read.hpp>

#include "collide/mesh_cases.hpp"
#include "io/support.hpp"
#include "support/catch.hpp"

namespace abut::test {

/// The robot of FCL's tests in its room.
template <scalar T, class Policy>
void check_robot_file(const Policy& on, int poses) {
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    check_env_and_rob<T>(on, io::read_mesh<T>(*folder / "env.obj"), io::read_mesh<T>(*folder / "rob.obj"), poses);
}

/// A scan against itself.
template <scalar T, class Policy>
void check_scan_file(const Policy& on, int poses) {
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    check_scan<T>(on, io::read_mesh<T>(*folder / "armadillo_2766.ply"), poses);
}

}  // namespace abut::test
