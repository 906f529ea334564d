// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>
#include <abut/experimental/cuda_work_stealing.hpp>

#include <cstdint>

#include "collide/schedule_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEST_CASE("schedules: items that make items: cuda") {
    const cuda on;
    check_schedule<schedule::shared_list>(on);
    check_schedule<schedule::static_partition>(on);
    check_schedule<schedule::work_stealing>(on);
    check_schedule<schedule::lazy_work_stealing>(on);
}

TEST_CASE("schedules: each is what it says: cuda") {
    const cuda on;
    check_schedule_is_itself<schedule::shared_list>(on);
    check_schedule_is_itself<schedule::static_partition>(on);
    check_schedule_is_itself<schedule::work_stealing>(on);
    check_schedule_is_itself<schedule::lazy_work_stealing>(on);
}

TEST_CASE("schedules: static partition: cuda") { check_scheduled_queries<float, schedule::static_partition>(cuda{}); }
TEST_CASE("schedules: work stealing: cuda") { check_scheduled_queries<float, schedule::work_stealing>(cuda{}); }
TEST_CASE("schedules: lazy work stealing: cuda") { check_scheduled_queries<float, schedule::lazy_work_stealing>(cuda{}); }

}  // namespace abut::test
