// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of all pairs of a cylinder or a cone and another shape.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("cylinders and cones: cuda decides every family as the host does", "", cylinder<float>, cylinder<double>,
                   cone<float>, cone<double>) {
    test::check_revolutions<TestType>(abut::cuda{});
}
