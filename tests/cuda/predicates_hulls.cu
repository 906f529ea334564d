// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of what meets a convex hull, in float. In double: predicates_hulls_double.cu.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("hulls and each kind of shape: cuda decides every family as the host does") {
    abut::test::check_hulls_and_others<float>(abut::cuda{});
}

TEST_CASE("balls and hulls next to contact: cuda decides every family as the host does") {
    abut::test::check_balls_and_hulls<float>(abut::cuda{});
}

TEST_CASE("planes and hulls: cuda decides them as the host does") {
    abut::test::check_planes_and_hulls<float>(abut::cuda{});
}

TEST_CASE("rays and hulls: cuda decides every family as the host does") {
    abut::test::check_rays_and_hulls<float>(abut::cuda{});
}
