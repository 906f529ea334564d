// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/many_within_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("within: lists of posed pairs and scenes of bodies, cuda") {
    abut::test::check_all_many_within<float>(abut::cuda{});
}
