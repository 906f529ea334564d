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
#include <abut/collide/nearness.hpp>
#include <abut/collide/question.hpp>
#include <abut/error.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/outward.hpp>

namespace abut {

namespace detail {

/// Finds out whether two shapes are no farther apart than a distance.
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
};

/// Whether the judge takes sets of these shapes.
template <class S, class U>
consteval bool can_come_within() {
    constexpr bool is = distance_decidable<S, U>;
    static_assert(
        is,
        "abut: `within` takes sets of points, segments, triangles, spheres, capsules, boxes, hulls, cylinders and cones, and "
        "planes with any of these; rays go with what they may meet; a shape of your own needs decide_within<A>(s, t, distance) and "
        "resolve_within(s, t, distance) beside it (docs/extending.md)");
    return is;
}

inline void check_distance(double distance, const char* function) {
    if (!(distance >= 0 && distance < infinity<double>)) {
        throw error(std::string(function) + ": distance is " + shortest(distance) + "; expected a finite number, 0 or more");
    }
}

/// Two shapes are no farther apart than a distance.
struct within_distance : relation {
    double distance;

    explicit within_distance(double d) : distance(d) {}
    void check(const char* function) const { check_distance(distance, function); }
    template <arithmetic A>
    [[nodiscard]] come_within<A> judge() const {
        return {distance};
    }
    template <class S, class U>
    static consteval bool decides() {
        return can_come_within<S, U>();
    }
    template <scalar T>
    [[nodiscard]] near_in_distance<T> nearness() const {
        return {distance_frame<T>(rounded_up<T>(distance))};
    }
    [[nodiscard]] double agreed() const { return distance; }
};

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
/// other and for rays, of which they certify it (docs/guide/distances.md); `fast` is approximate. With distance 0 the answer
/// is that of `pairs`. Answers do not depend on the policy, the number of threads or the index. Under a pose that is said of
/// the placed coordinates, each rounded once, as in all queries (docs/numerics.md).
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
/// `index_pair` in the policy's memory, sorted by a, then b, unless the options say otherwise. Of several devices and of ranks
/// as `pairs`; each rank gives the same distance.
template <arithmetic A = filtered, executor On, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
    requires(!detail::scene<X>)
[[nodiscard]] auto within(const On& on, const X& a, const Y& b, double distance,
                          const query_options<Filter, Traversal, Schedule>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::all_pairs{}), detail::two{a, b},
                     options, "abut::within");
}

/// The same of the two sides of each entry of a list, or of each two bodies: results as of `pairs`.
///
///     for (const auto& near : to_host(abut::within(on, list, 0.01))) use(near.pair, near.a, near.b);
///     for (const auto& near : to_host(abut::within(on, bodies, 0.01))) use(near.body_a, near.a, near.body_b, near.b);
template <arithmetic A = filtered, executor On, detail::scene Scene, detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto within(const On& on, const Scene& scene, double distance, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::all_pairs{}), detail::whole(scene),
                     options, "abut::within");
}

/// Number of pairs that are no farther apart than `distance` and that the filter wants, of all ranks together. Stores none
/// of them.
template <arithmetic A = filtered, executor On, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
    requires(!detail::scene<X>)
[[nodiscard]] auto count_within(const On& on, const X& a, const Y& b, double distance,
                                         const query_options<Filter, Traversal, Schedule>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::how_many{}), detail::two{a, b},
                     options, "abut::count_within");
}

/// The same of a list or of bodies.
template <arithmetic A = filtered, executor On, detail::scene Scene, detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto count_within(const On& on, const Scene& scene, double distance, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::how_many{}), detail::whole(scene),
                     options, "abut::count_within");
}

/// Whether any shape of `a` is no farther than `distance` from any shape of `b`. Stops soon after the first pair found.
template <arithmetic A = filtered, executor On, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
    requires(!detail::scene<X>)
[[nodiscard]] auto any_within(const On& on, const X& a, const Y& b, double distance,
                              const query_options<Filter, Traversal, Schedule>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::whether{}), detail::two{a, b}, options,
                     "abut::any_within");
}

/// The same of the entries of a list, or of two bodies.
template <arithmetic A = filtered, executor On, detail::scene Scene, detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto any_within(const On& on, const Scene& scene, double distance, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::whether{}), detail::whole(scene),
                     options, "abut::any_within");
}

/// Calls a visitor once for every pair that is no farther apart than `distance`, as for_each_pair does.
template <arithmetic A = filtered, executor On, class X, class Y, class Visitor, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
    requires(!detail::scene<X>)
void for_each_within(const On& on, const X& a, const Y& b, double distance, const Visitor& visitor,
                     const query_options<Filter, Traversal, Schedule>& options = {}) {
    ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::visited_by(visitor)), detail::two{a, b},
              options, "abut::for_each_within");
}

/// The same of a list or of bodies.
template <arithmetic A = filtered, executor On, detail::scene Scene, class Visitor,
          detail::options_of<Scene> Options = detail::default_options<Scene>>
void for_each_within(const On& on, const Scene& scene, double distance, const Visitor& visitor,
                     const Options& options = {}) {
    ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::visited_by(visitor)), detail::whole(scene),
              options, "abut::for_each_within");
}

/// All pairs of shapes of `x` that are no farther apart than `distance`, each once with a < b. A shape is not paired with
/// itself. Faces of a mesh are triangles here: neighbours are 0 apart and belong to the answer.
///
///     for (const auto [i, j] : to_host(abut::self_within(on, abut::make_bvh(on, vertices(mesh)), 0.5))) mark(i, j);
template <arithmetic A = filtered, executor On, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto self_within(const On& on, const X& x, double distance,
                               const query_options<Filter, Traversal, Schedule>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::all_pairs{}), detail::alone{x},
                     options, "abut::self_within");
}

/// Number of the pairs of `self_within`. Stores none of them.
template <arithmetic A = filtered, executor On, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto count_self_within(const On& on, const X& x, double distance,
                                              const query_options<Filter, Traversal, Schedule>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::within_distance(distance), detail::how_many{}), detail::alone{x},
                     options, "abut::count_self_within");
}

///@}

}  // namespace abut
