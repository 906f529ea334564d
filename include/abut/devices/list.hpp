// SPDX-License-Identifier: MIT
#pragma once

// Lists of posed pairs on several devices. Each device has all indices. Entries are dealt out one by one, so that
// neighbours, which are often alike, fall to different devices.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/list.hpp>
#include <abut/collide/list_distance.hpp>
#include <abut/collide/list_within.hpp>
#include <abut/collide/merge.hpp>
#include <abut/collide/pair_kinds.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/merge.hpp>
#include <abut/execution/team.hpp>

namespace abut {

/// An entry of a list for several devices: two indices that each device has, each under a pose. Write
/// `posed_pair<decltype(gear)>{posed(gear, here), posed(gear, there)}`, where `gear` is what make_bvh of several devices
/// made.
/// @ingroup devices
template <class IndexA, class IndexB>
struct posed_pair<replicated<IndexA>, replicated<IndexB>> {
    replicated<posed_object<IndexA>> a;  ///< the first one
    replicated<posed_object<IndexB>> b;  ///< the second one
};

namespace detail {

/// Positions of a device's entries in the whole list.
struct entries_of_part {
    std::uint32_t part, parts;
    [[nodiscard]] ABUT_HD std::uint32_t operator()(std::size_t i) const {
        return static_cast<std::uint32_t>(i * parts + part);
    }
    template <class Found>
    [[nodiscard]] ABUT_HD Found named(Found of) const {
        of.pair = (*this)(of.pair);
        return of;
    }
};
template <class Found>
struct put_entries {
    const Found* found;
    entries_of_part position;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const { out[position(i)] = found[i]; }
};
struct by_entry {
    template <class Found>
    ABUT_HD bool operator()(const Found& x, const Found& y) const {
        return x.pair != y.pair ? x.pair < y.pair : by_ids{}(x, y);
    }
};

/// The same options for a device's entries.
template <class Options>
auto options_there(const Options& options, const entries_of_part& position) {
    auto there = options_of_part(options, position);
    there.scheduling.report = nullptr;  // of one query, and here are several
    return there;
}

/// Runs ask(k, entries, position) on each device, of the entries that fall to it.
template <class Team, class IndexA, class IndexB, class Ask>
void ask_entries(const Team& team, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                 const char* function, const Ask& ask) {
    for (const auto& entry : list) {
        require_as_many(team, entry.a, function);
        require_as_many(team, entry.b, function);
    }
    execution::on_each(team, [&](int k) {
        const entries_of_part position{static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(team.size())};
        std::vector<posed_pair<IndexA, IndexB>> mine;
        for (std::size_t i = position(0); i < list.size(); i = position(mine.size())) {
            mine.push_back({list[i].a[k], list[i].b[k]});
        }
        ask(k, std::as_const(mine), position);
    });
}

/// A device's entries, ready to be asked for pairs of a kind (pair_kinds.hpp).
template <class Policy, class IndexA, class IndexB, class Options, class Kind>
auto pair_up_mine(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& mine, const Options& options,
                  const char* function, const entries_of_part& position, const Kind& kind) {
    return pair_up(on, mine, options_there(options, position), function, position,
                   kind.template nearness<typename IndexA::scalar_type>(function));
}

/// What ask(policy, pairing) finds of each device's entries, as one list.
template <class Found, class Team, class List, class Options, class Kind, class Ask>
auto found_of_entries(const Team& team, const List& list, const Options& options, const char* function, const Kind& kind,
                      const Ask& ask) {
    using local = typename Team::local_policy;
    found_lists<local, Found> found(static_cast<std::size_t>(team.size()));
    ask_entries(team, list, function, [&](int k, const auto& mine, const entries_of_part& position) {
        const local& on = team[k];
        const auto some = ask(on, pair_up_mine(on, mine, options, function, position, kind));
        found[static_cast<std::size_t>(k)] = found_of_part(on, some, position);
    });
    return on_first(team, std::move(found), options.sorted, by_entry{});
}

template <arithmetic A, class Team, class List, class Options, class Kind>
bool any_of_entries(const Team& team, const List& list, const Options& options, const char* function, const Kind& kind) {
    std::atomic<bool> found{false};
    ask_entries(team, list, function, [&](int k, const auto& mine, const auto& position) {
        const auto pairing = pair_up_mine(team[k], mine, options, function, position, kind);
        if (any_of<A>(team[k], pairing, kind.template judge<A>())) found.store(true);
    });
    return found.load();
}
template <arithmetic A, class Team, class List, class Options, class Kind>
std::uint64_t count_of_entries(const Team& team, const List& list, const Options& options, const char* function,
                               const Kind& kind) {
    std::atomic<std::uint64_t> sum{0};
    ask_entries(team, list, function, [&](int k, const auto& mine, const auto& position) {
        const auto pairing = pair_up_mine(team[k], mine, options, function, position, kind);
        sum += count_of<A>(team[k], pairing, kind.template judge<A>());
    });
    return sum.load();
}
template <arithmetic A, class Team, class List, class Options, class Kind>
auto pairs_of_entries(const Team& team, const List& list, const Options& options, const char* function, const Kind& kind) {
    return found_of_entries<tagged_pair>(team, list, options, function, kind, [&](const auto& on, const auto& pairing) {
        return pairs_of<A>(on, pairing, kind.template names<A>());
    });
}
template <arithmetic A, class Team, class List, class VisitorOf, class Options, class Kind>
void visit_entries(const Team& team, const List& list, const VisitorOf& visitor_of, const Options& options,
                   const char* function, const Kind& kind) {
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    std::vector<visitor> visitors;
    for (int k = 0; k < team.size(); ++k) visitors.push_back(visitor_of(k));
    ask_entries(team, list, function, [&](int k, const auto& mine, const auto& position) {
        const auto pairing = pair_up_mine(team[k], mine, options, function, position, kind);
        const call_of_part<visitor, entries_of_part> visits{visitors[static_cast<std::size_t>(k)], position};
        visit_pairs_of<A>(team[k], pairing, visits, kind.template judge<A>());
    });
}

template <class Team, class A, class B>
consteval bool can_be_listed_on_devices() {
    return can_be_listed<typename Team::local_policy, A, B>();
}

}  // namespace detail

/// @addtogroup devices
///@{

/// Whether the shapes of any entry touch, as `any` of a list under one policy.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any(const Team& team, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                       const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_on_devices<Team, IndexA, IndexB>()) {
        return detail::any_of_entries<A>(team, list, options, "abut::any", detail::pairs_that_touch{});
    } else {
        return false;
    }
}

/// Number of pairs of shapes that touch, of all entries.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count(const Team& team,
                                  const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                                  const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_on_devices<Team, IndexA, IndexB>()) {
        return detail::count_of_entries<A>(team, list, options, "abut::count", detail::pairs_that_touch{});
    } else {
        return 0;
    }
}

/// All pairs of shapes that touch, tagged with the entry's position, as `pairs` of a list under one policy: a `result` of
/// `tagged_pair` in memory of the first device.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto pairs(const Team& team, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                         const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_on_devices<Team, IndexA, IndexB>()) {
        return detail::pairs_of_entries<A>(team, list, options, "abut::pairs", detail::pairs_that_touch{});
    } else {
        return result<tagged_pair, space_of<typename Team::local_policy>>();
    }
}

/// Calls visitor_of(k)(tagged_pair) -> visit once for every such pair, on the k-th device, which has found it; otherwise as
/// `for_each_pair` of two arguments on several devices.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class VisitorOf,
          class Filter = keep_all, schedule Schedule = schedule::shared_list>
void for_each_pair(const Team& team, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                   const VisitorOf& visitor_of, const list_options<Filter, Schedule>& options = {}) {
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    if constexpr (detail::can_be_listed_on_devices<Team, IndexA, IndexB>() &&
                  detail::is_visitor<typename Team::local_policy, visitor, tagged_pair>()) {
        detail::visit_entries<A>(team, list, visitor_of, options, "abut::for_each_pair", detail::pairs_that_touch{});
    }
}

/// The contacts of all pairs of shapes that touch, as `contacts` of a list under one policy: a `result` of `tagged_contact`
/// in memory of the first device.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto contacts(const Team& team, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                            const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_on_devices<Team, IndexA, IndexB>()) {
        return detail::found_of_entries<tagged_contact<typename IndexA::scalar_type>>(
            team, list, options, "abut::contacts", detail::pairs_that_touch{}, [&](const auto& on, const auto& pairing) {
                return detail::contacts_of<A>(on, pairing, options.discard_sideways);
            });
    } else {
        return result<tagged_contact<float>, space_of<typename Team::local_policy>>();
    }
}

/// How far apart the two indices of each entry are, as `distance` of a list under one policy: a `result` of `separation`,
/// one of each entry, in memory of the first device.
template <execution::policy_team Team, class IndexA, class IndexB>
[[nodiscard]] auto distance(const Team& team, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                            const distance_options& options = {}) {
    using local = typename Team::local_policy;
    if constexpr (detail::can_be_measured<local, IndexA, IndexB>()) {
        using found_type = separation<typename IndexA::scalar_type>;
        std::vector<result<found_type, space_of<local>>> found(static_cast<std::size_t>(team.size()));
        detail::ask_entries(team, list, "abut::distance", [&](int k, const auto& mine, const auto& position) {
            found[static_cast<std::size_t>(k)] = detail::distances_of(team[k], mine, options, "abut::distance", position);
        });
        execution::buffer_of<local, found_type> all(team[0], list.size());
        for (int k = 0; k < team.size(); ++k) {
            const auto& some = found[static_cast<std::size_t>(k)];
            execution::buffer_of<local, found_type> came(team[0], some.size());
            copy_across(team[k], some.data(), some.size(), team[0], came.data());
            const detail::entries_of_part position{static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(team.size())};
            for_each_index(team[0], some.size(), detail::put_entries<found_type>{came.data(), position, all.data()});
            synchronize(team[0]);
        }
        return result<found_type, space_of<local>>(std::move(all));
    } else {
        return result<separation<float>, space_of<local>>();
    }
}

/// All pairs of shapes that are no farther apart than `distance`, of all entries, as `within` of a list under one policy: a
/// `result` of `tagged_pair` in memory of the first device.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto within(const Team& team, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                          double distance, const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<typename Team::local_policy, IndexA, IndexB>()) {
        constexpr const char* function = "abut::within";
        detail::check_distance(distance, function);
        return detail::pairs_of_entries<A>(team, list, options, function, detail::pairs_within{distance});
    } else {
        return result<tagged_pair, space_of<typename Team::local_policy>>();
    }
}

/// Number of the pairs of `within`, of all entries. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count_within(const Team& team,
                                         const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                                         double distance, const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<typename Team::local_policy, IndexA, IndexB>()) {
        constexpr const char* function = "abut::count_within";
        detail::check_distance(distance, function);
        return detail::count_of_entries<A>(team, list, options, function, detail::pairs_within{distance});
    } else {
        return 0;
    }
}

/// Whether two shapes of any entry are no farther apart than `distance`. Each device stops soon after the first pair that it
/// finds.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any_within(const Team& team,
                              const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list, double distance,
                              const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<typename Team::local_policy, IndexA, IndexB>()) {
        constexpr const char* function = "abut::any_within";
        detail::check_distance(distance, function);
        return detail::any_of_entries<A>(team, list, options, function, detail::pairs_within{distance});
    } else {
        return false;
    }
}

/// Calls visitor_of(k)(tagged_pair) -> visit once for every pair of `within`, on the k-th device, which has found it;
/// otherwise as `for_each_pair` of a list on several devices.
template <arithmetic A = filtered, execution::policy_team Team, class IndexA, class IndexB, class VisitorOf,
          class Filter = keep_all, schedule Schedule = schedule::shared_list>
void for_each_within(const Team& team, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list,
                     double distance, const VisitorOf& visitor_of, const list_options<Filter, Schedule>& options = {}) {
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    if constexpr (detail::can_be_listed_within<typename Team::local_policy, IndexA, IndexB>() &&
                  detail::is_visitor<typename Team::local_policy, visitor, tagged_pair>()) {
        constexpr const char* function = "abut::for_each_within";
        detail::check_distance(distance, function);
        detail::visit_entries<A>(team, list, visitor_of, options, function, detail::pairs_within{distance});
    }
}

///@}

}  // namespace abut
