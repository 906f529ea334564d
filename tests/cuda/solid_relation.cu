// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/patch_cases.hpp"
#include "collide/solid_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("relation of solids: cuda", "", float, double) {
    abut::test::check_relations<TestType>(abut::cuda{});
    abut::test::check_scenes_of_solids<TestType>(abut::cuda{}, 4);
}

TEMPLATE_TEST_CASE("patches of solids: cuda", "", float, double) { abut::test::check_patches<TestType>(abut::cuda{}); }
