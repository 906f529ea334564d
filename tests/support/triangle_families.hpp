// SPDX-License-Identifier: MIT
#pragma once

// Families of triangle-triangle pairs, each built to break something (docs/results/wrong-answers.md says what). A pair is a
// pure function of (seed, family, index), on hosts and devices alike and bit for bit; draws.hpp says how. In each family
// some pairs touch and some do not.

#include <cstdint>

#include <abut/config.hpp>
#include <abut/shape/primitive.hpp>

#include "draws.hpp"

namespace abut::test {

enum class triangle_family : int {
    random,
    offset_1e3,
    offset_1e6,
    scaled_1e_minus_30,
    scaled_1e_minus_13,
    scaled_1e_minus_4,
    scaled_1e6,
    scaled_1e13,
    scaled_1e30,
    needle_1e3,
    needle_1e6,
    needle_1e9,
    needle_1e12,
    tiny_and_large,
    vertex_on_face,
    edge_on_edge,
    vertex_on_edge,
    shared_vertex,
    shared_edge,
    copied,
    coplanar_tilted,
    coplanar_aligned,
    coplanar_nested,
    collinear_edges,
    lattice_4,
    lattice_16,
    lattice_256,
    tenths_4,
    tenths_16,
    tenths_256,
    degenerate,
    degenerate_rounded,
    denormal,
    largest,
    mixed_exponents,
    any_scale,
    all_bit_patterns,
    grid_borders,
    signed_zeros,
};

inline constexpr int triangle_family_count = static_cast<int>(triangle_family::signed_zeros) + 1;

/// On the host only.
inline const char* name_of(triangle_family f) {
    constexpr const char* names[triangle_family_count] = {
        "random",          "offset 1e3",         "offset 1e6",      "scaled 1e-30",    "scaled 1e-13",
        "scaled 1e-4",     "scaled 1e6",         "scaled 1e13",     "scaled 1e30",     "needle 1e3",
        "needle 1e6",      "needle 1e9",         "needle 1e12",     "tiny and large",  "vertex on face",
        "edge on edge",    "vertex on edge",     "shared vertex",   "shared edge",     "copied",
        "coplanar tilted", "coplanar aligned",   "coplanar nested", "collinear edges", "lattice 4",
        "lattice 16",      "lattice 256",        "0.1 lattice 4",   "0.1 lattice 16",  "0.1 lattice 256",
        "degenerate",      "degenerate rounded", "denormal",        "largest",         "mixed exponents",
        "any scale",       "all bit patterns",   "grid borders",    "signed zeros"};
    return names[static_cast<int>(f)];
}

template <scalar T>
struct triangle_pair {
    triangle<T> a, b;
};

/// The corners in order number 0 to 5; 0 is as they are.
template <scalar T>
ABUT_HD triangle<T> reordered(const triangle<T>& t, int order) {
    const vec3<T> v[3] = {t.a, t.b, t.c};
    const int i = order % 3, j = (i + (order < 3 ? 1 : 2)) % 3;
    return {v[i], v[j], v[3 - i - j]};
}

namespace construction::triangles {

template <scalar T>
using pair = triangle_pair<T>;

/// One of its 72 orders: of the corners and of the sides
template <scalar T>
ABUT_HD pair<T> reordered_pair(draws& d, const pair<T>& p) {
    const int k = d.below(72);
    const triangle<T> a = reordered(p.a, k % 6), b = reordered(p.b, k / 6 % 6);
    return k < 36 ? pair<T>{a, b} : pair<T>{b, a};
}

template <scalar T>
ABUT_HD T& coordinate(vec3<T>& v, int k) {
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

template <scalar T>
ABUT_HD void move_any(draws& d, vec3<T>& v, int steps) {
    T& x = coordinate(v, d.below(3));
    x = moved(x, steps);
}

/// The axis along which v is longest
ABUT_HD inline int main_axis(const point& v) {
    const double x = v.x < 0 ? -v.x : v.x, y = v.y < 0 ? -v.y : v.y, z = v.z < 0 ? -v.z : v.z;
    return x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
}

ABUT_HD inline double random_sign(draws& d) { return d.below(2) == 0 ? -1 : 1; }

template <scalar T>
ABUT_HD triangle<T> random_triangle(draws& d) {
    return {round_to<T>(cube(d, 1)), round_to<T>(cube(d, 1)), round_to<T>(cube(d, 1))};
}

/// A triangle's corner a, its edges from there, its normal, and the direction in its plane away from the edge a b.
struct frame {
    point a, ab, ac, n, out;
    template <scalar T>
    ABUT_HD explicit frame(const triangle<T>& t)
        : a(widened(t.a)),
          ab(along(widened(t.b), -1, a)),
          ac(along(widened(t.c), -1, a)),
          n(unit(cross_product(ab, ac))),
          out(unit(cross_product(ab, n))) {}
    ABUT_HD point at(double u, double v) const { return along(along(a, u, ab), v, ac); }
};

template <scalar T>
ABUT_HD pair<T> random_pair(draws& d, double scale, double offset) {
    const point o{offset * scale, -offset * scale, offset / 2 * scale};
    vec3<T> v[6];
    for (vec3<T>& x : v) x = round_to<T>(along(o, scale, cube(d, 1)));
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

/// A needle (length 1, width 1 / aspect) and, half of the time, a triangle of which an edge passes it at a distance of 1e-9
/// to 0.1; or else another needle, which meets it but for twice their width.
template <scalar T>
ABUT_HD pair<T> needle_pair(draws& d, double aspect) {
    const point o = cube(d, 1), e = unit(cube(d, 1)), across = unit(cross_product(e, cube(d, 1))), v = unit(cube(d, 1));
    const double third = d.uniform(0, 1), t = d.uniform(0.1, 0.9), width = 1 / aspect;
    pair<T> p;
    p.a = {round_to<T>(o), round_to<T>(along(o, 1, e)), round_to<T>(along(along(o, third, e), width, across))};
    const point m = unit(cross_product(e, v)), foot = along(o, t, e);
    const double before = d.uniform(-1, -0.1), behind = d.uniform(0.1, 1), side = random_sign(d);
    if (d.below(2) == 0) {
        const point near = along(foot, side * d.power_of_ten(-9, -1), m);
        const double height = d.uniform(0.3, 1), shift = d.uniform(-0.5, 0.5);
        p.b = {round_to<T>(along(near, before, v)), round_to<T>(along(near, behind, v)),
               round_to<T>(along(along(foot, height, m), shift, v))};
    } else {
        const double gap = d.uniform(0, 2), in = d.uniform(0, 0.5);
        const point inner = along(foot, width * in, across), near = along(inner, width * gap, unit(cube(d, 1)));
        const double place = d.uniform(-0.5, 0.5);
        p.b = {round_to<T>(along(near, before, v)), round_to<T>(along(near, behind, v)),
               round_to<T>(along(along(inner, place, v), side * width, across))};
    }
    return reordered_pair(d, p);
}

/// A triangle of 1e-7 (1e-15) to 0.1 of the size at the other's face, edge or corner
template <scalar T>
ABUT_HD pair<T> tiny_pair(draws& d) {
    pair<T> p;
    p.b = random_triangle<T>(d);
    const int feature = d.below(3);
    const double size = d.power_of_ten(sizeof(T) == 4 ? -7 : -15, -1), u = feature > 0 ? d.uniform(0, 1) : 0.0;
    const double v = feature > 1 ? d.uniform(0, 1) * (1 - u) : 0.0;
    const point foot = frame(p.b).at(u, v);
    p.a.a = round_to<T>(along(foot, size, cube(d, 1)));
    p.a.b = round_to<T>(along(foot, size, cube(d, 1)));
    p.a.c = round_to<T>(along(foot, size, cube(d, 1)));
    return reordered_pair(d, p);
}

/// A corner in a face as nearly as it rounds, or one step above or below that; the other two on one side.
template <scalar T>
ABUT_HD pair<T> vertex_face_pair(draws& d) {
    pair<T> p;
    p.b = random_triangle<T>(d);
    const frame f(p.b);
    const double u = d.uniform(0.05, 0.9), v = d.uniform(0.05, 0.95) * (1 - u), side = random_sign(d);
    const point foot = f.at(u, v);
    p.a.a = round_to<T>(foot);
    T& x = coordinate(p.a.a, main_axis(f.n));
    x = moved(x, d.below(3) - 1);
    vec3<T>* const others[2] = {&p.a.b, &p.a.c};
    for (vec3<T>* w : others) {
        const double height = side * d.uniform(0.1, 1), s = d.uniform(-1, 1), t = d.uniform(-1, 1);
        *w = round_to<T>(along(along(along(foot, height, f.n), s, f.ab), t, f.ac));
    }
    return reordered_pair(d, p);
}

/// Edges that cross as nearly as they round, or one step off; the third corners are on either side of the plane of both.
template <scalar T>
ABUT_HD pair<T> edge_edge_pair(draws& d) {
    const point o = cube(d, 1), u = unit(cube(d, 1)), v = unit(cube(d, 1)), w = unit(cross_product(u, v));
    double t[4];
    for (double& x : t) x = d.uniform(0.05, 1);
    pair<T> p;
    p.a.a = round_to<T>(along(o, -t[0], u));
    p.a.b = round_to<T>(along(o, t[1], u));
    p.b.a = round_to<T>(along(o, -t[2], v));
    p.b.b = round_to<T>(along(o, t[3], v));
    vec3<T>* const third[2] = {&p.a.c, &p.b.c};
    for (int k = 0; k < 2; ++k) {
        const double height = d.uniform(0.1, 1), x = d.uniform(-1, 1), y = d.uniform(-1, 1);
        *third[k] = round_to<T>(along(along(along(o, k == 0 ? height : -height, w), x, u), y, v));
    }
    T& x = coordinate(p.a.a, main_axis(w));
    x = moved(x, d.below(3) - 1);
    return reordered_pair(d, p);
}

/// A corner on an edge: rounded, the other two beyond the edge and on either side of the plane; or exactly, at a quarter of
/// an edge on a lattice, and then half of the time one step off.
template <scalar T>
ABUT_HD pair<T> vertex_edge_pair(draws& d) {
    pair<T> p;
    if (d.below(2) == 0) {
        p.b = random_triangle<T>(d);
        const frame f(p.b);
        const double u = d.uniform(0.05, 0.95);
        const point foot = f.at(u, 0);
        p.a.a = round_to<T>(foot);
        vec3<T>* const others[2] = {&p.a.b, &p.a.c};
        for (int k = 0; k < 2; ++k) {
            const double height = d.uniform(0.1, 1), out = d.uniform(0.1, 1), s = d.uniform(-1, 1);
            *others[k] = round_to<T>(along(along(along(foot, k == 0 ? height : -height, f.n), out, f.out), s, f.ab));
        }
    } else {
        vec3<T>* const corners[3] = {&p.b.a, &p.b.b, &p.b.c};
        for (vec3<T>* v : corners) {
            for (int k = 0; k < 3; ++k) coordinate(*v, k) = static_cast<T>(4 * (d.below(17) - 8));
        }
        const T weight = static_cast<T>(d.below(5));
        vec3<T>* const others[2] = {&p.a.b, &p.a.c};
        for (int k = 0; k < 3; ++k) {
            const T from = coordinate(p.b.a, k), to = coordinate(p.b.b, k), third = coordinate(p.b.c, k);
            const T foot = (weight * to + (4 - weight) * from) / 4;  // small integers: exact
            coordinate(p.a.a, k) = foot;
            // Away from the third corner, so that little else touches
            for (vec3<T>* w : others) coordinate(*w, k) = foot + (foot - third) / 4 + static_cast<T>(d.below(9) - 4);
        }
        if (d.below(2) == 0) move_any(d, p.a.a, d.below(2) == 0 ? -1 : 1);
    }
    return reordered_pair(d, p);
}

/// One corner in common, or but for a step in one coordinate; half of the time on either side of a plane through it.
template <scalar T>
ABUT_HD pair<T> shared_vertex_pair(draws& d) {
    pair<T> p;
    p.a = random_triangle<T>(d);
    p.b = random_triangle<T>(d);
    p.b.a = p.a.a;
    if (d.below(2) == 0) {
        const point o = widened(p.a.a);
        const frame f(triangle<T>{p.a.a, p.a.b, p.b.b});
        const point w = along(f.n, d.uniform(-0.5, 0.5), f.out);
        vec3<T>* const others[4] = {&p.a.b, &p.a.c, &p.b.b, &p.b.c};
        for (int k = 0; k < 4; ++k) {
            const point away = along(widened(*others[k]), -1, o);
            const double reach = product(away, w), wanted = k < 2 ? d.uniform(0.05, 1) : d.uniform(-1, -0.05);
            *others[k] = round_to<T>(along(along(o, 1, away), (wanted - reach) / product(w, w), w));
        }
    }
    if (d.below(3) != 0) move_any(d, p.b.a, d.below(2) == 0 ? -1 : 1);
    return reordered_pair(d, p);
}

/// Two corners in common; or one, and the other but for a step; or both but for a step.
template <scalar T>
ABUT_HD pair<T> shared_edge_pair(draws& d) {
    pair<T> p;
    p.a = random_triangle<T>(d);
    p.b.c = round_to<T>(cube(d, 1));
    p.b.a = p.a.a;
    p.b.b = p.a.b;
    const int kind = d.below(5);
    if (kind > 0) move_any(d, p.b.a, d.below(2) == 0 ? -1 : 1);
    if (kind > 1) move_any(d, p.b.b, d.below(2) == 0 ? -1 : 1);
    return reordered_pair(d, p);
}

/// The same triangle twice; or one coordinate is a step off; or each corner is, along one axis: to one side or to any.
template <scalar T>
ABUT_HD pair<T> copied_pair(draws& d) {
    pair<T> p;
    p.a = p.b = random_triangle<T>(d);
    const int kind = d.below(4), axis = main_axis(frame(p.a).n), step = d.below(2) == 0 ? -1 : 1;
    if (kind == 1) move_any(d, p.b.a, step);
    if (kind > 1) {
        vec3<T>* const corners[3] = {&p.b.a, &p.b.b, &p.b.c};
        for (vec3<T>* v : corners) {
            const int other = d.below(2) == 0 ? -1 : 1;
            coordinate(*v, axis) = moved(coordinate(*v, axis), kind == 2 ? step : other);
        }
    }
    return reordered_pair(d, p);
}

/// In one plane, but for rounding
template <scalar T>
ABUT_HD pair<T> tilted_pair(draws& d) {
    const point o = cube(d, 1), u = unit(cube(d, 1)), v = unit(cross_product(u, cube(d, 1)));
    vec3<T> w[6];
    for (vec3<T>& x : w) {
        const double s = d.uniform(-1, 1), t = d.uniform(-1, 1);
        x = round_to<T>(along(along(o, s, u), t, v));
    }
    return {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
}

/// In one plane along two axes, exactly; half of the time on a lattice in it.
template <scalar T>
ABUT_HD pair<T> aligned_pair(draws& d) {
    const int axis = d.below(3), kind = d.below(2);
    const T height = rounded_to<T>(d.uniform(-1, 1));
    vec3<T> w[6];
    for (vec3<T>& v : w) {
        for (int k = 0; k < 3; ++k) {
            const double x = kind == 0 ? d.uniform(-1, 1) : (d.below(9) - 4) / 4.0;
            coordinate(v, k) = k == axis ? height : rounded_to<T>(x);
        }
    }
    return {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
}

/// One inside the other or on its border, exactly in its tilted plane; or lifted by a step, all of it or one corner.
template <scalar T>
ABUT_HD pair<T> nested_pair(draws& d) {
    constexpr int fine = 12;
    const int lift = d.below(4), step = d.below(2) == 0 ? -1 : 1;
    int o[3], u[3], v[3], i[3], j[3];
    for (int k = 0; k < 3; ++k) {
        o[k] = d.below(201) - 100;
        u[k] = d.below(9) - 4;
        v[k] = d.below(9) - 4;
        i[k] = d.below(fine + 1);
        j[k] = d.below(fine + 1 - i[k]);
    }
    pair<T> p;
    vec3<T>* const inner[3] = {&p.a.a, &p.a.b, &p.a.c};
    for (int k = 0; k < 3; ++k) {
        coordinate(p.b.a, k) = static_cast<T>(o[k]);
        coordinate(p.b.b, k) = static_cast<T>(o[k] + fine * u[k]);
        coordinate(p.b.c, k) = static_cast<T>(o[k] + fine * v[k]);
        for (int c = 0; c < 3; ++c) coordinate(*inner[c], k) = static_cast<T>(o[k] + i[c] * u[k] + j[c] * v[k]);
    }
    const point edge_u{static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2])};
    const point edge_v{static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
    const int axis = main_axis(cross_product(edge_u, edge_v));
    for (int c = 0; c < 3; ++c) {
        T& x = coordinate(*inner[c], axis);
        if (lift < 2 && (lift == 0 || c == 0)) x = moved(x, step);
    }
    return reordered_pair(d, p);
}

/// Edges on one line, which overlap, touch or do not; on a lattice, 0.1 times it, or a step off it.
template <scalar T>
ABUT_HD pair<T> collinear_pair(draws& d) {
    const T unit_length = d.below(2) == 0 ? T(1) : T(0.1);
    int at[4];
    for (int& x : at) x = d.below(9);
    pair<T> p;
    for (int k = 0; k < 3; ++k) {
        const int o = d.below(17) - 8, u = d.below(9) - 4, above = d.below(17), below = d.below(17);
        coordinate(p.a.a, k) = static_cast<T>(o + at[0] * u) * unit_length;
        coordinate(p.a.b, k) = static_cast<T>(o + at[1] * u) * unit_length;
        coordinate(p.b.a, k) = static_cast<T>(o + at[2] * u) * unit_length;
        coordinate(p.b.b, k) = static_cast<T>(o + at[3] * u) * unit_length;
        coordinate(p.a.c, k) = static_cast<T>(o + 4 * u + above) * unit_length;
        coordinate(p.b.c, k) = static_cast<T>(o + 4 * u - below) * unit_length;
    }
    if (d.below(4) == 0) move_any(d, p.a.a, d.below(2) == 0 ? -1 : 1);
    return reordered_pair(d, p);
}

template <scalar T>
ABUT_HD vec3<T> lattice_point(draws& d, int size, T unit_length) {
    vec3<T> v;
    for (int k = 0; k < 3; ++k) coordinate(v, k) = static_cast<T>(d.below(size + 1)) * unit_length;
    return v;
}

template <scalar T>
ABUT_HD pair<T> lattice_pair(draws& d, int size, T unit_length) {
    vec3<T> v[6];
    for (vec3<T>& x : v) x = lattice_point(d, size, unit_length);
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

/// On a lattice: a triangle, a segment with one corner repeated or with three in a line, or a point.
template <scalar T>
ABUT_HD triangle<T> degenerate_triangle(draws& d, int size) {
    triangle<T> t;
    t.a = lattice_point(d, size, T(1));
    t.b = lattice_point(d, size, T(1));
    t.c = lattice_point(d, size, T(1));
    const int kind = d.below(4), order = d.below(6);
    if (kind == 1) t.c = d.below(2) == 0 ? t.a : t.b;
    if (kind == 2) {
        for (int k = 0; k < 3; ++k) coordinate(t.c, k) = 2 * coordinate(t.b, k) - coordinate(t.a, k);
    }
    if (kind == 3) t.b = t.c = t.a;
    return reordered(t, order);
}

/// Segments through one lattice point, or through neighbours, and so skew
template <scalar T>
ABUT_HD pair<T> crossing_segments(draws& d) {
    int steps[4];
    for (int& s : steps) s = d.below(4);
    const int moved_axis = d.below(6);  // none, half of the time
    vec3<T> v[4];
    for (int k = 0; k < 3; ++k) {
        const int o = d.below(65), u = d.below(33) - 16, w = d.below(33) - 16, other = o + (k == moved_axis ? 1 : 0);
        coordinate(v[0], k) = static_cast<T>(o - steps[0] * u);
        coordinate(v[1], k) = static_cast<T>(o + steps[1] * u);
        coordinate(v[2], k) = static_cast<T>(other - steps[2] * w);
        coordinate(v[3], k) = static_cast<T>(other + steps[3] * w);
    }
    return {{v[0], v[1], v[1]}, {v[2], v[3], v[2]}};
}

template <scalar T>
ABUT_HD pair<T> degenerate_pair(draws& d) {
    pair<T> p;
    if (d.below(4) == 0) {
        p = crossing_segments<T>(d);
    } else {
        const int size = 1 + d.below(4);
        p.a = degenerate_triangle<T>(d, size);
        p.b = degenerate_triangle<T>(d, size);
    }
    return reordered_pair(d, p);
}

/// Points and segments at faces, edges and segments, as nearly as they round, or one step off
template <scalar T>
ABUT_HD pair<T> degenerate_rounded_pair(draws& d) {
    pair<T> p;
    p.b = random_triangle<T>(d);
    const frame f(p.b);
    const int kind = d.below(6);
    const double u = d.uniform(0.05, 0.9), v = kind == 0 || kind == 2 ? d.uniform(0.05, 0.95) * (1 - u) : 0.0;
    const point foot = f.at(u, v);
    const double side = random_sign(d), height = d.uniform(0.1, 1), out = d.uniform(-1, 1), s = d.uniform(-1, 1);
    const point end = along(along(along(foot, side * height, f.n), out, f.out), s, f.ab);
    p.a.a = p.a.b = p.a.c = round_to<T>(foot);             // 0, 1: a point at the face, at an edge
    if (kind == 2 || kind == 4) p.a.b = round_to<T>(end);  // a segment that ends at the face, at a segment
    if (kind == 3 || kind == 5) {                          // a segment through an edge, through a segment
        p.a.a = round_to<T>(along(foot, -1, along(end, -1, foot)));
        p.a.b = p.a.c = round_to<T>(end);
    }
    if (kind == 4 || kind == 5) p.b.c = p.b.a;
    const int axis = main_axis(f.n);
    coordinate(p.a.a, axis) = moved(coordinate(p.a.a, axis), d.below(3) - 1);
    return reordered_pair(d, p);
}

template <scalar T>
ABUT_HD pair<T> denormal_pair(draws& d) {
    const int size = d.below(2) == 0 ? 6 : 4096;
    pair<T> p = lattice_pair<T>(d, size, least_denormal<T>);
    vec3<T>* const corners[6] = {&p.a.a, &p.a.b, &p.a.c, &p.b.a, &p.b.b, &p.b.c};
    for (vec3<T>* v : corners) {
        for (int k = 0; k < 3; ++k) {
            if (d.below(2) == 0) coordinate(*v, k) = -coordinate(*v, k);  // signed zeros among them
        }
    }
    return p;
}

template <scalar T>
ABUT_HD pair<T> largest_pair(draws& d) {
    vec3<T> v[6];
    for (vec3<T>& x : v) {
        for (int k = 0; k < 3; ++k) {
            T& e = coordinate(x, k);
            e = largest_number<T>;
            if (d.below(3) != 0) e *= rounded_to<T>(d.uniform(0.25, 1));
            if (d.below(2) == 0) e = -e;
        }
    }
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

/// A triangle in the plane z = 0, and one that reaches down to that plane on the z axis, or nearly; all exponents that there
/// are.
template <scalar T>
ABUT_HD pair<T> mixed_pair(draws& d) {
    pair<T> p;
    vec3<T>* const corners[6] = {&p.a.a, &p.a.b, &p.a.c, &p.b.a, &p.b.b, &p.b.c};
    for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 3; ++k) coordinate(*corners[i], k) = any_finite<T>(d);
        if (i < 3 && corners[i]->z < 0) corners[i]->z = -corners[i]->z;
        if (i >= 3) corners[i]->z = T(0);
    }
    // Its corners in three quadrants, so that it is likely to have the axis inside
    p.b.a.x = p.b.a.x < 0 ? -p.b.a.x : p.b.a.x;
    p.b.a.y = p.b.a.y < 0 ? -p.b.a.y : p.b.a.y;
    p.b.b.x = p.b.b.x < 0 ? p.b.b.x : -p.b.b.x;
    p.b.c.y = p.b.c.y < 0 ? p.b.c.y : -p.b.c.y;
    const int kind = d.below(4);
    p.a.a.x = p.a.a.y = d.below(2) == 0 ? T(0) : least_denormal<T>;
    if (kind < 2) p.a.a.z = T(0);
    if (kind == 2) p.a.a.z = least_denormal<T>;
    if (d.below(4) == 0) p.b.b.z = any_finite<T>(d);  // tilts the plane
    return reordered_pair(d, p);
}

/// A corner on an edge, on a grid of which all coordinates take 15 to 19 bits, many of them near the ends of their range; or
/// one unit off, or one step; times a power of two.
template <scalar T>
ABUT_HD pair<T> grid_border_pair(draws& d) {
    constexpr int fraction = sizeof(T) == 4 ? 23 : 52, bias = sizeof(T) == 4 ? 127 : 1023,
                  reach = sizeof(T) == 4 ? 105 : 360;
    const int quarter = 1 << (12 + d.below(5)), weight = d.below(5), power = d.below(2 * reach + 1) - reach;
    const T unit = sizeof(T) == 4 ? static_cast<T>(from_bits(static_cast<std::uint32_t>(bias + power) << fraction % 32))
                                  : static_cast<T>(from_bits(static_cast<std::uint64_t>(bias + power) << fraction));
    const bool extreme = d.below(2) == 0;
    int on[9], at[9];
    for (int& x : on) {
        x = 4 * (d.below(2 * quarter - 1) - (quarter - 1));
        if (extreme && d.below(4) != 0) x = (x < 0 ? -4 : 4) * (quarter - 1 - d.below(9));
    }
    for (int k = 0; k < 3; ++k) {
        at[k] = (weight * on[3 + k] + (4 - weight) * on[k]) / 4;
        for (int i = 3; i < 9; i += 3) {
            const int out = at[k] + (at[k] - on[6 + k]) / 4 + d.below(quarter + 1) - quarter / 2;
            at[i + k] = out < -4 * quarter ? 1 - 4 * quarter : out > 4 * quarter ? 4 * quarter - 1 : out;
        }
    }
    const int kind = d.below(4);
    if (kind == 1) at[d.below(3)] += d.below(2) == 0 ? -1 : 1;
    pair<T> p;
    vec3<T>* const corners[6] = {&p.a.a, &p.a.b, &p.a.c, &p.b.a, &p.b.b, &p.b.c};
    for (int i = 0; i < 18; ++i) coordinate(*corners[i / 3], i % 3) = static_cast<T>(i < 9 ? at[i] : on[i - 9]) * unit;
    if (kind == 2) move_any(d, p.a.a, d.below(2) == 0 ? -1 : 1);
    return reordered_pair(d, p);
}

/// Small integers, many of them 0 of either sign, half of the time with a corner in common but for such signs; or one of the
/// zeros is a denormal number.
template <scalar T>
ABUT_HD pair<T> signed_zeros_pair(draws& d) {
    pair<T> p;
    vec3<T>* const corners[6] = {&p.a.a, &p.a.b, &p.a.c, &p.b.a, &p.b.b, &p.b.c};
    for (vec3<T>* v : corners) {
        for (int k = 0; k < 3; ++k) coordinate(*v, k) = d.below(2) == 0 ? T(0) : static_cast<T>(d.below(7) - 3);
    }
    if (d.below(2) == 0) p.b.a = p.a.a;
    const bool nearly = d.below(2) == 0;
    for (vec3<T>* v : corners) {
        for (int k = 0; k < 3; ++k) {
            T& x = coordinate(*v, k);
            if (x == 0 && nearly && d.below(8) == 0) x = least_denormal<T>;
            if (d.below(2) == 0 && (x == 0 || x == least_denormal<T>)) x = -x;
        }
    }
    return reordered_pair(d, p);
}

/// Pairs that touch or nearly do, times a power of two of the whole range; where that underflows, rounded.
template <scalar T>
ABUT_HD pair<T> any_scale_pair(draws& d) {
    const int kind = d.below(5);
    pair<T> p = kind == 0   ? vertex_face_pair<T>(d)
                : kind == 1 ? edge_edge_pair<T>(d)
                : kind == 2 ? vertex_edge_pair<T>(d)
                : kind == 3 ? shared_edge_pair<T>(d)
                            : tilted_pair<T>(d);
    constexpr int low = sizeof(T) == 4 ? -126 : -1022, high = sizeof(T) == 4 ? 120 : 1016;
    const int k = d.below(high - low) + low;
    const T scale = sizeof(T) == 4 ? static_cast<T>(from_bits(static_cast<std::uint32_t>(127 + k) << 23))
                                   : static_cast<T>(from_bits(static_cast<std::uint64_t>(1023 + k) << 52));
    vec3<T>* const corners[6] = {&p.a.a, &p.a.b, &p.a.c, &p.b.a, &p.b.b, &p.b.c};
    for (vec3<T>* v : corners) *v = scale * *v;
    return p;
}

template <scalar T>
ABUT_HD pair<T> any_pair(draws& d) {
    vec3<T> v[6];
    for (vec3<T>& x : v) {
        for (int k = 0; k < 3; ++k) coordinate(x, k) = any_finite<T>(d);
    }
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

}  // namespace construction::triangles

/// Pair number `index` of a family.
template <scalar T>
ABUT_HD triangle_pair<T> make_triangle_pair(std::uint64_t seed_value, triangle_family f, std::uint64_t index) {
    namespace make = construction::triangles;
    draws d(seed_value, 100 + static_cast<std::uint64_t>(f), index);
    switch (f) {
        case triangle_family::random:
            return make::random_pair<T>(d, 1, 0);
        case triangle_family::offset_1e3:
            return make::random_pair<T>(d, 1, 1e3);
        case triangle_family::offset_1e6:
            return make::random_pair<T>(d, 1, 1e6);
        case triangle_family::scaled_1e_minus_30:
            return make::random_pair<T>(d, 1e-30, 0);
        case triangle_family::scaled_1e_minus_13:
            return make::random_pair<T>(d, 1e-13, 0);
        case triangle_family::scaled_1e_minus_4:
            return make::random_pair<T>(d, 1e-4, 0);
        case triangle_family::scaled_1e6:
            return make::random_pair<T>(d, 1e6, 0);
        case triangle_family::scaled_1e13:
            return make::random_pair<T>(d, 1e13, 0);
        case triangle_family::scaled_1e30:
            return make::random_pair<T>(d, 1e30, 0);
        case triangle_family::needle_1e3:
            return make::needle_pair<T>(d, 1e3);
        case triangle_family::needle_1e6:
            return make::needle_pair<T>(d, 1e6);
        case triangle_family::needle_1e9:
            return make::needle_pair<T>(d, 1e9);
        case triangle_family::needle_1e12:
            return make::needle_pair<T>(d, 1e12);
        case triangle_family::tiny_and_large:
            return make::tiny_pair<T>(d);
        case triangle_family::vertex_on_face:
            return make::vertex_face_pair<T>(d);
        case triangle_family::edge_on_edge:
            return make::edge_edge_pair<T>(d);
        case triangle_family::vertex_on_edge:
            return make::vertex_edge_pair<T>(d);
        case triangle_family::shared_vertex:
            return make::shared_vertex_pair<T>(d);
        case triangle_family::shared_edge:
            return make::shared_edge_pair<T>(d);
        case triangle_family::copied:
            return make::copied_pair<T>(d);
        case triangle_family::coplanar_tilted:
            return make::tilted_pair<T>(d);
        case triangle_family::coplanar_aligned:
            return make::aligned_pair<T>(d);
        case triangle_family::coplanar_nested:
            return make::nested_pair<T>(d);
        case triangle_family::collinear_edges:
            return make::collinear_pair<T>(d);
        case triangle_family::lattice_4:
            return make::lattice_pair<T>(d, 4, T(1));
        case triangle_family::lattice_16:
            return make::lattice_pair<T>(d, 16, T(1));
        case triangle_family::lattice_256:
            return make::lattice_pair<T>(d, 256, T(1));
        case triangle_family::tenths_4:
            return make::lattice_pair<T>(d, 4, T(0.1));
        case triangle_family::tenths_16:
            return make::lattice_pair<T>(d, 16, T(0.1));
        case triangle_family::tenths_256:
            return make::lattice_pair<T>(d, 256, T(0.1));
        case triangle_family::degenerate:
            return make::degenerate_pair<T>(d);
        case triangle_family::degenerate_rounded:
            return make::degenerate_rounded_pair<T>(d);
        case triangle_family::denormal:
            return make::denormal_pair<T>(d);
        case triangle_family::largest:
            return make::largest_pair<T>(d);
        case triangle_family::mixed_exponents:
            return make::mixed_pair<T>(d);
        case triangle_family::any_scale:
            return make::any_scale_pair<T>(d);
        case triangle_family::all_bit_patterns:
            return make::any_pair<T>(d);
        case triangle_family::grid_borders:
            return make::grid_border_pair<T>(d);
        case triangle_family::signed_zeros:
            return make::signed_zeros_pair<T>(d);
    }
    return {};
}

// --- other shapes, of a pair and its index, which are tried against its second triangle -------------------------------

/// The edges of the first triangle in turn.
template <scalar T>
ABUT_HD segment<T> segment_beside_triangle(const triangle_pair<T>& p, std::uint64_t k) {
    const triangle<T> turned = reordered(p.a, static_cast<int>(k % 6));
    return {turned.a, turned.b};
}

/// A corner of the first triangle; or one of the second's own, there or a step away along x; or the middle of an edge,
/// rounded.
template <scalar T>
ABUT_HD vec3<T> point_beside_triangle(const triangle_pair<T>& p, std::uint64_t k) {
    const triangle<T> own = reordered(p.b, static_cast<int>(k / 4 % 3));
    vec3<T> point = reordered(p.a, static_cast<int>(k / 4 % 3)).a;
    if (k % 4 == 1) point = own.a;
    if (k % 4 == 2) point = {construction::moved(own.a.x, 1), own.a.y, own.a.z};
    if (k % 4 == 3) point = T(0.5) * own.a + T(0.5) * own.b;
    return point.x - point.x == 0 ? point : own.a;
}

}  // namespace abut::test
