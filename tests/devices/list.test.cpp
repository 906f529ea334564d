// SPDX-License-Identifier: MIT
//
// Lists of posed pairs: of several policies as of one.

#include "devices/host_team.hpp"

#include "devices/list_cases.hpp"

TEST_CASE("devices: lists of posed pairs") {
    const int n = GENERATE(1, 2, 3, 5);
    abut::test::device_cases::check_lists<float>(abut::test::host_team<abut::serial>(n));
}
