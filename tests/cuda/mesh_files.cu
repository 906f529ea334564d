// SPDX-License-Identifier: MIT
// long to compile
//
// A file of its own, since it is left out where FCL is not there. Eigen, which FCL includes, marks
// functions for devices in a way that nvcc warns of, unless it is told not to. nvcc: -DEIGEN_NO_CUDA
#include <abut/cuda.hpp>

#include "collide/fcl_mesh_cases.hpp"
#include "collide/mesh_file_cases.hpp"

namespace abut::test {

TEST_CASE("meshes against meshes: FCL finds the same pairs in general position: cuda") { check_fcl_shapes(cuda{}); }

TEST_CASE("meshes against meshes: FCL finds the same pairs of real files: cuda") { check_fcl_files(cuda{}); }

TEMPLATE_TEST_CASE("meshes against meshes: the robot of FCL's tests in its room: cuda", "", float, double) {
    check_robot_file<TestType>(cuda{}, 20);
}

TEST_CASE("meshes against meshes: a scan against itself: cuda") { check_scan_file<double>(cuda{}, 12); }

}  // namespace abut::test
