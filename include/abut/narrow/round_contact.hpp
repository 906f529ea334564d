// SPDX-License-Identifier: MIT
#pragma once

// Contacts of spheres and capsules that touch something. A round shape comes apart soonest straight away from the other's
// nearest point; where its axis (a sphere's: its centre) lies in the other, along a face normal or across the axis and an
// edge. Depth is the least move in any direction.

#include <abut/narrow/directions.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_triangle.hpp>
#include <abut/narrow/plain_ways.hpp>
#include <abut/narrow/triangle_contact.hpp>
#include <abut/predicate/near_cores.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/shape/core.hpp>
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

/// A ball swept along an axis (a sphere's is a point), and a triangle, at the common scale.
struct round_pair {
    point axis[2];
    double radius;
    corners t;

    template <class S, scalar T>
    ABUT_HD constexpr round_pair(const common_scale& scale, const S& s, const segment<T>& s_axis, const triangle<T>& s_t)
        : axis{scale(s_axis.a), scale(s_axis.b)}, radius(scale(s.radius)), t(scale(s_t)) {}

    ABUT_HD constexpr extent of_ball(const point& n) const {
        const extent e = extent_of(axis, n, axis[0]);
        return {plain_sum(e.lower, -radius), plain_sum(e.upper, radius)};
    }
    ABUT_HD constexpr extent of_triangle(const point& n) const { return extent_of(t.at, n, axis[0]); }
};

/// How much more than the least a depth may be for its direction to pass: a fraction of contact_bound that covers rounding
/// of a right one.
template <scalar T>
inline constexpr double tolerable_excess = (std::same_as<T, float> ? 8 : 16) * static_cast<double>(unit_roundoff<T>);

/// Whether half of that is enough in plain doubles: of the largest magnitude, which is looked for where `less`, that is no
/// larger, does not tell.
template <class S, class U>
ABUT_INLINE ABUT_HD constexpr bool is_tolerable(double excess, double less, const S& s, const U& t) {
    constexpr double part = tolerable_excess<scalar_type_of<S>> / 2;
    return excess <= part * less || excess <= part * static_cast<double>(greatest(magnitude_of(s), magnitude_of(t)));
}

/// The directions of faces: of the triangle, and of what the axis and each edge span. One of them separates an axis that
/// lies in the triangle soonest.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr void offer_faces(const round_pair& pair, const segment<T>& axis, const triangle<T>& t,
                                                 least_overlap& way) {
    const auto offer_both = [&](const point& n) {
        if (is_zero(n)) return;
        const point stored = as_stored_direction<T>(n);
        way.offer_both(stored, pair.of_ball(stored), pair.of_triangle(stored));
    };
    const point normal = face_normal(t);
    if (is_zero(normal)) return offer_both(across_both(triangle<T>{axis.a, axis.b, axis.b}, t));
    offer_both(normal);
    const vec3<two_doubles> along = edge_between(axis.a, axis.b).direction;
    if (is_zero(along)) return;
    for (int i = 0; i < 3; ++i) offer_both(unit_cross(along, edge_of(t, i).direction));
}

/// The directions between all features of the axis and of the triangle's boundary. One of them is the nearest's, where
/// distances do not tell which: they hardly differ where directions do.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr void offer_features(const round_pair& pair, least_overlap& way) {
    using N = two_doubles;
    const point &p = pair.axis[0], &q = pair.axis[1];
    const auto offer = [&](const vec3<N>& away, double sign) {
        const point n = as_stored_direction<T>(scale(sign, unit_vector(away)));
        if (!is_zero(n)) way.offer(n, plain_sum(pair.of_triangle(n).upper, -pair.of_ball(n).lower));
    };
    for (int i = 0; i < 3; ++i) {
        const point &from = pair.t.at[i], &to = pair.t.at[i == 2 ? 0 : i + 1];
        offer(foot_on_segment<N>(p, from, to).away, 1);
        offer(foot_on_segment<N>(q, from, to).away, 1);
        offer(foot_on_segment<N>(from, p, q).away, -1);
        offer(near_segments<N>(p, q, from, to).away, 1);
    }
}

/// The way out of a triangle for a ball swept along an axis, whose nearest points are known: straight away. Moved by less
/// than the radius less the distance nothing comes apart, so a direction is right if its depth is that. If it is not, or if
/// the way is so short that its direction is uncertain, or 0, the shortest one in any direction.
template <scalar T, class N>
ABUT_HD constexpr least_overlap way_out(const round_pair& pair, const segment<T>& axis, const triangle<T>& t,
                                        const vec3<N>& away, bool crosses) {
    least_overlap way;
    double distance = 0;
    const point straight = as_stored_direction<T>(unit_vector(away));
    if (!is_zero(straight)) {
        way.offer(straight, plain_sum(pair.of_triangle(straight).upper, -pair.of_ball(straight).lower));
        distance = plain_dot(straight, rounded_off(away));
    }
    const double enough = plain_sum(plain_sum(pair.radius, -distance), tolerable_excess<T>);
    if (largest_of(rounded_off(away)) > 0x1p-12 && way.depth <= enough) return way;
    offer_faces<T>(pair, axis, t, way);
    if (!crosses && way.depth > enough) offer_features<T>(pair, way);
    return way;
}

}  // namespace abut::detail::contact_math

namespace abut::detail {

/// Points, segments, spheres and capsules with each other, but for a sphere and a segment. Of cores with as many corners the
/// shape without a radius comes first.
template <class S, class U>
concept pair_of_round_contact = (pair_without_faces<S, U> || (std::same_as<S, U> && corners_of_core<S> == 1)) &&
                                !(corners_of_core<S> == corners_of_core<U> && has_radius<S> && !has_radius<U>);

/// The segment that a shape is around, which may be a point.
template <class S>
ABUT_HD constexpr segment<scalar_type_of<S>> axis_around(const S& s) {
    const auto core = core_of(s);
    return {core.at[0], core.at[corners_of_core<S> - 1]};
}

template <class S, class U>
inline constexpr bool are_spheres = has_radius<S> && has_radius<U> && corners_of_core<S> + corners_of_core<U> == 2;

/// The numbers of the contact below in plain doubles (plain_ways.hpp). The depth is the overlap along the normal as it is
/// stored, and the normal is right where that is the least there can be, the radii less the distance, but for a part of
/// contact_bound.
template <class S, class U>
    requires(has_plain_pair<S, U> && corners_of_core<S> > 0 && corners_of_core<U> < 3)
ABUT_INLINE ABUT_HD constexpr auto first_contact_of(const S& s, const U& t, const plain_pair<S, U>& both) {
    using namespace contact_math;
    using T = scalar_type_of<S>;
    first_contact<T> answer{both.touch()};
    if (answer.touch != verdict::yes) return answer;
    const point away = negated(both.cores.straightened());
    const double distance = root(one_double{plain_dot(away, away)}).high, radii = both.radii(), per_distance = 1 / distance;
    const point n = plain_normal<T>(plain_times(per_distance, away));
    const double depth = plain_sum(both.cores.overlap(n), radii), excess = plain_sum(depth, -plain_sum(radii, -distance));
    constexpr int corners = corners_of_core<S> + corners_of_core<U>;
    if (!is_tolerable(excess, both.size / (6 * corners - 4), s, t)) return first_contact<T>{};
    const double from = greatest(plain_sum(distance, -both.radius_a), -both.radius_b);
    const double to = least(plain_sum(distance, both.radius_a), both.radius_b);
    double part = plain_product(plain_sum(from, to) / 2, per_distance);
    if (!are_spheres<S, U>) part = into_unit_of_doubles(part);
    answer.found = plain_contact(both.on_b(t).at(-part, both.way()), n, depth);
    return answer;
}

// All of shapes that are known to touch, with ids 0.

/// The triangle's point nearest to the centre.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const sphere<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const plain_pair<sphere<T>, triangle<T>> both(s, t);
    if (const auto first = first_contact_of(s, t, both); first.touch == verdict::yes) return first.found;
    const common_scale scale(s, t);
    const segment<T> axis{s.center, s.center};
    const round_pair pair(scale, s, axis, t);
    const auto foot = foot_on_triangle<number_for<T>>(pair.axis[0], pair.t);
    return assembled<T>(scale, foot.at, way_out<T>(pair, axis, t, foot.away, false));
}

/// The triangle's point nearest to the axis.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const capsule<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const round_pair pair(scale, s, s.axis, t);
    const auto found = nearest_points<number_for<T>>(pair.axis[0], pair.axis[1], pair.t);
    return assembled<T>(scale, found.nearest.at.on_b, way_out<T>(pair, s.axis, t, found.nearest.away, found.crosses));
}

/// Of shapes around points and segments: from the points of both cores that are nearest to each other. The point is the
/// middle of what both shapes have of the line through these, or the one of the two that is nearer to that middle, if it is
/// not between them; of spheres it may be anywhere on the line.
template <class S, class U>
    requires pair_of_round_contact<S, U>
ABUT_NOINLINE ABUT_HD constexpr auto contact_between(const S& s, const U& t) {
    using namespace contact_math;
    using T = scalar_type_of<S>;
    if (const auto first = first_contact_of(s, t, plain_pair<S, U>(s, t)); first.touch == verdict::yes) return first.found;
    const common_scale scale(s, t);
    const segment<T> axis = axis_around(s), other = axis_around(t);
    const triangle<T> flat{other.a, other.b, other.b};
    round_pair pair(scale, capsule<T>{axis, radius_around_core(s)}, axis, flat);
    const double radius_a = pair.radius, radius_b = scale(radius_around_core(t));
    pair.radius = plain_sum(radius_a, radius_b);
    const auto found = nearest_points<number_for<T>>(pair.axis[0], pair.axis[1], pair.t).nearest;
    const point& on_b = found.at.on_b;
    const double distance = root(one_double{plain_dot(rounded_off(found.away), rounded_off(found.away))}).high;
    point where = on_b;
    if (distance > 0) {
        const double from = greatest(plain_sum(distance, -radius_a), -radius_b);
        const double to = least(plain_sum(distance, radius_a), radius_b);
        const double part = plain_sum(from, to) / 2 / distance;
        where = plain_step(on_b, are_spheres<S, U> ? part : into_unit_of_doubles(part), rounded_off(found.away));
    }
    return assembled<T>(scale, where, way_out<T>(pair, axis, flat, found.away, false));
}

/// Segments are triangles with two equal corners, points are spheres of radius 0.
template <scalar T>
ABUT_HD constexpr contact<T> contact_between(const sphere<T>& s, const segment<T>& t) {
    if (const auto first = first_contact_of(s, t, plain_pair<sphere<T>, segment<T>>(s, t)); first.touch == verdict::yes)
        return first.found;
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
