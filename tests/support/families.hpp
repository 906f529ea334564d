// SPDX-License-Identifier: MIT
#pragma once

// Families of sphere-triangle pairs, each built to break something (docs/results/wrong-answers.md says what). A pair is a
// pure function of (seed, family, index), on hosts and devices alike and bit for bit; draws.hpp says how.

#include <cstdint>

#include <abut/config.hpp>
#include <abut/shape/primitive.hpp>

#include "draws.hpp"

namespace abut::test {

enum class family : int {
    random,
    offset_1e3,
    offset_1e6,
    scaled_1e_minus_30,
    scaled_1e_minus_13,
    scaled_1e_minus_4,
    scaled_1e6,
    scaled_1e13,
    scaled_1e30,
    tangent_vertex,
    tangent_edge,
    tangent_face,
    needle_1e3,
    needle_1e6,
    needle_1e9,
    needle_1e12,
    radius_zero,
    radius_tiny,
    lattice_4,
    lattice_16,
    lattice_256,
    tenths_4,
    tenths_16,
    tenths_256,
    degenerate,
    denormal,
    largest,
    mixed_exponents,
    any_scale,
    all_bit_patterns,
};

inline constexpr int family_count = 30;

/// On the host only.
inline const char* name_of(family f) {
    constexpr const char* names[family_count] = {
        "random",     "offset 1e3",  "offset 1e6",  "scaled 1e-30",    "scaled 1e-13",   "scaled 1e-4",
        "scaled 1e6", "scaled 1e13", "scaled 1e30", "tangent vertex",  "tangent edge",   "tangent face",
        "needle 1e3", "needle 1e6",  "needle 1e9",  "needle 1e12",     "radius 0",       "radius tiny",
        "lattice 4",  "lattice 16",  "lattice 256", "0.1 lattice 4",   "0.1 lattice 16", "0.1 lattice 256",
        "degenerate", "denormal",    "largest",     "mixed exponents", "any scale",      "all bit patterns"};
    return names[static_cast<int>(f)];
}

template <scalar T>
struct sphere_triangle_pair {
    sphere<T> s;
    triangle<T> t;
};

namespace construction {

template <scalar T>
using pair = sphere_triangle_pair<T>;

template <scalar T>
ABUT_HD pair<T> random_pair(draws& d, double scale, double offset) {
    const point o{offset, -offset, offset / 2};
    pair<T> p;
    vec3<T>* const points[4] = {&p.t.a, &p.t.b, &p.t.c, &p.s.center};
    for (vec3<T>* v : points) {
        const point x = cube(d, 1);
        *v = round_to<T>(along(point{o.x * scale, o.y * scale, o.z * scale}, scale, x));
    }
    p.s.radius = static_cast<T>(d.uniform(0, 1) * scale);
    return p;
}

/// A sphere around a point off a random feature (0: vertex, 1: edge, 2: face), with the radius nearest to its distance from
/// that feature of the rounded triangle, or one step to either side.
template <scalar T>
ABUT_HD pair<T> tangent_pair(draws& d, int feature) {
    pair<T> p;
    p.t = {round_to<T>(cube(d, 1)), round_to<T>(cube(d, 1)), round_to<T>(cube(d, 1))};
    const point a = widened(p.t.a), b = widened(p.t.b), c = widened(p.t.c);
    const point ab = along(b, -1, a), ac = along(c, -1, a), n = unit(cross_product(ab, ac));
    const double distance = d.uniform(0.05, 1), side = d.below(2) == 0 ? -1 : 1;
    double r = 0;
    if (feature == 0) {
        const point away = along(along(point{0, 0, 0}, -1 / length(ab), ab), -1 / length(ac), ac);
        p.s.center = round_to<T>(along(a, distance, unit(along(unit(away), side * d.uniform(0, 0.5), n))));
        r = length(along(widened(p.s.center), -1, a));
    } else if (feature == 1) {
        const point out = unit(cross_product(ab, n)), foot = along(a, d.uniform(0.1, 0.9), ab);
        p.s.center = round_to<T>(along(foot, distance, unit(along(out, side * d.uniform(0, 3), n))));
        r = length(cross_product(along(widened(p.s.center), -1, a), ab)) / length(ab);
    } else {
        const double u = d.uniform(0.05, 0.9), v = d.uniform(0.05, 0.95) * (1 - u);
        p.s.center = round_to<T>(along(along(along(a, u, ab), v, ac), side * distance, n));
        const double height = product(along(widened(p.s.center), -1, a), n);
        r = height < 0 ? -height : height;
    }
    p.s.radius = stepped(static_cast<T>(r), d.below(3) - 1);
    return p;
}

/// Length 1, width 1 / aspect; the sphere's surface passes the line at a relative distance of 1e-1 to 1e-7.
template <scalar T>
ABUT_HD pair<T> needle_pair(draws& d, double aspect) {
    pair<T> p;
    const point a = cube(d, 1), along_it = unit(cube(d, 1)), across = unit(cross_product(along_it, cube(d, 1)));
    p.t = {round_to<T>(a), round_to<T>(along(a, 1, along_it)),
           round_to<T>(along(along(a, d.uniform(0, 1), along_it), 1 / aspect, across))};
    const point x = widened(p.t.a), edge = along(widened(p.t.b), -1, x), foot = along(x, d.uniform(0, 1), edge);
    const double distance = d.power_of_ten(-4, 0);
    p.s.center = round_to<T>(along(foot, distance, unit(cross_product(edge, cube(d, 1)))));
    const double r = length(cross_product(along(widened(p.s.center), -1, x), edge)) / length(edge);
    const double side = d.below(2) == 0 ? -1 : 1;  // a statement of its own: draws come in order, arguments need not
    p.s.radius = static_cast<T>(r * std::fma(side, d.power_of_ten(-7, -1), 1.0));
    return p;
}

/// Points on and next to triangles: corners on a lattice of step 4, weights of quarters, so that the point is exact.
template <scalar T>
ABUT_HD pair<T> point_pair(draws& d) {
    pair<T> p;
    double x[3][3];
    vec3<T>* const points[3] = {&p.t.a, &p.t.b, &p.t.c};
    for (int i = 0; i < 3; ++i) {
        for (double& e : x[i]) e = 4 * (d.below(65) - 32);
        *points[i] = round_to<T>({x[i][0], x[i][1], x[i][2]});
    }
    const int u = d.below(5), v = d.below(5 - u);
    double c[3];
    for (int k = 0; k < 3; ++k)
        c[k] = (u * x[0][k] + v * x[1][k] + (4 - u - v) * x[2][k]) / 4;  // integers below 2^10: exact
    p.s = {round_to<T>({c[0], c[1], c[2]}), T(0)};
    T* const coordinate[3] = {&p.s.center.x, &p.s.center.y, &p.s.center.z};
    T& moved = *coordinate[d.below(3)];
    if (d.below(2) == 0 && moved != 0) moved = stepped(moved, d.below(3) - 1);
    return p;
}

template <scalar T>
ABUT_HD pair<T> tiny_radius_pair(draws& d) {
    pair<T> p;
    p.t = {round_to<T>(cube(d, 1)), round_to<T>(cube(d, 1)), round_to<T>(cube(d, 1))};
    const point a = widened(p.t.a), ab = along(widened(p.t.b), -1, a), ac = along(widened(p.t.c), -1, a);
    const double u = d.uniform(0, 1), v = d.uniform(0, 1) * (1 - u), r = d.power_of_ten(sizeof(T) == 4 ? -8 : -16, -5);
    const point off = unit(cross_product(ab, ac));
    p.s = {round_to<T>(along(along(along(a, u, ab), v, ac), r * d.uniform(-2, 2), off)), static_cast<T>(r)};
    return p;
}

template <scalar T>
ABUT_HD pair<T> lattice_pair(draws& d, int size, bool degenerate, T unit_length) {
    T v[12];
    for (T& x : v) x = static_cast<T>(d.below(size + 1)) * unit_length;
    if (degenerate) {
        // A point, a segment with a repeated corner, or three points in a line with any of them in the middle.
        const int kind = d.below(5);
        for (int k = 0; k < 3; ++k) {
            if (kind == 0) v[3 + k] = v[6 + k] = v[k];
            if (kind == 1) v[3 + k] = v[k];
            if (kind == 2) v[6 + k] = v[k];
            if (kind == 3) v[6 + k] = v[3 + k];
            if (kind == 4) v[6 + k] = 2 * v[3 + k] - v[k];
        }
        if (kind == 4 && d.below(2) == 0) {
            for (int k = 0; k < 3; ++k) {
                const T x = v[k];
                v[k] = v[3 + k];
                v[3 + k] = x;
            }
        }
    }
    const T r = static_cast<T>(d.below(size / 2 + 2)) * unit_length;
    return {{{v[9], v[10], v[11]}, r}, {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}}};
}

/// Half general, half within a step of tangency (in double: some steps).
template <scalar T>
ABUT_HD pair<T> degenerate_pair(draws& d) {
    if (d.below(2) == 0) return lattice_pair<T>(d, 16, true, T(1));
    pair<T> p = tangent_pair<T>(d, d.below(2));
    const point a = widened(p.t.a), c = widened(p.s.center);
    if (d.below(2) == 0) {
        p.t.c = d.below(2) == 0 ? p.t.a : p.t.b;  // the segment a b, to which the sphere may be tangent
    } else {
        p.t.b = p.t.c = p.t.a;
        p.s.radius = stepped(static_cast<T>(length(along(c, -1, a))), d.below(3) - 1);
    }
    return p;
}

template <scalar T>
ABUT_HD pair<T> denormal_pair(draws& d) {
    const int size = d.below(2) == 0 ? 12 : 4096;
    pair<T> p = lattice_pair<T>(d, size, false, least_denormal<T>);
    T* const coordinate[3] = {&p.t.a.x, &p.t.b.y, &p.s.center.z};
    for (T* x : coordinate) *x = d.below(2) == 0 ? -*x : *x;  // signed zeros among them
    return p;
}

template <scalar T>
ABUT_HD pair<T> largest_pair(draws& d) {
    T v[13];
    for (T& x : v) {
        x = d.below(3) == 0 ? largest_number<T> : static_cast<T>(largest_number<T> * static_cast<T>(d.uniform(0.25, 1)));
        if (d.below(2) == 0) x = -x;
    }
    const T r = v[12] < 0 ? -v[12] : v[12];
    return {{{v[9], v[10], v[11]}, r}, {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}}};
}

/// A huge ball that touches the plane z = 0 at the origin, and a triangle whose exponents are spread over all that there
/// are: half of the time the plane's z decides, half of the time a corner is lifted by little.
template <scalar T>
ABUT_HD pair<T> mixed_pair(draws& d) {
    pair<T> p;
    vec3<T>* const points[3] = {&p.t.a, &p.t.b, &p.t.c};
    for (vec3<T>* v : points) *v = {any_finite<T>(d), any_finite<T>(d), T(0)};
    const T r = d.below(4) == 0 ? largest_number<T> : any_finite<T>(d);
    p.s.radius = r < 0 ? -r : r;
    p.s.center = {T(0), T(0), d.below(2) == 0 ? p.s.radius : -p.s.radius};
    const int kind = d.below(4);
    if (kind == 1) p.t.a = {T(0), T(0), T(0)};
    if (kind == 2) p.t = {{T(0), T(0), least_denormal<T>}, p.t.b, p.t.c};
    if (kind == 3) {
        const T lift = any_finite<T>(d);
        for (vec3<T>* v : points) v->z = lift;
        if (d.below(2) == 0) p.t.b = {-p.t.a.x, -p.t.a.y, lift};  // so that the axis meets the edge a b
    }
    return p;
}

/// Tangent within a step, times a power of two of the whole range; where that underflows, coordinates and radius are
/// rounded.
template <scalar T>
ABUT_HD pair<T> any_scale_pair(draws& d) {
    pair<T> p = tangent_pair<T>(d, d.below(3));
    constexpr int reach = sizeof(T) == 4 ? 125 : 1020, fraction = sizeof(T) == 4 ? 23 : 52;
    const int k = d.below(2 * reach) - reach;
    const T scale = sizeof(T) == 4 ? static_cast<T>(from_bits(static_cast<std::uint32_t>(127 + k) << fraction % 32))
                                   : static_cast<T>(from_bits(static_cast<std::uint64_t>(1023 + k) << fraction));
    vec3<T>* const points[4] = {&p.t.a, &p.t.b, &p.t.c, &p.s.center};
    for (vec3<T>* v : points) *v = scale * *v;
    p.s.radius = scale * p.s.radius;
    return p;
}

template <scalar T>
ABUT_HD pair<T> any_pair(draws& d) {
    T v[13];
    for (T& x : v) x = any_finite<T>(d);
    const T r = v[12] < 0 ? -v[12] : v[12];
    return {{{v[9], v[10], v[11]}, r}, {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}}};
}

}  // namespace construction

/// Pair number `index` of a family.
template <scalar T>
ABUT_HD sphere_triangle_pair<T> make_pair(std::uint64_t seed_value, family f, std::uint64_t index) {
    namespace make = construction;
    draws d(seed_value, static_cast<std::uint64_t>(f), index);
    switch (f) {
        case family::random:
            return make::random_pair<T>(d, 1, 0);
        case family::offset_1e3:
            return make::random_pair<T>(d, 1, 1e3);
        case family::offset_1e6:
            return make::random_pair<T>(d, 1, 1e6);
        case family::scaled_1e_minus_30:
            return make::random_pair<T>(d, 1e-30, 0);
        case family::scaled_1e_minus_13:
            return make::random_pair<T>(d, 1e-13, 0);
        case family::scaled_1e_minus_4:
            return make::random_pair<T>(d, 1e-4, 0);
        case family::scaled_1e6:
            return make::random_pair<T>(d, 1e6, 0);
        case family::scaled_1e13:
            return make::random_pair<T>(d, 1e13, 0);
        case family::scaled_1e30:
            return make::random_pair<T>(d, 1e30, 0);
        case family::tangent_vertex:
            return make::tangent_pair<T>(d, 0);
        case family::tangent_edge:
            return make::tangent_pair<T>(d, 1);
        case family::tangent_face:
            return make::tangent_pair<T>(d, 2);
        case family::needle_1e3:
            return make::needle_pair<T>(d, 1e3);
        case family::needle_1e6:
            return make::needle_pair<T>(d, 1e6);
        case family::needle_1e9:
            return make::needle_pair<T>(d, 1e9);
        case family::needle_1e12:
            return make::needle_pair<T>(d, 1e12);
        case family::radius_zero:
            return make::point_pair<T>(d);
        case family::radius_tiny:
            return make::tiny_radius_pair<T>(d);
        case family::lattice_4:
            return make::lattice_pair<T>(d, 4, false, T(1));
        case family::lattice_16:
            return make::lattice_pair<T>(d, 16, false, T(1));
        case family::lattice_256:
            return make::lattice_pair<T>(d, 256, false, T(1));
        case family::tenths_4:
            return make::lattice_pair<T>(d, 4, false, T(0.1));
        case family::tenths_16:
            return make::lattice_pair<T>(d, 16, false, T(0.1));
        case family::tenths_256:
            return make::lattice_pair<T>(d, 256, false, T(0.1));
        case family::degenerate:
            return make::degenerate_pair<T>(d);
        case family::denormal:
            return make::denormal_pair<T>(d);
        case family::largest:
            return make::largest_pair<T>(d);
        case family::mixed_exponents:
            return make::mixed_pair<T>(d);
        case family::any_scale:
            return make::any_scale_pair<T>(d);
        case family::all_bit_patterns:
            return make::any_pair<T>(d);
    }
    return {};
}

// --- other shapes, of a pair and its index ----------------------------------------------------------------------------

namespace construction {

/// The point of a ball farthest along x, rounded: within a step of its surface. Its centre where that overflows.
template <scalar T>
ABUT_HD vec3<T> end_along_x(const sphere<T>& s) {
    const volatile T x = s.center.x + s.radius;
    return x - x == 0 ? vec3<T>{x, s.center.y, s.center.z} : s.center;
}

}  // namespace construction

/// An edge of the triangle; of some, one end is within a step of the ball's surface.
template <scalar T>
ABUT_HD segment<T> segment_beside_ball(const sphere_triangle_pair<T>& p, std::uint64_t k) {
    return {k % 4 == 0 ? construction::end_along_x(p.s) : p.t.a, p.t.b};
}

template <scalar T>
struct ball_pair {
    sphere<T> s, o;
};
/// The other ball's radius is 0, or a share of the first one's, which it then lacks. Some touch from outside, within a step.
template <scalar T>
ABUT_HD ball_pair<T> two_balls(const sphere_triangle_pair<T>& p, std::uint64_t k) {
    const T share = k % 2 == 0 ? T(0) : p.s.radius / 4;
    return {{p.s.center, p.s.radius - share}, {k % 8 < 2 ? construction::end_along_x(p.s) : p.t.a, share}};
}

}  // namespace abut::test
