// SPDX-License-Identifier: MIT
// long to compile
//
// What is asked of several devices about solids. Where there is one, it is asked as two.

#include <abut/cuda_devices.hpp>

#include "devices/solid_team_cases.hpp"

TEST_CASE("several devices: how solids lie to each other, cuda") {
    abut::test::check_relations_of_team(abut::cuda_devices({0, 0}));
    abut::test::check_spans_of_team(abut::cuda_devices({0, 0}));
    abut::test::check_errors_of_solids(abut::cuda_devices({0, 0}), abut::cuda_devices({0, 0, 0}));
    const abut::cuda_devices all;
    if (all.size() > 1) abut::test::check_relations_of_team(all);
}
