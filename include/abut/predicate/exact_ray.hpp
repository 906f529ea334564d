// SPDX-License-Identifier: MIT
#pragma once

// Rays and triangles as signs of determinants, written once over a number type: whether they meet. When is asked in
// narrow/exact_hit_time.hpp.
//
// Let o be the origin, d the direction, and A, B, C the ways from o to the corners. The line meets the triangle where it
// passes the three sides in no two opposite senses: where the signs of (A x B).d, (B x C).d and (C x A).d are none of them
// opposite (E. Haines, S. Hyde, Pluecker coordinates; the same signs for both faces at an edge make a closed mesh
// watertight). Their sum is n.d, with the normal n of the triangle. If they are not all 0, it is not 0, and the point that
// is met is at t = n.A / n.d. If all are 0, the line lies in the plane of the triangle, or the triangle has no area, or d is
// 0. In the last case the question is whether o lies in the triangle. In the others a ray meets the triangle if and only if
// it meets a side, for it leaves a triangle with an area through a side.
//
// A side from A to B = A + e, in one plane with o and d. If f = d x e is not 0 the point is at t = (A x e) / f, which is
// (A x d) / f of the side, in any coordinate of these in which f is not 0. If f is 0, both are on parallel lines, and meet
// if A lies on the line of d, too: then one of the ends has a t of 0 or more.
//
// Checked against rational numbers and linear programming (tests/predicate/ray_triangle.test.cpp).

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>
#include <abut/predicate/exact_faces.hpp>
#include <abut/predicate/exact_triangles.hpp>

namespace abut::detail {

/// The values of all questions here begin alike: the origin, the corners, and two points whose difference is the direction,
/// which may be that of a segment's ends and need not be representable. Points as they are, and as seen from the origin.
template <class N>
struct line_and_triangle {
    using way = vec3<decltype(N{} - N{})>;
    vec3<N> corner[3];
    way to[3], along;

    template <std::size_t V>
    ABUT_HD explicit constexpr line_and_triangle(const N (&v)[V])
        : corner{{v[3], v[4], v[5]}, {v[6], v[7], v[8]}, {v[9], v[10], v[11]}}, to{}, along{} {
        const vec3<N> origin{v[0], v[1], v[2]};
        for (int i = 0; i < 3; ++i) to[i] = corner[i] - origin;
        along = vec3<N>{v[12], v[13], v[14]} - vec3<N>{v[15], v[16], v[17]};
    }
    [[nodiscard]] ABUT_HD constexpr auto normal() const { return cross(corner[1] - corner[0], corner[2] - corner[0]); }
    [[nodiscard]] ABUT_HD constexpr way side(int i) const { return corner[after(i)] - corner[i]; }
};

/// Coordinate `axis` of v, by its sign.
ABUT_HD constexpr int sign_along(const sign_triple& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Whether the ray meets side i, which lies in one plane with it.
template <class N>
ABUT_HD constexpr bool meets_side(const line_and_triangle<N>& l, int i) {
    const auto &p = l.to[i], &q = l.to[after(i)];
    const auto edge = l.side(i);
    const sign_triple f = signs_of(cross(l.along, edge)), of_p = signs_of(cross(p, l.along));
    const int axis = axis_of(f);
    if (axis < 3) {
        const int turn = sign_along(f, axis);
        return sign_along(signs_of(cross(p, edge)), axis) * turn >= 0 && sign_along(of_p, axis) * turn >= 0 &&
               sign_along(signs_of(cross(q, l.along)), axis) * turn <= 0;
    }
    if (!of_p.all_zero()) return false;
    const sign_triple forward = signs_of(l.along);
    const int k = axis_of(forward), direction = sign_along(forward, k);
    return sign_along(signs_of(p), k) * direction >= 0 || sign_along(signs_of(q), k) * direction >= 0;
}

struct ray_meets_triangle {
    static constexpr int degree = 3, points = 4;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&v)[18]) {
        const line_and_triangle<N> l(v);
        const int ab = sign_of_dot(cross(l.to[0], l.to[1]), l.along), bc = sign_of_dot(cross(l.to[1], l.to[2]), l.along),
                  ca = sign_of_dot(cross(l.to[2], l.to[0]), l.along);
        const bool any_left = ab > 0 || bc > 0 || ca > 0, any_right = ab < 0 || bc < 0 || ca < 0;
        if (any_left && any_right) return false;
        if (any_left || any_right) return sign_of_dot(l.normal(), l.to[0]) * (any_left ? 1 : -1) >= 0;
        if (!signs_of(l.along).all_zero()) return meets_side(l, 0) || meets_side(l, 1) || meets_side(l, 2);
        const three_points<N> corners{{l.corner[0], l.corner[1], l.corner[2]}};
        const vec3<N> origin{v[0], v[1], v[2]};
        return hulls_meet(three_points<N>{{origin, origin, origin}}, corners);
    }
};

}  // namespace abut::detail
