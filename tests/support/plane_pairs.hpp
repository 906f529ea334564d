// SPDX-License-Identifier: MIT
#pragma once

// Planes beside triangles: general, touching, without a normal. For other_shapes.hpp.

#include "shape_families.hpp"

namespace abut::test::construction {

template <scalar T>
ABUT_HD T height_at(const vec3<T>& normal, const point& x) {
    return rounded_to<T>(product(widened(normal), x));
}

/// A plane near a corner (0), an edge (1), the face (2); 3: along axes, where heights are exact; 4: near a corner, and far
/// from the origin.
template <scalar T>
ABUT_HD void touching(draws& d, int kind, shape_triangle_pair<plane, T>& p) {
    p.t = any_triangle<T>(d, 1);
    if (kind == 4) {
        const vec3<T> far = rounded_cube<T>(d, 1e4);
        p.t = {p.t.a + far, p.t.b + far, p.t.c + far};
    }
    const point a = widened(p.t.a), b = widened(p.t.b), c = widened(p.t.c), n = normal_of_corners(p.t);
    if (kind == 3) {
        const int axis = d.below(3), corner = d.below(3);
        p.s.normal = {axis == 0 ? T(1) : T(0), axis == 1 ? T(-1) : T(0), axis == 2 ? T(0.5) : T(0)};
        p.s.offset = height_at(p.s.normal, corner == 0 ? a : corner == 1 ? b : c);
    } else {
        const point tilt = cube(d, 0.3);
        const point across = kind == 0 || kind == 4 ? unit(along(between(a, b), 1, between(a, c)))
                             : kind == 1            ? unit(cross_product(between(a, b), along(n, 1, tilt)))
                                                    : n;
        p.s.normal = round_to<T>(across);
        p.s.offset = height_at(p.s.normal, a);
    }
    const int steps = d.below(3) - 1;
    if (p.s.offset != 0) p.s.offset = stepped(p.s.offset, steps);
}

template <scalar T>
ABUT_HD void from_numbers(draws& d, shape_family f, const T (&v)[16], shape_triangle_pair<plane, T>& p) {
    p = {{{v[9], v[10], v[11]}, v[12]}, triangle_of(v)};
    const int kind = d.below(4);
    if (f == shape_family::mixed_exponents) {
        // n . x is exact: the normal is along an axis, and a power of two.
        const T length = any_power_of_two<T>(d);
        if (kind == 0) p.s = {{length, T(0), T(0)}, p.t.a.x * length};
        if (kind == 1) p.s = {{T(0), -length, T(0)}, p.t.b.y * -length};
        if (kind == 2) p.s = {{p.s.normal.x, T(0), T(0)}, T(0)};
        if (!(p.s.offset - p.s.offset == 0)) p.s.offset = largest_number<T>;
        return;
    }
    if (f == shape_family::all_bit_patterns || f == shape_family::largest) return;
    // Through, or near, the middle of the numbers.
    if (kind != 0) p.s.offset = height_at(p.s.normal, widened(vec3<T>{v[13], v[14], v[15]}));
    if (kind == 3) p.s.normal.x = -p.s.normal.x;
}

template <scalar T>
ABUT_HD void general(draws& d, double scale, const point& offset, shape_triangle_pair<plane, T>& p) {
    const point on = along(offset, scale, cube(d, 0.8));
    p.s.normal = rounded_cube<T>(d, 1);
    p.s.offset = height_at(p.s.normal, on);
}

template <scalar T>
ABUT_HD point surface_point(draws& d, const shape_triangle_pair<plane, T>& p) {
    const point n = widened(p.s.normal), x = cube(d, 1);
    return along(x, (static_cast<double>(p.s.offset) - product(n, x)) / product(n, n), n);
}

template <scalar T>
ABUT_HD void without_extent(draws& d, const point& on, shape_triangle_pair<plane, T>& p) {
    p.s = {{T(0), T(0), T(0)}, d.below(2) == 0 ? T(0) : any_finite<T>(d)};
    if (d.below(2) == 0) p.s = {round_to<T>(on), T(0)};
}

}  // namespace abut::test::construction
