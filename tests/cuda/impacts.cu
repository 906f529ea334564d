// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/impact_cases.hpp"
#include "support/catch.hpp"

using abut::test::ways;

TEST_CASE("impacts: cuda, float") {
    abut::test::check_all_impacts<float, ways::conservative_too>(abut::cuda{});
    abut::test::check_small_impacts<float, ways::conservative_too>(abut::cuda{});
    abut::test::check_first_of_many<float>(abut::cuda{});
}

TEST_CASE("impacts: cuda, float, thousands of faces") { abut::test::check_large_impacts<float>(abut::cuda{}); }

TEST_CASE("impacts: cuda, candidates that find no room") { abut::test::check_many_candidates<float>(abut::cuda{}); }

TEST_CASE("vertices and faces in motion in a query: cuda") {
    for (const auto& c : abut::test::impact_cases<float>()) {
        if (!c.follows) abut::test::check_moving_pairs(abut::cuda{}, c);
    }
}
