// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of what meets a convex hull.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("hulls and each kind of shape: cuda decides every family as the host does", "", float, double) {
    test::check_hulls_and_others<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("balls and hulls next to contact: cuda decides every family as the host does", "", float, double) {
    test::check_balls_and_hulls<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("planes and hulls: cuda decides them as the host does", "", float, double) {
    test::check_planes_and_hulls<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("rays and hulls: cuda decides every family as the host does", "", float, double) {
    test::check_rays_and_hulls<TestType>(abut::cuda{});
}
