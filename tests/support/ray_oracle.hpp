// SPDX-License-Identifier: MIT
#pragma once

// The oracle for rays and triangles, in rational numbers: when does a ray meet a triangle first? It is a linear program, to
// find the least t with
//     t d = l_a (a - o) + l_b (b - o) + l_c (c - o),   l_a + l_b + l_c = 1,   all of them 0 or more,
// and the least t is that of a basic solution: one whose columns, of those numbers that are not 0, are independent. All 15
// sets of columns are tried, by elimination. It shares no formula with the library, and knows nothing of sides or planes.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/shape/primitive.hpp>

#include "draws.hpp"
#include "rational.hpp"
#include "triangle_families.hpp"

namespace abut::test {

using rational = boost::multiprecision::cpp_rational;

namespace ray_program {

using column = std::array<integer, 4>;

/// The weights with which the columns add up to the last one, over one denominator, if those are independent and there are
/// such: by elimination in integers, of which each division leaves no remainder (Bareiss, 1968).
struct solution {
    std::vector<integer> numerators;
    integer denominator;
};
inline std::optional<solution> weights(std::vector<column> columns) {
    const std::size_t n = columns.size() - 1;
    std::vector<std::size_t> row_of;
    std::array<bool, 4> used{};
    integer before = 1;
    for (std::size_t j = 0; j < n; ++j) {
        std::size_t r = 0;
        while (r < 4 && (used[r] || columns[j][r] == 0)) ++r;
        if (r == 4) return std::nullopt;
        used[r] = true;
        row_of.push_back(r);
        const integer pivot = columns[j][r];
        for (std::size_t i = 0; i < 4; ++i) {
            if (i == r) continue;
            const integer factor = columns[j][i];
            for (column& c : columns) c[i] = (c[i] * pivot - factor * c[r]) / before;
        }
        before = pivot;
    }
    for (std::size_t i = 0; i < 4; ++i) {
        if (!used[i] && columns[n][i] != 0) return std::nullopt;
    }
    solution found{{}, before};
    for (std::size_t j = 0; j < n; ++j) found.numerators.push_back(columns[n][row_of[j]]);
    return found;
}

inline std::optional<rational> first_time(const integer_point& o, const std::array<integer_point, 3>& corners,
                                          const integer_point& d) {
    const std::array<column, 4> all{{{-d.x, -d.y, -d.z, 0},
                                     {corners[0].x - o.x, corners[0].y - o.y, corners[0].z - o.z, 1},
                                     {corners[1].x - o.x, corners[1].y - o.y, corners[1].z - o.z, 1},
                                     {corners[2].x - o.x, corners[2].y - o.y, corners[2].z - o.z, 1}}};
    std::optional<rational> least;
    for (unsigned set = 2; set < 16; ++set) {
        std::vector<column> columns;
        for (unsigned k = 0; k < 4; ++k) {
            if ((set >> k & 1) != 0) columns.push_back(all[k]);
        }
        columns.push_back({0, 0, 0, 1});
        const auto found = weights(columns);
        if (!found) continue;
        bool is_one = true;
        for (const integer& w : found->numerators) is_one = is_one && w.sign() * found->denominator.sign() >= 0;
        if (!is_one) continue;
        const rational t = (set & 1) != 0 ? rational(found->numerators.front()) / rational(found->denominator) : rational(0);
        if (!least || t < *least) least = t;
    }
    return least;
}

}  // namespace ray_program

/// The time at which origin + t (end - start) is first in the triangle, for t of 0 or more; no more than `last`.
template <scalar T>
std::optional<rational> first_time(const vec3<T>& origin, const vec3<T>& end, const vec3<T>& start, const triangle<T>& t,
                                   bool has_end = false) {
    const auto n = to_integers<T>({origin.x, origin.y, origin.z, t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y,
                                   t.c.z, end.x, end.y, end.z, start.x, start.y, start.z});
    const auto point = [&](std::size_t i) { return integer_point{n[i], n[i + 1], n[i + 2]}; };
    const integer_point d{n[12] - n[15], n[13] - n[16], n[14] - n[17]};
    auto found = ray_program::first_time(point(0), {point(3), point(6), point(9)}, d);
    if (has_end && found && *found > 1) found.reset();
    return found;
}
template <scalar T>
std::optional<rational> first_time(const ray<T>& r, const triangle<T>& t) {
    return first_time(r.origin, r.direction, vec3<T>{0, 0, 0}, t);
}
template <scalar T>
std::optional<rational> first_time(const segment<T>& s, const triangle<T>& t) {
    return first_time(s.a, s.b, s.a, t, true);
}

/// A double as it is.
inline rational exactly(double x) {
    int e = 0;
    const double m = std::frexp(x, &e);
    rational r(static_cast<std::int64_t>(std::ldexp(m, 53)));
    e -= 53;
    const boost::multiprecision::cpp_int power = boost::multiprecision::cpp_int(1) << (e < 0 ? -e : e);
    return e < 0 ? rational(r / power) : rational(r * power);
}
/// Whether x is the double that is nearest to t, and of two the lesser; or the largest one, if t is above it.
inline bool is_rounded(double x, const rational& t) {
    if (!(x >= 0) || std::isinf(x)) return false;
    const double next = std::nextafter(x, HUGE_VAL), before = std::nextafter(x, -1.0);
    if (!std::isinf(next) && 2 * t > exactly(x) + exactly(next)) return false;
    return x == 0 || 2 * t > exactly(before) + exactly(x);
}

/// A ray and a triangle of a family: the second triangle of a pair, and from a corner of the first a ray that goes along its
/// side, or is aimed at a corner, a side or the inside of the second, or away from it, or goes along the second's side.
template <scalar T>
struct ray_pair {
    ray<T> r;
    triangle<T> t;
};
template <scalar T>
ray_pair<T> make_ray_pair(std::uint64_t seed, triangle_family f, std::uint64_t index) {
    const triangle_pair<T> p = make_triangle_pair<T>(seed, f, index);
    draws d(seed + 1, static_cast<std::uint64_t>(f), index);
    const triangle<T> t = reordered(p.b, d.below(6));
    const auto way = [](const vec3<T>& from, const vec3<T>& to) {
        const auto one = [](T x, T y) { return std::isfinite(y - x) ? y - x : y / 2 - x / 2; };
        return vec3<T>{one(from.x, to.x), one(from.y, to.y), one(from.z, to.z)};
    };
    const auto middle = [](const vec3<T>& x, const vec3<T>& y) { return T(0.5) * x + T(0.5) * y; };
    const vec3<T> inside = middle(middle(t.a, t.b), t.c), o = p.a.a;
    switch (d.below(8)) {
        case 0: return {{o, way(o, p.a.b)}, t};
        case 1: return {{o, way(o, t.a)}, t};
        case 2: return {{o, way(o, middle(t.a, t.b))}, t};
        case 3: return {{o, way(inside, o)}, t};
        case 4: return {{o, way(t.a, t.b)}, t};
        case 5: return {{middle(t.a, t.b), way(t.a, t.c)}, t};
        default: return {{o, way(o, inside)}, t};
    }
}

}  // namespace abut::test
