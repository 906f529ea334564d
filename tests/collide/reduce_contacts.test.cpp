// SPDX-License-Identifier: MIT

#include "reduction_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("reduction of contacts", "", float, double) {
    SECTION("serial") { check_all_reductions<TestType>(serial{}); }
    SECTION("openmp") { check_all_reductions<TestType>(openmp{.threads = 3}); }
}

}  // namespace abut::test
