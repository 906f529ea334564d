// SPDX-License-Identifier: MIT
#pragma once

// within, count_within, any_within, for_each_within of a list: of many pairs of posed indices in one call, of each what
// these say of the two alone (within.hpp). They are the queries of list.hpp with boxes that may be so far apart, and the
// judge of within.hpp. Not for how far apart the two of an entry are: that is list_distance.hpp.

#include <cstdint>
#include <vector>

#include <abut/collide/list.hpp>
#include <abut/collide/within.hpp>

namespace abut {

namespace detail {

/// Whether `within` takes a list of these indices.
template <class Policy, class IndexA, class IndexB>
consteval bool can_be_listed_within() {
    if constexpr (can_be_listed<Policy, IndexA, IndexB>()) {
        return can_come_within<shape_in_world<IndexA>, shape_in_world<IndexB>>();
    } else {
        return false;
    }
}

/// A list, ready to be asked: all pairs whose boxes are near enough.
template <class Policy, class IndexA, class IndexB, class Options>
auto pair_up_within(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list, double distance,
                    const Options& options, const char* function) {
    return pair_up(on, list, options, function, own_positions{},
                   near_within<typename IndexA::scalar_type>(distance, function));
}

}  // namespace detail

/// @addtogroup lists
///@{

/// All pairs of shapes that are no farther apart than `distance`, of all entries: of each entry what `within` says of its
/// two indices alone (see @ref within ), tagged with the entry's position. A `result` of tagged_pair in the policy's memory,
/// 12 bytes each. The distance is taken exactly, and an `error` if it is negative, infinite or NaN.
///
///     for (const auto& near : to_host(abut::within(on, list, 0.01))) use(near.pair, near.a, near.b);
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto within(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list, double distance,
                          const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<Policy, IndexA, IndexB>()) {
        return detail::pairs_of<A>(on, detail::pair_up_within(on, list, distance, options, "abut::within"),
                                   detail::come_within<A>{distance});
    } else {
        return result<tagged_pair, space_of<Policy>>();
    }
}

/// Number of the pairs of `within`, of all entries. Stores none of them.
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count_within(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                                         double distance, const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<Policy, IndexA, IndexB>()) {
        return detail::count_of<A>(on, detail::pair_up_within(on, list, distance, options, "abut::count_within"),
                                   detail::come_within<A>{distance});
    } else {
        return 0;
    }
}

/// Whether two shapes of any entry are no farther apart than `distance`. Stops soon after the first pair found.
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any_within(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list, double distance,
                              const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<Policy, IndexA, IndexB>()) {
        return detail::any_of<A>(on, detail::pair_up_within(on, list, distance, options, "abut::any_within"),
                                 detail::come_within<A>{distance});
    } else {
        return false;
    }
}

/// Calls visitor(tagged_pair) -> visit once for every pair of `within`; see for_each_pair of two arguments.
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Visitor,
          class Filter = keep_all, schedule Schedule = schedule::shared_list>
void for_each_within(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list, double distance,
                     const Visitor& visitor, const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<Policy, IndexA, IndexB>() &&
                  detail::is_visitor<Policy, Visitor, tagged_pair>()) {
        detail::visit_pairs_of<A>(on, detail::pair_up_within(on, list, distance, options, "abut::for_each_within"), visitor,
                                  detail::come_within<A>{distance});
    }
}

///@}

}  // namespace abut
