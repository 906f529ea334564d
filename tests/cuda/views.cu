// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "shape/view_cases.hpp"

TEMPLATE_TEST_CASE("views: coordinates in arrays of their own: cuda", "", float, double) {
    abut::test::check_xyz_views<TestType>(abut::cuda{});
    abut::test::check_xyz_refusals<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("sets: that own a copy of what a view sees: cuda", "", float, double) {
    abut::test::check_copies_of_views<TestType>(abut::cuda{});
}
