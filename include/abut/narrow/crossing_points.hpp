// SPDX-License-Identifier: MIT
#pragma once

// Where the corners lie of what two triangles have in common (predicate/shared_corners.hpp says which these are). A corner of
// either is where it is. A side that passes a triangle, or another side, is cut at a share of its length: that share is
// rounded to double as a ray's time is, exactly, and the point to T. Both are taken of the side from its lesser end, so that
// a side has the same point whichever of its triangles asks.
//
// Error bound. With M the largest coordinate of the side's ends and u the unit roundoff of double: the share is off by u, the
// side's length along an axis is at most 2 M, and the way from the end is added in pairs of doubles and rounded once. So a
// coordinate is off by 3 u M in double. In float the share may be one of doubles alone, if it is then off by less than 2^-30:
// with the last rounding that is 2^-24 + 2^-28 of M. Where numbers are denormal, one or two of the least more.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/shared_corners.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// By coordinates, x first.
template <scalar T>
ABUT_HD constexpr bool comes_before(const vec3<T>& p, const vec3<T>& q) {
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
}
template <scalar T>
ABUT_HD constexpr void put_in_order(vec3<T>& p, vec3<T>& q) {
    if (!comes_before(q, p)) return;
    const vec3<T> first = q;
    q = p;
    p = first;
}
/// A side, from its lesser end.
template <scalar T>
ABUT_HD constexpr segment<T> side_in_order(const triangle<T>& t, unsigned i) {
    segment<T> side{corner(t, i), corner(t, i == 2 ? 0 : i + 1)};
    put_in_order(side.a, side.b);
    return side;
}
template <scalar T>
ABUT_HD constexpr triangle<T> corners_in_order(triangle<T> t) {
    put_in_order(t.a, t.b);
    put_in_order(t.b, t.c);
    put_in_order(t.a, t.b);
    return t;
}

/// When a line passes another one in its plane, and by what share of itself that may be off, as cross_plane. Seen along the
/// axis that shows most of both.
template <class N, scalar T>
ABUT_HD constexpr plane_crossing<N> cross_line(const segment<T>& l, const segment<T>& other, double error) {
    using contact_math::between;
    using contact_math::rounded_off;
    if (std::same_as<T, float> && any_subnormal(in_a_row(l.a, l.b, other.a, other.b).value)) return {{}, 1};
    const vec3<double> from = widened(l.a), start = widened(other.a);
    const auto to = between<N>(from, start), along = between<N>(from, widened(l.b)), side = between<N>(start, widened(other.b));
    const double apart = magnitudes(rounded_off(to)), length = magnitudes(rounded_off(along)),
                 reach = magnitudes(rounded_off(side));
    if (!(least(apart, length, reach) > 0x1p-200 && greatest(apart, length, reach) < 0x1p200)) return {{}, 1};
    const auto of_both = cross(along, side), passed = cross(to, side);
    const double x = absolute(of_both.x.high), y = absolute(of_both.y.high), z = absolute(of_both.z.high);
    const N speed = x >= y && x >= z ? of_both.x : y >= z ? of_both.y : of_both.z;
    const N height = x >= y && x >= z ? passed.x : y >= z ? passed.y : passed.z;
    const double relative =
        error * reach * (apart / absolute(height.high) + length / absolute(speed.high)) + error;
    return {height / speed, relative < 0.5 ? 2 * relative : 1};
}

/// A time that is known so well that it is rounded; else a negative number.
ABUT_HD constexpr double certain_time(const plane_crossing<contact_math::two_doubles>& met) {
    if (!(met.relative < 0x1p-59)) return -1;
    const contact_math::two_doubles& time = met.time;
    const double lost = met.relative * time.high;
    const bool is_certain = plain_sum(time.high, plain_sum(time.low, lost)) == time.high &&
                            plain_sum(time.high, plain_sum(time.low, -lost)) == time.high;
    return is_certain && time.high > smallest_normal<double> && time.high <= 1 ? time.high : -1;
}

/// The point at a share of a segment.
template <scalar T>
ABUT_HD constexpr vec3<T> at_share(const segment<T>& l, double share) {
    using contact_math::two_doubles;
    const vec3<double> from = widened(l.a), to = widened(l.b);
    const double most = greatest(greatest(absolute(from.x), absolute(from.y), absolute(from.z)),
                                 greatest(absolute(to.x), absolute(to.y), absolute(to.z)));
    // Without overflow, and with all digits.
    const int e = most > 0x1p1000 ? -8 : most < 0x1p-400 ? 600 : 0;
    const auto coordinate = [&](double x, double y) {
        const double p = e == 0 ? x : contact_math::scaled(x, e), q = e == 0 ? y : contact_math::scaled(y, e);
        const double there = (two_doubles::of(p) + two_doubles::of(share) * two_doubles::difference(q, p)).high;
        return rounded_within<T>(e == 0 ? there : contact_math::scaled(there, -e));
    };
    return {coordinate(from.x, to.x), coordinate(from.y, to.y), coordinate(from.z, to.z)};
}

/// Where a segment passes a triangle that it meets in one point, which is none of its ends.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr vec3<T> point_of_passing(const segment<T>& l, const triangle<T>& t) {
    if constexpr (std::same_as<T, float>) {
        const auto [time, relative] = cross_plane<contact_math::one_double>(line_of<T>(l), t, 0x1p-48);
        if (relative < 0x1p-31) return at_share(l, least(time.high, 1.0));
    } else {
        const double time = certain_time(cross_plane<contact_math::two_doubles>(line_of<T>(l), t, 0x1p-98));
        if (time >= 0) return at_share(l, time);
    }
    return at_share(l, greatest(exact_hit_time(l, t), 0.0));
}
/// And another segment, on another line.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr vec3<T> point_of_passing(const segment<T>& l, const segment<T>& other) {
    if constexpr (std::same_as<T, float>) {
        const auto [time, relative] = cross_line<contact_math::one_double>(l, other, 0x1p-48);
        if (relative < 0x1p-31) return at_share(l, least(time.high, 1.0));
    } else {
        const double time = certain_time(cross_line<contact_math::two_doubles>(l, other, 0x1p-98));
        if (time >= 0) return at_share(l, time);
    }
    return at_share(l, greatest(exact_hit_time(l, triangle<T>{other.a, other.b, other.b}), 0.0));
}

/// Corner i of what two triangles have in common.
template <scalar T>
ABUT_HD constexpr vec3<T> point_of_corner(const shared_corners& all, int i, const triangle<T>& s, const triangle<T>& t) {
    const place_in_triangle in_s = all.in_first(i), in_t = all.in_second(i);
    if (in_s < side_of_triangle) return corner(s, in_s);
    if (in_t < side_of_triangle) return corner(t, in_t);
    if (in_t == inside_of_triangle) return point_of_passing(side_in_order(s, in_s - side_of_triangle), corners_in_order(t));
    if (in_s == inside_of_triangle) return point_of_passing(side_in_order(t, in_t - side_of_triangle), corners_in_order(s));
    const segment<T> a = side_in_order(s, in_s - side_of_triangle), b = side_in_order(t, in_t - side_of_triangle);
    const bool is_b_first = comes_before(b.a, a.a) || (!comes_before(a.a, b.a) && comes_before(b.b, a.b));
    return is_b_first ? point_of_passing(b, a) : point_of_passing(a, b);
}

}  // namespace abut::detail
