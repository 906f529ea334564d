// SPDX-License-Identifier: MIT
#pragma once

// Boxes beside triangles: general, touching, without extent. For other_shapes.hpp.

#include <cmath>

#include <abut/arithmetic/magnitude.hpp>

#include "shape_families.hpp"

namespace abut::test::construction {

/// The box with a corner at p that extends to the side of `away`, by 0.05 to 1.
template <scalar T>
ABUT_HD aabb<T> box_from_corner(draws& d, const point& p, const point& away) {
    const double x = d.uniform(0.05, 1), y = d.uniform(0.05, 1), z = d.uniform(0.05, 1);
    const point q{away.x < 0 ? p.x - x : p.x + x, away.y < 0 ? p.y - y : p.y + y, away.z < 0 ? p.z - z : p.z + z};
    return box_of(round_to<T>(p), round_to<T>(q));
}

/// Within a step of touching: 0 a corner of the triangle and a face, an edge or a corner of the box; 1 an edge and an edge;
/// 2 the triangle's face and a corner of the box; 3 a triangle that is parallel to an axis, or to two, against the face; 4
/// an edge and an edge, where the triangle is much larger than the box.
template <scalar T>
ABUT_HD void touching(draws& d, int kind, shape_triangle_pair<aabb, T>& p) {
    const double half = kind == 4 ? 100 : 1;
    p.t = any_triangle<T>(d, half);
    if (kind == 0) {
        const vec3<T> q = rounded_cube<T>(d, 1), r = rounded_cube<T>(d, 1);
        const aabb<T> box = box_of(q, r);
        const vec3<T> a = p.t.a;
        p.s = box;
        // One to three coordinates of corner a lie in faces, and the other corners beyond them.
        T* const of[3][3] = {{&p.t.a.x, &p.t.b.x, &p.t.c.x}, {&p.t.a.y, &p.t.b.y, &p.t.c.y}, {&p.t.a.z, &p.t.b.z, &p.t.c.z}};
        const T lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
        const T at[3] = {a.x, a.y, a.z};
        const int first = d.below(3), count = 1 + d.below(3);
        for (int i = 0; i < 3; ++i) {
            const int k = (first + i) % 3;
            const bool above = d.below(2) == 0;
            const double inside = d.uniform(0, 1);
            if (i < count) {
                *of[k][0] = above ? upper[k] : lower[k];
                for (int j = 1; j < 3; ++j) {
                    const T off = at[k] < 0 ? -at[k] : at[k];
                    *of[k][j] = above ? upper[k] + off : lower[k] - off;
                }
            } else {
                *of[k][0] = rounded_to<T>(std::fma(inside, static_cast<double>(upper[k]) - static_cast<double>(lower[k]),
                                                   static_cast<double>(lower[k])));
            }
        }
    } else if (kind == 2) {
        const point n = normal_of_corners(p.t), on = point_of(d, p.t, 2);
        p.s = box_from_corner<T>(d, on, n);
    } else if (kind == 3) {
        const int axis = d.below(3);
        T* const a[3] = {&p.t.a.x, &p.t.a.y, &p.t.a.z};
        T* const b[3] = {&p.t.b.x, &p.t.b.y, &p.t.b.z};
        T* const c[3] = {&p.t.c.x, &p.t.c.y, &p.t.c.z};
        *b[axis] = *a[axis];
        if (d.below(2) == 0) {
            *c[axis] = *a[axis];
        } else {
            *b[(axis + 1) % 3] = *a[(axis + 1) % 3];
        }
        const point on = point_of(d, p.t, d.below(3)), away = cube(d, 1);
        p.s = box_from_corner<T>(d, on, away);
    } else {
        // The box's edge along axis k goes through a point of the triangle's edge; both lie on different sides of d = e_k x
        // f.
        const point a = widened(p.t.a), f = between(a, widened(p.t.b)), on = point_of(d, p.t, 1);
        const int k = d.below(3);
        const point e{k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
        point side = cross_product(e, f);
        if (product(side, between(a, widened(p.t.c))) > 0) side = {-side.x, -side.y, -side.z};
        p.s = box_from_corner<T>(d, on, side);
        const T back = static_cast<T>(d.uniform(0, 1));
        T* const lower[3] = {&p.s.lower.x, &p.s.lower.y, &p.s.lower.z};
        *lower[k] = *lower[k] - back;
    }
    construction::nudge(d, p.t);
}

template <scalar T>
ABUT_HD void from_numbers(draws& d, shape_family f, const T (&v)[16], shape_triangle_pair<aabb, T>& p) {
    p = {box_of<T>({v[9], v[10], v[11]}, {v[12], v[13], v[14]}), triangle_of(v)};
    if (f != shape_family::mixed_exponents || d.below(3) != 0) return;
    // A corner in the middle of a face, in front of it or behind it by a denormal number.
    const auto denormal = [&] { return static_cast<T>(d.below(9) - 4) * least_denormal<T>; };
    p.s = {{T(-1), T(-1), T(-1)}, {denormal(), T(1), T(1)}};
    p.t = any_triangle<T>(d, 0.5);
    p.t.a.x = denormal();
    p.t.b.x = abut::detail::absolute(p.t.b.x);
    p.t.c.x = abut::detail::absolute(p.t.c.x);
}

template <scalar T>
ABUT_HD void general(draws& d, double scale, const point& offset, shape_triangle_pair<aabb, T>& p) {
    const point a = along(offset, scale, cube(d, 1)), size = cube(d, scale);
    p.s = box_of(round_to<T>(a), round_to<T>(along(a, 1, size)));
}

/// A point on the shape's surface.
template <scalar T>
ABUT_HD point surface_point(draws& d, const shape_triangle_pair<aabb, T>& p) {
    double x[3] = {d.uniform(0, 1), d.uniform(0, 1), d.uniform(0, 1)};
    for (int i = d.below(3); i >= 0; --i) {
        const int k = d.below(3);
        x[k] = d.below(2);
    }
    const point l = widened(p.s.lower), size = between(l, widened(p.s.upper));
    return {std::fma(x[0], size.x, l.x), std::fma(x[1], size.y, l.y), std::fma(x[2], size.z, l.z)};
}

/// Boxes of no extent in some directions, that contain a point of the triangle or nearly do; on a lattice, so that it is
/// exact.
template <scalar T>
ABUT_HD void without_extent(draws& d, const point& on, shape_triangle_pair<aabb, T>& p) {
    const vec3<T> q = round_to<T>(on);
    p.s = {q, q};
    T* const lower[3] = {&p.s.lower.x, &p.s.lower.y, &p.s.lower.z};
    for (T* x : lower) {
        const int by = d.below(6);
        *x = *x - static_cast<T>(by < 3 ? 0 : by);
    }
}

}  // namespace abut::test::construction
