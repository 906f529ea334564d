// SPDX-License-Identifier: MIT
#pragma once

// `within`: are two shapes no farther apart than a distance? The distance of shapes that are convex hulls of points, or what
// is within a radius of such a hull, from each other or from a plane, is compared with a number that is taken as it is. The
// squared distance is a rational of the input, and so the answer is decided exactly. Cylinders and cones with all of these
// are decided exactly as well, by signs of polynomials; with each other they are certified, and so are rays. Not for how far apart they are:
// that is distance (narrow/distance.hpp), which rounds.

#include <concepts>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/as_hull.hpp>
#include <abut/predicate/box_within.hpp>
#include <abut/predicate/half_space.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/predicate/ray_within.hpp>
#include <abut/predicate/revolution_pair_within.hpp>
#include <abut/predicate/revolution_within.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/shape.hpp>

namespace abut {

namespace detail {

// The stages of shapes that are seen as hulls are those of the hull (as_hull.hpp), and those of a half space its plane's, if
// none of it a point tells (half_space.hpp). The others are written in one order of two shapes.

template <class S, class U>
concept has_stages_within = std::same_as<scalar_type_of<S>, scalar_type_of<U>> &&
    (requires(const S& s, const U& t) { resolve_within(s, t, 0.0); } ||
     requires(const S& s, const U& t) { resolve_within(t, s, 0.0); });
template <class S, class U>
concept within_as_hull = seen_as_hull<S> && !std::same_as<U, hull_form_of<S>> && !is_half_space<U> &&
                         has_stages_within<hull_form_of<S>, hull_form_of<U>>;

template <arithmetic A, class S, class U>
    requires within_as_hull<S, U>
ABUT_HD constexpr verdict decide_within(const S& s, const U& t, double distance) {
    const auto a = hull_form(s);
    const auto b = hull_form(t);
    return decide_within_in_place<A>(a.as_hull(), b.as_hull(), distance);
}
template <arithmetic A, class S, class U>
    requires(within_as_hull<S, U> && std::same_as<A, filtered>)
ABUT_HD constexpr verdict decide_within_late(const S& s, const U& t, double distance) {
    const auto a = hull_form(s);
    const auto b = hull_form(t);
    if constexpr (requires { decide_within_late<A>(a.as_hull(), b.as_hull(), distance); }) {
        return decide_within_late<A>(a.as_hull(), b.as_hull(), distance);
    } else {
        return verdict::unknown;
    }
}
template <class S, class U>
    requires within_as_hull<S, U>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const S& s, const U& t, double distance) {
    const auto a = hull_form(s);
    const auto b = hull_form(t);
    return resolve_within_in_place(a.as_hull(), b.as_hull(), distance);
}

template <arithmetic A, scalar T, beside_plane<T> S>
ABUT_HD constexpr verdict decide_within(const half_space<T>& s, const S& t, double distance) {
    const verdict v = decide<A>(s, any_point_of(t));
    const auto shape = hull_form(t);
    return v == verdict::yes ? v : v || decide_within_in_place<A>(surface_of(s), shape.as_hull(), distance);
}
template <scalar T, beside_plane<T> S>
ABUT_HD constexpr bool resolve_within(const half_space<T>& s, const S& t, double distance) {
    const auto shape = hull_form(t);
    return resolve(s, any_point_of(t)) || resolve_within_in_place(surface_of(s), shape.as_hull(), distance);
}

/// Shapes in the order in which their stages are written.
template <class S, class U>
concept within_as_given = std::same_as<scalar_type_of<S>, scalar_type_of<U>> && requires(const S& s, const U& t) {
    resolve_within(s, t, 0.0);
};

/// What the first stage left, in registers; `unknown` only where the exponents of all numbers span more than 124 bits.
template <arithmetic A, class S, class U>
ABUT_HD constexpr verdict decide_within_open(const S& s, const U& t, double distance) {
    if constexpr (!std::same_as<A, exact> && requires { decide_within_late<A>(s, t, distance); }) {
        if (std::same_as<A, fast> || !ABUT_CONSTANT_EVALUATED()) {
            const verdict v = decide_within_late<A>(s, t, distance);
            if (std::same_as<A, fast> || v != verdict::unknown) return v;
        }
    }
    return decide_within<exact>(s, t, distance);
}

}  // namespace detail

/// Two shapes whose distance can be compared with a number: points, segments, triangles, spheres, capsules, boxes, convex
/// hulls, cylinders and cones, each with each, and a plane with any of these; and a ray with what it may meet, but for
/// planes; of one scalar type.
template <class S, class U>
concept distance_decidable = detail::within_as_given<S, U> || detail::within_as_given<U, S>;

/// Whether two closed shapes are no farther apart than `distance`, which is finite and 0 or more: points, segments,
/// triangles, spheres, capsules, boxes, convex hulls, cylinders and cones with each other, a plane with any of them, and a ray
/// with a triangle, sphere, capsule, box, hull, cylinder or cone. With `filtered` and `exact` the answer is right for every finite input, with the distance taken exactly as the double that it
/// is, and the same on each compiler and device; `fast` is approximate. With distance 0 it is `intersects`. Constant
/// expressions are decided in integers.
///
/// Of two cylinders, two cones, one of each, or a ray and another shape the answer is certified: it may be yes as well where
/// they are farther apart than a distance above 0, but by less than 2^-100 of the size of both.
///
///     static_assert(abut::within(abut::sphere<float>{{0, 0, 5}, 1}, abut::vec3<float>{0, 0, 1}, 3));
/// @ingroup one_pair
template <arithmetic A = filtered, shape S, shape U>
[[nodiscard]] ABUT_HD constexpr bool within(const S& s, const U& t, double distance) {
    if constexpr (!distance_decidable<S, U>) {
        static_assert(distance_decidable<S, U>,
                      "abut::within does not support this pair of shapes (both of one scalar type; rays go with what they "
                      "may meet, and planes not with planes; a shape of your own needs decide_within<A>(s, t, distance) and "
                      "resolve_within(s, t, distance) beside it: docs/extending.md)");
        return false;
    } else if constexpr (!detail::within_as_given<S, U>) {
        return within<A>(t, s, distance);
    } else {
        using namespace detail;  // and what is beside a shape of the caller's own
        const S& stored_s = detail::as_stored(s);
        const U& stored_t = detail::as_stored(t);
        if (!std::same_as<A, exact> && !ABUT_CONSTANT_EVALUATED()) {
            const verdict v = decide_within<A>(stored_s, stored_t, distance);
            if (v != verdict::unknown) return v == verdict::yes;
        }
        const verdict v = detail::decide_within_open<A>(stored_s, stored_t, distance);
        return v == verdict::unknown ? resolve_within(stored_s, stored_t, distance) : v == verdict::yes;
    }
}

}  // namespace abut
