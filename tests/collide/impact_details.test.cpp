// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>

#include "collide/impact_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEST_CASE("impact_details: points come together against the normal") {
    check_details<float>(serial{});
    check_details<double>(openmp{});
}

}  // namespace abut::test
