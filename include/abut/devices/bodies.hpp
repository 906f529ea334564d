// SPDX-License-Identifier: MIT
#pragma once

// Scenes of many bodies on several devices. Each has all bodies; each walks its share of the tree over them, and asks about
// the pairs of bodies that it finds near each other.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/bodies.hpp>
#include <abut/collide/body_pairs.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/query.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

template <class Index>
inline constexpr bool refits_alone<bodies<Index>> = false;

struct by_bodies {
    template <class Found>
    ABUT_HD bool operator()(const Found& x, const Found& y) const {
        return x.body_a != y.body_a   ? x.body_a < y.body_a
               : x.body_b != y.body_b ? x.body_b < y.body_b
                                      : by_ids{}(x, y);
    }
};

/// ask(k, pairing) for each device's share of the near pairs, on all at a time.
template <class Team, class Index, class Options, class Ask>
void ask_bodies(const Team& team, const replicated<bodies<Index>>& all, const Options& options, bool sorted,
                const char* function, const Ask& ask) {
    if constexpr (can_be_listed<typename Team::local_policy, Index>()) {
        require_as_many(team, all, function);
        execution::on_each(team, [&](int k) {
            auto here = options;
            here.scheduling.report = nullptr;  // of one query, and here are several
            ask(k, pair_up_bodies(team[k], all[k], here, sorted, function, share_of(team, k)));
        });
    }
}
/// What ask(on, pairing) finds, in memory of the first device.
template <class Found, class Team, class Index, class Options, class Ask>
auto found_of_bodies(const Team& team, const replicated<bodies<Index>>& all, const Options& options, const char* function,
                     const Ask& ask) {
    std::vector<result<Found, space_of<typename Team::local_policy>>> found(static_cast<std::size_t>(team.size()));
    ask_bodies(team, all, options, options.sorted, function, [&](int k, const auto& pairing) {
        found[static_cast<std::size_t>(k)] = ask(team[k], pairing);
    });
    return on_first(team, std::move(found), options.sorted, by_bodies{});
}

}  // namespace detail

/// @addtogroup devices
///@{

/// Bodies on each device: body i is indices[index_of[i]] under poses[i], as of `make_bodies` under one policy. Indices are
/// what `make_bvh` made for these devices. Throws as `make_bodies` does, and `error` if an index lies on another number of
/// devices. Waits for all.
template <execution::policy_team Team, class Index>
[[nodiscard]] auto make_bodies(const Team& team, const std::vector<replicated<Index>>& indices,
                               std::type_identity_t<std::span<const std::uint32_t>> index_of,
                               std::type_identity_t<std::span<const rigid<typename Index::scalar_type>>> poses) {
    for (const replicated<Index>& index : indices) detail::require_as_many(team, index, "abut::make_bodies");
    return replicated(detail::each_of(team, [&](int k) {
        std::vector<Index> there;
        for (const replicated<Index>& index : indices) there.push_back(index[k]);
        return make_bodies(team[k], there, index_of, poses);
    }));
}

/// The same bodies under other poses, in host memory, as `refit` of one policy. The first device decides for all whether
/// there is to be a new tree: they have to walk the same one. Waits for all.
template <execution::policy_team Team, class Index>
[[nodiscard]] auto refit(const Team& team, const replicated<bodies<Index>>& all,
                         std::type_identity_t<std::span<const rigid<typename Index::scalar_type>>> poses) {
    detail::require_as_many(team, all, "abut::refit");
    auto moved = detail::each_of(team, [&](int k) {
        detail::check_refit(team[k], all[k], poses.size());
        return detail::move_bodies(team[k], all[k], poses);
    });
    const bool new_tree = moved.front().wants_new_tree;
    return replicated(detail::each_of(team, [&](int k) {
        return detail::settle_bodies(team[k], std::move(moved[static_cast<std::size_t>(k)]), new_tree);
    }));
}

/// Whether any shape of a body touches any of another; as under one policy. Each device stops soon after the first pair that
/// it finds.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any(const Team& team, const replicated<bodies<Index>>& all,
                       const body_options<Filter, Schedule>& options = {}) {
    std::atomic<bool> found{false};
    detail::ask_bodies(team, all, options, false, "abut::any", [&](int k, const auto& pairing) {
        if (detail::any_of<A>(team[k], pairing)) found.store(true);
    });
    return found.load();
}

/// Number of pairs of shapes of two bodies that touch. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count(const Team& team, const replicated<bodies<Index>>& all,
                                  const body_options<Filter, Schedule>& options = {}) {
    std::atomic<std::uint64_t> sum{0};
    detail::ask_bodies(team, all, options, false, "abut::count",
                       [&](int k, const auto& pairing) { sum += detail::count_of<A>(team[k], pairing); });
    return sum.load();
}

/// All pairs of shapes of two different bodies that touch, as under one policy: a `result` of `body_pair` in memory of the
/// first device.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto pairs(const Team& team, const replicated<bodies<Index>>& all,
                         const body_options<Filter, Schedule>& options = {}) {
    return detail::found_of_bodies<body_pair>(
        team, all, options, "abut::pairs",
        [](const auto& on, const auto& pairing) { return detail::pairs_of<A>(on, pairing); });
}

/// Calls visitor_of(k)(body_pair) -> visit for every such pair, once, on the k-th device, which has found it; otherwise as
/// `for_each_pair` of two arguments on several devices.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class VisitorOf, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
void for_each_pair(const Team& team, const replicated<bodies<Index>>& all, const VisitorOf& visitor_of,
                   const body_options<Filter, Schedule>& options = {}) {
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    if constexpr (detail::is_visitor<typename Team::local_policy, visitor, body_pair>()) {
        std::vector<visitor> visitors;
        for (int k = 0; k < team.size(); ++k) visitors.push_back(visitor_of(k));
        detail::ask_bodies(team, all, options, false, "abut::for_each_pair", [&](int k, const auto& pairing) {
            detail::visit_pairs_of<A>(team[k], pairing, visitors[static_cast<std::size_t>(k)]);
        });
    }
}

/// Their contacts, as under one policy: a `result` of `body_contact` in memory of the first device.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto contacts(const Team& team, const replicated<bodies<Index>>& all,
                            const body_options<Filter, Schedule>& options = {}) {
    return detail::found_of_bodies<body_contact<typename Index::scalar_type>>(
        team, all, options, "abut::contacts", [&](const auto& on, const auto& pairing) {
            return detail::contacts_of<A>(on, pairing, options.discard_sideways);
        });
}

///@}

}  // namespace abut
