// SPDX-License-Identifier: MIT
#pragma once

// The exact half of the predicate between a capsule and a triangle: an OR over pairs of features, one of the capsule's axis
// (an end, or the inside) and one of the triangle (a corner, the inside of an edge, the inside of the face).
//
// Why it is complete. Let x on the axis and y on the triangle be as near to each other as any, each in the inside of one
// feature. Then x - y is orthogonal to both features. If some direction d lies along both, then x + td and y + td are as
// near for every t, and the larger |t| brings one of them to the border of its feature, that is into a feature of lower
// dimension; so there is a nearest pair whose features have no common direction. Six kinds are left: end and corner; end and
// edge; end and face; axis and corner; axis and edge, not parallel; axis and face, not parallel. In the last x - y is
// orthogonal to all of space, so the axis crosses the face, whatever the radius; in the others x and y are each other's
// orthogonal feet, strictly inside. Each question below has that for its condition, and that their distance is at most the
// radius, so each yes is backed by two points. Degenerate shapes need no case of their own: their features without extent
// have no inside, and no foot strictly in it.

#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>
#include <abut/predicate/exact_ball.hpp>

namespace abut::detail {

/// Degree 6, with signs of degree 4. Two lines along d and f, and their common normal n = d x f: the first goes from s0 to
/// s1, the second from t0 to t1; p0 = t0 - s0, p1 = t1 - s0, q0 = t0 - s1. The foot on the first is at n . (p0 x f) / n . n
/// of its length from s0, and at n . (q0 x f) / n . n from s1; that on the second at n . (p0 x d) / n . n from t0. The
/// distance is |p0 . n| / |n|. All signs are 0 where the lines are parallel.
template <class N, class R>
ABUT_HD constexpr bool lines_within(const vec3<N>& d, const vec3<N>& f, const vec3<N>& p0, const vec3<N>& p1,
                                    const vec3<N>& q0, const R& r) {
    const auto n = cross(d, f);
    return sign_of_dot(cross(p0, f), n) > 0 && sign_of_dot(cross(q0, f), n) < 0 && sign_of_dot(cross(p0, d), n) > 0 &&
           sign_of_dot(cross(p1, d), n) < 0 && squares_at_most(dot(p0, n), scale(r, n));
}

/// Degree 3. The segment from the origin along d goes through the inside of the face p: its ends lie strictly on different
/// sides of the plane (q is a corner as seen from the other end), and its line passes all edges on one side.
template <class N>
ABUT_HD constexpr bool crosses_face(const vec3<N>& d, const vec3<N> (&p)[3], const vec3<N>& q) {
    const auto n = cross(p[1] - p[0], p[2] - p[0]);
    if (sign_of_dot(n, p[0]) * sign_of_dot(n, q) >= 0) return false;
    const int side = sign_of_dot(cross(p[0], p[1]), d);
    return side != 0 && sign_of_dot(cross(p[1], p[2]), d) == side && sign_of_dot(cross(p[2], p[0]), d) == side;
}

/// The axis's ends, the triangle's corners, the radius.
struct capsule_meets_triangle {
    static constexpr int degree = 6, points = 5;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[16]) {
        const vec3<N> s0 = point_at(value, 0), s1 = point_at(value, 1);
        const vec3<N> a = point_at(value, 2), b = point_at(value, 3), c = point_at(value, 4);
        const N& r = value[15];
        using difference = decltype(a - s0);
        const difference p[3] = {a - s0, b - s0, c - s0}, q[3] = {a - s1, b - s1, c - s1}, edge[3] = {b - a, c - b, a - c};
        for (int i = 0; i < 3; ++i) {
            if (vertex_in_ball(p[i], r) || vertex_in_ball(q[i], r)) return true;
        }
        // Seen from a corner, the axis goes from -p to -q, which asks the same as from p to q.
        const difference back = s0 - s1, d = s1 - s0;
        for (int i = 0; i < 3; ++i) {
            const int j = i == 2 ? 0 : i + 1;
            if (edge_in_ball(p[i], q[i], back, r) || edge_in_ball(p[i], p[j], edge[i], r) ||
                edge_in_ball(q[i], q[j], edge[i], r)) {
                return true;
            }
        }
        if (crosses_face(d, p, q[0])) return true;
        for (int i = 0; i < 3; ++i) {
            const int j = i == 2 ? 0 : i + 1;
            if (lines_within(d, edge[i], p[i], p[j], q[i], r)) return true;
        }
        const auto normal = cross(edge[0], edge[1]);
        return face_in_ball(p[0], p[1], p[2], normal, r) || face_in_ball(q[0], q[1], q[2], normal, r);
    }
};

}  // namespace abut::detail
