// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/raycast_solids_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("raycast of solids: cuda") {
    const abut::cuda on;
    abut::test::check_raycast_of<abut::sphere<float>>(on);
    abut::test::check_raycast_of<abut::aabb<float>>(on);
    abut::test::check_raycast_of<abut::capsule<float>>(on);
    abut::test::check_raycast_of<abut::cone<double>>(on);
    abut::test::check_raycast_scales_of<abut::sphere<float>>(on);
    abut::test::check_raycast_scales_of<abut::cylinder<double>>(on);
}
