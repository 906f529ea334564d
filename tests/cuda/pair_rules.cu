// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/pair_rule_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("pair rules: cuda") {
    abut::test::check_all_rules<double>(abut::cuda{});
    abut::test::check_all_rules<float>(abut::cuda{});
}
