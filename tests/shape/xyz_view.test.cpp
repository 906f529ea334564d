// SPDX-License-Identifier: MIT
#include <abut/shape/xyz_view.hpp>

#include "shape/view_cases.hpp"

TEMPLATE_TEST_CASE("views: coordinates in arrays of their own", "", float, double) {
    abut::test::check_xyz_views<TestType>(abut::serial{});
    abut::test::check_xyz_views<TestType>(abut::openmp{.threads = 3});
}

TEMPLATE_TEST_CASE("views: what is no geometry is refused in arrays of their own", "", float, double) {
    abut::test::check_xyz_refusals<TestType>(abut::serial{});
    abut::test::check_xyz_refusals<TestType>(abut::openmp{.threads = 3});
}

TEMPLATE_TEST_CASE("sets: that own a copy of what a view sees", "", float, double) {
    abut::test::check_copies_of_views<TestType>(abut::serial{});
    abut::test::check_copies_of_views<TestType>(abut::openmp{.threads = 3});
}
