// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/hull_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("hulls: more queries, cuda") { abut::test::check_more_of_hulls<float>(abut::cuda{}); }
