// SPDX-License-Identifier: MIT
#pragma once

// The exact half of the question whether a box and a segment, the axis of a capsule, or a triangle are no farther apart than
// a number. An OR over pairs of features, as in exact_capsule.hpp: a nearest pair of points exists whose features have no
// common direction. These are left:
// - an end and anything of the box: how far the end is from the box is the length of a vector of differences, degree 2;
// - the inside of the axis and a corner: edge_in_ball, degree 4;
// - the inside of the axis and an edge that is not parallel to it: seen along the edge that is a point, and the axis's foot
//   must be between the edge's ends, degree 3;
// - the inside of the axis and a face that is not parallel to it, or the box's inside: the axis goes through the box.
// A triangle has three such axes. And it has a face, which may be near a corner of the box, face_in_ball, degree 6; or it
// meets the box. Every other feature of the box has a direction in common with the face, or crosses it.
// Boxes may be flat: features without extent only ask the same twice. Each yes is backed by two points.

#include <cstddef>

#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>
#include <abut/predicate/exact_ball.hpp>
#include <abut/predicate/exact_box.hpp>

namespace abut::detail {

/// How far x is beyond the interval, on either side.
template <class N>
ABUT_HD constexpr auto excess_of(const N& x, const N& lower, const N& upper) {
    const auto below = lower - x, above = x - upper;
    return sign(below) > 0 ? below : sign(above) > 0 ? above : decltype(above){};
}

/// Degree 2: whether p is within r of the box.
template <class N, class R>
ABUT_HD constexpr bool box_in_ball(const vec3<N>& lower, const vec3<N>& upper, const vec3<N>& p, const R& r) {
    using difference = decltype(p.x - p.x);
    return vertex_in_ball(vec3<difference>{excess_of(p.x, lower.x, upper.x), excess_of(p.y, lower.y, upper.y),
                                           excess_of(p.z, lower.z, upper.z)},
                          r);
}

template <class N>
ABUT_HD constexpr vec3<N> seen_along_z(const vec3<N>& v) {
    return {v.x, v.y, N{}};
}

/// The edge of the box along z through c, which ends at `upper`, and the inside of the axis from a to b.
template <class N, class R>
ABUT_HD constexpr bool edge_near_axis(const vec3<N>& c, const N& upper, const vec3<N>& a, const vec3<N>& b, const R& r) {
    const auto d = b - a, to_c = c - a;
    const auto along = seen_along_z(d), q = seen_along_z(to_c);
    if (!edge_in_ball(seen_along_z(a - c), seen_along_z(b - c), along, r)) return false;
    // The foot is at t of the whole length.
    const auto t = dot(along, q), whole = dot(along, along);
    using square = decltype(dot(along, q));
    using difference = decltype(c.z - a.z);
    const vec3<square> weights{whole, t, square{}};
    return sign_of_dot(vec3<difference>{a.z - c.z, d.z, difference{}}, weights) >= 0 &&
           sign_of_dot(vec3<difference>{a.z - upper, d.z, difference{}}, weights) <= 0;
}

/// Corner i of a box.
template <class N>
ABUT_HD constexpr vec3<N> box_corner(const vec3<N>& lower, const vec3<N>& upper, int i) {
    return {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z};
}

/// Degree 4. The axis from a to b.
template <class N, class R>
ABUT_HD constexpr bool box_near_axis(vec3<N> lower, vec3<N> upper, vec3<N> a, vec3<N> b, const R& r) {
    if (box_in_ball(lower, upper, a, r) || box_in_ball(lower, upper, b, r)) return true;
    ABUT_ROLLED
    for (int i = 0; i < 8; ++i) {
        const vec3<N> c = box_corner(lower, upper, i);
        if (edge_in_ball(a - c, b - c, b - a, r)) return true;
    }
    ABUT_ROLLED
    for (int i = 0; i < 12; ++i) {
        const vec3<N> c{(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, lower.z};
        if (edge_near_axis(c, upper.z, a, b, r)) return true;
        if (i % 4 != 3) continue;
        rotate(lower.x, lower.y, lower.z);
        rotate(upper.x, upper.y, upper.z);
        rotate(a.x, a.y, a.z);
        rotate(b.x, b.y, b.z);
    }
    return axis_meets_box(lower, upper, a, b);
}

/// The box's lower and upper corner, the ends of an axis or the corners of a triangle, a radius and a distance.
template <int Corners>
struct box_within_hull {
    static constexpr int degree = Corners == 2 ? 4 : 6, points = 2 + Corners;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[std::size_t{8 + 3 * Corners}]) {
        const vec3<N> lower = point_at(value, 0), upper = point_at(value, 1);
        const auto r = value[6 + 3 * Corners] + value[7 + 3 * Corners];
        vec3<N> a = point_at(value, 2), b = point_at(value, 3);
        if (box_near_axis(lower, upper, a, b, r)) return true;
        if constexpr (Corners == 3) {
            vec3<N> c = point_at(value, 4);
            ABUT_ROLLED
            for (int i = 0; i < 2; ++i) {
                rotate(a, b, c);
                if (box_near_axis(lower, upper, a, b, r)) return true;
            }
            const auto normal = cross(b - a, c - b);
            ABUT_ROLLED
            for (int i = 0; i < 8; ++i) {
                const vec3<N> corner = box_corner(lower, upper, i);
                if (face_in_ball(a - corner, b - corner, c - corner, normal, r)) return true;
            }
            N both[15]{};
            for (int i = 0; i < 15; ++i) both[i] = value[i];
            return box_meets_triangle::holds(both);
        }
        return false;
    }
};

}  // namespace abut::detail
