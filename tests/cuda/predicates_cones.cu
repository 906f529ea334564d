// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of all pairs of a cone and another shape.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("cones: cuda decides every family as the host does", "", abut::cone<float>, abut::cone<double>) {
    abut::test::check_revolutions<TestType>(abut::cuda{});
}
