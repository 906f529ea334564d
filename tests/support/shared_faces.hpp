// SPDX-License-Identifier: MIT
#pragma once

// Pairs of faces that may share vertices: the oracle, and families of pairs.
//
// The oracle, in unbounded integers. The points that two triangles have in common are those with weights l, m >= 0,
//     sum l_i a_i = sum m_j b_j,   sum l_i = 1,   sum m_j = 1.
// The solutions are a polytope, and its vertices are the solutions whose columns are linearly independent: each set of
// columns is tried, by elimination without fractions. What the triangles have in common is the hull of the points that these
// vertices stand for. It is within what is shared, where that is a point or a segment, if and only if each of the points is.
// Nothing here knows of normals, sides, turns or cones.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <abut/arithmetic/wide_int.hpp>
#include <abut/shape/mesh_face.hpp>

#include "draws.hpp"
#include "rational.hpp"

namespace abut::test {

namespace oracle {

template <class N>
using point_of = std::array<N, 3>;

/// A point with a denominator, which is positive.
template <class N>
struct fraction_point {
    point_of<N> over;
    N denominator;
};

/// The point that stands for the set of columns, of weights for a (bits 0 to 2) and for b (bits 3 to 5), if it is a vertex
/// of the polytope.
template <class N>
std::optional<fraction_point<N>> vertex_of(const std::array<point_of<N>, 3>& a, const std::array<point_of<N>, 3>& b,
                                           unsigned columns) {
    constexpr std::size_t rows = 5;
    std::vector<std::size_t> used;
    for (std::size_t k = 0; k < 6; ++k) {
        if ((columns >> k & 1) != 0) used.push_back(k);
    }
    const std::size_t width = used.size() + 1;
    if (used.size() > rows) return std::nullopt;
    std::vector<N> cell(rows * width);
    const auto at = [&](std::size_t r, std::size_t c) -> N& { return cell[r * width + c]; };
    for (std::size_t c = 0; c < used.size(); ++c) {
        const std::size_t k = used[c];
        for (std::size_t r = 0; r < 3; ++r) at(r, c) = k < 3 ? a[k][r] : -b[k - 3][r];
        at(3, c) = k < 3 ? 1 : 0;
        at(4, c) = k < 3 ? 0 : 1;
    }
    at(3, width - 1) = at(4, width - 1) = 1;
    // Jordan's elimination: after each step all pivots are equal, and each division leaves no remainder.
    N pivot = 1;
    for (std::size_t c = 0; c < used.size(); ++c) {
        std::size_t r = c;
        while (r < rows && at(r, c) == 0) ++r;
        if (r == rows) return std::nullopt;  // dependent
        for (std::size_t k = 0; k < width; ++k) std::swap(at(r, k), at(c, k));
        for (std::size_t i = 0; i < rows; ++i) {
            if (i == c) continue;
            const N factor = at(i, c);
            for (std::size_t k = 0; k < width; ++k) at(i, k) = (at(i, k) * at(c, c) - factor * at(c, k)) / pivot;
        }
        pivot = at(c, c);
    }
    for (std::size_t r = used.size(); r < rows; ++r) {
        if (at(r, width - 1) != 0) return std::nullopt;  // no solution
    }
    fraction_point<N> p{{}, pivot < 0 ? N(-pivot) : pivot};
    for (std::size_t c = 0; c < used.size(); ++c) {
        const N weight = pivot < 0 ? N(-at(c, width - 1)) : at(c, width - 1);
        if (weight < 0) return std::nullopt;
        if (used[c] >= 3) continue;
        for (std::size_t r = 0; r < 3; ++r) p.over[r] += weight * a[used[c]][r];
    }
    return p;
}

/// Whether p is on the segment from u to v, by a weight between 0 and 1 for v.
template <class N>
bool is_on(const fraction_point<N>& p, const point_of<N>& u, const point_of<N>& v) {
    // p - u = w (v - u), the same w for each coordinate: as the fraction n / d
    N n = 0, d = 0;
    for (std::size_t r = 0; r < 3; ++r) {
        const N along = (v[r] - u[r]) * p.denominator, off = p.over[r] - u[r] * p.denominator;
        if (along == 0) {
            if (off != 0) return false;
            continue;
        }
        if (d == 0) {
            n = off, d = along;
        } else if (n * along != off * d) {
            return false;
        }
    }
    if (d < 0) n = -n, d = -d;
    return n >= 0 && n <= d;
}

/// Whether two triangles have a point in common that is on none of the segments between their shared corners: corners of a,
/// each of which is in the same place as one of b.
template <class N>
bool meet_beyond(const std::array<point_of<N>, 3>& a, const std::array<point_of<N>, 3>& b,
                 const std::vector<std::size_t>& shared) {
    const auto beyond = [&](const fraction_point<N>& p) {
        for (const std::size_t i : shared) {
            for (const std::size_t j : shared) {
                if (is_on(p, a[i], a[j])) return false;
            }
        }
        return true;
    };
    // Three segments are not convex: all corners are on them, and only a point in the middle may not be.
    if (shared.size() == 3) {
        fraction_point<N> middle{{}, 3};
        for (std::size_t r = 0; r < 3; ++r) middle.over[r] = a[0][r] + a[1][r] + a[2][r];
        return beyond(middle);
    }
    for (unsigned columns = 0; columns < 64; ++columns) {
        if ((columns & 7) == 0 || columns >> 3 == 0) continue;
        const auto p = vertex_of(a, b, columns);
        if (p && beyond(*p)) return true;
    }
    return false;
}

/// Of two faces by the numbers of their vertices, or by their places.
template <scalar T>
bool meet_beyond_shared(const detail::mesh_face<T>& f, const detail::mesh_face<T>& g) {
    const auto list = [](const triangle<T>& t) { return std::vector<vec3<T>>{t.a, t.b, t.c}; };
    const std::vector<vec3<T>> of_f = list(f.corners), of_g = list(g.corners);
    std::vector<std::size_t> shared;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto same = [&](const std::vector<vec3<T>>& points, const std::uint32_t* names, std::size_t j) {
            return f.vertex[0] == detail::mesh_face<T>::by_place ? of_f[i] == points[j] : f.vertex[i] == names[j];
        };
        bool named = false, again = false;
        for (std::size_t j = 0; j < 3; ++j) named = named || same(of_g, g.vertex, j);
        for (std::size_t j = 0; j < i; ++j) again = again || same(of_f, f.vertex, j);
        if (named && !again) shared.push_back(i);
    }
    std::vector<T> values;
    for (const auto* points : {&of_f, &of_g}) {
        for (const vec3<T>& p : *points) values.insert(values.end(), {p.x, p.y, p.z});
    }
    const std::vector<integer> v = to_integers(values);
    std::size_t bits = 0;
    for (const integer& x : v) bits = x == 0 ? bits : std::max<std::size_t>(bits, msb(integer(abs(x))) + 1);
    const auto decide_in = [&]<class N>(N) {
        std::array<point_of<N>, 3> a{}, b{};
        for (std::size_t k = 0; k < 9; ++k) {
            a[k / 3][k % 3] = to_number<N>(v[k]);
            b[k / 3][k % 3] = to_number<N>(v[9 + k]);
        }
        return meet_beyond(a, b, shared);
    };
    // With coordinates below 2^b minors are below 2^(3 b + 6), as hulls.hpp counts, so points with their denominators below
    // 2^(4 b + 9), of which two are multiplied.
    if (bits <= 13) return decide_in(int128{});
    if (bits <= 60) return decide_in(boost::multiprecision::int512_t{});
    return decide_in(integer{});
}

}  // namespace oracle

/// Where the vertices of two faces lie. Which of them the faces name is drawn beside.
enum class places : int {
    lattice_1,
    lattice_2,
    lattice_4,
    lattice_100,
    flat_lattice,
    line_lattice,
    tilted_plane,
    tilted_line,
    tenths,
    offset_tenths,
    random,
    nearly_flat,
    tiny,
    huge,
    denormal,
    mixed_exponents,
    any_span,
    borders_of_range,
    turned_lattice,
    lost_differences,
    signed_zeros,
};
inline constexpr int places_count = static_cast<int>(places::signed_zeros) + 1;
inline const char* name_of(places p) {
    constexpr const char* names[places_count] = {"lattice 1",      "lattice 2",
                                                 "lattice 4",      "lattice 100",
                                                 "flat lattice",   "line lattice",
                                                 "tilted plane",   "tilted line",
                                                 "tenths",         "offset tenths",
                                                 "random",         "nearly flat",
                                                 "tiny",           "huge",
                                                 "denormal",       "mixed exponents",
                                                 "any span",       "borders of range",
                                                 "turned lattice", "lost differences",
                                                 "signed zeros"};
    return names[static_cast<int>(p)];
}

template <scalar T>
std::vector<vec3<T>> draw_places(draws& d, places kind, std::size_t count) {
    const auto round = [](double x) { return construction::rounded_to<T>(x); };
    const double turn[9] = {d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1),
                            d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1)};
    const auto lattice = [&d](int n) { return static_cast<double>(d.below(n + 1)); };
    const auto scaled = [&](int n, double unit) {
        const double x = lattice(n), y = lattice(n), z = lattice(n);
        return vec3<T>{round(x * unit), round(y * unit), round(z * unit)};
    };
    const auto tilted = [&](double u, double v) {
        return vec3<T>{round(turn[0] + u * turn[3] + v * turn[6]), round(turn[1] + u * turn[4] + v * turn[7]),
                       round(turn[2] + u * turn[5] + v * turn[8])};
    };
    constexpr bool narrow = std::same_as<T, float>;
    // Where numbers, their products and products of three leave the normal range.
    constexpr int borders[] = {narrow ? -126 : -338, narrow ? -120 : -342, narrow ? -126 : -511, narrow ? -123 : -1021};
    // A rotation times a number, in integers, by a quaternion: right angles at any orientation.
    const auto whole = [&] { return std::floor(d.uniform(-1, 1) * (narrow ? 0x1p8 : 0x1p20)); };
    const double q0 = whole(), q1 = whole(), q2 = whole(), q3 = whole();
    const double frame[3][3] = {{q0 * q0 + q1 * q1 - q2 * q2 - q3 * q3, 2 * (q1 * q2 + q0 * q3), 2 * (q1 * q3 - q0 * q2)},
                                {2 * (q1 * q2 - q0 * q3), q0 * q0 - q1 * q1 + q2 * q2 - q3 * q3, 2 * (q2 * q3 + q0 * q1)},
                                {2 * (q1 * q3 + q0 * q2), 2 * (q2 * q3 - q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3}};
    const bool is_subnormal = d.below(2) == 0;
    const double border = std::ldexp(1.0, borders[d.below(4)]);
    std::vector<vec3<T>> points;
    for (std::size_t k = 0; k < count; ++k) {
        vec3<T> p{};
        switch (kind) {
            case places::lattice_1:
                p = scaled(1, 1);
                break;
            case places::lattice_2:
                p = scaled(2, 1);
                break;
            case places::lattice_4:
                p = scaled(4, 1);
                break;
            case places::lattice_100:
                p = scaled(100, 1);
                break;
            case places::flat_lattice:
                p = scaled(3, 1), p.z = 2;
                break;
            case places::line_lattice:
                p.x = round(lattice(4)), p.y = 2 * p.x, p.z = -p.x;
                break;
            case places::tilted_plane: {
                const double u = lattice(3), v = lattice(3);
                p = tilted(u, v);
                break;
            }
            case places::tilted_line:
                p = tilted(lattice(4), 0);
                break;
            case places::tenths:
                p = scaled(3, 0.1);
                break;
            case places::offset_tenths:
                p = scaled(3, 0.1), p.x += T(1e4), p.y -= T(3e3);
                break;
            case places::random:
                p = construction::round_to<T>(construction::cube(d, 1));
                break;
            case places::nearly_flat:
                p = construction::round_to<T>(construction::cube(d, 1)), p.z = round(d.uniform(-1e-7, 1e-7));
                break;
            case places::tiny:
                p = scaled(3, narrow ? 0x1.8p-118 : 0x1.8p-1000);
                break;
            case places::huge:
                p = scaled(3, narrow ? 0x1.4p125 : 0x1.4p1020);
                break;
            case places::denormal:
                p = scaled(3, narrow ? 0x1p-149 : 0x1p-1074);
                break;
            case places::mixed_exponents: {
                T* const x[] = {&p.x, &p.y, &p.z};
                for (T* const one : x) *one = round(std::ldexp(lattice(2), d.below(6) * 9));
                break;
            }
            case places::any_span: {
                T* const x[] = {&p.x, &p.y, &p.z};
                for (T* const one : x) *one = round(std::ldexp(lattice(2), (narrow ? 60 : 250) * (d.below(4) - 2)));
                break;
            }
            case places::borders_of_range: {
                T* const x[] = {&p.x, &p.y, &p.z};
                for (T* const one : x) *one = round((lattice(3) + lattice(2) * (narrow ? 0x1p-20 : 0x1p-40)) * border);
                break;
            }
            case places::turned_lattice: {
                const double u = lattice(3), v = lattice(3), w = d.below(3) == 0 ? 1 : 0;
                p.x = round(u * frame[0][0] + v * frame[1][0] + w * frame[2][0]);
                p.y = round(u * frame[0][1] + v * frame[1][1] + w * frame[2][1]);
                p.z = round(u * frame[0][2] + v * frame[1][2] + w * frame[2][2]);
                break;
            }
            case places::lost_differences: {  // in a plane, and seen along x on a line, but for what is rounded or flushed
                const double unit = narrow && is_subnormal ? 0x1p-126 : 1;
                const double v = narrow && is_subnormal ? lattice(4) / 4
                                 : d.below(2) == 0      ? lattice(2)
                                                        : lattice(7) * 0x1p-54;
                p = {round(lattice(3) * unit), round(v * unit), round(3 * v * unit)};
                break;
            }
            case places::signed_zeros: {
                p = scaled(1, 1);
                T* const x[] = {&p.x, &p.y, &p.z};
                for (T* const one : x) *one = *one == 0 && d.below(2) == 0 ? -*one : *one;
                break;
            }
        }
        points.push_back(p);
    }
    return points;
}

template <scalar T>
struct face_pair {
    detail::mesh_face<T> f, g;
};

/// Two faces over three to eight vertices, some of which may be in one place: of all ways in which they may share vertices,
/// and in all orders. One face in ten may name a vertex again. In one pair of eight, places count and not numbers.
template <scalar T>
face_pair<T> make_face_pair(places kind, std::uint64_t index) {
    draws d(20270115, 120 + static_cast<std::uint64_t>(kind), index);
    const int count = 3 + d.below(6);
    const std::vector<vec3<T>> points = draw_places<T>(d, kind, static_cast<std::size_t>(count));
    const bool by_place = d.below(8) == 0;
    const auto draw_face = [&] {
        int v[3];
        const bool may_repeat = d.below(10) == 0;
        do {
            for (int& x : v) x = d.below(count);
        } while (!may_repeat && (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]));
        detail::mesh_face<T> f{};
        f.corners = {points[static_cast<std::size_t>(v[0])], points[static_cast<std::size_t>(v[1])],
                     points[static_cast<std::size_t>(v[2])]};
        for (std::size_t k = 0; k < 3; ++k) {
            f.vertex[k] = by_place ? detail::mesh_face<T>::by_place : static_cast<std::uint32_t>(v[k]);
        }
        return f;
    };
    const auto f = draw_face();
    return {f, draw_face()};
}

}  // namespace abut::test
