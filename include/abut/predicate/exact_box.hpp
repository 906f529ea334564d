// SPDX-License-Identifier: MIT
#pragma once

// The exact half of the predicates between a box and a triangle or a segment: thirteen axes (T. Akenine-Moeller, Fast 3D
// Triangle-Box Overlap Testing, 2001), of degree 1 (the box's own), 2 (a box axis x an edge) and 3 (the triangle's normal).
// Both are apart if and only if one of the axes has their shadows strictly apart; an axis that is 0 has no such shadows. A
// segment has one edge and no normal, and so six axes.
//
// Why thirteen are enough, also where the box has no extent in some direction and the triangle has no area. Apart means that
// 0 is not in the closed polytope P = {x - y : x in the box, y in the triangle}. Let D be the directions of P's affine hull,
// which are spanned by box axes e_i and triangle edges f_j.
// - D is the space: a facet separates 0. A facet is a sum of a face of each, so its normal is that of a box face (e_k), of
//   the triangle (n), or of two edges (e_i x f_j).
// - D is a plane with normal m, and 0 outside of the plane: m separates, and is e_k where two box axes span D, e_i x f_j
//   where one of each does, and n where two edges do.
// - D is a plane, and 0 in it: an edge of the polygon P separates, that is any d which is orthogonal to the edge and not
//   parallel to m, towards its outside. For an edge e_i, the other two box axes are orthogonal to it and not both parallel
//   to m; for an edge f_j, the three e_i x f_j span all that is orthogonal to it.
// - D is a line along f (or e_i): 0 is outside the line, or beyond an end on it. In the first case one of the e_i x f (the
//   e_k) has a product with P that is not 0, as they span all that is orthogonal to the line; in the second, any e_i that is
//   not orthogonal to the line.
// - P is a point: one of the e_i.

#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut::detail {

/// Whether all three numbers lie on one side of the interval.
template <class N>
ABUT_HD constexpr bool beyond(const N& a, const N& b, const N& c, const N& lower, const N& upper) {
    return (sign(a - upper) > 0 && sign(b - upper) > 0 && sign(c - upper) > 0) ||
           (sign(a - lower) < 0 && sign(b - lower) < 0 && sign(c - lower) < 0);
}

/// One coordinate of all values, for questions that are asked in two of the three.
template <class N>
struct coordinate_of_all {
    N lower, upper, corner[3];
};

/// The side of the line from p along the edge (fx, fy) on which (x, y) lies.
template <class M, class N>
ABUT_HD constexpr int side_of_edge(const M& fx, const M& fy, const N& px, const N& py, const N& x, const N& y) {
    return sign(fx * (y - py) - fy * (x - px));
}

/// Whether box and triangle are apart on the axis e_z x f for the edge f from corner `from`: seen along z, the box lies
/// beyond the edge, or beyond the parallel to it through the third corner.
template <class N>
ABUT_HD constexpr bool apart_beside_edge(const coordinate_of_all<N>& x, const coordinate_of_all<N>& y, int from) {
    const int to = from == 2 ? 0 : from + 1, third = 3 - from - to;
    const auto fx = x.corner[to] - x.corner[from], fy = y.corner[to] - y.corner[from];
    const bool right = sign(fx) > 0, up = sign(fy) > 0;
    // The side is linear: these are the box's corners where it is least and greatest.
    const N &least_x = up ? x.upper : x.lower, &least_y = right ? y.lower : y.upper;
    const N &most_x = up ? x.lower : x.upper, &most_y = right ? y.upper : y.lower;
    return (side_of_edge(fx, fy, x.corner[from], y.corner[from], least_x, least_y) > 0 &&
            side_of_edge(fx, fy, x.corner[third], y.corner[third], least_x, least_y) > 0) ||
           (side_of_edge(fx, fy, x.corner[from], y.corner[from], most_x, most_y) < 0 &&
            side_of_edge(fx, fy, x.corner[third], y.corner[third], most_x, most_y) < 0);
}

/// The box's lower and upper corner, then the triangle's corners.
struct box_meets_triangle {
    static constexpr int degree = 3, points = 5;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[15]) {
        coordinate_of_all<N> axis[3]{};
        for (int k = 0; k < 3; ++k) {
            axis[k] = {value[k], value[3 + k], {value[6 + k], value[9 + k], value[12 + k]}};
            const auto& [lower, upper, corner] = axis[k];
            if (beyond(corner[0], corner[1], corner[2], lower, upper)) return false;
        }
        const vec3<N> a{value[6], value[7], value[8]}, b{value[9], value[10], value[11]}, c{value[12], value[13], value[14]};
        const auto n = cross(b - a, c - a);
        const bool x = sign(n.x) > 0, y = sign(n.y) > 0, z = sign(n.z) > 0;
        const vec3<N> lowest{value[x ? 0 : 3], value[y ? 1 : 4], value[z ? 2 : 5]};
        const vec3<N> highest{value[x ? 3 : 0], value[y ? 4 : 1], value[z ? 5 : 2]};
        if (sign_of_dot(n, lowest - a) > 0 || sign_of_dot(n, highest - a) < 0) return false;
        for (int k = 0; k < 3; ++k) {
            for (int from = 0; from < 3; ++from) {
                if (apart_beside_edge(axis[k], axis[k == 2 ? 0 : k + 1], from)) return false;
            }
        }
        return true;
    }
};

/// Degree 2. A segment is a triangle whose third corner is the second.
template <class N>
ABUT_HD constexpr bool axis_meets_box(const vec3<N>& lower, const vec3<N>& upper, const vec3<N>& a, const vec3<N>& b) {
    const coordinate_of_all<N> axis[3] = {
        {lower.x, upper.x, {a.x, b.x, b.x}}, {lower.y, upper.y, {a.y, b.y, b.y}}, {lower.z, upper.z, {a.z, b.z, b.z}}};
    for (int k = 0; k < 3; ++k) {
        if (beyond(axis[k].corner[0], axis[k].corner[1], axis[k].corner[1], axis[k].lower, axis[k].upper)) return false;
    }
    for (int k = 0; k < 3; ++k) {
        if (apart_beside_edge(axis[k], axis[k == 2 ? 0 : k + 1], 0)) return false;
    }
    return true;
}

/// The box's lower and upper corner, then the segment's ends.
struct box_meets_segment {
    static constexpr int degree = 2, points = 4;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[12]) {
        return axis_meets_box(vec3<N>{value[0], value[1], value[2]}, vec3<N>{value[3], value[4], value[5]},
                              vec3<N>{value[6], value[7], value[8]}, vec3<N>{value[9], value[10], value[11]});
    }
};

}  // namespace abut::detail
