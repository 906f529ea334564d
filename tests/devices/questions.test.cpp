// SPDX-License-Identifier: MIT
#include "devices/host_team.hpp"

#include "devices/question_cases.hpp"

TEST_CASE("devices: points, rays and distances are asked of several policies as of one") {
    const int n = GENERATE(1, 2, 3, 5);
    abut::test::check_questions<float>(abut::test::host_team<abut::serial>(n));
}

TEST_CASE("devices: points, rays and distances in double, on several threads each") {
    const abut::test::host_team<abut::openmp> team(3, abut::openmp{.threads = 2});
    abut::test::device_cases::check_nearest_few<double>(team);
    abut::test::device_cases::check_distance_on<double>(team);
}

TEST_CASE("devices: errors of questions") {
    using abut::serial;
    abut::test::device_cases::check_question_errors<float>(abut::test::host_team<serial>(2), abut::test::host_team<serial>(3));
}
