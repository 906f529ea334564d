// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/hull_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("hulls: scenes, cuda") { abut::test::check_scenes_of_hulls<float>(abut::cuda{}); }
