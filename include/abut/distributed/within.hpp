// SPDX-License-Identifier: MIT
#pragma once

// within and the queries beside it, of sets whose parts lie on many ranks: those of query.hpp with a distance.

#include <cstdint>

#include <abut/collide/pair_kinds.hpp>
#include <abut/collide/within.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/query.hpp>

namespace abut {

namespace detail {

/// Whether these queries of ranks take their arguments.
template <class Local, class X, class Y, class Filter>
consteval bool can_be_within_globally() {
    if constexpr (can_be_within<Local, X, Y, keep_all>()) {
        return can_pair_globally<Local, X, Y, Filter>();
    } else {
        return false;
    }
}

/// Pairs that no rank asks about before all have found that they ask about the same.
template <class Local>
pairs_within agreed_pairs_within(const distributed<Local>& on, double distance, const char* function) {
    attempts attempt;
    attempt([&] { check_distance(distance, function); });
    attempt.settle(on.ranks());
    require_one(on.ranks(), distance, function, "distances");
    return {distance};
}

}  // namespace detail

/// @addtogroup distributed
///@{

/// All pairs of this rank's a-shapes that are no farther apart than `distance`, each once: a `result` of `global_pair` in
/// the local policy's memory, sorted by a, then b, unless the options say otherwise. The lists of all ranks, one after
/// another, are the list of one machine. Arguments are this rank's parts, as those of `within` under the local policy; each
/// rank gives the same distance. Shapes of b go to the ranks whose a-shapes they come so near.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto within(const distributed<Local>& on, const X& a, const Y& b, double distance,
                          const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_globally<Local, X, Y, Filter>()) {
        constexpr const char* function = "abut::within";
        return detail::pairs_of_parts<A>(on, a, b, options, function, detail::agreed_pairs_within(on, distance, function));
    } else {
        return result<global_pair, space_of<Local>>();
    }
}

/// Number of the pairs of `within` of all ranks: the same answer on each.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count_within(const distributed<Local>& on, const X& a, const Y& b, double distance,
                                         const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_globally<Local, X, Y, Filter>()) {
        constexpr const char* function = "abut::count_within";
        return detail::count_of_parts<A>(on, a, b, options, function, detail::agreed_pairs_within(on, distance, function));
    } else {
        return 0;
    }
}

/// Whether there is any such pair: the same answer on all ranks.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] bool any_within(const distributed<Local>& on, const X& a, const Y& b, double distance,
                              const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_globally<Local, X, Y, Filter>()) {
        constexpr const char* function = "abut::any_within";
        return detail::any_of_parts<A>(on, a, b, options, function, detail::agreed_pairs_within(on, distance, function));
    } else {
        return false;
    }
}

/// Calls visitor(global_pair) -> visit once for every such pair of this rank's a-shapes, as `for_each_pair` of ranks does.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Visitor, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void for_each_within(const distributed<Local>& on, const X& a, const Y& b, double distance, const Visitor& visitor,
                     const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_globally<Local, X, Y, Filter>() && detail::is_global_visitor<Local, Visitor>()) {
        constexpr const char* function = "abut::for_each_within";
        detail::visit_all_parts<A>(on, a, b, visitor, options, function,
                                   detail::agreed_pairs_within(on, distance, function));
    }
}

/// All pairs of shapes of one set that are no farther apart than `distance`, each once with a < b, of which a is this
/// rank's: a `result` of `global_pair`. `x` is this rank's part.
template <arithmetic A = filtered, execution_policy Local, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto self_within(const distributed<Local>& on, const X& x, double distance,
                               const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_globally<Local, X, X, Filter>()) {
        constexpr const char* function = "abut::self_within";
        return detail::pairs_of_parts<A>(on, x, detail::itself{}, options, function,
                                         detail::agreed_pairs_within(on, distance, function));
    } else {
        return result<global_pair, space_of<Local>>();
    }
}

/// The number of the pairs of `self_within` of all ranks: the same answer on each.
template <arithmetic A = filtered, execution_policy Local, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count_self_within(const distributed<Local>& on, const X& x, double distance,
                                              const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within_globally<Local, X, X, Filter>()) {
        constexpr const char* function = "abut::count_self_within";
        return detail::count_of_parts<A>(on, x, detail::itself{}, options, function,
                                         detail::agreed_pairs_within(on, distance, function));
    } else {
        return 0;
    }
}

///@}

}  // namespace abut
