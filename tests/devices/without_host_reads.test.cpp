// SPDX-License-Identifier: MIT

// Several policies whose memory the host may not read, as that of devices: tables of ids of divided sets lie there too.

#include <abut/abut.hpp>

#include "devices/host_team.hpp"
#include "devices/question_cases.hpp"
#include "support/catch.hpp"
#include "support/fenced.hpp"

TEST_CASE("devices: distances where the host cannot read their memory") {
    const abut::test::host_team<abut::test::fenced> team(2);
    abut::test::device_cases::check_distance_on<float>(team);
}
