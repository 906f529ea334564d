// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/turning_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("meetings of bodies that turn: cuda") {
    const abut::cuda on;
    abut::test::check_turning<float>(on, 24);
    abut::test::check_turning_triangles<double>(on, 24);
}
