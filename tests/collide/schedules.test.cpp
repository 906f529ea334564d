// SPDX-License-Identifier: MIT
#include "collide/schedule_cases.hpp"

namespace abut::test {

TEST_CASE("schedules: serial has one") {
    check_scheduled_sets<float, schedule::work_stealing>(serial{});
    schedule_report report{.ran = schedule::work_stealing};
    uniform random(20270104);
    const auto tree = make_bvh(serial{}, random_soup<float>(50, random));
    CHECK(count(serial{}, tree, tree, by_schedule<schedule::work_stealing>{.scheduling = {.report = &report}}) >= 50);
    CHECK(report.ran == schedule::shared_list);
}

TEST_CASE("schedules: openmp") {
    constexpr openmp on{.threads = 3};
    check_scheduled_queries<double, schedule::work_stealing>(on, 200);
    check_scheduled_forms<float, schedule::static_partition>(on);
    check_scheduled_lists<float, schedule::lazy_work_stealing>(on);
}

TEST_CASE("schedules: wide trees") {
    constexpr openmp on{.threads = 2};
    uniform random(20270105);
    const auto a = random_soup<float>(400, random), b = random_soup<float>(300, random);
    const auto expected = placed_truth(a.view(), b.view());
    check_scheduled<schedule::work_stealing>(on, wide(on, make_bvh(on, a)), make_bvh(on, b), expected);
}

}  // namespace abut::test
