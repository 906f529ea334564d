// SPDX-License-Identifier: MIT
#include <abut/abut.hpp>

#include "collide/box_cases.hpp"

TEST_CASE("half spaces: queries, serial") {
    abut::test::check_half_spaces<float>(abut::serial{});
    abut::test::check_half_spaces<double>(abut::serial{});
}
TEST_CASE("half spaces: queries, openmp") { abut::test::check_half_spaces<float>(abut::openmp{3}); }
