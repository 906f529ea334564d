// SPDX-License-Identifier: MIT
// long to compile
#include <abut/cuda.hpp>

#include "collide/box_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("oriented boxes: pairs, cuda") { abut::test::check_sets_of_boxes<float>(abut::cuda{}); }
