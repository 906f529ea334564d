// SPDX-License-Identifier: MIT
#pragma once

// The oracle for balls against points, segments and triangles, in unbounded integers. It shares no formula with the library:
// the squared distance is the minimum of a convex quadratic over the barycentric weights, found by trying the supports of
// the weights and checking the Karush-Kuhn-Tucker conditions, on the Gram matrix of the corners alone.

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/arithmetic/wide_int.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::test {

using integer = boost::multiprecision::cpp_int;

/// An integer in the number type N, which must hold it. If that is int128, 64 bits must: under nvcc Boost 1.83 knows no
/// __int128.
template <class N>
N to_number(const integer& x) {
    if constexpr (std::same_as<N, int128>)
        return static_cast<std::int64_t>(x);
    else
        return static_cast<N>(x);
}

/// Finite numbers as integers of one unit, the largest power of two that divides them all.
template <scalar T>
std::vector<integer> to_integers(const std::vector<T>& values) {
    std::vector<std::int64_t> mantissa(values.size());
    std::vector<int> exponent(values.size());
    int low = 1 << 20;
    for (std::size_t i = 0; i < values.size(); ++i) {
        int e = 0;
        mantissa[i] = static_cast<std::int64_t>(std::ldexp(std::frexp(static_cast<double>(values[i]), &e), 53));
        exponent[i] = e - 53;
        if (mantissa[i] == 0) continue;
        const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa[i]));
        mantissa[i] >>= zeros;
        exponent[i] += zeros;
        low = exponent[i] < low ? exponent[i] : low;
    }
    std::vector<integer> r(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        r[i] = mantissa[i];
        if (mantissa[i] != 0) r[i] <<= exponent[i] - low;
    }
    return r;
}

struct integer_point {
    integer x, y, z;
};

inline integer inner(const integer_point& a, const integer_point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Whether the hull of `w` has a point within sqrt(squared_radius) of the origin.
inline bool hull_reaches(const std::vector<integer_point>& w, const integer& squared_radius) {
    const std::size_t n = w.size();
    std::vector<std::vector<integer>> g(n, std::vector<integer>(n));
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i; j < n; ++j) g[i][j] = g[j][i] = inner(w[i], w[j]);
    }
    // Support of one: x = w_i is the minimum if w_i . w_j >= w_i . w_i for all j.
    for (std::size_t i = 0; i < n; ++i) {
        bool optimal = true;
        for (std::size_t j = 0; j < n; ++j) optimal = optimal && g[i][j] >= g[i][i];
        if (optimal) return g[i][i] <= squared_radius;
    }
    // Support of two: x = (u w_i + v w_j) / d with x . w_i = x . w_j = (g_ii g_jj - g_ij^2) / d = |x|^2.
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            const integer u = g[j][j] - g[i][j], v = g[i][i] - g[i][j], d = u + v;
            if (d == 0 || u < 0 || v < 0) continue;
            const integer gram = g[i][i] * g[j][j] - g[i][j] * g[i][j];
            bool optimal = true;
            for (std::size_t k = 0; k < n; ++k) optimal = optimal && (k == i || k == j || u * g[i][k] + v * g[j][k] >= gram);
            if (optimal) return gram <= squared_radius * d;
        }
    }
    // Support of three: no smaller one was optimal, so the plane's foot is inside; |x|^2 = det g / (sum of its cofactors).
    const integer c00 = g[1][1] * g[2][2] - g[1][2] * g[1][2], c01 = g[0][2] * g[1][2] - g[0][1] * g[2][2],
                  c02 = g[0][1] * g[1][2] - g[0][2] * g[1][1], c11 = g[0][0] * g[2][2] - g[0][2] * g[0][2],
                  c12 = g[0][1] * g[0][2] - g[0][0] * g[1][2], c22 = g[0][0] * g[1][1] - g[0][1] * g[0][1];
    const integer determinant = g[0][0] * c00 + g[0][1] * c01 + g[0][2] * c02;
    return determinant <= squared_radius * (c00 + c11 + c22 + 2 * (c01 + c02 + c12));
}

namespace oracle {

template <scalar T>
bool ball_and_points(const vec3<T>& center, const std::vector<T>& radii, const std::vector<vec3<T>>& points) {
    std::vector<T> values{center.x, center.y, center.z};
    for (const vec3<T>& p : points) values.insert(values.end(), {p.x, p.y, p.z});
    values.insert(values.end(), radii.begin(), radii.end());
    const std::vector<integer> v = to_integers(values);
    std::vector<integer_point> w;
    for (std::size_t i = 1; i <= points.size(); ++i)
        w.push_back({v[3 * i] - v[0], v[3 * i + 1] - v[1], v[3 * i + 2] - v[2]});
    integer r = 0;
    for (std::size_t i = 3 * points.size() + 3; i < v.size(); ++i) r += v[i];
    return hull_reaches(w, r * r);
}

template <scalar T>
bool intersects(const sphere<T>& s, const triangle<T>& t) {
    return ball_and_points<T>(s.center, {s.radius}, {t.a, t.b, t.c});
}

template <scalar T>
bool intersects(const sphere<T>& s, const segment<T>& t) {
    return ball_and_points<T>(s.center, {s.radius}, {t.a, t.b});
}

template <scalar T>
bool intersects(const sphere<T>& s, const sphere<T>& t) {
    return ball_and_points<T>(s.center, {s.radius, t.radius}, {t.center});
}

}  // namespace oracle

}  // namespace abut::test
