// SPDX-License-Identifier: MIT
// long to compile
//
// Bodies that turn, asked of several devices. Where there is one, it is asked as two.

#include <abut/cuda_devices.hpp>

#include "devices/meeting_cases.hpp"

TEST_CASE("several devices: bodies that turn, cuda") {
    abut::test::check_meetings_of_team(abut::cuda_devices({0, 0}), abut::cuda_devices({0, 0, 0}));
    const abut::cuda_devices all;
    if (all.size() > 1) abut::test::check_meetings_of_team(all, abut::cuda_devices({0}));
}
