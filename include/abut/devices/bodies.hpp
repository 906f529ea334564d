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
#include <abut/collide/body_within.hpp>
#include <abut/collide/pair_kinds.hpp>
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
template <class Team, class Index, class Options, class Kind, class Ask>
void ask_bodies(const Team& team, const replicated<bodies<Index>>& all, const Options& options, bool sorted,
                const char* function, const Kind& kind, const Ask& ask) {
    if constexpr (can_be_listed<typename Team::local_policy, Index>()) {
        require_as_many(team, all, function);
        execution::on_each(team, [&](int k) {
            auto here = options;
            here.scheduling.report = nullptr;  // of one query, and here are several
            ask(k, pair_up_bodies(team[k], all[k], here, sorted, function, share_of(team, k),
                                  kind.template nearness<typename Index::scalar_type>(function)));
        });
    }
}
/// What ask(on, pairing) finds, in memory of the first device.
template <class Found, class Team, class Index, class Options, class Kind, class Ask>
auto found_of_bodies(const Team& team, const replicated<bodies<Index>>& all, const Options& options, const char* function,
                     const Kind& kind, const Ask& ask) {
    std::vector<result<Found, space_of<typename Team::local_policy>>> found(static_cast<std::size_t>(team.size()));
    ask_bodies(team, all, options, options.sorted, function, kind, [&](int k, const auto& pairing) {
        found[static_cast<std::size_t>(k)] = ask(team[k], pairing);
    });
    return on_first(team, std::move(found), options.sorted, by_bodies{});
}

template <arithmetic A, class Team, class Index, class Options, class Kind>
bool any_of_bodies(const Team& team, const replicated<bodies<Index>>& all, const Options& options, const char* function,
                   const Kind& kind) {
    std::atomic<bool> found{false};
    ask_bodies(team, all, options, false, function, kind, [&](int k, const auto& pairing) {
        if (any_of<A>(team[k], pairing, kind.template judge<A>())) found.store(true);
    });
    return found.load();
}
template <arithmetic A, class Team, class Index, class Options, class Kind>
std::uint64_t count_of_bodies(const Team& team, const replicated<bodies<Index>>& all, const Options& options,
                              const char* function, const Kind& kind) {
    std::atomic<std::uint64_t> sum{0};
    ask_bodies(team, all, options, false, function, kind,
               [&](int k, const auto& pairing) { sum += count_of<A>(team[k], pairing, kind.template judge<A>()); });
    return sum.load();
}
template <arithmetic A, class Team, class Index, class Options, class Kind>
auto pairs_of_bodies(const Team& team, const replicated<bodies<Index>>& all, const Options& options, const char* function,
                     const Kind& kind) {
    return found_of_bodies<body_pair>(team, all, options, function, kind, [&](const auto& on, const auto& pairing) {
        return pairs_of<A>(on, pairing, kind.template names<A>());
    });
}
template <arithmetic A, class Team, class Index, class VisitorOf, class Options, class Kind>
void visit_bodies(const Team& team, const replicated<bodies<Index>>& all, const VisitorOf& visitor_of, const Options& options,
                  const char* function, const Kind& kind) {
    std::vector<std::remove_cvref_t<decltype(visitor_of(0))>> visitors;
    for (int k = 0; k < team.size(); ++k) visitors.push_back(visitor_of(k));
    ask_bodies(team, all, options, false, function, kind, [&](int k, const auto& pairing) {
        visit_pairs_of<A>(team[k], pairing, visitors[static_cast<std::size_t>(k)], kind.template judge<A>());
    });
}

/// Whether `within` takes the bodies of each device.
template <class Team, class Index>
consteval bool can_pair_bodies_on_devices_within() {
    return can_pair_bodies_within<typename Team::local_policy, bodies<Index>>();
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
    return detail::any_of_bodies<A>(team, all, options, "abut::any", detail::pairs_that_touch{});
}

/// Number of pairs of shapes of two bodies that touch. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count(const Team& team, const replicated<bodies<Index>>& all,
                                  const body_options<Filter, Schedule>& options = {}) {
    return detail::count_of_bodies<A>(team, all, options, "abut::count", detail::pairs_that_touch{});
}

/// All pairs of shapes of two different bodies that touch, as under one policy: a `result` of `body_pair` in memory of the
/// first device.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto pairs(const Team& team, const replicated<bodies<Index>>& all,
                         const body_options<Filter, Schedule>& options = {}) {
    return detail::pairs_of_bodies<A>(team, all, options, "abut::pairs", detail::pairs_that_touch{});
}

/// Calls visitor_of(k)(body_pair) -> visit for every such pair, once, on the k-th device, which has found it; otherwise as
/// `for_each_pair` of two arguments on several devices.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class VisitorOf, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
void for_each_pair(const Team& team, const replicated<bodies<Index>>& all, const VisitorOf& visitor_of,
                   const body_options<Filter, Schedule>& options = {}) {
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    if constexpr (detail::is_visitor<typename Team::local_policy, visitor, body_pair>()) {
        detail::visit_bodies<A>(team, all, visitor_of, options, "abut::for_each_pair", detail::pairs_that_touch{});
    }
}

/// Their contacts, as under one policy: a `result` of `body_contact` in memory of the first device.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto contacts(const Team& team, const replicated<bodies<Index>>& all,
                            const body_options<Filter, Schedule>& options = {}) {
    return detail::found_of_bodies<body_contact<typename Index::scalar_type>>(
        team, all, options, "abut::contacts", detail::pairs_that_touch{}, [&](const auto& on, const auto& pairing) {
            return detail::contacts_of<A>(on, pairing, options.discard_sideways);
        });
}

/// All pairs of shapes of two different bodies that are no farther apart than `distance`, as `within` of bodies under one
/// policy: a `result` of `body_pair` in memory of the first device.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto within(const Team& team, const replicated<bodies<Index>>& all, double distance,
                          const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_pair_bodies_on_devices_within<Team, Index>()) {
        constexpr const char* function = "abut::within";
        detail::check_distance(distance, function);
        return detail::pairs_of_bodies<A>(team, all, options, function, detail::pairs_within{distance});
    } else {
        return result<body_pair, space_of<typename Team::local_policy>>();
    }
}

/// Number of the pairs of `within`. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count_within(const Team& team, const replicated<bodies<Index>>& all, double distance,
                                         const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_pair_bodies_on_devices_within<Team, Index>()) {
        constexpr const char* function = "abut::count_within";
        detail::check_distance(distance, function);
        return detail::count_of_bodies<A>(team, all, options, function, detail::pairs_within{distance});
    } else {
        return 0;
    }
}

/// Whether any shape of a body is no farther than `distance` from any of another. Each device stops soon after the first
/// pair that it finds.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any_within(const Team& team, const replicated<bodies<Index>>& all, double distance,
                              const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_pair_bodies_on_devices_within<Team, Index>()) {
        constexpr const char* function = "abut::any_within";
        detail::check_distance(distance, function);
        return detail::any_of_bodies<A>(team, all, options, function, detail::pairs_within{distance});
    } else {
        return false;
    }
}

/// Calls visitor_of(k)(body_pair) -> visit once for every pair of `within`, on the k-th device, which has found it;
/// otherwise as `for_each_pair` of bodies on several devices.
template <arithmetic A = filtered, execution::policy_team Team, class Index, class VisitorOf, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
void for_each_within(const Team& team, const replicated<bodies<Index>>& all, double distance, const VisitorOf& visitor_of,
                     const body_options<Filter, Schedule>& options = {}) {
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    if constexpr (detail::can_pair_bodies_on_devices_within<Team, Index>() &&
                  detail::is_visitor<typename Team::local_policy, visitor, body_pair>()) {
        constexpr const char* function = "abut::for_each_within";
        detail::check_distance(distance, function);
        detail::visit_bodies<A>(team, all, visitor_of, options, function, detail::pairs_within{distance});
    }
}

///@}

}  // namespace abut
