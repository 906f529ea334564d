// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/self_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("pairs within a set: cuda") { abut::test::check_all_self<float>(abut::cuda{}); }

TEST_CASE("welded: cuda") { abut::test::check_all_welded<double>(abut::cuda{}); }
