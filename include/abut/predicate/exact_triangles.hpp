// SPDX-License-Identifier: MIT
#pragma once

// Do two triangles meet, each the convex hull of three points? The question as signs of determinants, written once over a
// number type. Nothing here classifies degenerate input: segments and points fall out.
//
// Each corner lies on a side of the other's plane. If all three lie strictly on one side, the triangles are apart. Else:
//
// Not all six signs are 0. Then triangles that meet do so, among other places, where an edge of one crosses the other: what
// they share is convex, and its ends are on a boundary. An edge whose ends are on different sides of the other's plane, or
// one of them in it, meets that plane in one point. That point is in the triangle if and only if the edge's line passes the
// three sides in no two opposite senses: the signs of three of nine determinants. Edges within the plane can be left out:
// where one meets the triangle, so does a neighbour, or an edge of the triangle meets the neighbour.
//
// All six are 0: neither spans a plane that the other is not in. Two skew segments show by a pair of edges that pass each
// other. Else all is in one plane, and the projections along the axes decide: hulls in a plane meet if and only if all three
// of their images do, since one image is faithful. In two dimensions hulls are apart if and only if the line of an edge
// separates them, or for points of one line an interval of a coordinate does.
//
// Checked against linear programming in rational numbers (tests/support/hulls.hpp), in every family of degenerate input.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut::detail {

template <class N>
struct three_points {
    vec3<N> at[3];
    ABUT_HD constexpr const vec3<N>& operator[](int i) const { return at[i]; }
};

ABUT_HD constexpr int after(int i) { return i == 2 ? 0 : i + 1; }

/// On which side of the plane of t the corners of s lie; all 0 where t has no area.
struct plane_sides {
    int of[3];

    template <class N>
    ABUT_HD constexpr plane_sides(const three_points<N>& s, const three_points<N>& t) : of{} {
        const auto normal = cross(t[1] - t[0], t[2] - t[0]);
        for (int i = 0; i < 3; ++i) of[i] = sign_of_dot(normal, s[i] - t[0]);
    }
    [[nodiscard]] ABUT_HD constexpr bool strictly_one() const { return of[0] != 0 && of[0] == of[1] && of[0] == of[2]; }
    [[nodiscard]] ABUT_HD constexpr bool all_zero() const { return of[0] == 0 && of[1] == 0 && of[2] == 0; }
    /// Whether edge i of s meets the plane in one point.
    [[nodiscard]] ABUT_HD constexpr bool crossed_by(int i) const { return of[i] != of[after(i)]; }
};

/// In which sense the line of edge i of s passes that of edge j of t; 0 if they are in one plane.
template <class N>
ABUT_HD constexpr int passing_sense(const three_points<N>& s, int i, const three_points<N>& t, int j) {
    return sign_of_dot(cross(s[after(i)] - s[i], t[after(j)] - t[j]), t[j] - s[i]);
}

/// Whether edge i of s, which meets the plane of t in one point, meets t.
template <class N>
ABUT_HD constexpr bool passes_through(const three_points<N>& s, int i, const three_points<N>& t) {
    const int first = passing_sense(s, i, t, 0), second = passing_sense(s, i, t, 1);
    if (first * second < 0) return false;
    const int third = passing_sense(s, i, t, 2);
    return first * third >= 0 && second * third >= 0;
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
ABUT_HD constexpr bool edge_separates(const flat_points<N>& s, const flat_points<N>& t) {
    for (int i = 0; i < 3; ++i) {
        const flat_point<N>&p = s[i], &q = s[after(i)];
        const int side = turn(p, q, t[0]);
        if (side != 0 && turn(p, q, t[1]) == side && turn(p, q, t[2]) == side && turn(p, q, s[after(after(i))]) != side)
            return true;
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

/// Both in one plane; or else all signs of their corners are 0 because neither has an area.
template <class N>
ABUT_HD constexpr bool meet_in_plane(const three_points<N>& s, const three_points<N>& t) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (passing_sense(s, i, t, j) != 0) return false;  // skew segments
        }
    }
    for (int axis = 0; axis < 3; ++axis) {  // each coordinate is x once
        const flat_points<N> p = flattened(s, axis), q = flattened(t, axis);
        if (interval_separates(p, q) || edge_separates(p, q) || edge_separates(q, p)) return false;
    }
    return true;
}

/// Whether the hulls of s and of t have a point in common.
template <class N>
ABUT_HD constexpr bool hulls_meet(const three_points<N>& s, const three_points<N>& t) {
    const plane_sides of_s(s, t);
    if (of_s.strictly_one()) return false;
    const plane_sides of_t(t, s);
    if (of_t.strictly_one()) return false;
    if (of_s.all_zero() && of_t.all_zero()) return meet_in_plane(s, t);
    for (int i = 0; i < 3; ++i) {
        if (of_s.crossed_by(i) && passes_through(s, i, t)) return true;
        if (of_t.crossed_by(i) && passes_through(t, i, s)) return true;
    }
    return false;
}

/// How the question's values lie in an array of any number type: the coordinates of s, then those of t.
struct triangle_meets_triangle {
    static constexpr int degree = 3;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&v)[18]) {
        const three_points<N> s{{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}}};
        const three_points<N> t{{{v[9], v[10], v[11]}, {v[12], v[13], v[14]}, {v[15], v[16], v[17]}}};
        return hulls_meet(s, t);
    }
};

}  // namespace abut::detail
