// SPDX-License-Identifier: MIT
#pragma once

// What two triangles that touch have in common, and the point in its middle. In general position each plane cuts the other
// triangle in a chord, both chords are on one line, and the common part is what they share. Where corners or edges lie in
// the other's plane it is the same, with chords that end there. Triangles of one plane share a polygon.

#include <abut/arithmetic/limits.hpp>
#include <abut/narrow/cut_polygon.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// The ends of what a triangle has in common with a plane, from its corners' heights over it, which are not all 0. If all
/// are on one side, the corner that is nearest to the plane, twice.
template <class N>
ABUT_HD constexpr void chord_of(const corners& t, const N (&height)[3], point (&end)[2]) {
    int below = 0, ends = 0, lowest = 0, lone = 0;
    for (int i = 0; i < 3; ++i) {
        below += height[i].high < 0 ? 1 : 0;
        if (absolute(height[i].high) < absolute(height[lowest].high)) lowest = i;
        if (height[i].high == 0 && ends < 2) end[ends++] = t.at[i];
    }
    for (int i = 1; i < 3; ++i) {
        if (height[i].high != 0 && (height[i].high < 0) == (below == 1)) lone = i;
    }
    for (int k = 0; k < 2 && ends < 2; ++k) {
        const int other = lone + 1 + k - (lone + 1 + k > 2 ? 3 : 0);
        const bool crosses =
            (height[lone].high < 0 && height[other].high > 0) || (height[lone].high > 0 && height[other].high < 0);
        if (crosses) end[ends++] = on_segment(t.at[lone], t.at[other], height[lone] / (height[lone] - height[other]));
    }
    if (ends == 0) end[ends++] = t.at[lowest];
    if (ends == 1) end[1] = end[0];
}

/// The middle of what two chords of one line share, once as a point of either.
ABUT_HD constexpr two_points middle_of_chords(const point (&end_a)[2], const point (&end_b)[2], const point& line) {
    const auto along = [&](const point& p) { return plain_dot(line, plain_difference(p, end_a[0])); };
    const double a0 = 0, a1 = along(end_a[1]), b0 = along(end_b[0]), b1 = along(end_b[1]);
    const double from = greatest(least(a0, a1), least(b0, b1)), to = least(greatest(a0, a1), greatest(b0, b1));
    const double middle = plain_sum(from, to) / 2;
    const auto weight = [&](double x0, double x1) {
        return one_double::of(x0 == x1 ? 0 : plain_sum(middle, -x0) / plain_sum(x1, -x0));
    };
    const one_double in_a = into_unit(weight(a0, a1)), in_b = into_unit(weight(b0, b1));
    return {on_segment(end_a[0], end_a[1], in_a), on_segment(end_b[0], end_b[1], in_b)};
}
/// Along the longer one.
ABUT_HD constexpr two_points middle_of_chords(const point (&end_a)[2], const point (&end_b)[2]) {
    const point a = plain_difference(end_a[1], end_a[0]), b = plain_difference(end_b[1], end_b[0]);
    return middle_of_chords(end_a, end_b, plain_dot(a, a) < plain_dot(b, b) ? b : a);
}

/// A normal to measure heights by, in doubles and of any length, and the product of two edges' largest coordinates, which
/// bounds it. Of floats it is not the one that is stored: heights over that are off by a unit of roundoff.
template <scalar T>
struct height_normal {
    point n;
    double size = 1;

    ABUT_HD constexpr height_normal(const corners& t, const point& stored) : n(stored) {
        if constexpr (std::same_as<T, float>) {
            const auto ab = between<one_double>(t.at[0], t.at[1]), ac = between<one_double>(t.at[0], t.at[2]);
            n = rounded_off(cross(ab, ac));
            size = largest_of(rounded_off(ab)) * largest_of(rounded_off(ac));
        }
    }
    /// Whether a height is that of a distance above this.
    [[nodiscard]] ABUT_HD constexpr bool tells(double height, double distance) const {
        return height * height > distance * distance * plain_dot(n, n);
    }
};

/// Of triangles in general position. False if rounding may have put some corner on the wrong side of the other's plane, or
/// moved a chord's end by more than a small part of contact_bound, or if all corners of one are as good as in the other's
/// plane. Where the chords are poor, their gap shows it.
///
/// Of floats, a height is off by less than 2^-47 size r, where r is the largest coordinate of the ways between the
/// triangles. So an end of a chord, on an edge no longer than 3.5 r between heights of 2^-24 size r^2 at least, is off by
/// less than 2^-22.
template <scalar T>
ABUT_HD constexpr bool middle_in_general_position(const corners& a, const point& normal_a, const corners& b,
                                                  const point& normal_b, two_points& out) {
    constexpr double units = (std::same_as<T, float> ? 8 : 32) * static_cast<double>(unit_roundoff<T>);
    const height_normal<T> of_a(a, normal_a), of_b(b, normal_b);
    one_double height_a[3]{}, height_b[3]{};
    double lowest_a = infinity<double>, lowest_b = infinity<double>, highest_a = 0, highest_b = 0, reach = 0;
    int below_a = 0, below_b = 0;
    for (int i = 0; i < 3; ++i) {
        const point to_a = plain_difference(a.at[i], b.at[0]), to_b = plain_difference(b.at[i], a.at[0]);
        height_a[i] = {plain_dot(of_b.n, to_a)};
        height_b[i] = {plain_dot(of_a.n, to_b)};
        const double over_b = absolute(height_a[i].high), over_a = absolute(height_b[i].high);
        lowest_a = least(lowest_a, over_b);
        lowest_b = least(lowest_b, over_a);
        highest_a = greatest(highest_a, over_b);
        highest_b = greatest(highest_b, over_a);
        reach = greatest(reach, largest_of(to_a), largest_of(to_b));
        below_a += height_a[i].high < 0 ? 1 : 0;
        below_b += height_b[i].high < 0 ? 1 : 0;
    }
    const double certain = std::same_as<T, float> ? 0x1p-24 * reach * reach : units;
    if (!(lowest_a > certain * of_b.size && lowest_b > certain * of_a.size) || below_a % 3 == 0 || below_b % 3 == 0)
        return false;
    if (!of_b.tells(highest_a, units) || !of_a.tells(highest_b, units)) return false;
    point end_a[2]{}, end_b[2]{};
    chord_of(a, height_a, end_a);
    chord_of(b, height_b, end_b);
    out = middle_of_chords(end_a, end_b, rounded_off(cross(as<one_double>(normal_a), as<one_double>(normal_b))));
    return out.squared_gap() <= tolerable_square<T>();
}

// --- in any position, in sums of two doubles -----------------------------------------------------------------------------

/// Heights of corners over a plane through a point of it, by its normal, which is not 0 and has been brought to one, and
/// times that normal's length. Returns the greatest distance. What may be nothing but rounding is 0.
ABUT_NOINLINE ABUT_HD constexpr double heights_of(const corners& t, const vec3<two_doubles>& normal, const point& origin,
                                                  two_doubles (&height)[3]) {
    double highest = 0;
    for (int i = 0; i < 3; ++i) {
        height[i] = dot(normal, between<two_doubles>(origin, t.at[i]));
        if (!(absolute(height[i].high) > 0x1p-96)) height[i] = two_doubles::of(0);
        highest = greatest(highest, absolute(height[i].high));
    }
    return highest / root(one_double{dot(normal, normal).high}).high;
}

/// One side of a triangle, in its plane: what the edge from `corner` has on its outer side is beyond it.
struct triangle_side {
    vec3<two_doubles> outwards;
    double length;
    point corner;

    [[nodiscard]] ABUT_HD constexpr one_double beyond(const vec3<one_double>& p) const {
        const auto to_p = between<two_doubles>(corner, rounded_off(p));
        return one_double::of(length > 0 ? dot(outwards, to_p).high / length : 0);
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<one_double>& onto(const vec3<one_double>& p) const { return p; }
};

/// The middle of what a triangle, which may be a segment, has of another one in its plane.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr point middle_in_plane(const corners& a, const triangle<T>& t, const corners& b,
                                                      const vec3<two_doubles>& normal_b) {
    constexpr double slack = 4 * static_cast<double>(unit_roundoff<T>);
    cut_polygon<one_double> left(a);
    for (int i = 0; i < 3; ++i) {
        const vec3<two_doubles> outwards = cross(edge_of(t, i).direction, normal_b);
        left.cut(triangle_side{outwards, root(dot(outwards, outwards)).high, b.at[i]}, slack);
    }
    return left.middle();
}

ABUT_HD constexpr const two_points& nearer_of(const two_points& p, const two_points& q) {
    return q.squared_gap() < p.squared_gap() ? q : p;
}

/// A common point of triangles so thin, or so nearly in one plane, that rounding hides what else they have in common: where
/// an edge of one passes the other, where edges meet or where a corner lies on the other, whichever has the least gap.
ABUT_NOINLINE ABUT_HD constexpr two_points nearest_of_features(const corners& a, const corners& b) {
    using N = two_doubles;
    two_points nearest{a.at[0], foot_on_triangle<N>(a.at[0], b).at};
    for (int i = 0; i < 3; ++i) {
        const int j = i == 2 ? 0 : i + 1;
        const crossing<N> of_a = crossing_of<N>(a.at[i], a.at[j], b), of_b = crossing_of<N>(b.at[i], b.at[j], a);
        if (of_a.exists) nearest = nearer_of(nearest, of_a.found.at);
        if (of_b.exists) nearest = nearer_of(nearest, of_b.found.at.swapped());
        // Named first: of braces around a call nvcc 13.0 makes code that g++ does not take.
        const foot_point<N> on_b = foot_on_triangle<N>(a.at[i], b), on_a = foot_on_triangle<N>(b.at[i], a);
        nearest = nearer_of(nearest, two_points{a.at[i], on_b.at});
        nearest = nearer_of(nearest, two_points{on_a.at, b.at[i]});
        for (int k = 0; k < 3; ++k) {
            nearest = nearer_of(nearest, near_segments<N>(a.at[i], a.at[j], b.at[k], b.at[k == 2 ? 0 : k + 1]).at);
        }
    }
    return nearest;
}

/// A triangle without a normal, as the segment that it is: from one end to the other, and there once again.
template <scalar T>
ABUT_HD constexpr corners segment_of(const triangle<T>& t, const corners& at) {
    const int from = longest_edge(t);
    const point& to = at.at[from == 2 ? 0 : from + 1];
    return {{at.at[from], to, to}};
}

/// Of two segments.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr two_points middle_of_segments(const triangle<T>& s, const corners& a, const triangle<T>& t,
                                                              const corners& b) {
    const corners p = segment_of(s, a), q = segment_of(t, b);
    const point end_a[2] = {p.at[0], p.at[1]}, end_b[2] = {q.at[0], q.at[1]};
    const two_points shared = middle_of_chords(end_a, end_b);
    const bool parallel =
        is_zero(accurate_cross(edge_of(s, longest_edge(s)).direction, edge_of(t, longest_edge(t)).direction));
    if (parallel) return shared;
    const two_points crossing = near_segments<two_doubles>(end_a[0], end_a[1], end_b[0], end_b[1]).at;
    return crossing.squared_gap() <= tolerable_square<double>() ? crossing : nearer_of(crossing, shared);
}

/// In one plane passes what rounded coordinates may put there: all corners of one triangle within eight units of roundoff of
/// the other's plane. Of such the line which both planes share is an accident.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr two_points middle_in_any_position(const triangle<T>& s, const corners& at_s,
                                                                  const triangle<T>& t, const corners& at_t) {
    constexpr double rounding = 8 * static_cast<double>(unit_roundoff<T>);
    const vec3<two_doubles> normal_a = brought_to_one(face_direction(s)), normal_b = brought_to_one(face_direction(t));
    const bool flat_a = is_zero(normal_a), flat_b = is_zero(normal_b);
    if (flat_a && flat_b) return middle_of_segments(s, at_s, t, at_t);
    const corners a = flat_a ? segment_of(s, at_s) : at_s, b = flat_b ? segment_of(t, at_t) : at_t;
    two_doubles height_a[3]{}, height_b[3]{};
    const double highest_a = flat_b ? infinity<double> : heights_of(a, normal_b, b.at[0], height_a);
    const double highest_b = flat_a ? infinity<double> : heights_of(b, normal_a, a.at[0], height_b);
    if (least(highest_a, highest_b) <= rounding) {
        const bool a_in_b = highest_a <= highest_b;
        const corners& other = a_in_b ? b : a;
        const point middle = a_in_b ? middle_in_plane(a, t, b, normal_b) : middle_in_plane(b, s, a, normal_a);
        // First in doubles, which is enough but for needles. A needle's corners may be near its sides and far from it.
        point foot = foot_on_triangle<one_double>(middle, other).at;
        const auto is_near = [&] { return two_points{middle, foot}.squared_gap() <= 2 * rounding * rounding; };
        if (!is_near()) foot = foot_on_triangle<two_doubles>(middle, other).at;
        if (is_near()) return least(highest_a, highest_b) == 0 ? two_points{middle, middle} : two_points{middle, foot};
    }
    if (highest_a == 0 || highest_b == 0) return nearest_of_features(a, b);
    point end_a[2]{}, end_b[2]{};
    if (!flat_b) chord_of(a, height_a, end_a);
    if (!flat_a) chord_of(b, height_b, end_b);
    const two_points found = flat_a   ? two_points{end_a[0], foot_on_triangle<two_doubles>(end_a[0], b).at}
                             : flat_b ? two_points{foot_on_triangle<two_doubles>(end_b[0], a).at, end_b[0]}
                                      : middle_of_chords(end_a, end_b);
    // Half of a gap of 16 units of roundoff of double is from either triangle.
    return found.squared_gap() <= 16 * tolerable_square<double>() ? found : nearer_of(found, nearest_of_features(a, b));
}

}  // namespace abut::detail::contact_math
