// SPDX-License-Identifier: MIT

#include "contact_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("contacts of sets and indices", "", float, double) {
    SECTION("serial") { check_all_contacts<TestType>(serial{}); }
    SECTION("openmp") { check_all_contacts<TestType>(openmp{.threads = 3}); }
}

}  // namespace abut::test
