// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/revolution_distance_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEST_CASE("distance and nearest: sets of cylinders and cones, cuda") {
    const abut::cuda on;
    test::check_distance_of<cylinder<float>, triangle<float>>(on, 291);
    test::check_distance_of_posed_solids<cone<float>>(on, 292);
    test::check_nearest_of<cylinder<float>>(on, 293);
    test::check_distance_of<cylinder<float>, cylinder<float>>(on, 294);
    test::check_distance_of<cylinder<double>, capsule<double>>(on, 295);
    test::check_distance_of<cone<double>, cone<double>>(on, 296);
    test::check_distance_of<cone<float>, cylinder<float>>(on, 297);
    test::check_distance_of<capsule<double>, cone<double>>(on, 298);
}
