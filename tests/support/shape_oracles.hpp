// SPDX-License-Identifier: MIT
#pragma once

// The oracles for a triangle against a box, a plane and a capsule, in unbounded integers. None shares a formula with the
// library: boxes are hulls of eight points and go to the linear program of hulls.hpp; heights over a plane are fractions of
// the input's own exponents; for a capsule the six differences of corners and ends span a polytope, whose point nearest to
// the origin is found by trying supports and checking the Karush-Kuhn-Tucker conditions, on their Gram matrix alone.

#include <cstddef>
#include <stdexcept>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/shape/primitive.hpp>

#include "hulls.hpp"
#include "rational.hpp"

namespace abut::test {

/// The square of the distance between the origin and the hull of some points, as a fraction.
struct squared_distance {
    integer numerator, denominator;
};

/// Of as many points as you like, in any position.
///
/// x = sum of u_i w_i / d with u_i >= 0, sum of u_i = d > 0 is the nearest point if and only if x . w_j >= x . x for all j.
/// Some nearest point has a support of at most three affinely independent points, or four if it is the origin itself
/// (Caratheodory). In the affine hull of a support the nearest point has u = adj(G) 1, with G the Gram matrix of the
/// support, d = 1 . u, and x . x = det G / d.
inline squared_distance distance_to_hull(const std::vector<integer_point>& w) {
    const std::size_t n = w.size();
    std::vector<std::vector<integer>> g(n, std::vector<integer>(n));
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i; j < n; ++j) g[i][j] = g[j][i] = inner(w[i], w[j]);
    }
    for (std::size_t i = 0; i < n; ++i) {
        bool optimal = true;
        for (std::size_t k = 0; k < n && optimal; ++k) optimal = g[i][k] >= g[i][i];
        if (optimal) return {g[i][i], 1};
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            const integer u = g[j][j] - g[i][j], v = g[i][i] - g[i][j], d = u + v;
            if (d == 0 || u < 0 || v < 0) continue;
            const integer gram = g[i][i] * g[j][j] - g[i][j] * g[i][j];
            bool optimal = true;
            for (std::size_t k = 0; k < n && optimal; ++k) optimal = u * g[i][k] + v * g[j][k] >= gram;
            if (optimal) return {gram, d};
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            for (std::size_t k = j + 1; k < n; ++k) {
                const integer ii = g[j][j] * g[k][k] - g[j][k] * g[j][k], ij = g[i][k] * g[j][k] - g[i][j] * g[k][k],
                              ik = g[i][j] * g[j][k] - g[i][k] * g[j][j];
                const integer u = ii + ij + ik;
                if (u < 0) continue;
                const integer jj = g[i][i] * g[k][k] - g[i][k] * g[i][k], jk = g[i][j] * g[i][k] - g[i][i] * g[j][k];
                const integer v = ij + jj + jk;
                if (v < 0) continue;
                const integer t = ik + jk + g[i][i] * g[j][j] - g[i][j] * g[i][j], d = u + v + t;
                if (t < 0 || d == 0) continue;
                const integer gram = g[i][i] * ii + g[i][j] * ij + g[i][k] * ik;
                bool optimal = true;
                for (std::size_t m = 0; m < n && optimal; ++m) optimal = u * g[i][m] + v * g[j][m] + t * g[k][m] >= gram;
                if (optimal) return {gram, d};
            }
        }
    }
    // Four points around the origin: the signs of the tetrahedra that it makes with their faces.
    const auto volume = [&](std::size_t i, std::size_t j, std::size_t k) -> integer {
        const integer_point &p = w[i], &q = w[j], &r = w[k];
        return p.x * (q.y * r.z - q.z * r.y) - p.y * (q.x * r.z - q.z * r.x) + p.z * (q.x * r.y - q.y * r.x);
    };
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            for (std::size_t k = j + 1; k < n; ++k) {
                for (std::size_t m = k + 1; m < n; ++m) {
                    const int a = volume(j, k, m).sign(), b = -volume(i, k, m).sign(), c = volume(i, j, m).sign(),
                              d = -volume(i, j, k).sign();
                    if (a != 0 && a == b && a == c && a == d) return {0, 1};
                }
            }
        }
    }
    throw std::logic_error("distance_to_hull: no support is optimal");
}

namespace oracle {

template <scalar T>
bool intersects(const aabb<T>& box, const triangle<T>& t) {
    std::vector<vec3<T>> corners;
    for (int i = 0; i < 8; ++i) {
        corners.push_back({i % 2 == 0 ? box.lower.x : box.upper.x, i / 2 % 2 == 0 ? box.lower.y : box.upper.y,
                           i / 4 == 0 ? box.lower.z : box.upper.z});
    }
    return hulls_intersect<T>(corners, {t.a, t.b, t.c});
}

/// Some corner with normal . x <= offset, and some with normal . x >= offset.
template <scalar T>
bool intersects(const plane<T>& p, const triangle<T>& t) {
    using boost::multiprecision::cpp_rational;
    const auto exactly = [](T x) { return cpp_rational(static_cast<double>(x)); };
    const cpp_rational offset = exactly(p.offset);
    bool below = false, above = false;
    const vec3<T> corners[] = {t.a, t.b, t.c};  // nvcc takes no list in a loop of a template
    for (const vec3<T>& v : corners) {
        const cpp_rational height =
            exactly(v.z) * exactly(p.normal.z) + exactly(v.y) * exactly(p.normal.y) + exactly(v.x) * exactly(p.normal.x);
        below = below || height <= offset;
        above = above || height >= offset;
    }
    return below && above;
}

template <scalar T>
bool intersects(const capsule<T>& s, const triangle<T>& t) {
    std::vector<T> values;
    const vec3<T> points[] = {s.axis.a, s.axis.b, t.a, t.b, t.c};
    for (const vec3<T>& v : points) values.insert(values.end(), {v.x, v.y, v.z});
    values.push_back(s.radius);
    const std::vector<integer> v = to_integers(values);
    std::vector<integer_point> w;
    for (std::size_t i = 6; i < 15; i += 3) {
        for (std::size_t j = 0; j < 6; j += 3) w.push_back({v[i] - v[j], v[i + 1] - v[j + 1], v[i + 2] - v[j + 2]});
    }
    const auto [numerator, denominator] = distance_to_hull(w);
    return numerator <= v[15] * v[15] * denominator;
}

}  // namespace oracle

}  // namespace abut::test
