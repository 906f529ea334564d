// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/touching_bodies_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("bodies as wholes: cuda") { abut::test::check_whole_bodies<float>(abut::cuda{}); }
