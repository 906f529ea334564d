// SPDX-License-Identifier: MIT
// long to compile
//
// Convex hulls on several devices. Where there is one, it is asked as two.

#include <abut/cuda_devices.hpp>

#include "devices/hull_cases.hpp"

TEST_CASE("several devices: convex hulls, cuda") {
    abut::test::device_cases::check_hulls<float>(abut::cuda_devices({0, 0}));
    const abut::cuda_devices all;
    if (all.size() > 1) abut::test::device_cases::check_hulls<float>(all);
}
