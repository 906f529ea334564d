// SPDX-License-Identifier: MIT
#pragma once

// within, count_within, any_within, for_each_within of a scene of many bodies: which shapes of one body are no farther than
// a distance from which of another. They are the queries of body_pairs.hpp with boxes that may be so far apart, of bodies
// and of their shapes, and the judge of within.hpp. Not for pairs within one body: those are self_within of its index.

#include <cstdint>

#include <abut/collide/body_pairs.hpp>
#include <abut/collide/within.hpp>

namespace abut {

namespace detail {

/// Whether `within` takes the bodies.
template <class Policy, class Bodies>
consteval bool can_pair_bodies_within() {
    if constexpr (can_pair_bodies<Policy, Bodies>()) {
        using shape_type = shape_in_world<typename index_of_bodies<Bodies>::type>;
        return can_come_within<shape_type, shape_type>();
    } else {
        return false;
    }
}

/// Bodies, ready to be asked: all pairs whose boxes are near enough.
template <class Policy, class Bodies, class Options>
auto pair_up_bodies_within(const Policy& on, const Bodies& all, double distance, const Options& options, bool sorted,
                           const char* function) {
    using T = typename index_of_bodies<Bodies>::type::scalar_type;
    return pair_up_bodies(on, all, options, sorted, function, whole_search{}, near_within<T>(distance, function));
}

}  // namespace detail

/// @addtogroup many_bodies
///@{

/// All pairs of shapes of two different bodies that are no farther apart than `distance`, each once: of each two bodies what
/// `within` says of their posed indices (see @ref within ). A `result` of body_pair in the policy's memory, 16 bytes each.
/// The distance is taken exactly, and an `error` if it is negative, infinite or NaN.
///
///     for (const auto& near : to_host(abut::within(on, bodies, 0.01))) use(near.body_a, near.a, near.body_b, near.b);
template <arithmetic A = filtered, execution_policy Policy, many_bodies Bodies, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto within(const Policy& on, const Bodies& all, double distance,
                          const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_pair_bodies_within<Policy, Bodies>()) {
        return detail::pairs_of<A>(on,
                                   detail::pair_up_bodies_within(on, all, distance, options, options.sorted, "abut::within"),
                                   detail::come_within<A>{distance});
    } else {
        return result<body_pair, space_of<Policy>>();
    }
}

/// Number of the pairs of `within`. Stores none of them.
template <arithmetic A = filtered, execution_policy Policy, many_bodies Bodies, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count_within(const Policy& on, const Bodies& all, double distance,
                                         const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_pair_bodies_within<Policy, Bodies>()) {
        return detail::count_of<A>(on,
                                   detail::pair_up_bodies_within(on, all, distance, options, false, "abut::count_within"),
                                   detail::come_within<A>{distance});
    } else {
        return 0;
    }
}

/// Whether any shape of a body is no farther than `distance` from any of another. Stops soon after the first pair found.
template <arithmetic A = filtered, execution_policy Policy, many_bodies Bodies, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any_within(const Policy& on, const Bodies& all, double distance,
                              const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_pair_bodies_within<Policy, Bodies>()) {
        return detail::any_of<A>(on, detail::pair_up_bodies_within(on, all, distance, options, false, "abut::any_within"),
                                 detail::come_within<A>{distance});
    } else {
        return false;
    }
}

/// Calls visitor(body_pair) -> visit once for every pair of `within`; see for_each_pair of two arguments.
template <arithmetic A = filtered, execution_policy Policy, many_bodies Bodies, class Visitor, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
void for_each_within(const Policy& on, const Bodies& all, double distance, const Visitor& visitor,
                     const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_pair_bodies_within<Policy, Bodies>() && detail::is_visitor<Policy, Visitor, body_pair>()) {
        detail::visit_pairs_of<A>(on,
                                  detail::pair_up_bodies_within(on, all, distance, options, false, "abut::for_each_within"),
                                  visitor, detail::come_within<A>{distance});
    }
}

///@}

}  // namespace abut
