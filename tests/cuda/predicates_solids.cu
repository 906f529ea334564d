// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of all pairs of kinds of shapes without a triangle, a hull or a ray.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("spheres with segments and spheres: cuda decides every family as the host does", "", float, double) {
    test::check_balls<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("pairs without a triangle: cuda decides every family as the host does", "", float, double) {
    test::check_solids<TestType>(abut::cuda{});
}
