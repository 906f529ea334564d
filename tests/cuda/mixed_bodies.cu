// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/mixed_bodies_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("bodies of several kinds: cuda") { abut::test::check_mixed_alike(abut::cuda{}); }
