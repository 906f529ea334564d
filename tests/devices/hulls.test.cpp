// SPDX-License-Identifier: MIT
#include "devices/host_team.hpp"

#include "devices/hull_cases.hpp"

TEST_CASE("devices: convex hulls on several policies as on one") {
    abut::test::device_cases::check_hulls<float>(abut::test::host_team<abut::serial>(3));
    abut::test::device_cases::check_hulls<double>(abut::test::host_team<abut::serial>(2));
}
