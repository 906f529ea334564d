// SPDX-License-Identifier: MIT
#pragma once

// Contacts of a plane or a box with a triangle that touches it.

#include <abut/narrow/directions.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/triangle_contact.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// Where a triangle meets height 0: the mean of the points where edges pass it and of the corners in it; if rounding finds
/// neither, the corner that is nearest to it.
ABUT_HD constexpr point middle_at_zero(const corners& t, const two_doubles (&height)[3]) {
    gathered_points all(0);
    point nearest = t.at[0];
    double least_height = infinity<double>;
    for (int i = 0; i < 3; ++i) {
        const int j = i == 2 ? 0 : i + 1;
        const double from = height[i].high, to = height[j].high;
        if (absolute(from) < least_height) least_height = absolute(from), nearest = t.at[i];
        if (from == 0) all.offer({t.at[i], t.at[i]});
        if ((from < 0 && to > 0) || (from > 0 && to < 0)) {
            const point passing = on_segment(t.at[i], t.at[j], height[i] / (height[i] - height[j]));
            all.offer({passing, passing});
        }
    }
    return all.meet() ? all.result().on_a : nearest;
}

ABUT_HD constexpr double& coordinate(point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
ABUT_HD constexpr double coordinate(const point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// A convex polygon: what six cuts leave of a triangle.
struct cut_polygon {
    point at[9];
    int count;

    /// Keeps what is at most at `limit` along an axis (at least, if `sign` is -1), and `slack` beyond, or the points that
    /// are least beyond. New corners are put on the limit.
    ABUT_HD constexpr void cut(int axis, double sign, double limit, double slack) {
        double beyond[9]{}, least_beyond = infinity<double>;
        for (int i = 0; i < count; ++i) {
            beyond[i] = sign * plain_sum(coordinate(at[i], axis), -limit);
            least_beyond = least(least_beyond, beyond[i]);
        }
        const double most = greatest(slack, least_beyond);
        cut_polygon kept{{}, 0};
        for (int i = 0; i < count; ++i) {
            const int j = i + 1 == count ? 0 : i + 1;
            const bool stays = beyond[i] <= most, next_stays = beyond[j] <= most;
            if (stays) kept.add(at[i]);
            if (stays == next_stays || most > slack) continue;
            const double weight = beyond[i] / plain_sum(beyond[i], -beyond[j]);
            point passing = on_segment(at[i], at[j], into_unit(one_double::of(weight)));
            if (beyond[i] < 0 || beyond[j] < 0) coordinate(passing, axis) = limit;
            kept.add(passing);
        }
        *this = kept;
    }

private:
    ABUT_HD constexpr void add(const point& p) {
        if (count < 9) at[count++] = p;
    }
};

ABUT_HD constexpr double into_range(double x, double lower, double upper) {
    return x < lower ? lower : x > upper ? upper : x;
}

/// A point of a box and a triangle that touch.
ABUT_HD constexpr point middle_in_box(const point& lower, const point& upper, const corners& t) {
    cut_polygon left{{t.at[0], t.at[1], t.at[2]}, 3};
    for (int axis = 0; axis < 3; ++axis) {
        left.cut(axis, 1, coordinate(upper, axis), 0x1p-51);
        left.cut(axis, -1, coordinate(lower, axis), 0x1p-51);
    }
    gathered_points all(0);
    for (int i = 0; i < left.count; ++i) all.offer({left.at[i], left.at[i]});
    const point mean = all.result().on_a;
    return {into_range(mean.x, lower.x, upper.x), into_range(mean.y, lower.y, upper.y),
            into_range(mean.z, lower.z, upper.z)};
}

}  // namespace abut::detail::contact_math

namespace abut::detail {

// All of shapes that are known to touch, with ids 0.

/// The triangle is moved out to one side of the plane or the other. Of equals to where the plane's normal points. A plane of
/// normal 0 is everything: nothing separates from it, and the depth is the largest number.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const plane<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const corners corner = scale(t);
    const point given{static_cast<double>(s.normal.x), static_cast<double>(s.normal.y), static_cast<double>(s.normal.z)};
    const double largest = largest_of(given);
    if (!(largest > 0)) return {0, 0, t.a, {0, 0, 1}, largest_finite<T>};
    const int exponent = exponent_of(largest);
    const vec3<two_doubles> normal = as<two_doubles>(scaled(given, -exponent));
    const two_doubles length = root(dot(normal, normal));
    const auto offset = two_doubles::of(scaled(scaled(static_cast<double>(s.offset), -exponent), -scale.exponent));
    two_doubles height[3]{};
    for (int i = 0; i < 3; ++i) height[i] = (dot(normal, as<two_doubles>(corner.at[i])) - offset) / length;
    const point n = as_stored_direction<T>(unit_vector(normal));
    least_overlap way;
    way.offer(negated(n), -least(height[0].high, height[1].high, height[2].high));
    way.offer(n, greatest(height[0].high, height[1].high, height[2].high));
    return assembled<T>(scale, middle_at_zero(corner, height), way);
}

/// The least move along a face normal of either; of equals along the triangle's normal. The point is the mean corner of what
/// is in the box of the triangle.
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
    offer_both(face_normal<T>(corner));
    offer_both({1, 0, 0});
    offer_both({0, 1, 0});
    offer_both({0, 0, 1});
    return assembled<T>(scale, middle_in_box(lower, upper, corner), way);
}

}  // namespace abut::detail
