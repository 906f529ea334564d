// SPDX-License-Identifier: MIT
#pragma once

// Capsules beside triangles: general, touching, without length or radius. For other_shapes.hpp.

#include "shape_families.hpp"

namespace abut::test::construction {

/// Within a step of tangency: 0 an end and a corner, 1 an end and an edge, 2 an end and the face, 3 the axis and a corner, 4
/// the axis and an edge.
template <scalar T>
ABUT_HD void touching(draws& d, int kind, shape_triangle_pair<capsule, T>& p) {
    p.t = any_triangle<T>(d, 1);
    const point a = widened(p.t.a), b = widened(p.t.b), c = widened(p.t.c);
    const point ab = between(a, b), ac = between(a, c), n = normal_of_corners(p.t);
    const int feature = kind == 3 ? 0 : kind == 4 ? 1 : kind;
    const point on = point_of(d, p.t, feature);
    const double side = d.below(2) == 0 ? -1 : 1, tilt = side * d.uniform(0, 2), distance = d.uniform(0.05, 1);
    const point back = along(along(point{0, 0, 0}, -1 / length(ab), ab), -1 / length(ac), ac);
    point away = feature == 0   ? unit(along(unit(back), tilt / 4, n))
                 : feature == 1 ? unit(along(unit(cross_product(ab, n)), tilt, n))
                                : point{side * n.x, side * n.y, side * n.z};
    const point x = along(on, distance, away), other = cube(d, 1);
    if (kind <= 2) {
        // The axis leads away from the triangle.
        const double ahead = product(other, away);
        p.s.axis = {round_to<T>(x), round_to<T>(along(x, ahead < 0 ? -1 : 1, other))};
        if (d.below(2) == 0) p.s.axis = {p.s.axis.b, p.s.axis.a};
    } else {
        const point across = cross_product(away, other);
        const double ahead = d.uniform(0.05, 2), behind = d.uniform(0.05, 2);
        p.s.axis = {round_to<T>(along(x, ahead, across)), round_to<T>(along(x, -behind, across))};
    }
    const point s0 = widened(p.s.axis.a), s1 = widened(p.s.axis.b), axis = between(s0, s1);
    const point end = product(between(on, s0), away) < product(between(on, s1), away) ? s0 : s1, w = between(a, end);
    double r = 0;
    if (kind == 0) r = length(w);
    if (kind == 1) r = length(cross_product(w, ab)) / length(ab);
    if (kind == 2) r = product(w, n);
    if (kind == 3) r = length(cross_product(between(a, s0), axis)) / length(axis);
    if (kind == 4) r = product(between(a, s0), unit(cross_product(axis, ab)));
    const int steps = d.below(3) - 1;
    p.s.radius = stepped(static_cast<T>(r < 0 ? -r : r), steps);
}

template <scalar T>
ABUT_HD void from_numbers(draws& d, shape_family f, const T (&v)[16], shape_triangle_pair<capsule, T>& p) {
    p = {{{{v[9], v[10], v[11]}, {v[12], v[13], v[14]}}, v[15] < 0 ? -v[15] : v[15]}, triangle_of(v)};
    const T r = p.s.radius;
    if (f == shape_family::mixed_exponents) {
        // The axis passes at height r over a triangle in the plane z = 0, or one that is lifted by little or much.
        const int kind = d.below(4);
        const T lift = any_finite<T>(d);
        p.s.axis.a.z = p.s.axis.b.z = d.below(2) == 0 ? r : -r;
        p.t.a.z = p.t.b.z = p.t.c.z = kind == 0 ? lift : T(0);
        if (kind == 1) p.t.a = {T(0), T(0), least_denormal<T>};
        if (kind == 2) p.s.axis.b = {-p.s.axis.a.x, -p.s.axis.a.y, -p.s.axis.a.z};
        if (kind == 3) p.t.b = {-p.t.a.x, -p.t.a.y, T(0)};
        return;
    }
    if (f != shape_family::all_bit_patterns && f != shape_family::largest) p.s.radius = r / 4;
    // On a lattice r / 4 is exact; a whole one makes ties.
    if (f >= shape_family::lattice_4 && f <= shape_family::denormal && d.below(2) == 0)
        p.s.radius = d.below(3) == 0 ? T(0) : r;
}

template <scalar T>
ABUT_HD void general(draws& d, double scale, const point& offset, shape_triangle_pair<capsule, T>& p) {
    p.s.axis.a = round_to<T>(along(offset, scale, cube(d, 1)));
    p.s.axis.b = round_to<T>(along(offset, scale, cube(d, 1)));
    p.s.radius = rounded_to<T>(scale * d.power_of_ten(-3, 0) / 2);
}

template <scalar T>
ABUT_HD point surface_point(draws& d, const shape_triangle_pair<capsule, T>& p) {
    const point a = widened(p.s.axis.a), axis = between(a, widened(p.s.axis.b));
    const point on = along(a, d.uniform(0, 1), axis);
    return along(on, static_cast<double>(p.s.radius), unit(cross_product(axis, cube(d, 1))));
}

/// Radius 0, or length 0, or both, on and next to the triangle.
template <scalar T>
ABUT_HD void without_extent(draws& d, const point& on, shape_triangle_pair<capsule, T>& p) {
    const vec3<T> q = round_to<T>(on);
    const auto step = [&] { return static_cast<T>(d.below(17) - 8); };
    p.s = {{q, q}, T(0)};
    const int kind = d.below(4);
    const T x = step(), y = step(), z = step();
    if (kind == 0) p.s.axis.a = {q.x + x, q.y + y, q.z + z};
    if (kind == 1) p.s.axis = {{q.x + x, q.y + y, q.z + z}, {q.x - x, q.y - y, q.z - z}};
    if (kind == 2) p.s = {{{q.x + x, q.y, q.z}, {q.x + x, q.y, q.z}}, x < 0 ? -x : x};
}

}  // namespace abut::test::construction
