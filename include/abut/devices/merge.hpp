// SPDX-License-Identifier: MIT
#pragma once

// What several devices have found, each in order, becomes one list in memory of the first.

#include <cstddef>
#include <utility>
#include <vector>

#include <abut/collide/merge.hpp>
#include <abut/collide/options.hpp>
#include <abut/execution/team.hpp>

namespace abut::detail {

/// Of each device one, one after another in memory of the first. They are empty then.
template <class Team, class Found>
auto brought_to_first(const Team& team, found_lists<typename Team::local_policy, Found>& lists,
                      const std::vector<std::size_t>& first) {
    execution::buffer_of<typename Team::local_policy, Found> all(team[0], first.back());
    copy(team[0], lists[0].data(), lists[0].size(), all.data());
    lists[0] = {};
    for (std::size_t k = 1; k < lists.size(); ++k) {
        const auto& there = team[static_cast<int>(k)];
        synchronize(there);
        copy_across(there, lists[k].data(), lists[k].size(), team[0], all.data() + first[k]);
        lists[k] = {};
    }
    synchronize(team[0]);
    return all;
}
/// The same as one list.
template <class Team, class Found, class Order = by_ids>
auto on_first(const Team& team, std::vector<result<Found, space_of<typename Team::local_policy>>> lists, bool sorted,
              const Order& order = {}) {
    if (lists.size() == 1) return std::move(lists.front());
    const auto first = beginnings_of(lists);
    return merged(team[0], brought_to_first<Team, Found>(team, lists, first), first, sorted, order);
}

}  // namespace abut::detail
