// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/impact_cases.hpp"
#include "support/catch.hpp"

// Apart from impacts.cu, so that two processes compile them.

TEST_CASE("impacts: cuda, double") {
    abut::test::check_all_impacts<double, abut::test::ways::filtered_alone>(abut::cuda{});
    abut::test::check_large_impacts<double>(abut::cuda{});
}
