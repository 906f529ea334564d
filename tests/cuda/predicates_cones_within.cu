// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("within, cones: cuda decides every family as the host does", "", abut::cone<float>, abut::cone<double>) {
    abut::test::check_revolutions_within<TestType>(abut::cuda{});
}
