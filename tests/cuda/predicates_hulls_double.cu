// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of what meets a convex hull, in double. In float: predicates_hulls.cu.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("hulls and each kind of shape: cuda decides every family as the host does") {
    abut::test::check_hulls_and_others<double>(abut::cuda{});
}

TEST_CASE("balls and hulls next to contact: cuda decides every family as the host does") {
    abut::test::check_balls_and_hulls<double>(abut::cuda{});
}

TEST_CASE("planes and hulls: cuda decides them as the host does") {
    abut::test::check_planes_and_hulls<double>(abut::cuda{});
}

TEST_CASE("rays and hulls: cuda decides every family as the host does") {
    abut::test::check_rays_and_hulls<double>(abut::cuda{});
}
