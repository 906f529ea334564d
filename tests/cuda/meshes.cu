// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/batch_cases.hpp"
#include "collide/posed_cases.hpp"
#include "collide/validate_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("validate: cuda", "", float, double) { abut::test::check_validate<TestType>(abut::cuda{}); }

TEMPLATE_TEST_CASE("queries of posed sets and indices: cuda", "", float, double) {
    abut::test::check_all_posed<TestType>(abut::cuda{});
}

TEST_CASE("a list of posed pairs: cuda") { abut::test::check_batches<float>(abut::cuda{}); }
