// SPDX-License-Identifier: MIT
// long to compile
//
// Several devices. Where there is one, it is asked as two and as three: all but the copies between different devices is the
// same then.

#include <abut/cuda_devices.hpp>

#include <cstdio>
#include <string>

#include "devices/device_cases.hpp"

using namespace abut;

namespace {

int number_of_devices() {
    int count = 0;
    cudaGetDeviceCount(&count);
    return count;
}

}  // namespace

TEST_CASE("several devices: cuda") {
    for (const auto& list : {std::vector<int>{0}, std::vector<int>{0, 0}, std::vector<int>{0, 0, 0}}) {
        test::device_cases::check_each_way<float>(cuda_devices(list));
    }
    test::device_cases::check_stops<float>(cuda_devices({0, 0}));
    test::device_cases::check_corner<float>(cuda_devices({0, 0}));
    test::device_cases::check_large<float>(cuda_devices({0, 0, 0}));
    test::device_cases::check_nearest<double>(cuda_devices({0, 0, 0}));

    const cuda_devices all;
    CHECK(all.size() == number_of_devices());
    if (all.size() > 1) {
        test::device_cases::check_each_way<float>(all);
        test::device_cases::check_nearest<double>(all);
        test::device_cases::check_corner<float>(all);
        test::device_cases::check_large<float>(all);
        // The first of them is not the one that is current, and stays so.
        const cuda_devices turned({1, 0});
        test::device_cases::check_each_way<float>(turned);
        test::device_cases::check_nearest<double>(turned);
        int current = -1;
        CHECK((cudaGetDevice(&current) == cudaSuccess && current == 0));
    } else {
        std::printf("one device: copies between different ones are not tested\n");
    }
}

TEST_CASE("several devices: streams of the caller") {
    cudaStream_t streams[2] = {};
    for (cudaStream_t& s : streams) REQUIRE(cudaStreamCreate(&s) == cudaSuccess);
    {
        const auto team = cuda_devices::in_streams({{streams[0], 0}, {streams[1], 0}});
        test::device_cases::check_nearest<double>(team);
    }
    for (cudaStream_t s : streams) CHECK(cudaStreamDestroy(s) == cudaSuccess);
}

TEST_CASE("several devices: errors") {
    using test::device_cases::message_of;
    test::device_cases::check_errors<float>(cuda_devices({0, 0}), cuda_devices({0, 0, 0}));
    CHECK(message_of([] { cuda_devices none(std::vector<int>{}); }) == "abut::cuda_devices: the list of devices is empty");
    CHECK(message_of([] { cuda_devices none({-1}); }) == "abut::cuda_devices: there is no device -1");
    const int n = number_of_devices();
    CHECK(message_of([&] {
              cuda_devices none({0, n});
          }) == "abut::cuda_devices: there is no device " + std::to_string(n) + ", of " + std::to_string(n));
}
