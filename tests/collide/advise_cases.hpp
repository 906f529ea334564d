// SPDX-License-Identifier: MIT
#pragma once

// `advise`, on any policy: what it says of sets whose numbers are known, and that `fast` is `exact` where it says so.

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"

namespace abut::test {

/// How far coordinates on a grid may be apart, in its units, so that `fast` rounds nothing: the largest E with 3 E^3 or 3
/// E^2 at most 2^24 or 2^53.
template <class T>
inline constexpr std::int64_t proven_extent_3 = std::same_as<T, float> ? 177 : 144263;
template <class T>
inline constexpr std::int64_t proven_extent_2 = std::same_as<T, float> ? 2364 : 54794158;

/// 0 to most.
inline std::int64_t up_to(draws& d, std::int64_t most) {
    return static_cast<std::int64_t>(d.bits() % (static_cast<std::uint64_t>(most) + 1));
}

/// Triangles on a grid in a cube of `extent` units, of which some fill it, many are degenerate, and many touch others:
/// corners are on sides of the triangle before, or in it.
template <class T>
std::vector<triangle<T>> triangles_on_grid(std::uint64_t seed, std::size_t n, std::int64_t extent, double unit,
                                           double shift) {
    draws d(20261123, 300, seed);
    using cell = std::array<std::int64_t, 3>;
    const auto coordinate = [&] {
        const int kind = d.below(4);
        return kind == 0 ? std::int64_t{0} : kind == 1 ? extent : up_to(d, extent);
    };
    const auto anywhere = [&] { return cell{coordinate(), coordinate(), coordinate()}; };
    std::vector<std::array<cell, 3>> all;
    while (all.size() < n) {
        std::array<cell, 3> t{anywhere(), anywhere(), anywhere()};
        if (!all.empty() && d.below(2) == 0) {
            // A corner halfway between two of the one before, or two such, or between that and the third.
            const auto& last = all.back();
            const auto i = static_cast<std::size_t>(d.below(3));
            const auto between = [](const cell& a, const cell& b) {
                cell c;
                for (std::size_t k = 0; k < 3; ++k) c[k] = (a[k] + b[k]) / 2;
                return c;
            };
            t[0] = between(last[i], last[(i + 1) % 3]);
            if (d.below(2) == 0) t[0] = between(t[0], last[(i + 2) % 3]);
            if (d.below(3) == 0) t[1] = last[(i + 2) % 3];
        }
        for (auto& corner : t) {  // even, so that what is halfway is on the grid
            for (auto& x : corner) x -= d.below(4) == 0 ? 0 : x % 2;
        }
        all.push_back(t);
    }
    all.front() = {cell{0, 0, 0}, cell{extent, 0, extent}, cell{0, extent, extent}};
    std::vector<triangle<T>> made;
    const auto point = [&](const cell& c) {
        const auto x = [&](std::int64_t k) { return static_cast<T>((static_cast<double>(k) + shift) * unit); };
        return vec3<T>{x(c[0]), x(c[1]), x(c[2])};
    };
    for (const auto& t : all) made.push_back({point(t[0]), point(t[1]), point(t[2])});
    return made;
}

/// How many pairs `fast` decides otherwise than `exact`.
template <class Policy, class A, class B>
std::size_t wrong_pairs(const Policy& on, const A& a, const B& b) {
    const auto found = to_host(pairs<fast>(on, a, b)), right = to_host(pairs<exact>(on, a, b));
    std::size_t same = 0, i = 0, j = 0;
    while (i < found.size() && j < right.size()) {
        if (found[i] == right[j])
            ++same, ++i, ++j;
        else if (found[i] < right[j])
            ++i;
        else
            ++j;
    }
    return found.size() + right.size() - 2 * same;
}

template <class T, class Policy>
void check_advice_of_triangles(const Policy& on) {
    constexpr std::int64_t most = proven_extent_3<T>;
    // 3 * exponent has to be that of a normal number, and 2^digits times that finite.
    constexpr int digits = std::numeric_limits<T>::digits;
    constexpr int least = -((1 - std::numeric_limits<T>::min_exponent) / 3),
                  greatest = (std::numeric_limits<T>::max_exponent - 1 - digits) / 3;
    std::uint64_t seed = 0;
    for (const int exponent : {least, -3, 0, 7, greatest}) {
        for (const double shift : {0.0, -70.0, 5000.0}) {
            CAPTURE(exponent, shift);
            const double unit = std::ldexp(1.0, exponent);
            const triangle_soup<T> a(triangles_on_grid<T>(++seed, 120, most, unit, shift));
            const triangle_soup<T> b(triangles_on_grid<T>(++seed, 120, most, unit, shift));
            const advice said = advise(on, a, b);
            CHECK(said.fast_is_exact);
            CHECK(said.grid_exponent == exponent);
            CHECK(said.grid_extent == static_cast<double>(most));
            CHECK(wrong_pairs(on, a, b) == 0);
            std::vector<segment<T>> sides;
            for (const auto& t : triangles_on_grid<T>(++seed, 120, most, unit, shift)) sides.push_back({t.a, t.b});
            const segments<T> c(sides);
            CHECK(advise(on, c, a).fast_is_exact);
            CHECK(wrong_pairs(on, c, a) == 0);
            CHECK_FALSE(advise(on, c).fast_is_exact);  // segments do not meet segments
        }
    }
    const auto says = [&](std::int64_t extent, int exponent) {
        return advise(on, triangle_soup<T>(triangles_on_grid<T>(1, 50, extent, std::ldexp(1.0, exponent), 0))).fast_is_exact;
    };
    CHECK(says(most, 0));
    CHECK_FALSE(says(most + 1, 0));
    CHECK_FALSE(says(most, least - 1));
    CHECK_FALSE(says(most, greatest + 1));
    // What is said no of goes wrong further out.
    const triangle_soup<T> large(triangles_on_grid<T>(2, 300, most * most, 1, 0));
    CHECK_FALSE(advise(on, large).fast_is_exact);
    CHECK(wrong_pairs(on, large, large) > 0);
    // Two grids, each fine by itself.
    const triangle_soup<T> fine(triangles_on_grid<T>(3, 50, most, 1, 0)), finer(triangles_on_grid<T>(3, 50, most, 0.5, 0));
    CHECK(advise(on, fine).fast_is_exact);
    CHECK(advise(on, finer).fast_is_exact);
    CHECK_FALSE(advise(on, fine, finer).fast_is_exact);
}

template <class T>
std::vector<sphere<T>> spheres_on_grid(std::uint64_t seed, std::size_t n, std::int64_t extent, std::int64_t radius,
                                       double unit) {
    draws d(20261123, 301, seed);
    const auto below = [&](std::int64_t limit) { return static_cast<double>(up_to(d, limit)) * unit; };
    std::vector<sphere<T>> made{{{0, 0, 0}, static_cast<T>(static_cast<double>(radius) * unit)},
                                {{static_cast<T>(static_cast<double>(extent) * unit), 0, 0}, static_cast<T>(unit)}};
    while (made.size() < n) {
        // Pythagorean distances from the one before: tangent where radii fit.
        const vec3<T> c{static_cast<T>(below(extent)), static_cast<T>(below(extent)), static_cast<T>(below(extent))};
        const std::int64_t r = up_to(d, radius - 1);
        made.push_back({c, static_cast<T>(static_cast<double>(r) * unit)});
        const std::int64_t k = 1 + up_to(d, radius / 8);
        const double x = static_cast<double>(c.x) + 3 * static_cast<double>(k) * unit;
        const double y = static_cast<double>(c.y) + 4 * static_cast<double>(k) * unit;
        if (x > static_cast<double>(extent) * unit || y > static_cast<double>(extent) * unit || r > 5 * k ||
            5 * k - r > radius)
            continue;
        made.push_back({{static_cast<T>(x), static_cast<T>(y), c.z}, static_cast<T>(static_cast<double>(5 * k - r) * unit)});
    }
    return made;
}

template <class T, class Policy>
void check_advice_of_spheres(const Policy& on) {
    constexpr std::int64_t most = proven_extent_2<T>, radius = std::int64_t{1} << (std::numeric_limits<T>::digits / 2 - 1);
    for (const int exponent : {-63, -2, 0, 9, 51}) {
        CAPTURE(exponent);
        const double unit = std::ldexp(1.0, exponent);
        const spheres<T> a(spheres_on_grid<T>(1, 200, most, radius, unit)),
            b(spheres_on_grid<T>(2, 200, most, radius, unit));
        const advice said = advise(on, a, b);
        CHECK(said.fast_is_exact);
        CHECK_FALSE(said.equal_radii);
        CHECK(wrong_pairs(on, a, b) == 0);
    }
    const auto says = [&](std::int64_t extent, std::int64_t r) {
        return advise(on, spheres<T>(spheres_on_grid<T>(3, 50, extent, r, 1))).fast_is_exact;
    };
    CHECK(says(most, radius));
    CHECK_FALSE(says(most + 1, radius));
    CHECK_FALSE(says(most, radius + 1));
    const spheres<T> large(spheres_on_grid<T>(4, 400, most * 4096, radius * 4096 - 1, 1));
    CHECK_FALSE(advise(on, large).fast_is_exact);
    CHECK(wrong_pairs(on, large, large) > 0);
    const spheres<T> same({{{0, 0, 0}, 2}, {{1, 0, 5}, 2}}), other({{{0, 0, 0}, 3}});
    const triangle_soup<T> soup(triangles_on_grid<T>(5, 20, 10, 1, 0));
    CHECK(advise(on, same).equal_radii);
    CHECK(advise(on, same, other).equal_radii);  // of each set
    CHECK(advise(on, soup, same).equal_radii);
    CHECK_FALSE(advise(on, soup).equal_radii);
    CHECK_FALSE(advise(on, spheres<T>()).equal_radii);
    CHECK_FALSE(advise(on, soup, same).fast_is_exact);  // nothing is proven of a sphere and a triangle
    CHECK(advise(on, equal_spheres<T>({{0, 0, 0}, {1, 2, 3}}, 1)).equal_radii);
}

template <class Policy>
void check_advice_of_floats(const Policy& on) {
    const auto says = [&](double x) { return advise(on, points<double>({{0, 1, -x}, {-5, 0.25, 0}})).floats_suffice; };
    for (const double x : {0.0, -0.0, 1 / 3.0f + 0.0, 0x1p-149, 0x1.fffffep127, 0x1p127, 0x1.8p-148, -0x1.000002p-126}) {
        CAPTURE(x);
        CHECK(says(x));
    }
    for (const double x : {0.1, 0x1p-150, 0x1.8p-149, 0x1p128, 0x1.ffffffp127, 0x1.000001p0, 0x1p-1074, 0x1.000001p-126}) {
        CAPTURE(x);
        CHECK_FALSE(says(x));
    }
    CHECK(advise(on, points<float>({{0, 1, 0.1f}})).floats_suffice);
    const aabb<double> box{{0, 0, 0}, {1, 1, 1}};
    CHECK(advise(on, box).floats_suffice);
    CHECK_FALSE(advise(on, box).fast_is_exact);
    CHECK_FALSE(advise(on, capsule<double>{{{0, 0, 0}, {1, 1, 1}}, 0.1}).floats_suffice);
    // Nothing, and nothing but 0.
    const advice none = advise(on, triangle_soup<double>()), zero = advise(on, triangle<double>{});
    for (const advice& said : {none, zero}) {
        CHECK((said.fast_is_exact && said.floats_suffice && said.grid_exponent == 0 && said.grid_extent == 0));
    }
    const advice widest = advise(on, points<double>({{-0x1p1023, 0, 0}, {0x1p1023, 0, 0x1p-1074}}));
    CHECK(widest.grid_exponent == -1074);
    CHECK(std::isinf(widest.grid_extent));
}

/// What another policy says is said here too.
template <class T, class Policy>
void check_same_advice(const Policy& on) {
    const auto same = [](const advice& a, const advice& b) {
        CHECK(a.fast_is_exact == b.fast_is_exact);
        CHECK(a.floats_suffice == b.floats_suffice);
        CHECK(a.equal_radii == b.equal_radii);
        CHECK(a.grid_exponent == b.grid_exponent);
        CHECK(a.grid_extent == b.grid_extent);
    };
    for (const std::int64_t extent : {proven_extent_3<T>, 4 * proven_extent_3<T>}) {
        const triangle_soup<T> a(triangles_on_grid<T>(11, 3000, extent, 0.25, 7)),
            b(triangles_on_grid<T>(12, 10, extent, 1, 0));
        const spheres<T> c(spheres_on_grid<T>(13, 2000, extent, 20, 0.5));
        same(advise(on, a), advise(serial{}, a));
        same(advise(on, a, b), advise(serial{}, a, b));
        same(advise(on, c, c.copied_to(on)), advise(serial{}, c));
        same(advise(on, c, b), advise(serial{}, c, b));
    }
}

template <class Policy>
void check_all_advice(const Policy& on) {
    check_advice_of_triangles<float>(on);
    check_advice_of_triangles<double>(on);
    check_advice_of_spheres<float>(on);
    check_advice_of_spheres<double>(on);
    check_advice_of_floats(on);
    check_same_advice<float>(on);
    check_same_advice<double>(on);
}

}  // namespace abut::test
