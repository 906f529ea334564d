// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/many_within_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("within: lists of posed pairs and scenes of bodies, cuda") {
    abut::test::check_all_many_within<float>(abut::cuda{});
}

TEST_CASE("within: cylinders and cones, in sets and in lists of posed pairs, cuda") {
    const abut::cuda on;
    abut::test::check_within_of<abut::cylinder<float>, abut::sphere<float>>(on, 308);
    abut::test::check_within_of<abut::plane<float>, abut::cone<float>>(on, 312);
    abut::test::check_posed_within_of<abut::cone<float>, abut::vec3<float>>(on, 309);
    abut::test::check_lists_of_solids_within<abut::cylinder<float>, abut::vec3<float>>(on);
}
