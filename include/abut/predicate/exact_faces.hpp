// SPDX-License-Identifier: MIT
#pragma once

// Do two faces of a mesh meet in more than the vertices that they share? Each is the convex hull of three points. The
// question as signs of determinants, written once over a number type, for faces that share one vertex or two; those that
// share none are exact_triangles.hpp's, and those that share three meet in more if they have an area (zero_area.hpp).
// Faces without area, which are segments or points, are decided like all others.
//
// One shared vertex p. Close to p a face is the cone of the directions from p to its other two corners, a and b: p + x is in
// the face for every x of the cone that is short enough. So the faces meet in more than p if and only if the two cones have
// a direction in common. If one cone is strictly on one side of the plane of the other, they have none. Else, if the planes
// differ, each cone meets the line of both planes in one ray. With the heights a' = n . a and b' = n . b over the other's
// plane, of which n is the normal, and which are not of one sign, that of a and b runs along
//     |b'| a + |a'| b,   and   n x (a x b) = b' a - a' b:
// so it is n x m or m x n, where m = a x b, by the signs of a' and b' alone. The other cone's likewise: no other determinant
// is needed. If both are in one plane, the question is one of four directions in two dimensions, and if neither has an area,
// whether a direction of the one is one of the other.
//
// Two shared vertices u, v, at the third corners w and z. If u, v, w and z are not in one plane, the faces meet in the
// segment from u to v alone. If they are, and both have an area, w and z have to lie on one side of the line of u and v; if
// one has none, it lies on that line, where the other covers the shared segment and no more. If neither has, both are
// intervals of one line that hold the shared one, and go on beyond it at the same end or not. Vertices of different numbers
// may lie in one place: if u and v do, both faces are segments from there, and the question is whether these go one way.
//
// Checked against linear programming and clipping in rational numbers (tests/support/shared_faces.hpp).

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>
#include <abut/predicate/zero_area.hpp>

namespace abut::detail {

// --- directions ----------------------------------------------------------------------------------------------------------

/// The signs of three numbers.
struct sign_triple {
    int x, y, z;
    friend ABUT_HD constexpr bool operator==(const sign_triple& a, const sign_triple& b) {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
    ABUT_HD constexpr sign_triple operator-() const { return {-x, -y, -z}; }
    [[nodiscard]] ABUT_HD constexpr bool all_zero() const { return x == 0 && y == 0 && z == 0; }
};

template <class N>
ABUT_HD constexpr sign_triple signs_of(const vec3<N>& v) {
    return {sign(v.x), sign(v.y), sign(v.z)};
}

/// Whether one is a positive multiple of the other. Parallel vectors have equal signs then, or opposite ones.
template <class N>
ABUT_HD constexpr bool one_direction(const vec3<N>& g, const vec3<N>& h) {
    const sign_triple of_g = signs_of(g);
    return !of_g.all_zero() && of_g == signs_of(h) && signs_of(cross(g, h)).all_zero();
}

/// The first coordinate that is not 0, or 3.
ABUT_HD constexpr int axis_of(const sign_triple& normal) {
    return normal.x != 0 ? 0 : normal.y != 0 ? 1 : normal.z != 0 ? 2 : 3;
}

/// A coordinate of g x h: on which side of g lies h, seen along an axis.
template <class N>
ABUT_HD constexpr int turn_along(int axis, const vec3<N>& g, const vec3<N>& h) {
    return axis == 0 ? sign(g.y * h.z - g.z * h.y) : axis == 1 ? sign(g.z * h.x - g.x * h.z) : sign(g.x * h.y - g.y * h.x);
}

// --- one shared vertex ----------------------------------------------------------------------------------------------------

/// Whether g, in the plane of a and b, is a direction between theirs, or one of them. Seen along an axis the turn from a to
/// b is `side`, which is not 0.
template <class N>
ABUT_HD constexpr bool is_between(int axis, int side, const vec3<N>& a, const vec3<N>& b, const vec3<N>& g) {
    return !signs_of(g).all_zero() && turn_along(axis, a, g) * side >= 0 && turn_along(axis, g, b) * side >= 0;
}

/// Whether the cone of a and b, which has an area seen along an axis, has a direction of that of c and d, in its plane.
template <class N>
ABUT_HD constexpr bool cones_meet_in_plane(int axis, const vec3<N>& a, const vec3<N>& b, const vec3<N>& c,
                                           const vec3<N>& d) {
    const int side = turn_along(axis, a, b), other_side = turn_along(axis, c, d);
    if (is_between(axis, side, a, b, c) || is_between(axis, side, a, b, d)) return true;
    // Neither border of the second is in the first: then the first is within the second, or they are apart.
    return other_side != 0 && is_between(axis, other_side, c, d, a);
}

/// Whether the cone of a and b and that of c and d have a direction in common.
template <class N>
ABUT_HD constexpr bool cones_meet(const vec3<N>& a, const vec3<N>& b, const vec3<N>& c, const vec3<N>& d) {
    const auto m = cross(a, b);
    const int of_c = sign_of_dot(m, c), of_d = sign_of_dot(m, d);
    if (of_c * of_d > 0) return false;
    const auto n = cross(c, d);
    const int of_a = sign_of_dot(n, a), of_b = sign_of_dot(n, b);
    if (of_a * of_b > 0) return false;
    const bool first_is_in_plane = of_a == 0 && of_b == 0, second_is_in_plane = of_c == 0 && of_d == 0;
    if (!first_is_in_plane && !second_is_in_plane) {
        // The ray of a and b is n x m if b' >= 0 >= a', that of c and d is m x n if d' >= 0 >= c'.
        return (of_b > 0 || of_a < 0) != (of_d > 0 || of_c < 0);
    }
    // A cone that has no area and leaves the other's plane has no direction in it.
    if (!first_is_in_plane || !second_is_in_plane) return false;
    const int axis = axis_of(signs_of(m)), other_axis = axis_of(signs_of(n));
    if (axis < 3) return cones_meet_in_plane(axis, a, b, c, d);
    if (other_axis < 3) return cones_meet_in_plane(other_axis, c, d, a, b);
    return one_direction(a, c) || one_direction(a, d) || one_direction(b, c) || one_direction(b, d);
}

/// How the question's values lie in an array of any number type: the shared vertex, the other two corners of the one, those
/// of the other.
struct faces_meet_beyond_vertex {
    static constexpr int degree = 3, points = 5;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&v)[15]) {
        const vec3<N> p{v[0], v[1], v[2]};
        const vec3<N> a{v[3], v[4], v[5]}, b{v[6], v[7], v[8]}, c{v[9], v[10], v[11]}, d{v[12], v[13], v[14]};
        return cones_meet(a - p, b - p, c - p, d - p);
    }
};

// --- two shared vertices -----------------------------------------------------------------------------------------------

/// The shared vertices u and v, and the third corners.
template <class N>
ABUT_HD constexpr bool meet_beyond_edge(const vec3<N>& u, const vec3<N>& v, const vec3<N>& w, const vec3<N>& z) {
    const auto along = v - u, to_w = w - u, to_z = z - u;
    const auto m = cross(along, to_w);
    if (sign_of_dot(m, to_z) != 0) return false;
    const int axis = axis_of(signs_of(m));
    if (axis < 3) return turn_along(axis, along, to_z) == turn_along(axis, along, to_w);
    const sign_triple direction = signs_of(along);
    if (direction.all_zero()) return one_direction(to_w, to_z);
    if (!signs_of(cross(along, to_z)).all_zero()) return false;
    const sign_triple from_v_to_w = signs_of(w - v), from_v_to_z = signs_of(z - v);
    return (from_v_to_w == direction && from_v_to_z == direction) ||
           (signs_of(to_w) == -direction && signs_of(to_z) == -direction);
}

/// The shared vertices, the third corner of the one, that of the other.
struct faces_meet_beyond_edge {
    static constexpr int degree = 3, points = 4;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&v)[12]) {
        return meet_beyond_edge(vec3<N>{v[0], v[1], v[2]}, vec3<N>{v[3], v[4], v[5]}, vec3<N>{v[6], v[7], v[8]},
                                vec3<N>{v[9], v[10], v[11]});
    }
};

// --- three shared vertices ---------------------------------------------------------------------------------------------

/// Whether a face has more than its sides, that is, an area.
struct has_inner_points {
    static constexpr int degree = 2, points = 3;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&v)[9]) {
        return !corners_on_a_line::holds(v);
    }
};

}  // namespace abut::detail
