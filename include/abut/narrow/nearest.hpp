// SPDX-License-Identifier: MIT
#pragma once

// Where two shapes come nearest: pairs of points, one on each shape, whatever the shapes' position. Each point is a
// combination of corners with weights in [0, 1], so that rounding may move it along its shape and hardly off it; a poor
// weight shows in the gap between the two points. Pure functions over the numbers of numbers.hpp; those that are long and
// called often are not inlined, or kernels would be compiled with them many times over.

#include <abut/narrow/numbers.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// Three corners, two of a segment or one point, by their coordinates in double, which have been brought to [-2, 2).
struct corners {
    point at[3];
};

/// A point on each of two shapes.
struct two_points {
    point on_a, on_b;

    ABUT_HD constexpr double squared_gap() const {
        const point gap = plain_difference(on_a, on_b);
        return plain_dot(gap, gap);
    }
    ABUT_HD constexpr two_points swapped() const { return {on_b, on_a}; }
};

/// s where it lies in [0, 1], or the end that it is beyond; 0 for NaN.
template <class N>
ABUT_HD constexpr N into_unit(const N& s) {
    if (!(s.high > 0)) return N::of(0);
    return s < N::of(1) ? s : N::of(1);
}

/// p + s (q - p), with s in [0, 1].
template <class N>
ABUT_HD constexpr point on_segment(const point& p, const point& q, const N& s) {
    return rounded_off(as<N>(p) + scale(s, between<N>(p, q)));
}

/// A shape's nearest point to some x, and the way from there to x, which is more accurate than their difference.
template <class N>
struct foot_point {
    point at;
    vec3<N> away;
};

template <class N>
ABUT_HD constexpr foot_point<N> foot_on_segment(const point& x, const point& p, const point& q) {
    const vec3<N> whole = between<N>(p, q), edge = brought_to_one(whole), to_x = between<N>(p, x);
    const N length = dot(whole, edge);
    if (!(length.high > 0)) return {p, to_x};
    const N s = into_unit(dot(to_x, edge) / length);
    return {on_segment(p, q, s), to_x - scale(s, whole)};
}

/// On a triangle, which may be degenerate.
template <class N>
ABUT_NOINLINE ABUT_HD constexpr foot_point<N> foot_on_triangle(const point& x, const corners& t) {
    const vec3<N> ab = between<N>(t.at[0], t.at[1]), ac = between<N>(t.at[0], t.at[2]), ax = between<N>(t.at[0], x);
    foot_point<N> nearest{t.at[0], ax};
    N least_square = N::of(infinity<double>);
    const auto offer = [&](const foot_point<N>& foot) {
        const N square = dot(foot.away, foot.away);
        if (square < least_square) least_square = square, nearest = foot;
    };
    const vec3<N> n = cross(ab, ac), normal = brought_to_one(n);
    const N size = dot(normal, n);
    if (size.high > 0) {
        const N c = dot(normal, cross(ab, ax)) / size, b = dot(normal, cross(ax, ac)) / size;
        if (!(b.high < 0) && !(c.high < 0) && !((N::of(1) - b - c).high < 0)) {
            const vec3<N> along = scale(b, ab) + scale(c, ac);
            offer({rounded_off(as<N>(t.at[0]) + along), ax - along});
        }
    }
    for (int i = 0; i < 3; ++i) offer(foot_on_segment<N>(x, t.at[i], t.at[i == 2 ? 0 : i + 1]));
    return nearest;
}

/// A point on each of two shapes, and the way from b's to a's.
template <class N>
struct near_points {
    two_points at;
    vec3<N> away;
};

/// The points of two segments where their lines are nearest, or ends of the segments where that is beyond them: these need
/// not be the nearest ones.
template <class N>
ABUT_NOINLINE ABUT_HD constexpr near_points<N> near_segments(const point& p0, const point& p1, const point& q0,
                                                             const point& q1) {
    const vec3<N> u = between<N>(p0, p1), v = between<N>(q0, q1), step = between<N>(p0, q0);
    const vec3<N> n = cross(u, v), normal = brought_to_one(n);
    const N size = dot(normal, n);
    if (!(size.high > 0)) return {{p0, q0}, between<N>(q0, p0)};
    const N s = into_unit(dot(normal, cross(step, v)) / size), t = into_unit(dot(normal, cross(step, u)) / size);
    return {{on_segment(p0, p1, s), on_segment(q0, q1, t)}, scale(s, u) - scale(t, v) - step};
}

/// Where a segment crosses a triangle.
template <class N>
struct crossing {
    bool exists;
    bool is_certain;  ///< too plainly to be a matter of rounding
    near_points<N> found;
};

/// Volumes below this, of corners in [-2, 2), may be nothing but rounding.
template <class N>
inline constexpr double certain_volume = 0x1p-44;
template <>
inline constexpr double certain_volume<two_doubles> = 0x1p-94;

/// By the volumes that the segment's ends span with the triangle, and that the segment spans with its edges.
template <class N>
ABUT_NOINLINE ABUT_HD constexpr crossing<N> crossing_of(const point& p, const point& q, const corners& t) {
    crossing<N> none{};
    const vec3<N> normal = cross(between<N>(t.at[0], t.at[1]), between<N>(t.at[0], t.at[2]));
    const N at_p = dot(normal, between<N>(t.at[0], p)), at_q = dot(normal, between<N>(t.at[0], q));
    if ((at_p.high > 0 && at_q.high > 0) || (at_p.high < 0 && at_q.high < 0)) return none;
    const N fall = at_p - at_q;
    if (fall.high == 0) return none;
    const vec3<N> axis = between<N>(p, q);
    const double sign = fall.high > 0 ? -1 : 1;
    double least_volume = least(absolute(at_p.high), absolute(at_q.high));
    for (int i = 0; i < 3; ++i) {
        const vec3<N> from = between<N>(p, t.at[i]), to = between<N>(p, t.at[i == 2 ? 0 : i + 1]);
        least_volume = least(least_volume, sign * dot(axis, cross(from, to)).high);
    }
    if (least_volume < 0) return none;
    const point passing = on_segment(p, q, into_unit(at_p / fall));
    const foot_point<N> foot = foot_on_triangle<N>(passing, t);
    return {true, least_volume > certain_volume<N>, {{passing, foot.at}, foot.away}};
}

/// Of a segment and a triangle, at any distance from each other. Where they cross, there is no way from one to the other.
template <class N>
struct near_axis {
    near_points<N> nearest;
    bool crosses;
};
template <class N>
ABUT_HD constexpr near_axis<N> nearest_points(const point& p, const point& q, const corners& t) {
    const crossing<N> through = crossing_of<N>(p, q, t);
    if (through.is_certain) return {{through.found.at, as<N>({0, 0, 0})}, true};
    near_points<N> nearest{};
    N least_square = N::of(infinity<double>);
    const auto offer = [&](const near_points<N>& found) {
        const N square = dot(found.away, found.away);
        if (square < least_square) least_square = square, nearest = found;
    };
    if (through.exists) offer(through.found);
    const foot_point<N> at_p = foot_on_triangle<N>(p, t), at_q = foot_on_triangle<N>(q, t);
    offer({{p, at_p.at}, at_p.away});
    offer({{q, at_q.at}, at_q.away});
    for (int k = 0; k < 3; ++k) {
        offer(near_segments<N>(p, q, t.at[k], t.at[k == 2 ? 0 : k + 1]));
        const foot_point<N> foot = foot_on_segment<N>(t.at[k], p, q);
        offer({{foot.at, t.at[k]}, {-foot.away.x, -foot.away.y, -foot.away.z}});
    }
    return {nearest, false};
}

}  // namespace abut::detail::contact_math
