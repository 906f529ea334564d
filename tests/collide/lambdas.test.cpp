// SPDX-License-Identifier: MIT

#include "collide/lambda_cases.hpp"

TEST_CASE("Lambdas are filters and visitors") {
    lambda_cases::check(lambda_cases::ask_in_row(abut::serial{}, 5));
    lambda_cases::check(lambda_cases::ask_in_row(abut::openmp{}, 5));
}
