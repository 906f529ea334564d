// SPDX-License-Identifier: MIT
#pragma once

// Families of pairs of a triangle with a box, a plane or a capsule, each built to break something. A pair is a pure function
// of (seed, family, index), as in families.hpp.

#include <cmath>
#include <cstdint>

#include <abut/arithmetic/absolute.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/primitive.hpp>

#include "draws.hpp"

namespace abut::test {

/// What breaks what: offsets, differences; scales, squares that under- and overflow; needles, cancellation; lattices, exact
/// ties; tenths, ties that are none; degenerate, divisions by zero; no extent (of the other shape: a flat box, a capsule of
/// radius 0 or length 0, a plane of normal 0), the same; touching, every rounding; denormal, flush-to-zero; largest,
/// overflow; mixed exponents and bit patterns, spans; any scale, the filter's range checks.
enum class shape_family : int {
    random,
    offset_1e3,
    offset_1e6,
    scaled_1e_minus_30,
    scaled_1e_minus_13,
    scaled_1e13,
    scaled_1e30,
    small_triangle,
    large_triangle,
    needle_1e3,
    needle_1e6,
    needle_1e9,
    degenerate,
    no_extent,
    touching_0,
    touching_1,
    touching_2,
    touching_3,
    touching_4,
    lattice_4,
    lattice_16,
    lattice_256,
    tenths_4,
    tenths_16,
    tenths_256,
    denormal,
    largest,
    mixed_exponents,
    any_scale,
    all_bit_patterns,
};

inline constexpr int shape_family_count = 30;

template <template <class> class Shape, class T>
struct shape_triangle_pair {
    Shape<T> s;
    triangle<T> t;
};

namespace construction {

template <scalar T>
ABUT_HD vec3<T> rounded_cube(draws& d, double half) {
    return round_to<T>(cube(d, half));
}

template <scalar T>
ABUT_HD triangle<T> any_triangle(draws& d, double half) {
    const vec3<T> a = rounded_cube<T>(d, half), b = rounded_cube<T>(d, half), c = rounded_cube<T>(d, half);
    return {a, b, c};
}

ABUT_HD inline point between(const point& a, const point& b) { return along(b, -1, a); }

/// One of the triangle's coordinates moves by one step at most. Zeros stay.
template <scalar T>
ABUT_HD void nudge(draws& d, triangle<T>& t) {
    vec3<T>* const corner[3] = {&t.a, &t.b, &t.c};
    vec3<T>& p = *corner[d.below(3)];
    T* const coordinate[3] = {&p.x, &p.y, &p.z};
    T& x = *coordinate[d.below(3)];
    const int steps = d.below(3) - 1;
    if (x != 0) x = stepped(x, steps);
}

/// A triangle that may be a segment or a point, and any of whose corners may be in the middle.
template <scalar T>
ABUT_HD void collapse(draws& d, triangle<T>& t) {
    const int kind = d.below(5);
    if (kind == 0) t.b = t.c = t.a;
    if (kind == 1) t.b = t.a;
    if (kind == 2) t.c = t.a;
    if (kind == 3) t.c = t.b;
    if (kind == 4) {
        t.c = (t.b - t.a) + t.b;
        if (d.below(2) == 0) t = {t.b, t.a, t.c};
    }
}

template <scalar T>
ABUT_HD triangle<T> needle(draws& d, double aspect) {
    const point a = cube(d, 1), along_it = unit(cube(d, 1)), across = unit(cross_product(along_it, cube(d, 1)));
    const double at = d.uniform(0, 1);
    return {round_to<T>(a), round_to<T>(along(a, 1, along_it)),
            round_to<T>(along(along(a, at, along_it), 1 / aspect, across))};
}

/// A point of the triangle: near a corner (0), on an edge (1), in the face (2).
template <scalar T>
ABUT_HD point point_of(draws& d, const triangle<T>& t, int feature) {
    const point a = widened(t.a), ab = between(a, widened(t.b)), ac = between(a, widened(t.c));
    if (feature == 0) return a;
    const double u = d.uniform(0.05, 0.9);
    if (feature == 1) return along(a, u, ab);
    const double v = d.uniform(0.05, 0.95) * (1 - u);
    return along(along(a, u, ab), v, ac);
}

template <scalar T>
ABUT_HD point normal_of_corners(const triangle<T>& t) {
    const point a = widened(t.a);
    return unit(cross_product(between(a, widened(t.b)), between(a, widened(t.c))));
}

/// n numbers for the kinds of input that are the same for every shape.
template <scalar T, int V>
ABUT_HD void draw_numbers(draws& d, shape_family f, T (&v)[V]) {
    const bool coarse = d.below(2) == 0;
    for (T& x : v) {
        const auto on_lattice = [&](int size, T unit_length) { return static_cast<T>(d.below(size + 1)) * unit_length; };
        switch (f) {
            case shape_family::lattice_4:
                x = on_lattice(4, T(1));
                break;
            case shape_family::lattice_16:
                x = on_lattice(16, T(1));
                break;
            case shape_family::lattice_256:
                x = on_lattice(256, T(1));
                break;
            case shape_family::tenths_4:
                x = on_lattice(4, T(0.1));
                break;
            case shape_family::tenths_16:
                x = on_lattice(16, T(0.1));
                break;
            case shape_family::tenths_256:
                x = on_lattice(256, T(0.1));
                break;
            case shape_family::denormal:
                x = on_lattice(coarse ? 12 : 4096, least_denormal<T>);
                if (d.below(8) == 0) x = -x;  // signed zeros among them
                break;
            case shape_family::largest:
                x = d.below(3) == 0 ? largest_number<T>
                                    : static_cast<T>(largest_number<T> * static_cast<T>(d.uniform(0.25, 1)));
                if (d.below(2) == 0) x = -x;
                break;
            default:
                x = any_finite<T>(d);
        }
    }
}

/// Numbers of any size, many of them equal or 0, so that there are ties.
template <scalar T, int V>
ABUT_HD void draw_mixed(draws& d, T (&v)[V]) {
    for (int i = 0; i < V; ++i) {
        const int kind = d.below(6);
        v[i] = kind == 0 ? T(0) : kind <= 2 && i >= 3 ? v[i % 3 + 3 * d.below(i / 3)] : any_finite<T>(d);
        if (kind == 2 && d.below(2) == 0 && v[i] != 0) v[i] = -v[i];
    }
}

template <scalar T>
ABUT_HD triangle<T> triangle_of(const T* v) {
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
}

template <scalar T>
ABUT_HD aabb<T> box_of(const vec3<T>& p, const vec3<T>& q) {
    return {abut::detail::lesser(p, q), abut::detail::greater(p, q)};
}

ABUT_HD inline double scale_of(shape_family f) {
    return f == shape_family::scaled_1e_minus_30   ? 1e-30
           : f == shape_family::scaled_1e_minus_13 ? 1e-13
           : f == shape_family::scaled_1e13        ? 1e13
           : f == shape_family::scaled_1e30        ? 1e30
                                                   : 1;
}

ABUT_HD inline double offset_of(shape_family f) {
    return f == shape_family::offset_1e3 ? 1e3 : f == shape_family::offset_1e6 ? 1e6 : 0;
}

/// A power of two of nearly the whole range; its products with what `touching` makes are finite.
template <scalar T>
ABUT_HD T any_power_of_two(draws& d) {
    constexpr int low = sizeof(T) == 4 ? -125 : -1020, high = sizeof(T) == 4 ? 110 : 1005,
                  fraction = sizeof(T) == 4 ? 23 : 52;
    const int k = d.below(high - low) + low;
    return sizeof(T) == 4 ? static_cast<T>(from_bits(static_cast<std::uint32_t>(127 + k) << fraction % 32))
                          : static_cast<T>(from_bits(static_cast<std::uint64_t>(1023 + k) << fraction));
}

template <scalar T>
ABUT_HD triangle<T> scaled(T by, const triangle<T>& t) {
    return {by * t.a, by * t.b, by * t.c};
}
template <scalar T>
ABUT_HD aabb<T> scaled(T by, const aabb<T>& box) {
    return {by * box.lower, by * box.upper};
}
template <scalar T>
ABUT_HD capsule<T> scaled(T by, const capsule<T>& s) {
    return {{by * s.axis.a, by * s.axis.b}, by * s.radius};
}
template <scalar T>
ABUT_HD plane<T> scaled(T by, const plane<T>& p) {
    return {p.normal, by * p.offset};
}

// --- boxes ---------------------------------------------------------------------------------------------------------------

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
    nudge(d, p.t);
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

// --- planes --------------------------------------------------------------------------------------------------------------

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
    const vec3<T>& n = p.s.normal;
    if (kind != 0) p.s.offset = n.x * v[13] + (n.y * v[14] + n.z * v[15]);
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

// --- capsules ------------------------------------------------------------------------------------------------------------

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

// -------------------------------------------------------------------------------------------------------------------------

/// The triangles of `without_extent`: corners on a lattice of step 4, weights of quarters, so that the point is exact.
template <scalar T>
ABUT_HD point lattice_point_of(draws& d, triangle<T>& t) {
    double x[3][3];
    vec3<T>* const points[3] = {&t.a, &t.b, &t.c};
    for (int i = 0; i < 3; ++i) {
        for (double& e : x[i]) e = 4 * (d.below(65) - 32);
        *points[i] = round_to<T>({x[i][0], x[i][1], x[i][2]});
    }
    const int u = d.below(5), v = d.below(5 - u);
    double c[3];
    for (int k = 0; k < 3; ++k) c[k] = (u * x[0][k] + v * x[1][k] + (4 - u - v) * x[2][k]) / 4;
    return {c[0], c[1], c[2]};
}

}  // namespace construction

/// Pair number `index` of a family, of a triangle and a `Shape`: aabb, plane or capsule.
template <template <class> class Shape, scalar T>
ABUT_HD shape_triangle_pair<Shape, T> make_shape_pair(std::uint64_t seed, shape_family f, std::uint64_t index) {
    namespace make = construction;
    using make::point;
    draws d(seed, 100 + static_cast<std::uint64_t>(f), index);
    shape_triangle_pair<Shape, T> p{};
    switch (f) {
        case shape_family::small_triangle:
        case shape_family::large_triangle: {
            // `at` is the middle of the triangle's face, at a distance of up to three sizes or shapes from the shape's
            // surface.
            const double size = f == shape_family::small_triangle ? d.power_of_ten(-6, -1) : d.power_of_ten(1, 6);
            make::general(d, 1, {0, 0, 0}, p);
            const point near_by = make::surface_point(d, p), aside = make::cube(d, 0.5);
            const point at = make::along(near_by, 3 * (size < 1 ? size : 1), aside);
            const point u = make::cube(d, 1), v = make::cube(d, 1);
            p.t = {make::round_to<T>(make::along(at, size, u)), make::round_to<T>(make::along(at, size, v)),
                   make::round_to<T>(make::along(make::along(at, -size, u), -size, v))};
            break;
        }
        case shape_family::needle_1e3:
        case shape_family::needle_1e6:
        case shape_family::needle_1e9:
            p.t = make::needle<T>(d, f == shape_family::needle_1e3 ? 1e3 : f == shape_family::needle_1e6 ? 1e6 : 1e9);
            make::general(d, 0.5,
                          make::along(make::widened(p.t.a), 0.5, make::between(make::widened(p.t.a), make::widened(p.t.b))),
                          p);
            break;
        case shape_family::degenerate:
            if (d.below(2) == 0) {
                T v[16];
                make::draw_numbers(d, shape_family::lattice_16, v);
                make::from_numbers(d, shape_family::lattice_16, v, p);
            } else {
                make::touching(d, d.below(5), p);
            }
            make::collapse(d, p.t);
            break;
        case shape_family::no_extent: {
            const point on = make::lattice_point_of(d, p.t);
            make::without_extent(d, on, p);
            if (d.below(3) == 0) make::nudge(d, p.t);
            if (d.below(4) == 0) make::collapse(d, p.t);
            break;
        }
        case shape_family::touching_0:
        case shape_family::touching_1:
        case shape_family::touching_2:
        case shape_family::touching_3:
        case shape_family::touching_4:
            make::touching(d, static_cast<int>(f) - static_cast<int>(shape_family::touching_0), p);
            break;
        case shape_family::any_scale: {
            make::touching(d, d.below(5), p);
            const T by = make::any_power_of_two<T>(d);
            p = {make::scaled(by, p.s), make::scaled(by, p.t)};
            break;
        }
        case shape_family::lattice_4:
        case shape_family::lattice_16:
        case shape_family::lattice_256:
        case shape_family::tenths_4:
        case shape_family::tenths_16:
        case shape_family::tenths_256:
        case shape_family::denormal:
        case shape_family::largest:
        case shape_family::all_bit_patterns: {
            T v[16];
            make::draw_numbers(d, f, v);
            make::from_numbers(d, f, v, p);
            break;
        }
        case shape_family::mixed_exponents: {
            T v[16];
            make::draw_mixed(d, v);
            make::from_numbers(d, f, v, p);
            break;
        }
        default: {
            const double scale = make::scale_of(f), far = make::offset_of(f);
            const point offset{far, -far, far / 2};
            const auto corner = [&] { return make::round_to<T>(make::along(offset, scale, make::cube(d, 1))); };
            p.t.a = corner();
            p.t.b = corner();
            p.t.c = corner();
            make::general(d, scale, offset, p);
        }
    }
    return p;
}

}  // namespace abut::test
