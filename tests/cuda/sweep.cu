// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/sweep_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("sweep: cuda") {
    const abut::cuda on;
    abut::test::check_sweep_of_sets<float>(on, 20);
    abut::test::check_sweep_of_sets<double>(on, 20);
    abut::test::check_sweep_scales<float>(on);
}
