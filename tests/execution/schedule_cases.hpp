// SPDX-License-Identifier: MIT
#pragma once

// Every schedule finds what the default one finds, with room and without, on one block and on all; and each is the one that
// it says it is: what it alone does, it does where all work comes of one item.

#include <algorithm>
#include <cstdint>
#include <vector>

#include <abut/execution/parallel.hpp>
#include <abut/execution/schedule.hpp>

#include "execution/verb_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

/// Whether a report says what a schedule that shared out a lot of work must say. `is_narrow` where its queues were tiny.
inline void check_report(const schedule_report& report, schedule asked, bool is_narrow) {
    CAPTURE(report.workers, report.steps, report.items, report.steals, report.stolen, report.failed_steals, report.offers);
    CAPTURE(report.transfers, report.transferred, report.overflows, report.rounds, report.balances, report.idle_share);
    REQUIRE(report.ran == asked);
    CHECK(report.workers > 1);
    if (asked == schedule::shared_list) {
        CHECK(report.steals + report.balances + report.offers == 0);
        return;
    }
    CHECK(report.steps > 0);
    CHECK(report.items >= report.steps);
    CHECK(report.idle_share >= 0);
    CHECK(report.idle_share <= 1);
    const bool steals = asked != schedule::static_partition, lazy = asked == schedule::lazy_work_stealing;
    CHECK((report.steals > 0) == steals);
    CHECK((report.offers > 0) == steals);
    CHECK(report.stolen >= report.steals);
    CHECK((report.transfers > 0) == lazy);
    // Of a static partition no block leaves before its queue has room for all that it holds, so it may come to no balance.
    if (steals || !is_narrow) CHECK((report.balances > 0) == !steals);
    CHECK((report.rounds > 1) == (report.balances > 0));
    if (lazy) CHECK(report.transferred == report.stolen);
    if (is_narrow) CHECK(report.overflows > 0);
}

template <schedule Schedule, class Policy>
void check_schedule_of(const Policy& on, const grow& tree, const std::vector<std::uint64_t>& expected,
                       execution::scheduled<Schedule> how) {
    CAPTURE(static_cast<int>(Schedule), static_cast<int>(tree.shape), tree.depth, tree.roots, how.queue_capacity,
            how.most_blocks);
    schedule_report report;
    how.report = &report;
    execution::work_queue<std::uint64_t, space_of<Policy>> hits(on);
    for_each_descendant(on, how, tree, keep_some{}, hits);
    CHECK((sorted_content(on, hits) == expected));
    CHECK(report.ran == Schedule);
    execution::work_flag<space_of<Policy>> found(on);
    for_each_descendant(on, how, tree, raise_always{}, found);
    CHECK(found.raised() == (tree.roots > 0));
}

template <schedule Schedule, class Policy>
void check_schedule(const Policy& on) {
    using kind = grow::kind;
    const grow trees[] = {{kind::full, 1},   {kind::full, 2}, {kind::full, 8},        {kind::ragged, 20},
                          {kind::chain, 95}, {kind::comb, 95}, {kind::ragged, 6, 3000}, {kind::full, 3, 0}};
    for (const grow& tree : trees) {
        const grown truth(tree);
        std::vector<std::uint64_t> expected;
        for (const std::uint64_t c : truth.candidates) {
            if (c % 5 == 0 || c % 3 != 0) expected.push_back(c);
        }
        std::sort(expected.begin(), expected.end());
        for (const std::uint32_t capacity : {0u, 1u, 40u, 600u}) {
            for (const std::uint32_t blocks : {0u, 1u, 3u}) {
                check_schedule_of<Schedule>(on, tree, expected, {{.most_blocks = blocks, .queue_capacity = capacity}});
            }
        }
    }
}

/// On a busy machine the calling thread works alone for as long as it has lost by waiting (execution/parallel.hpp). A test
/// of what threads do together lets it forget that.
inline void forget_lost_time() { execution::detail::lost_time_of_thread() = {}; }

/// Candidates that all come of one item: blocks, or threads, that have nothing to begin with have to get something. Threads
/// of a host may begin so late that nothing is left, and may try again.
template <schedule Schedule, class Policy>
void check_schedule_is_itself(const Policy& on, std::uint32_t depth = 10, int tries = 1) {
    const std::uint64_t candidates = std::uint64_t{1} << 2 * depth;
    for (const std::uint32_t capacity : {0u, 20u}) {
        schedule_report report;
        const execution::scheduled<Schedule> how{{.queue_capacity = capacity, .report = &report}};
        for (int k = 0; k < tries && report.steals == 0; ++k) {
            forget_lost_time();
            execution::work_count<space_of<Policy>> count(on);
            for_each_descendant(on, how, grow{grow::kind::full, depth}, count_always{}, count);
            CHECK(count.total() == candidates);
            if (Schedule != schedule::shared_list) CHECK(report.items == (candidates - 1) / 3);
        }
        check_report(report, Schedule, capacity == 20);
    }
}

}  // namespace abut::test
