// SPDX-License-Identifier: MIT
//
// nvcc: --extended-lambda

#include <abut/cuda.hpp>

#include "collide/lambda_cases.hpp"

TEST_CASE("Lambdas that are marked are filters and visitors on a device") {
    lambda_cases::check(lambda_cases::ask_in_row(abut::cuda{}, 5));
}
