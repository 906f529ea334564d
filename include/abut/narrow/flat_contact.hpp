// SPDX-License-Identifier: MIT
#pragma once

// Contacts of a plane or a box with what touches it.

#include <abut/arithmetic/error_free.hpp>
#include <abut/narrow/cut_polygon.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_ways.hpp>
#include <abut/predicate/near_cores.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// Where a triangle meets height 0: the mean of the points where edges pass it and of the corners in it; if rounding finds
/// neither, the corner that is nearest to it.
ABUT_HD constexpr point middle_at_zero(const corners& t, const two_doubles (&height)[3]) {
    point first{}, sum{0, 0, 0}, nearest = t.at[0];
    int count = 0;
    const auto add = [&](const point& p) {
        if (count == 0) first = p;
        const point d = plain_difference(p, first);
        sum = {plain_sum(sum.x, d.x), plain_sum(sum.y, d.y), plain_sum(sum.z, d.z)};
        ++count;
    };
    double least_height = infinity<double>;
    for (int i = 0; i < 3; ++i) {
        const int j = i == 2 ? 0 : i + 1;
        const double from = height[i].high, to = height[j].high;
        if (absolute(from) < least_height) least_height = absolute(from), nearest = t.at[i];
        if (from == 0) add(t.at[i]);
        if ((from < 0 && to > 0) || (from > 0 && to < 0)) {
            add(on_segment(t.at[i], t.at[j], height[i] / (height[i] - height[j])));
        }
    }
    if (count == 0) return nearest;
    return {plain_sum(first.x, sum.x / count), plain_sum(first.y, sum.y / count), plain_sum(first.z, sum.z / count)};
}

/// How high points lie over a plane, whose normal is not 0. The points are at the common scale.
template <std::size_t N>
struct plane_heights {
    vec3<two_doubles> normal;  ///< brought to one
    two_doubles height[N];
    int exponent;  ///< heights times 2^exponent are lengths; the common scale's, but of planes beyond 2^100 of that

    template <scalar T>
    ABUT_HD constexpr plane_heights(const plane<T>& s, const point (&at)[N], const common_scale& scale)
        : normal{}, height{}, exponent(scale.exponent) {
        const point given = widened(s.normal);
        const int of_normal = exponent_of(largest_of(given));
        normal = as<two_doubles>(scaled(given, -of_normal));
        const two_doubles length = root(dot(normal, normal));
        const auto given_offset = static_cast<double>(s.offset);
        const int of_offset = given_offset == 0 ? -3000 : exponent_of(absolute(given_offset));
        // In one step, since the first of two may overflow. What the limit of a step leaves out is as good as 0.
        const int both = -(of_normal + scale.exponent);
        const bool is_far = both + of_offset > 100;
        if (is_far) exponent = of_offset - of_normal;
        const auto offset = two_doubles::of(scaled(given_offset, is_far         ? -of_offset
                                                                 : both < -2044 ? -2044
                                                                 : both > 2046  ? 2046
                                                                                : both));
        for (std::size_t i = 0; i < N; ++i) {
            const two_doubles over = is_far ? -offset : dot(normal, as<two_doubles>(at[i])) - offset;
            height[i] = over / length;
        }
    }
};

/// The same in plain doubles, where numbers are of moderate size. The direction is within 2u, so that a height is within 9u
/// of itself and of how far its point is from the origin.
struct plain_plane {
    point unit{};
    double offset = 0;
    bool is_good = false;

    /// `size`: of what is measured, as it is seen from the origin.
    template <scalar T>
    ABUT_HD constexpr plain_plane(const plane<T>& s, double size) {
        const point given = widened(s.normal);
        const auto off = static_cast<double>(s.offset);
        const double most = largest_of(given);
        if (!(most > 0x1p-200 && most < 0x1p200 && absolute(off) < 0x1p400)) return;
        const double per_length = 1 / root(one_double{plain_dot(given, given)}).high;
        unit = plain_unit(plain_times(per_length, given));
        offset = plain_product(off, per_length);
        is_good = are_plain_sizes<T>(greatest(size, absolute(offset)));
    }
    [[nodiscard]] ABUT_HD constexpr double height(const point& p) const { return plain_sum(plain_dot(unit, p), -offset); }
};

/// The contact of a plane with one or two corners around which a shape reaches that far. Not where heights are too near to
/// 0, or to each other's opposites, for rounding to tell to which side it is.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr first_contact<T> first_contact_with_plane(const plane<T>& s, const vec3<T>& a,
                                                                          const vec3<T>& b, T radius) {
    const auto magnitude = static_cast<double>(greatest(magnitude_of(a), magnitude_of(b), radius));
    const plain_plane over(s, magnitude);
    if (!over.is_good) return {};
    const point p = widened(a), q = widened(b), n = std::same_as<T, float> ? as_stored_direction<T>(over.unit) : over.unit;
    const double from = over.height(p), to = over.height(q), lowest = least(from, to), highest = greatest(from, to);
    const auto reach = static_cast<double>(radius);
    least_overlap way;
    way.offer(negated(n), plain_sum(reach, -lowest));
    way.offer(n, plain_sum(reach, highest));
    const double open = 0x1p-46 * magnitude;
    if (!(absolute(plain_sum(lowest, highest)) > open && way.depth > open)) return {};
    const bool is_from = absolute(from) <= absolute(to), passes = lowest <= 0 && highest >= 0;
    if (passes && !(least(-lowest, highest) > open) && !(a == b)) return {};
    // On the way from one corner to the other, or the foot of the nearer one.
    point where = plain_step(is_from ? p : q, -(is_from ? from : to), n);
    if (passes && !(a == b)) where = plain_step(p, from / plain_sum(from, -to), plain_difference(q, p));
    const auto one = [](double x) { return rounded(static_cast<T>(x)); };
    return {verdict::yes, plain_contact(vec3<T>{one(where.x), one(where.y), one(where.z)}, way.normal, way.depth)};
}

template <class P>
ABUT_HD constexpr auto& coordinate(P& p, int axis) {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// One side of a box: what is greater than the limit along an axis is beyond it, or what is less if the sign is -1.
template <class N>
struct box_side {
    int axis;
    bool is_lower;
    double limit;

    [[nodiscard]] ABUT_HD constexpr N beyond(const vec3<N>& p) const {
        const N over = coordinate(p, axis) - N::of(limit);
        return is_lower ? -over : over;
    }
    [[nodiscard]] ABUT_HD constexpr vec3<N> onto(vec3<N> p) const {
        coordinate(p, axis) = N::of(limit);
        return p;
    }
};

ABUT_HD constexpr double into_range(double x, double lower, double upper) {
    return x < lower ? lower : x > upper ? upper : x;
}

/// A point of a box, and how far off a triangle it may be that touches the box: as far as it had to be moved into the box.
struct point_in_box {
    point at;
    double moved;
};

/// The middle of what a triangle has in a box.
template <class N>
ABUT_NOINLINE ABUT_HD constexpr point_in_box middle_in_box_by(const point& lower, const point& upper, const corners& t,
                                                              double slack) {
    cut_polygon<N> left(t);
    for (int axis = 0; axis < 3; ++axis) {
        left.cut(box_side<N>{axis, false, coordinate(upper, axis)}, slack);
        left.cut(box_side<N>{axis, true, coordinate(lower, axis)}, slack);
    }
    const point middle = left.middle();
    const point in{into_range(middle.x, lower.x, upper.x), into_range(middle.y, lower.y, upper.y),
                   into_range(middle.z, lower.z, upper.z)};
    return {in, largest_of(plain_difference(in, middle))};
}

/// A point of a box and a triangle that touch. Where they have but a sliver in common, along which a cut goes, roundings
/// move the cut's end by many times as much as they are. Of doubles that may be more than contact_bound, and is done again
/// in sums of two.
template <scalar T>
ABUT_HD constexpr point middle_in_box(const point& lower, const point& upper, const corners& t) {
    constexpr double slack = 0x1p-51;
    const point_in_box found = middle_in_box_by<one_double>(lower, upper, t, slack);
    if constexpr (std::same_as<T, double>) {
        if (found.moved > slack) {
            const point_in_box again = middle_in_box_by<two_doubles>(lower, upper, t, 0x1p-90);
            if (again.moved < found.moved) return again.at;
        }
    }
    return found.at;
}

}  // namespace abut::detail::contact_math

namespace abut::detail {

// All of shapes that are known to touch, with ids 0.

/// The triangle is moved out to one side of the plane or the other. Of equals to where the plane's normal points. A plane of
/// normal 0 is everything: nothing separates from it, and the depth is the largest number.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const plane<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    if (is_zero(widened(s.normal))) return {0, 0, t.a, {0, 0, 1}, largest_finite<T>};
    const common_scale scale(s, t);
    const corners corner = scale(t);
    const plane_heights<3> over(s, corner.at, scale);
    const auto& height = over.height;
    const point n = as_stored_direction<T>(unit_vector(over.normal));
    least_overlap way;
    way.offer(negated(n), -least(height[0].high, height[1].high, height[2].high));
    way.offer(n, greatest(height[0].high, height[1].high, height[2].high));
    return assembled<T>(scale, middle_at_zero(corner, height), way);
}

/// The least move along a face normal of either; of equals along the triangle's normal. The point is the middle of what is
/// in the box of the triangle.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const aabb<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const corners corner = scale(t);
    const point lower = scale(s.lower), upper = scale(s.upper), &origin = corner.at[0];
    point of_box[8]{};
    for (int i = 0; i < 8; ++i) {
        of_box[i] = {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z};
    }
    least_overlap way;
    const auto offer_both = [&](const point& n) {
        if (!is_zero(n)) way.offer_both(n, extent_of(of_box, n, origin), extent_of(corner.at, n, origin));
    };
    offer_both(face_normal(t));
    offer_both({1, 0, 0});
    offer_both({0, 1, 0});
    offer_both({0, 0, 1});
    return assembled<T>(scale, middle_in_box<T>(lower, upper, corner), way);
}

/// Segments and points are triangles with equal corners, of a box and of a plane.
template <class S, has_corners U>
    requires(corners_of_shape<U> < 3 &&
             (std::same_as<S, aabb<scalar_type_of<U>>> || std::same_as<S, plane<scalar_type_of<U>>>))
ABUT_HD constexpr auto contact_between(const S& s, const U& t) {
    const vec3<scalar_type_of<U>> a = core_of(t).at[0], b = core_of(t).at[corners_of_shape<U> - 1];
    return contact_between(s, triangle<scalar_type_of<U>>{a, b, b});
}

/// The least move along an axis. The point is the middle of the common box.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const aabb<T>& s, const aabb<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const point a[2] = {scale(s.lower), scale(s.upper)}, b[2] = {scale(t.lower), scale(t.upper)};
    least_overlap way;
    for (const point& n : {point{1, 0, 0}, point{0, 1, 0}, point{0, 0, 1}}) {
        way.offer_both(n, extent_of(a, n, a[0]), extent_of(b, n, a[0]));
    }
    const point lower = greatest(a[0], b[0]), upper = least(a[1], b[1]);
    return assembled<T>(scale, middle_of({lower, upper}), way);
}

/// Of a plane and a shape that reaches `radius` around some points: out to one side or the other, as for a triangle. The
/// point is the middle of what its core has in the plane; or else the foot of its lowest or highest point.
template <scalar T, int N>
ABUT_HD constexpr contact<T> contact_with_plane(const plane<T>& s, const corner_hull<T, N>& core, T radius,
                                                const contact_math::common_scale& scale) {
    using namespace contact_math;
    if (is_zero(widened(s.normal))) return {0, 0, core.at[0], {0, 0, 1}, largest_finite<T>};
    if (const auto first = first_contact_with_plane(s, core.at[0], core.at[N - 1], radius); first.touch == verdict::yes) {
        return first.found;
    }
    const corners corner{{scale(core.at[0]), scale(core.at[N - 1]), scale(core.at[N - 1])}};
    const plane_heights<3> over(s, corner.at, scale);
    const auto& height = over.height;
    const point n = as_stored_direction<T>(unit_vector(over.normal));
    const double lowest = least(height[0].high, height[1].high), highest = greatest(height[0].high, height[1].high);
    const double reach = scale(radius);
    least_overlap way;
    way.offer(negated(n), plain_sum(reach, -lowest));
    way.offer(n, plain_sum(reach, highest));
    point where{};
    if (lowest <= 0 && highest >= 0) {
        where = middle_at_zero(corner, height);
    } else {
        const int nearest = absolute(height[0].high) <= absolute(height[1].high) ? 0 : 1;
        where = plain_step(corner.at[nearest], -height[nearest].high, n);
    }
    return assembled<T>(scale, where, way);
}
template <scalar T, class S>
    requires(has_radius<S> && has_point_or_axis<S> && std::same_as<scalar_type_of<S>, T>)
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const plane<T>& s, const S& t) {
    return contact_with_plane(s, core_of(t), t.radius, contact_math::common_scale(s, t));
}
/// On the way from the lowest corner to the highest, and amid the box along axes that are in the plane.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const plane<T>& s, const aabb<T>& t) {
    auto core = core_over(s, t);
    // A half of a denormal number is rounded: it must not be joined with the sum.
    const auto to_middle = [](T along, T& a, T& b) {
        if (along == 0) a = b = plain_sum(plain_product(a, T(0.5)), plain_product(b, T(0.5)));
    };
    to_middle(s.normal.x, core.at[0].x, core.at[1].x);
    to_middle(s.normal.y, core.at[0].y, core.at[1].y);
    to_middle(s.normal.z, core.at[0].z, core.at[1].z);
    return contact_with_plane(s, core, T(0), contact_math::common_scale(s, t));
}

}  // namespace abut::detail
