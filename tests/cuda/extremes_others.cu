// SPDX-License-Identifier: MIT
// long to compile
//
// Queries at extremes, of other shapes; scenes are those of
// tests/collide/extremes.test.cpp, where host policies give the same exact answers.
#include <abut/cuda.hpp>

#include "collide/extreme_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("queries at extremes, other shapes: cuda", "", float, double) {
    abut::test::check_other_extreme_queries<TestType>(abut::cuda{});
}
