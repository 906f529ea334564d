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

TEST_CASE("devices: rays meet solids on several policies as on one") {
    namespace cases = abut::test::device_cases;
    const abut::test::host_team<abut::serial> team(3);
    const auto centers = cases::some_points<float>(200, 41);
    std::vector<abut::sphere<float>> balls;
    std::vector<abut::cone<float>> hats;
    for (std::size_t i = 0; i + 1 < centers.size(); ++i) {
        balls.push_back({centers[i], 0.25f});
        hats.push_back({centers[i], centers[i + 1], 0.25f});
    }
    const abut::rays<float> lines(cases::some_rays<float>(300, 42));
    const auto check = [&](const auto& set) {
        const auto expected = cases::met_by<float>(abut::serial{}, set, lines);
        CHECK(expected.all.size() > 50);
        CHECK((cases::met_by<float>(team, make_bvh(team, set), lines) == expected));
        CHECK((cases::met_by<float>(team, make_bvh(team, divide(team, set)), lines) == expected));
    };
    check(abut::spheres<float>(balls));
    check(abut::cones<float>(hats));
}

TEST_CASE("devices: errors of questions") {
    using abut::serial;
    abut::test::device_cases::check_question_errors<float>(abut::test::host_team<serial>(2), abut::test::host_team<serial>(3));
}
