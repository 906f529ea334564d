// SPDX-License-Identifier: MIT

#include "collide/fcl_mesh_cases.hpp"

namespace abut::test {

TEST_CASE("meshes against meshes: FCL finds the same pairs in general position") { check_fcl_shapes(serial{}); }

TEST_CASE("meshes against meshes: FCL finds the same pairs of real files") { check_fcl_files(serial{}); }

}  // namespace abut::test
