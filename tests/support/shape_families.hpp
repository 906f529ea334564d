// SPDX-License-Identifier: MIT
#pragma once

// The families of pairs of a triangle with a box, a plane or a capsule, and what their constructions share. The shapes have
// their own: box_pairs.hpp, plane_pairs.hpp, capsule_pairs.hpp; other_shapes.hpp puts a pair together.

#include <cmath>
#include <concepts>
#include <cstdint>

#include <abut/shape/bounds.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

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

inline const char* name_of(shape_family f) {
    constexpr const char* names[shape_family_count] = {
        "random",          "offset 1e3",     "offset 1e6",     "scaled 1e-30",    "scaled 1e-13",  "scaled 1e13",
        "scaled 1e30",     "small triangle", "large triangle", "needle 1e3",      "needle 1e6",    "needle 1e9",
        "degenerate",      "no extent",      "touching 0",     "touching 1",      "touching 2",    "touching 3",
        "touching 4",      "lattice 4",      "lattice 16",     "lattice 256",     "0.1 lattice 4", "0.1 lattice 16",
        "0.1 lattice 256", "denormal",       "largest",        "mixed exponents", "any scale",     "all bit patterns"};
    return names[static_cast<int>(f)];
}

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
    return {abut::detail::least(p, q), abut::detail::greatest(p, q)};
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
ABUT_HD vec3<T> scaled(T by, const vec3<T>& p) {
    return by * p;
}
template <scalar T>
ABUT_HD segment<T> scaled(T by, const segment<T>& s) {
    return {by * s.a, by * s.b};
}
template <scalar T>
ABUT_HD sphere<T> scaled(T by, const sphere<T>& s) {
    return {by * s.center, by * s.radius};
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

/// Where two shapes touch, a normal, and two vectors across it.
struct contact_frame {
    point at, normal, u, v;
    double length = 1;      ///< of the normal
    double unit = 1;        ///< of extents of boxes; a plane's normal is that many times shorter
    point gap = {0, 0, 0};  ///< added to each point in the end
};

/// On a lattice, with a normal of whole length.
ABUT_HD inline contact_frame any_contact_frame(draws& d, int shift) {
    constexpr double frames[][9] = {{0, 0, 1, 1, 0, 0, 0, 1, 0},   {1, 2, 2, 2, -1, 0, 0, 1, -1},
                                    {2, 3, 6, 3, -2, 0, 0, 2, -1}, {0, 3, 4, 1, 0, 0, 0, 4, -3},
                                    {6, 6, 7, 1, -1, 0, 0, 7, -6}, {1, 4, 8, 4, -1, 0, 0, 2, -1}};
    constexpr double lengths[] = {1, 3, 7, 5, 11, 9};
    const int which = d.below(6), turn = d.below(3), sign = d.below(2) == 0 ? -1 : 1;
    const auto turned = [turn](const double* w) { return point{w[turn], w[(turn + 1) % 3], w[(turn + 2) % 3]}; };
    const int x = d.below(9) - 4 + shift, y = d.below(9) - 4 - shift, z = d.below(9) - 4;
    const point at{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}, n = turned(frames[which]);
    return {at, along({0, 0, 0}, sign, n), turned(frames[which] + 3), turned(frames[which] + 6), lengths[which]};
}

/// A shape that touches the frame's point, on the side of its normal, or on the other one; where it is round, its centre
/// or axis is `up` normals away.
template <class S>
ABUT_HD S touching_from(draws& d, const contact_frame& f, int side, int up) {
    using T = scalar_type_of<S>;
    const auto moved_by = [&](int along_n, int along_u, int along_v) {
        const point p = along(along(along(f.at, side * along_n, f.normal), along_u, f.u), along_v, f.v);
        return round_to<T>(along(p, 1, f.gap));
    };
    const int i = d.below(5) - 2, j = d.below(5) - 2, back = d.below(4), away = d.below(3);
    // A segment through a point above, across the normal, or away from it.
    const auto axis_at = [&](int height) {
        return away == 0 ? segment<T>{moved_by(height, 0, 0), moved_by(height + 1 + back, i, j)}
                         : segment<T>{moved_by(height, i, j), moved_by(height, -back * i, -back * j)};
    };
    if constexpr (std::same_as<S, vec3<T>>) {
        return moved_by(0, 0, 0);
    } else if constexpr (std::same_as<S, segment<T>>) {
        return axis_at(0);
    } else if constexpr (std::same_as<S, triangle<T>>) {
        const segment<T> axis = axis_at(0);
        return {axis.a, axis.b, moved_by(away, j, back)};
    } else if constexpr (std::same_as<S, sphere<T>>) {
        return {moved_by(up, 0, 0), rounded_to<T>(up * f.length)};
    } else if constexpr (std::same_as<S, capsule<T>>) {
        return {axis_at(up), rounded_to<T>(up * f.length)};
    } else if constexpr (std::same_as<S, plane<T>>) {
        const point n{f.normal.x / f.unit, f.normal.y / f.unit, f.normal.z / f.unit};
        return {round_to<T>(n), rounded_to<T>(product(n, f.at))};
    } else {
        S box;
        const auto set = [&](double at, double n, T& lower, T& upper) {
            const double before = d.below(5), behind = d.below(5);
            lower = rounded_to<T>(side * n > 0 ? at : std::fma(-before, f.unit, at));
            upper = rounded_to<T>(side * n < 0 ? at : std::fma(behind, f.unit, at));
        };
        set(f.at.x, f.normal.x, box.lower.x, box.upper.x);
        set(f.at.y, f.normal.y, box.lower.y, box.upper.y);
        set(f.at.z, f.normal.z, box.lower.z, box.upper.z);
        return box;
    }
}

}  // namespace construction

}  // namespace abut::test
