// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/body_rows_cases.hpp"
#include "collide/ray_options_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("bodies: rays, points and distance, cuda") {
    const abut::cuda on;
    abut::test::check_all_body_rows<float>(on);
    abut::test::check_body_distance<float>(on);
}

TEST_CASE("options of rays and points: cuda") {
    const abut::cuda on;
    const auto make = [&](const auto& set) { return make_bvh(on, set); };
    abut::test::check_ray_options<float>(on, make);
    abut::test::check_ray_options<double>(on, make);
    abut::test::check_nearest_options<float>(on, make);
}
