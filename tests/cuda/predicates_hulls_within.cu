// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of `within` for a convex hull and each kind of shape.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("within, hulls: cuda decides every family as the host does", "", float, double) {
    test::check_hulls_within<TestType>(abut::cuda{});
}
