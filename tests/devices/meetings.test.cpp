// SPDX-License-Identifier: MIT
#include "devices/meeting_cases.hpp"

#include "devices/host_team.hpp"

TEST_CASE("devices: bodies that turn, in lists and in scenes") {
    using team = abut::test::host_team<abut::serial>;
    const int size = GENERATE(1, 2, 3);
    abut::test::check_meetings_of_team(team(size), team(size + 1));
}
