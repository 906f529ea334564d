// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of what meets a triangle and is not in predicates.cu: segments, points and rays; and faces of a mesh with each
// other.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("segments and triangles: cuda decides every family as the host does", "", float, double) {
    test::check_segments_and_triangles<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("points and triangles: cuda decides every family as the host does", "", float, double) {
    test::check_points_and_triangles<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("rays and triangles: cuda decides every family as the host does", "", float, double) {
    test::check_rays_and_triangles<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("faces of a mesh: cuda decides every family as the host does", "", float, double) {
    test::check_faces<TestType>(abut::cuda{});
}
