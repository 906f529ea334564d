// SPDX-License-Identifier: MIT
// long to compile
//
// Meshes in motion and many bodies on several devices; one device is asked as two and as three, as in devices.cu.

#include <abut/cuda_devices.hpp>

#include "devices/device_cases.hpp"

using namespace abut;

TEST_CASE("several devices: meshes in motion") {
    for (const auto& list : {std::vector<int>{0}, std::vector<int>{0, 0}, std::vector<int>{0, 0, 0}}) {
        test::device_cases::check_impacts<float>(cuda_devices(list));
    }
    const cuda_devices all;
    if (all.size() > 1) test::device_cases::check_impacts<float>(all);
}

TEST_CASE("several devices: many bodies") {
    for (const auto& list : {std::vector<int>{0}, std::vector<int>{0, 0}, std::vector<int>{0, 0, 0}}) {
        test::device_cases::check_bodies<float>(cuda_devices(list));
    }
    const cuda_devices all;
    if (all.size() > 1) test::device_cases::check_bodies<float>(all);
}
