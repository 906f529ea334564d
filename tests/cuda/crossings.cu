// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/crossing_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("crossings: cuda", "", float, double) {
    abut::test::check_crossings<TestType>(abut::cuda{});
    abut::test::check_self_crossings<TestType>(abut::cuda{});
}
