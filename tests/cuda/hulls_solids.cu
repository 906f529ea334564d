// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/hull_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("hulls: with cylinders and cones, cuda") {
    abut::test::check_hulls_and_solids<abut::cylinder<float>>(abut::cuda{});
    abut::test::check_hulls_and_solids<abut::cone<double>>(abut::cuda{});
}
