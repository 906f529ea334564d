// SPDX-License-Identifier: MIT
#pragma once

// The stages of `within` for a convex hull and another one, or a shape around a core of points: a point, segment, triangle,
// box, sphere or capsule. They are those of a capsule and a hull (capsule_hull.hpp), where the radius is now the shape's own
// and the distance: both are taken as they are, and the square of their sum is compared with that of the cores' distance. A
// plane is within a distance of a hull if it is of a triangle of the hull's points, as plane_hull.hpp has them.

#include <concepts>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/predicate/plane_hull.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Shapes of the scalar type T whose cores are hulls of points.
template <class S, class T>
concept has_core_points = std::same_as<scalar_type_of<S>, T> && requires(const S& s) {
    core_points_of(s).as_hull();
};

/// The first stage: in floating point; or of `exact` in integers, and unknown only where the exponents of all numbers span
/// more than 124 bits.
///@{
template <arithmetic A, scalar T, has_core_points<T> S>
ABUT_HD constexpr verdict decide_within(const hull<T>& h, const S& s, double distance) {
    const auto core = core_points_of(s);
    if constexpr (std::same_as<A, exact>) {
        return near_in_integers<2, false>(core.as_hull(), radius_around_core(s), h, distance);
    } else {
        constexpr bool certified = std::same_as<A, filtered>;
        return near_in_floats<certified>(core.as_hull(), radius_within<certified>(h, s, distance), h);
    }
}
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide_within(const plane<T>& p, const hull<T>& h, double distance) {
    verdict any = verdict::no;
    for (std::size_t i = 0; i < fan_size(h) && any != verdict::yes; ++i) {
        any = any || decide_within<A>(p, fan_triangle(h, i), distance);
    }
    return any;
}
///@}

/// What the filter left, in integers, with points compared in double first.
template <arithmetic A, scalar T, has_core_points<T> S>
requires std::same_as<A, filtered> ABUT_HD constexpr verdict decide_within_late(const hull<T>& h, const S& s,
                                                                                double distance) {
    const auto core = core_points_of(s);
    return near_in_integers<2, true>(core.as_hull(), radius_around_core(s), h, distance);
}

/// The last one: decides every finite input. The distance is a double also where T is float.
///@{
template <scalar T, has_core_points<T> S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const hull<T>& h, const S& s, double distance) {
    const auto core = core_points_of(s);
    return near_in_integers<limbs_of_any<double>, true>(core.as_hull(), radius_around_core(s), h, distance) == verdict::yes;
}
template <scalar T>
ABUT_HD constexpr bool resolve_within(const plane<T>& p, const hull<T>& h, double distance) {
    bool any = false;
    for (std::size_t i = 0; i < fan_size(h) && !any; ++i) any = resolve_within(p, fan_triangle(h, i), distance);
    return any;
}
///@}

}  // namespace abut::detail
