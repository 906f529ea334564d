// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/contact_cases.hpp"
#include "collide/reduction_cases.hpp"
#include "support/catch.hpp"

TEMPLATE_TEST_CASE("contacts of sets and indices: cuda", "", float, double) {
    abut::test::check_few_contacts<TestType>(abut::cuda{});
}

TEMPLATE_TEST_CASE("reduction of contacts: cuda", "", float, double) {
    abut::test::check_all_reductions<TestType>(abut::cuda{});
}
