// SPDX-License-Identifier: MIT
#pragma once

// within and the queries beside it on several devices: those of query.hpp with a distance.

#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/pair_kinds.hpp>
#include <abut/collide/within.hpp>
#include <abut/devices/query.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

/// Whether these queries of several devices take their arguments and options.
template <class Team, class X, class Y, class Filter, traversal Traversal>
consteval bool can_be_within_on_devices() {
    static_assert(Traversal == traversal::both_at_once, "abut: queries of several devices walk both_at_once");
    return Traversal == traversal::both_at_once &&
           can_be_within<typename Team::local_policy, type_on_device<X>, type_on_device<Y>, Filter>();
}

}  // namespace detail

/// @addtogroup devices
///@{

/// All pairs that are no farther apart than `distance`, as `within` finds them under one policy: a `result` of `index_pair`
/// in memory of the first device, sorted by a, then b, unless the options say otherwise. Arguments are those of `pairs` on
/// several devices, of shapes that `within` takes.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto within(const Team& team, const X& a, const Y& b, double distance,
                          const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_on_devices<Team, X, Y, Filter, Traversal>()) {
        constexpr const char* function = "abut::within";
        detail::check_distance(distance, function);
        return detail::on_first(
            team, detail::pairs_on_each<A>(team, a, b, options, function, detail::pairs_within{distance}), options.sorted);
    } else {
        return result<index_pair, space_of<typename Team::local_policy>>();
    }
}

/// Number of pairs that are no farther apart than `distance` and that the filter wants. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count_within(const Team& team, const X& a, const Y& b, double distance,
                                         const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_on_devices<Team, X, Y, Filter, Traversal>()) {
        constexpr const char* function = "abut::count_within";
        detail::check_distance(distance, function);
        return detail::count_on_devices<A>(team, a, b, options, function, detail::pairs_within{distance});
    } else {
        return 0;
    }
}

/// Whether any pair is no farther apart than `distance`. Each device stops soon after the first one that it finds.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] bool any_within(const Team& team, const X& a, const Y& b, double distance,
                              const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_on_devices<Team, X, Y, Filter, Traversal>()) {
        constexpr const char* function = "abut::any_within";
        detail::check_distance(distance, function);
        return detail::any_on_devices<A>(team, a, b, options, function, detail::pairs_within{distance});
    } else {
        return false;
    }
}

/// Calls visitor_of(k)(index_pair) -> visit once for every pair that is no farther apart than `distance`, as for_each_pair
/// of several devices does.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class VisitorOf, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void for_each_within(const Team& team, const X& a, const Y& b, double distance, const VisitorOf& visitor_of,
                     const query_options<Filter, Traversal, Schedule>& options = {}) {
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    if constexpr (detail::can_be_within_on_devices<Team, X, Y, Filter, Traversal>() &&
                  detail::is_visitor<typename Team::local_policy, visitor, index_pair>()) {
        constexpr const char* function = "abut::for_each_within";
        detail::check_distance(distance, function);
        detail::visit_on_devices<A>(team, a, b, visitor_of, options, function, detail::pairs_within{distance});
    }
}

/// All pairs of shapes of `x` that are no farther apart than `distance`, as `self_within` finds them under one policy: of a
/// set or an index that lies on each device, or is divided. A `result` of `index_pair` in memory of the first device.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto self_within(const Team& team, const X& x, double distance,
                               const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_on_devices<Team, X, X, Filter, Traversal>()) {
        constexpr const char* function = "abut::self_within";
        detail::check_distance(distance, function);
        return detail::self_pairs_on_devices<A>(team, x, options, function, detail::pairs_within{distance});
    } else {
        return result<index_pair, space_of<typename Team::local_policy>>();
    }
}

/// The number of the pairs of `self_within`. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count_self_within(const Team& team, const X& x, double distance,
                                              const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_on_devices<Team, X, X, Filter, Traversal>()) {
        constexpr const char* function = "abut::count_self_within";
        detail::check_distance(distance, function);
        return detail::count_self_on_devices<A>(team, x, options, function, detail::pairs_within{distance});
    } else {
        return 0;
    }
}

///@}

}  // namespace abut
