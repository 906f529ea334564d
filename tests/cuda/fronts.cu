// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>
#include <abut/experimental/cuda_work_stealing.hpp>

#include "collide/front_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("fronts: cuda") { abut::test::check_fronts(abut::cuda{}, 200); }
