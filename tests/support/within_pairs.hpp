// SPDX-License-Identifier: MIT
#pragma once

// Pairs of shapes and distances to compare theirs with, and the oracle that says what is right: the least double that the
// distance of a pair does not exceed, in unbounded integers. It shares no formula with the library: differences of corners
// span a polytope, whose point nearest to the origin is found on their Gram matrix alone (shape_oracles.hpp).

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <type_traits>
#include <vector>

#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

#include "draws.hpp"
#include "rational.hpp"
#include "shape_oracles.hpp"
#include "triangle_families.hpp"

namespace abut::test {

/// Of what is around which there may be a radius: a hull, or a box.
template <class S>
std::vector<vec3<scalar_type_of<S>>> corners_of(const S& s) {
    const auto core = detail::core_of(s);
    if constexpr (std::same_as<std::remove_cvref_t<decltype(core)>, aabb<scalar_type_of<S>>>) {
        std::vector<vec3<scalar_type_of<S>>> corners;
        for (int i = 0; i < 8; ++i) {
            corners.push_back({i % 2 == 0 ? s.lower.x : s.upper.x, i / 2 % 2 == 0 ? s.lower.y : s.upper.y,
                               i / 4 == 0 ? s.lower.z : s.upper.z});
        }
        return corners;
    } else {
        return {std::begin(core.at), std::end(core.at)};
    }
}

template <scalar T>
std::vector<vec3<T>> corners_of(const hull<T>& h) {
    std::vector<vec3<T>> corners;
    for (std::size_t i = 0; i < h.count; ++i) corners.push_back(h[i]);
    return corners;
}

/// The distance of two shapes, less their radii, in a unit of 2^-shift.
class exact_gap {
public:
    template <class S, class U>
    exact_gap(const S& s, const U& t) {
        const auto a = corners_of(s);
        const auto b = corners_of(t);
        std::vector<double> values;
        const auto add = [&values](const auto& corners) {
            for (const auto& p : corners) {
                values.insert(values.end(),
                              {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
            }
        };
        add(a);
        add(b);
        values.push_back(static_cast<double>(detail::radius_around_core(s)));
        values.push_back(static_cast<double>(detail::radius_around_core(t)));
        values.push_back(1);  // which tells the unit
        const std::vector<integer> v = to_integers(values);
        std::vector<integer_point> ways;
        const std::size_t n = a.size(), m = b.size();
        for (std::size_t i = 0; i < 3 * n; i += 3) {
            for (std::size_t j = 3 * n; j < 3 * (n + m); j += 3) {
                ways.push_back({v[j] - v[i], v[j + 1] - v[i + 1], v[j + 2] - v[i + 2]});
            }
        }
        square_ = distance_to_hull(ways);
        radii_ = v[3 * (n + m)] + v[3 * (n + m) + 1];
        shift_ = static_cast<int>(msb(v.back()));
    }

    /// The sign of the distance less d >= 0.
    [[nodiscard]] int compared_with(double d) const {
        int e = 0;
        auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(d, &e), 53));
        e += shift_ - 53;
        const int finer = e < 0 ? -e : 0;
        integer radius = mantissa, radii = radii_, numerator = square_.numerator;
        radius <<= e < 0 ? 0 : e;
        radii <<= finer;
        numerator <<= 2 * finer;
        radius += radii;
        return integer(numerator - radius * radius * square_.denominator).sign();
    }
    /// The least double that the distance does not exceed; infinite if there is none.
    [[nodiscard]] double least_double() const {
        std::uint64_t low = 0, high = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());
        while (low < high) {
            const std::uint64_t middle = low + (high - low) / 2;
            if (compared_with(std::bit_cast<double>(middle)) <= 0) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        return std::bit_cast<double>(low);
    }

private:
    squared_distance square_{};
    integer radii_;
    int shift_ = 0;
};

namespace construction {

/// Two triangles whose distance is a whole number times a power of two, with the nearest features of any kind. All corners
/// of one are on one side of a plane with the normal n, all of the other beyond a parallel plane; |n| is whole. Each has
/// one, two or three corners in its plane, around two points that n joins.
template <scalar T>
triangle_pair<T> at_whole_distance(draws& d) {
    struct whole {
        int x, y, z;
    };
    // A normal of whole length, and two vectors that are orthogonal to it.
    constexpr whole frames[][3] = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{1, 2, 2}, {2, -1, 0}, {0, 1, -1}},
                                   {{2, 3, 6}, {3, -2, 0}, {0, 2, -1}}, {{2, 6, 9}, {3, -1, 0}, {0, 3, -2}},
                                   {{6, 6, 7}, {1, -1, 0}, {0, 7, -6}}, {{1, 4, 8}, {4, -1, 0}, {0, 2, -1}}};
    const auto& frame = frames[d.below(6)];
    const whole n = frame[0], u = frame[1], v = frame[2];
    const int away = d.below(5), shift = d.below(3) == 0 ? 1 << 15 : 0, e = d.below(4) == 0 ? d.below(200) - 148 : 0;
    const auto place = [&](int along_u, int along_v, int along_n) {
        const auto at = [&](int nn, int uu, int vv) {
            return static_cast<T>(std::ldexp(along_u * uu + along_v * vv + along_n * nn + shift, e));
        };
        return vec3<T>{at(n.x, u.x, v.x), at(n.y, u.y, v.y), at(n.z, u.z, v.z)};
    };
    const auto hull = [&](int from, int side) {
        // (2i, 2j), or around that.
        const int in_plane = d.below(3), i = d.below(3) - 1, j = d.below(3) - 1;
        const int a = in_plane == 2 ? 1 + d.below(3) : i, b = in_plane == 2 ? d.below(3) - 1 : j;
        const int up1 = in_plane > 0 ? 0 : 1 + d.below(3), up2 = in_plane > 1 ? 0 : 1 + d.below(3);
        vec3<T> corners[3] = {place(in_plane == 0 ? 0 : -a, in_plane == 0 ? 0 : -b, from),
                              place(in_plane == 0 ? d.below(9) - 4 : a, in_plane == 0 ? d.below(9) - 4 : b, from + side * up1),
                              place(d.below(9) - 4, d.below(9) - 4, from + side * up2)};
        if (in_plane == 2) corners[2] = place(d.below(3) - 1, 1 + d.below(4), from);
        return triangle<T>{corners[0], corners[1], corners[2]};
    };
    const triangle<T> s = hull(0, -1), t = hull(away, 1);
    const int order = d.below(36);
    return {reordered(s, order % 6), reordered(t, order / 6)};
}

}  // namespace construction

/// A sphere, a capsule and a triangle of the corners that a family has for a triangle.
template <scalar T>
struct round_shapes {
    sphere<T> ball;
    capsule<T> rod;
    triangle<T> flat;
};
template <scalar T>
struct round_pair {
    round_shapes<T> a, b;
};

/// The families of triangles, and behind them pairs at whole distances.
inline constexpr int within_family_count = triangle_family_count + 1;

template <scalar T>
round_pair<T> make_round_pair(std::uint64_t seed, int family, std::uint64_t index) {
    draws d(seed, 7700 + static_cast<std::uint64_t>(family), index);
    const bool whole = family == triangle_family_count;
    const triangle_pair<T> p = whole ? construction::at_whole_distance<T>(d)
                                     : make_triangle_pair<T>(seed, static_cast<triangle_family>(family), index);
    const auto radius = [&](const vec3<T>& q) {
        const T r = q.x < 0 ? -q.x : q.x;
        const int kind = d.below(4);
        return kind == 0 ? T(0) : kind == 1 ? r : kind == 2 ? r / 4 : r / 1024;
    };
    const T ra = radius(p.b.a), rb = radius(p.a.b);
    return {{{p.a.a, ra}, {{p.a.a, p.a.b}, ra}, p.a}, {{p.b.c, rb}, {{p.b.b, p.b.c}, rb}, p.b}};
}

/// Calls f(shape of a, shape of b): all kinds of pairs by turns.
template <scalar T, class F>
void with_shapes(const round_pair<T>& p, std::uint64_t kind, const F& f) {
    switch (kind % 6) {
        case 0: return f(p.a.flat, p.b.flat);
        case 1: return f(p.a.ball, p.b.flat);
        case 2: return f(p.a.rod, p.b.flat);
        case 3: return f(p.a.rod, p.b.rod);
        case 4: return f(p.a.ball, p.b.rod);
        default: return f(p.a.ball, p.b.ball);
    }
}

/// A distance to ask about, given the least one that is enough: that, or a step or two away from it, half of it and twice
/// it, none, and the least and the greatest numbers.
inline double distance_near(double least, std::uint64_t kind) {
    const double most = std::numeric_limits<double>::max();
    const auto step = [](double x, double to) { return std::nextafter(x, to); };
    const double at = std::fmin(least, most);
    switch (kind % 12) {
        case 0:
        case 1: return at;
        case 2:
        case 3:
        case 4: return step(at, 0);
        case 5: return step(step(at, 0), 0);
        case 6: return step(at, most);
        case 7: return at / 2;
        case 8: return at <= most / 2 ? 2 * at : most;
        case 9: return 0;
        case 10: return std::numeric_limits<double>::denorm_min();
        default: return at * (1 - 0x1p-24);
    }
}

}  // namespace abut::test
