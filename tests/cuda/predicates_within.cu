// SPDX-License-Identifier: MIT
// long to compile
//
// Every stage of `within` for all kinds of shapes but hulls.
#include <abut/cuda.hpp>

#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("within, boxes and planes: cuda decides every family as the host does", "", float, double) {
    test::check_solids_within<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("within, triangles and balls: cuda decides every family as the host does", "", float, double) {
    test::check_round_within<TestType>(abut::cuda{});
}
