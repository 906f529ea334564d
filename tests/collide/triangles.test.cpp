// SPDX-License-Identifier: MIT
#include <abut/collide/query.hpp>

#include "collide/triangle_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("triangles against triangles: serial", "", float, double) { test::check_triangle_queries<TestType>(serial{}); }

TEMPLATE_TEST_CASE("triangles against triangles: openmp", "", float, double) {
    test::check_triangle_queries<TestType>(openmp{.threads = 3});
}
