// SPDX-License-Identifier: MIT
#pragma once

// Contacts of spheres and capsules that touch something. A round shape comes apart soonest straight away from the other's
// nearest point; where its axis (a sphere's: its centre) lies in the other, along a face normal or across the axis and an
// edge. Depth is the least move in any direction.

#include <abut/narrow/directions.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/triangle_contact.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// Doubles are enough for float; double needs more, since a direction is a small difference of large numbers.
template <scalar T>
struct numbers_for {
    using type = one_double;
};
template <>
struct numbers_for<double> {
    using type = two_doubles;
};
template <scalar T>
using number_for = typename numbers_for<T>::type;

/// The way out of a triangle for the ball of this radius swept along p q, whose nearest points are known: straight away, or
/// where that is so short that its direction is uncertain, or 0, whatever is shortest.
template <scalar T, class N>
ABUT_HD constexpr least_overlap way_out(const point& p, const point& q, double radius, const corners& t,
                                        const vec3<N>& away) {
    const point axis[2] = {p, q};
    least_overlap way;
    const auto extents = [&](const point& n, extent& of_axis, extent& of_t) {
        of_axis = extent_of(axis, n, p);
        of_t = extent_of(t.at, n, p);
        of_axis = {plain_sum(of_axis.lower, -radius), plain_sum(of_axis.upper, radius)};
    };
    extent a{}, b{};
    const point straight = as_stored_direction<T>(unit_vector(away));
    if (!is_zero(straight)) {
        extents(straight, a, b);
        way.offer(straight, plain_sum(b.upper, -a.lower));
    }
    if (largest_of(rounded_off(away)) > 0x1p-12) return way;
    const auto offer_both = [&](const point& n) {
        if (is_zero(n)) return;
        const point stored = as_stored_direction<T>(n);
        extents(stored, a, b);
        way.offer_both(stored, a, b);
    };
    const point normal = face_normal<T>(t);
    if (is_zero(normal)) {
        offer_both(across_both({{p, q, q}}, t));
    } else {
        offer_both(normal);
        const vec3<two_doubles> along = between<two_doubles>(p, q);
        if (is_zero(rounded_off(along))) return way;
        for (int i = 0; i < 3; ++i) offer_both(unit_cross(along, between<two_doubles>(t.at[i], t.at[i == 2 ? 0 : i + 1])));
    }
    return way;
}

}  // namespace abut::detail::contact_math

namespace abut::detail {

// All of shapes that are known to touch, with ids 0.

/// The triangle's point nearest to the centre.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const sphere<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const corners corner = scale(t);
    const point center = scale(s.center);
    const auto foot = foot_on_triangle<number_for<T>>(center, corner);
    return assembled<T>(scale, foot.at, way_out<T>(center, center, scale(s.radius), corner, foot.away));
}

/// The triangle's point nearest to the axis.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const capsule<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const corners corner = scale(t);
    const point p = scale(s.axis.a), q = scale(s.axis.b);
    const auto nearest = nearest_points<number_for<T>>(p, q, corner);
    return assembled<T>(scale, nearest.at.on_b, way_out<T>(p, q, scale(s.radius), corner, nearest.away));
}

/// Along the line through both centres, the middle of what both spheres have of it.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const sphere<T>& s, const sphere<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const point a = scale(s.center), b = scale(t.center);
    const double radius_a = scale(s.radius), radius_b = scale(t.radius);
    const auto away = between<number_for<T>>(b, a);
    const point straight = as_stored_direction<T>(unit_vector(away));
    least_overlap way;
    const point n = is_zero(straight) ? way.normal : straight;
    const double distance = plain_dot(n, rounded_off(away));
    way.offer(n, plain_sum(plain_sum(radius_a, radius_b), -distance));
    const double from = greatest(plain_sum(distance, -radius_a), -radius_b);
    const double to = least(plain_sum(distance, radius_a), radius_b), middle = plain_sum(from, to) / 2;
    const point where{plain_sum(b.x, plain_product(middle, n.x)), plain_sum(b.y, plain_product(middle, n.y)),
                      plain_sum(b.z, plain_product(middle, n.z))};
    return assembled<T>(scale, where, way);
}

/// Segments are triangles with two equal corners, points are spheres of radius 0.
template <scalar T>
ABUT_HD constexpr contact<T> contact_between(const sphere<T>& s, const segment<T>& t) {
    return contact_between(s, triangle<T>{t.a, t.b, t.b});
}
template <scalar T>
ABUT_HD constexpr contact<T> contact_between(const vec3<T>& p, const triangle<T>& t) {
    return contact_between(sphere<T>{p, T(0)}, t);
}
template <scalar T>
ABUT_HD constexpr contact<T> contact_between(const segment<T>& s, const triangle<T>& t) {
    return contact_between(triangle<T>{s.a, s.b, s.b}, t);
}

}  // namespace abut::detail
