// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/triangle_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("triangles against triangles: cuda", "", float, double) {
    abut::test::check_triangle_queries<TestType>(abut::cuda{});
}
