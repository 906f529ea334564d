// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/box_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("half spaces: queries, cuda") { abut::test::check_half_spaces<float>(abut::cuda{}); }
