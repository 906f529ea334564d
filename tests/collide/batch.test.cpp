// SPDX-License-Identifier: MIT

#include "collide/batch_cases.hpp"

TEMPLATE_TEST_CASE("a list of posed pairs: serial and openmp", "", float, double) {
    abut::test::check_batches<TestType>(abut::serial{});
    abut::test::check_batches<TestType>(abut::openmp{3});
    abut::test::check_mixed_batch<TestType>(abut::serial{});
}
