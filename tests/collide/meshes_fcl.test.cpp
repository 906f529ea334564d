// SPDX-License-Identifier: MIT

#include "collide/fcl_mesh_cases.hpp"

namespace abut::test {

TEST_CASE("meshes against meshes: FCL finds the same pairs in general position") {
    check_fcl_shapes(serial{});
    check_fcl_shapes(openmp{.threads = 3});
}

TEST_CASE("meshes against meshes: FCL finds the same pairs of real files: serial") { check_fcl_files(serial{}); }

TEST_CASE("meshes against meshes: FCL finds the same pairs of real files: openmp") { check_fcl_files(openmp{.threads = 3}); }

}  // namespace abut::test
