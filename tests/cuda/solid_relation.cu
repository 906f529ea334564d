// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <concepts>

#include "collide/patch_cases.hpp"
#include "collide/solid_cases.hpp"
#include "cuda/part.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("relation of solids: cuda", "", float, double) {
    constexpr int part = std::same_as<TestType, float> ? 0 : 1;
    if constexpr (abut::test::is_in_part(part)) abut::test::check_relations<TestType>(abut::cuda{});
    if constexpr (abut::test::is_in_part(2 + part)) abut::test::check_scenes_of_solids<TestType>(abut::cuda{}, 4);
}

TEMPLATE_TEST_CASE("patches of solids: cuda", "", float, double) {
    if constexpr (abut::test::is_in_part(std::same_as<TestType, float> ? 4 : 5)) abut::test::check_patches<TestType>(abut::cuda{});
}
