// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <concepts>

#include "collide/crossing_cases.hpp"
#include "cuda/part.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("crossings: cuda", "", float, double) {
    constexpr int part = std::same_as<TestType, float> ? 0 : 1;
    if constexpr (abut::test::is_in_part(part)) abut::test::check_crossings<TestType>(abut::cuda{});
    if constexpr (abut::test::is_in_part(2 + part)) abut::test::check_self_crossings<TestType>(abut::cuda{});
}
