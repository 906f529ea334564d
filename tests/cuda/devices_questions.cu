// SPDX-License-Identifier: MIT
// long to compile
//
// What points and rays ask of several devices, and lists of posed pairs. Where there is one, it is asked as two: all but the
// copies between different devices is the same then.

#include <abut/cuda_devices.hpp>

#include <cstdio>

#include "devices/list_cases.hpp"
#include "devices/question_cases.hpp"

namespace {

void check_all(const abut::cuda_devices& team) {
    abut::test::check_questions<float>(team);
    abut::test::device_cases::check_lists<float>(team);
    abut::test::device_cases::check_question_errors<float>(team, abut::cuda_devices({0, 0, 0}));
}

}  // namespace

TEST_CASE("several devices: what points and rays ask, distances and lists, cuda") {
    check_all(abut::cuda_devices({0, 0}));
    const abut::cuda_devices all;
    if (all.size() > 1) {
        check_all(all);
    } else {
        std::printf("one device: copies between different ones are not tested\n");
    }
}
