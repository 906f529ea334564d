// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/body_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("many bodies: cuda") { abut::test::check_all_bodies<float>(abut::cuda{}); }
