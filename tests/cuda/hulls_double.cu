// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/hull_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("hulls: queries in double, cuda") { abut::test::check_hulls<double>(abut::cuda{}); }
