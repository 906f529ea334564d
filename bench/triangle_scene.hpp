// SPDX-License-Identifier: MIT
#pragma once

// The triangles of bench/triangles.cpp, its peers and bench/triangles.cu. Number i of a scene is a pure function of i, and
// the same bits on hosts and devices (tests/support/draws.hpp says how).

#include <cstddef>
#include <cstdint>

#include <abut/predicate/intersects.hpp>
#include <abut/shape/primitive.hpp>

#include "../tests/support/draws.hpp"
#include "../tests/support/triangle_families.hpp"

namespace triangle_scene {

using abut::test::draws;
using abut::test::triangle_pair;
using abut::test::construction::along;
using abut::test::construction::cube;
using abut::test::construction::point;

inline constexpr std::uint64_t seed = 2012;

/// Corners uniform in a cube of half side `size`, then moved so that their mean is at `center`.
template <abut::scalar T>
ABUT_HD abut::triangle<T> triangle_around(draws& d, const point& center, double size) {
    const point a = cube(d, size), b = cube(d, size), c = cube(d, size), to = along(center, -1.0 / 3, a + b + c);
    using abut::test::construction::round_to;
    return {round_to<T>(a + to), round_to<T>(b + to), round_to<T>(c + to)};
}

/// Centers are uniform in a cube of half side `spread`: the smaller it is, the more triangles touch.
struct hit_share {
    const char* percent;
    double spread;
};

// --- pairs: two triangles of one size, both new in each pair --------------------------------------------------------------

/// For one processor: more than a branch predictor can learn by heart.
inline constexpr std::uint64_t pair_count = 1 << 16;
inline constexpr hit_share pair_shares[] = {{"1", 2.282}, {"1.7", 1.8756}, {"20", 0.676}, {"50", 0.3778}};

template <abut::scalar T>
ABUT_HD triangle_pair<T> random_pair(double spread, std::uint64_t i) {
    draws d(seed, 1, i);
    const point p = cube(d, spread);
    const auto a = triangle_around<T>(d, p, 1);
    const point q = cube(d, spread);
    return {a, triangle_around<T>(d, q, 1)};
}

// --- one against many -----------------------------------------------------------------------------------------------------

template <abut::scalar T>
ABUT_HD constexpr abut::triangle<T> reference() {
    return {{T(-0.3), T(-0.2), T(0.1)}, {T(0.4), T(-0.1), T(-0.2)}, {T(0.05), T(0.35), T(0.15)}};
}

/// How many, up to that of Maffina, 2012.
inline constexpr std::size_t most_triangles = 35'000'000;
inline constexpr std::size_t one_sizes[] = {10'000,    30'000,     100'000,    300'000,       1'000'000,
                                            3'000'000, 10'000'000, 20'000'000, most_triangles};

inline constexpr hit_share one_shares[] = {{"1", 1.1154}, {"50", 0.2518}};

/// One of many triangles; `stream` gives other triangles, for a second side.
template <abut::scalar T>
ABUT_HD abut::triangle<T> random_triangle(double spread, std::uint64_t i, std::uint64_t stream = 2) {
    draws d(seed, stream, i);
    const point center = cube(d, spread);
    return triangle_around<T>(d, center, 0.35);
}

/// The scene of 1 % hits, where those that touch the reference are moved out of its way: as much to read and nearly as
/// much to decide, and no hit.
template <abut::scalar T>
ABUT_HD abut::triangle<T> missing_triangle(std::uint64_t i) {
    const auto t = random_triangle<T>(one_shares[0].spread, i);
    const abut::vec3<T> away{T(4), T(0), T(0)};
    return abut::intersects(reference<T>(), t) ? abut::triangle<T>{t.a + away, t.b + away, t.c + away} : t;
}

// --- many against many ----------------------------------------------------------------------------------------------------

inline constexpr double many_spread = 4;
inline constexpr std::uint64_t stream_of_a = 3, stream_of_b = 4;

}  // namespace triangle_scene
