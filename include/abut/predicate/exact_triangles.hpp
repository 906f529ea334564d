// SPDX-License-Identifier: MIT
#pragma once

// Do two triangles meet, each the convex hull of three points? The question as signs of determinants, written once over a
// number type, for triangles, segments and points alike.
//
// Each corner lies on a side of the other's plane. If all three lie strictly on one side, the triangles are apart. Else:
//
// Neither has all three in the other's plane. Then both planes exist and cross in a line, of which each triangle covers a
// closed interval. One corner of each is alone on its side, if corners in the other's plane are counted to a fitting side:
// an interval lies between the edges from that corner. Two determinants say whether the intervals overlap: O. Devillers,
// P. Guigue, Faster triangle-triangle intersection tests (2002), INRIA RR-4488, section 4.
//
// Both have all three there. If one has an area, both lie in its plane, and a projection along an axis that keeps the area
// is faithful: in two dimensions hulls, of which one has an area, are apart if and only if the line of an edge separates
// them. If neither has an area, two skew segments show by a pair of edges that pass each other. Else all is in one plane,
// and the projections along all axes decide: hulls in a plane meet if and only if all three of their images do, since one
// image is faithful. There, points of one line are apart if an interval of a coordinate is.
//
// One has all three there: so the other has no area, and crosses the plane of the first. It meets the first where one of its
// edges does: an edge whose ends are on different sides of the plane, or one of them in it, meets that plane in one point,
// which is in the triangle if and only if the edge's line passes the three sides in no two opposite senses.
//
// Every determinant is that of three vectors from one corner to others: its terms are then no larger than the box around
// both triangles makes them, which predicate/coarse_grid.hpp counts on.
//
// Checked against linear programming in rational numbers (tests/support/hulls.hpp), in every family of degenerate input.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>
#include <abut/predicate/lone_corner.hpp>

namespace abut::detail {

template <class N>
struct three_points {
    vec3<N> at[3];
    ABUT_HD constexpr const vec3<N>& operator[](int i) const { return at[i]; }
};

ABUT_HD constexpr int after(int i) { return i == 2 ? 0 : i + 1; }

/// On which side of the plane of t the corners of s lie, a bit for each corner; no bits where t has no area.
struct plane_sides {
    unsigned above = 0, below = 0;

    template <class N>
    ABUT_HD constexpr plane_sides(const three_points<N>& s, const three_points<N>& t) {
        const auto normal = cross(t[1] - t[0], t[2] - t[0]);
        for (int i = 0; i < 3; ++i) {
            const int side = sign_of_dot(normal, s[i] - t[0]);
            above |= static_cast<unsigned>(side > 0) << i;
            below |= static_cast<unsigned>(side < 0) << i;
        }
    }
    [[nodiscard]] ABUT_HD constexpr bool strictly_one() const { return above == 0b111 || below == 0b111; }
    [[nodiscard]] ABUT_HD constexpr bool all_zero() const { return (above | below) == 0; }
    /// Whether edge i of s meets the plane in one point.
    [[nodiscard]] ABUT_HD constexpr bool crossed_by(int i) const {
        const int j = after(i);
        return (((above >> i ^ above >> j) | (below >> i ^ below >> j)) & 1) != 0;
    }
    /// The corners above, or if none is, those in the plane: one or two of them, unless all are on one side or in it.
    [[nodiscard]] ABUT_HD constexpr unsigned upper_part() const { return above != 0 ? above : 0b111 & ~below; }
};

/// Corner k. A host reads it where it lies; a device has no indexed registers, and would go through memory.
template <class N>
ABUT_HD constexpr vec3<N> corner(const three_points<N>& s, unsigned k) {
#if ABUT_DEVICE_CODE
    const auto pick = [k](const N& a, const N& b, const N& c) { return k == 0 ? a : k == 1 ? b : c; };
    return {pick(s[0].x, s[1].x, s[2].x), pick(s[0].y, s[1].y, s[2].y), pick(s[0].z, s[1].z, s[2].z)};
#else
    return s.at[k];
#endif
}

/// Whether two triangles, neither in the other's plane nor on one side of it, cover parts of the line in which the planes
/// cross that overlap.
template <class N>
ABUT_HD constexpr bool intervals_meet(const three_points<N>& s, unsigned above, const three_points<N>& t,
                                      unsigned other_above) {
    const lone_corner of_s(above, other_above), of_t(other_above, above);
    const vec3<N> p = corner(s, of_s.alone), q = corner(t, of_t.alone);
    const auto across = q - p;
    return sign_of_dot(cross(corner(s, of_s.next) - p, across), corner(t, of_t.next) - p) <= 0 &&
           sign_of_dot(cross(corner(s, of_s.last) - p, corner(t, of_t.last) - p), across) <= 0;
}

// Loops over edges turn the corners, so that each looks at the first edge: corners stay in a device's registers, and no turn
// of a loop is compiled for itself.

template <class N>
ABUT_HD constexpr void turn_corners(three_points<N>& s) {
    rotate(s.at[0], s.at[1], s.at[2]);
}

/// In which sense the lines of the first edges of s and t pass each other; 0 if they are in one plane.
template <class N>
ABUT_HD constexpr int passing_sense(const three_points<N>& s, const three_points<N>& t) {
    return sign_of_dot(cross(s[1] - s[0], t[0] - s[0]), t[1] - s[0]);
}

/// Whether the first edge of s, which meets the plane of t in one point, meets t.
template <class N>
ABUT_HD constexpr bool passes_through(const three_points<N>& s, three_points<N> t) {
    bool left = false, right = false;
    ABUT_ROLLED
    for (int edge = 0; edge < 3 && !(left && right); ++edge) {
        const int sense = passing_sense(s, t);
        left |= sense < 0;
        right |= sense > 0;
        turn_corners(t);
    }
    return !(left && right);
}

// In one plane, one coordinate left out.

template <class N>
struct flat_point {
    N x, y;
};

template <class N>
struct flat_points {
    flat_point<N> at[3];
    ABUT_HD constexpr const flat_point<N>& operator[](int i) const { return at[i]; }
};

template <class N>
ABUT_HD constexpr flat_points<N> flattened(const three_points<N>& s, int axis) {
    flat_points<N> flat{};
    for (int i = 0; i < 3; ++i) {
        const vec3<N>& p = s[i];
        flat.at[i] = axis == 0 ? flat_point<N>{p.y, p.z} : axis == 1 ? flat_point<N>{p.z, p.x} : flat_point<N>{p.x, p.y};
    }
    return flat;
}

/// Whether p, q, r turn left (1), right (-1), or not at all.
template <class N>
ABUT_HD constexpr int turn(const flat_point<N>& p, const flat_point<N>& q, const flat_point<N>& r) {
    return sign((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
}

/// Whether the line of an edge of s has all of t strictly on one side, and s not on that side.
template <class N>
ABUT_HD constexpr bool edge_separates(flat_points<N> s, const flat_points<N>& t) {
    ABUT_ROLLED
    for (int edge = 0; edge < 3; ++edge) {
        const int side = turn(s[0], s[1], t[0]);
        if (side != 0 && turn(s[0], s[1], t[1]) == side && turn(s[0], s[1], t[2]) == side && turn(s[0], s[1], s[2]) != side)
            return true;
        rotate(s.at[0], s.at[1], s.at[2]);
    }
    return false;
}

/// Whether all of s lies strictly on one side of all of t, in the coordinate x.
template <class N>
ABUT_HD constexpr bool interval_separates(const flat_points<N>& s, const flat_points<N>& t) {
    const int side = sign(s[0].x - t[0].x);
    if (side == 0) return false;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (sign(s[i].x - t[j].x) != side) return false;
        }
    }
    return true;
}

/// Seen along an axis, in a plane; one of them has an area there.
template <class N>
ABUT_HD constexpr bool images_meet(const three_points<N>& s, const three_points<N>& t, int axis) {
    flat_points<N> p = flattened(s, axis), q = flattened(t, axis);
    ABUT_ROLLED
    for (int of_whom = 0; of_whom < 2; ++of_whom) {
        if (edge_separates(p, q)) return false;
        const flat_points<N> other = p;
        p = q;
        q = other;
    }
    return true;
}

/// An axis along which the area of s shows, or 3 if s has none.
template <class N>
ABUT_HD constexpr int axis_of_area(const three_points<N>& s) {
    const auto normal = cross(s[1] - s[0], s[2] - s[0]);
    return sign(normal.x) != 0 ? 0 : sign(normal.y) != 0 ? 1 : sign(normal.z) != 0 ? 2 : 3;
}

/// Neither has an area.
template <class N>
ABUT_HD constexpr bool segments_meet(three_points<N> s, three_points<N> t) {
    ABUT_ROLLED
    for (int pair = 1; pair <= 9; ++pair) {
        if (passing_sense(s, t) != 0) return false;  // skew
        turn_corners(s);
        if (pair % 3 == 0) turn_corners(t);
    }
    ABUT_ROLLED
    for (int axis = 0; axis < 3; ++axis) {  // each coordinate is x once
        if (interval_separates(flattened(s, axis), flattened(t, axis)) || !images_meet(s, t, axis)) return false;
    }
    return true;
}

/// Both in one plane; or else all signs of their corners are 0 because neither has an area.
template <class N>
ABUT_HD constexpr bool meet_in_plane(const three_points<N>& s, const three_points<N>& t) {
    const int of_s = axis_of_area(s), axis = of_s < 3 ? of_s : axis_of_area(t);
    return axis < 3 ? images_meet(s, t, axis) : segments_meet(s, t);
}

/// Whether an edge of s, which crosses the plane of t, meets t.
template <class N>
ABUT_HD constexpr bool segment_meets(three_points<N> s, const plane_sides& of_s, const three_points<N>& t) {
    ABUT_ROLLED
    for (int i = 0; i < 3; ++i) {
        if (of_s.crossed_by(i) && passes_through(s, t)) return true;
        turn_corners(s);
    }
    return false;
}

/// Whether the hulls of s and of t have a point in common.
template <class N>
ABUT_HD constexpr bool hulls_meet(const three_points<N>& s, const three_points<N>& t) {
    const plane_sides of_s(s, t);
    if (of_s.strictly_one()) return false;
    const plane_sides of_t(t, s);
    if (of_t.strictly_one()) return false;
    if (of_s.all_zero()) return of_t.all_zero() ? meet_in_plane(s, t) : segment_meets(t, of_t, s);
    if (of_t.all_zero()) return segment_meets(s, of_s, t);
    return intervals_meet(s, of_s.upper_part(), t, of_t.upper_part());
}

/// How the question's values lie in an array of any number type: the coordinates of s, then those of t.
struct triangle_meets_triangle {
    static constexpr int degree = 3, points = 6;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&v)[18]) {
        const three_points<N> s{{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}}};
        const three_points<N> t{{{v[9], v[10], v[11]}, {v[12], v[13], v[14]}, {v[15], v[16], v[17]}}};
        return hulls_meet(s, t);
    }
};

}  // namespace abut::detail
