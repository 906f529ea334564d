// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/inside_cases.hpp"
#include "collide/raycast_cases.hpp"
#include "collide/winding_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("raycast: cuda") {
    const abut::cuda on;
    abut::test::check_raycast<float>(on);
    abut::test::check_raycast<double>(on);
    abut::test::check_watertight<float>(on);
    abut::test::check_watertight<double>(on);
    abut::test::check_raycast_scales<float>(on);
    abut::test::check_raycast_scales<double>(on);
}

TEST_CASE("inside: cuda") {
    const abut::cuda on;
    abut::test::check_inside<float>(on);
    abut::test::check_inside<double>(on, 1);
}

TEST_CASE("winding number: cuda") {
    const abut::cuda on;
    abut::test::check_winding<float>(on);
    abut::test::check_winding_bits<double>(on);
}
