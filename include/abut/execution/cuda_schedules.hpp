// SPDX-License-Identifier: MIT
#pragma once

// for_each_descendant of `cuda` (execution/policy.hpp), by any schedule. Each is a header of its own, and all share
// cuda_descent.hpp.

#include <cstdint>

#include <abut/execution/cuda_expand.hpp>
#include <abut/execution/cuda_partition.hpp>
#include <abut/execution/cuda_stealing.hpp>
#include <abut/execution/schedule.hpp>

namespace abut::execution {

template <schedule Schedule, expander Expand, class Judge, class... Queues>
    requires candidate_judge<Judge, typename Expand::candidate, sink_of<Queues>...>
std::uint64_t for_each_descendant(const cuda& on, const scheduled<Schedule>& how, const Expand& expand, const Judge& judge,
                                  Queues&... queues) {
    const auto seeds = static_cast<unsigned>(expand.seeds());
    if (seeds == 0) {
        if (how.report != nullptr) *how.report = {.ran = Schedule};
        return 0;
    }
    const detail::current_device scope(on);
    return detail::descend(on, how, seeds, expand, judge, queues...);
}

template <expander Expand, class Judge, class... Queues>
    requires candidate_judge<Judge, typename Expand::candidate, sink_of<Queues>...>
std::uint64_t for_each_descendant(const cuda& on, const Expand& expand, const Judge& judge, Queues&... queues) {
    return for_each_descendant(on, scheduled<schedule::shared_list>{}, expand, judge, queues...);
}

}  // namespace abut::execution
