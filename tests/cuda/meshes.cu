// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/validate_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("validate: cuda", "", float, double) { abut::test::check_validate<TestType>(abut::cuda{}); }
