// SPDX-License-Identifier: MIT
#include "devices/host_team.hpp"

#include "devices/solid_team_cases.hpp"

TEST_CASE("devices: relations of two solids, of lists and of bodies") {
    abut::test::check_relations_of_team(abut::test::host_team<abut::serial>(GENERATE(1, 2, 3)));
}

TEST_CASE("devices: stretches of rays inside") {
    abut::test::check_spans_of_team(abut::test::host_team<abut::serial>(GENERATE(1, 2, 3)));
}

TEST_CASE("devices: what is no solid") {
    using team = abut::test::host_team<abut::serial>;
    abut::test::check_errors_of_solids(team(2), team(3));
}
