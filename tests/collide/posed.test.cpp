// SPDX-License-Identifier: MIT

#include "posed_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("queries of posed sets and indices", "", float, double) {
    SECTION("serial") { check_all_posed<TestType>(serial{}); }
    SECTION("openmp") { check_all_posed<TestType>(openmp{.threads = 3}); }
}

}  // namespace abut::test
