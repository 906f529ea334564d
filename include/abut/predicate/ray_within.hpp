// SPDX-License-Identifier: MIT
#pragma once

// The stages of `within` for a ray and a shape that it may meet: a triangle, sphere, box, capsule, cylinder, cone or convex
// hull. Of the ray a part is taken that ends farther on than any foot of the shape's points: the direction times a power of
// two. Its end is no number of the type, and so the answer is certified, as that of two cylinders (farthest_points.hpp), and
// with the distance 0 it is that of `intersects`, which is exact.

#include <concepts>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_float.hpp>
#include <abut/predicate/farthest_points.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/revolution_within.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Shapes that a ray may meet.
template <class U>
concept near_rays = (decidable_pair<ray<scalar_type_of<U>>, U> || decidable_pair<U, ray<scalar_type_of<U>>>)&&(
    solid_of_revolution<U> || has_core_points<U, scalar_type_of<U>>);

/// So much of a ray as shapes of that size, seen from its origin, are beside: the sum of magnitudes is less than twice the
/// length.
template <class N, scalar T>
ABUT_HD constexpr part_of_ray<N> part_beside(const ray<T>& r, const N& size) {
    const vec3<N> way = seen_in<N>(r.direction, vec3<T>{0, 0, 0});
    const N length = magnitudes_of(way);
    if (sense_of(length) == 0 || sense_of(size) == 0) return {way};
    if constexpr (is_wide<N>) {
        return {N(1.0).scaled(size.exponent - length.exponent + 2) * way};
    } else {
        return {(4 * (size / length)) * way};
    }
}

/// What is near a ray, in numbers of a kind. An axis has a length.
template <class N, scalar T, class U>
ABUT_HD constexpr auto seen_beside(const ray<T>& r, const U& t) {
    if constexpr (solid_of_revolution<U>) {
        return solid_in_numbers<N>(t, r.origin);
    } else {
        return points_in_numbers<N, std::remove_cvref_t<decltype(core_points_of(t))>>{core_points_of(t), r.origin};
    }
}

/// Whether they are within a distance; `unknown` in double where rounding leaves that open.
template <class N, scalar T, class U>
ABUT_NOINLINE ABUT_HD constexpr verdict search_near_ray(const ray<T>& r, const U& t, double distance) {
    const auto seen = seen_beside<N>(r, t);
    const T around = solid_of_revolution<U> ? T(0) : radius_around_core(t);
    const part_of_ray<N> part = part_beside(r, seen.size());
    if constexpr (is_wide<N>) {
        return search_near(part, seen, N(around) + N(distance));
    } else {
        const double reach = widened_exactly(around) + distance, size = seen.size(), all = size + part.size() + reach;
        const double along = magnitudes_of(seen_in<N>(r.direction, vec3<T>{0, 0, 0}));
        if (!(size > 0x1p-60 && all < 0x1p60 && along > 0x1p-900 && along < 0x1p900)) return verdict::unknown;
        return search_near(part, seen, reach);
    }
}

/// The first stage: in double; or of `exact` in 256 digits, and unknown only where that search does not end. `fast` takes
/// these too for what is left.
template <arithmetic A, near_rays U>
ABUT_HD constexpr verdict decide_within(const ray<scalar_type_of<U>>& r, const U& t, double distance) {
    if (distance == 0) return decide_in_place<A>(r, t);
    if constexpr (solid_of_revolution<U>) {
        if (is_point(axis_of(t))) return decide_within<A>(r, ball_around(t), distance);
    }
    if constexpr (std::same_as<A, exact>) {
        return search_near_ray<wide_float>(r, t, distance);
    } else {
        const verdict v = search_near_ray<double>(r, t, distance);
        if (std::same_as<A, filtered> || v != verdict::unknown) return v;
        return to_verdict(search_near_ray<wide_float>(r, t, distance) != verdict::no);
    }
}

/// What that leaves of those that meet.
template <arithmetic A, near_rays U>
    requires std::same_as<A, filtered>
ABUT_HD constexpr verdict decide_within_late(const ray<scalar_type_of<U>>& r, const U& t, double) {
    return decide_in_place<filtered>(r, t) == verdict::yes ? verdict::yes : verdict::unknown;
}

/// The last one. Where the search does not end, both are within the distance, as far as it came.
template <near_rays U>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const ray<scalar_type_of<U>>& r, const U& t, double distance) {
    if (distance == 0) return resolve_in_place(r, t);
    if constexpr (solid_of_revolution<U>) {
        if (is_point(axis_of(t))) return resolve_within(r, ball_around(t), distance);
    }
    return search_near_ray<wide_float>(r, t, distance) != verdict::no;
}

}  // namespace abut::detail
