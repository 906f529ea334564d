// SPDX-License-Identifier: MIT
#pragma once

// within, count_within, any_within, for_each_within: which shapes of one set are no farther than a distance from which of
// another; and self_within, count_self_within, of one set among itself. They are `pairs` and the others with boxes that may
// be so far apart, and a judge that compares distances exactly (predicate/within.hpp). Not for how far shapes are apart
// (distance.hpp), nor for the nearest ones (nearest.hpp).

#include <concepts>
#include <cstdint>
#include <string>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/pairing.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/error.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/outward.hpp>

namespace abut {

namespace detail {

/// Finds out whether two shapes are no farther apart than a distance, and knows their ids.
template <arithmetic A>
struct come_within {
    double distance;

    template <class S, class U>
    ABUT_HD verdict decide(const S& s, const U& t) const {
        if constexpr (within_as_given<S, U>) {
            return decide_within<A>(s, t, distance);
        } else {
            return decide_within<A>(t, s, distance);
        }
    }
    template <class S, class U>
    ABUT_HD verdict finish(const S& s, const U& t) const {
        if constexpr (std::same_as<A, exact>) {
            return verdict::unknown;  // the first try was all that registers can do
        } else if constexpr (within_as_given<S, U>) {
            return decide_within_open<A>(s, t, distance);
        } else {
            return decide_within_open<A>(t, s, distance);
        }
    }
    template <class S, class U>
    bool resolve(const S& s, const U& t) const {
        if constexpr (within_as_given<S, U>) {
            return resolve_within(s, t, distance);
        } else {
            return resolve_within(t, s, distance);
        }
    }
    template <class View>
    ABUT_HD auto answer(const View& both, std::uint64_t key) const {
        return both.ids(key);
    }
};

/// Whether the judge takes sets of these shapes.
template <class S, class U>
consteval bool can_come_within() {
    constexpr bool is = distance_decidable<S, U>;
    static_assert(
        is,
        "abut: `within` takes sets of points, segments, triangles, spheres, capsules, boxes, hulls, cylinders and cones, and "
        "planes with any of these; rays go with what they may meet");
    return is;
}

inline void check_distance(double distance, const char* function) {
    if (!(distance >= 0 && distance < infinity<double>)) {
        throw error(std::string(function) + ": distance is " + shortest(distance) + "; expected a finite number, 0 or more");
    }
}

/// How near shapes are that are no farther apart than a distance, which is checked.
template <scalar T>
near_in_distance<T> near_within(double distance, const char* function) {
    check_distance(distance, function);
    return near_in_distance<T>{distance_frame<T>(rounded_up<T>(distance))};
}

/// Whether these queries take both arguments and the filter.
template <class Policy, class X, class Y, class Filter>
consteval bool can_be_within() {
    if constexpr (can_both_be_asked<Policy, X, Y>()) {
        return can_come_within<typename shape_of_argument<X>::type, typename shape_of_argument<Y>::type>() &&
               is_filter<Policy, Filter>();
    } else {
        return false;
    }
}

/// Both arguments, ready to be paired: all pairs whose boxes are near enough.
template <class Policy, class X, class Y, class Options>
auto pair_up_within(const Policy& on, const X& x, const Y& y, double distance, const Options& options,
                    const char* function) {
    using T = scalar_type_of<typename shape_of_argument<X>::type>;
    return pair_up(on, x, y, options, function, near_within<T>(distance, function));
}
template <class Policy, class X, class Options>
auto pair_up_self_within(const Policy& on, const X& x, double distance, const Options& options, const char* function) {
    using T = scalar_type_of<typename shape_of_argument<X>::type>;
    return pair_up_self(on, x, options, function, as_they_are{}, near_within<T>(distance, function));
}

}  // namespace detail

/// @defgroup within Which shapes come within a distance
///
/// `within`, `count_within`, `any_within` and `for_each_within` of two arguments: `pairs`, `count`, `any` and
/// `for_each_pair` with a distance; `self_within` and `count_self_within` of one. Arguments are those of @ref queries , of
/// points, segments, triangles, spheres, capsules, boxes, convex hulls, cylinders and cones, each with any of these, and
/// planes with any, and rays with what they may meet: so they find the neighbours of points as well as which parts of two meshes are closer than a clearance.
/// Lists of posed pairs (@ref lists ) and scenes of many bodies (@ref many_bodies ) have them too.
///
/// The distance is a finite double, 0 or more, and taken exactly. A pair that is exactly so far apart belongs to the answer.
/// `filtered`, the default, and `exact` decide that exactly, for every finite input, but for cylinders and cones with each
/// other and for rays, of which they certify it (docs/guide.md); `fast` is approximate. With distance 0 the answer is that of `pairs`. Answers do not depend on the policy, the number of threads or the index. Under a pose that
/// is said of the placed coordinates, each rounded once, as in all queries (docs/numerics.md).
///
/// @par Memory
/// As in @ref queries.
///
/// @par Errors
/// As in @ref queries, and `error` where the distance is negative, infinite or NaN.
///
/// @par Synchronisation
/// As in @ref queries.
///
/// @par Example
/// @snippet queries.cpp within
///@{

/// All pairs of a shape of `a` and a shape of `b` that are no farther apart than `distance`, each once: a `result` of
/// `index_pair` in the policy's memory, sorted by a, then b, unless the options say otherwise.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto within(const Policy& on, const X& a, const Y& b, double distance,
                          const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within<Policy, X, Y, Filter>()) {
        return detail::pairs_of<A>(on, detail::pair_up_within(on, a, b, distance, options, "abut::within"),
                                   detail::come_within<A>{distance});
    } else {
        return result<index_pair, space_of<Policy>>();
    }
}

/// Number of pairs that are no farther apart than `distance` and that the filter wants. Stores none of them.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count_within(const Policy& on, const X& a, const Y& b, double distance,
                                         const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within<Policy, X, Y, Filter>()) {
        return detail::count_of<A>(on, detail::pair_up_within(on, a, b, distance, options, "abut::count_within"),
                                   detail::come_within<A>{distance});
    } else {
        return 0;
    }
}

/// Whether any shape of `a` is no farther than `distance` from any shape of `b`. Stops soon after the first pair found.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] bool any_within(const Policy& on, const X& a, const Y& b, double distance,
                              const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within<Policy, X, Y, Filter>()) {
        return detail::any_of<A>(on, detail::pair_up_within(on, a, b, distance, options, "abut::any_within"),
                                 detail::come_within<A>{distance});
    } else {
        return false;
    }
}

/// Calls visitor(index_pair) -> visit once for every pair that is no farther apart than `distance`, as for_each_pair does.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Visitor, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void for_each_within(const Policy& on, const X& a, const Y& b, double distance, const Visitor& visitor,
                     const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within<Policy, X, Y, Filter>() && detail::is_visitor<Policy, Visitor, index_pair>()) {
        detail::visit_pairs_of<A>(on, detail::pair_up_within(on, a, b, distance, options, "abut::for_each_within"), visitor,
                                  detail::come_within<A>{distance});
    }
}

/// All pairs of shapes of `x` that are no farther apart than `distance`, each once with a < b. A shape is not paired with
/// itself. Faces of a mesh are triangles here: neighbours are 0 apart and belong to the answer.
///
///     for (const auto [i, j] : to_host(abut::self_within(on, abut::make_bvh(on, vertices(mesh)), 0.5))) mark(i, j);
template <arithmetic A = filtered, execution_policy Policy, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto self_within(const Policy& on, const X& x, double distance,
                               const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within<Policy, X, X, Filter>()) {
        return detail::pairs_of<A>(on, detail::pair_up_self_within(on, x, distance, options, "abut::self_within"),
                                   detail::come_within<A>{distance});
    } else {
        return result<index_pair, space_of<Policy>>();
    }
}

/// Number of the pairs of `self_within`. Stores none of them.
template <arithmetic A = filtered, execution_policy Policy, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count_self_within(const Policy& on, const X& x, double distance,
                                              const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_be_within<Policy, X, X, Filter>()) {
        return detail::count_of<A>(on, detail::pair_up_self_within(on, x, distance, options, "abut::count_self_within"),
                                   detail::come_within<A>{distance});
    } else {
        return 0;
    }
}

///@}

}  // namespace abut
