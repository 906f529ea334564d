// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <cmath>
#include <cstdio>
#include <string>

#include "support/catch.hpp"
#include "support/common_parts.hpp"
#include "support/draws.hpp"

namespace abut::test {

constexpr std::uint64_t parts_seed = 20261202;

/// Worst figures: how far points are from the middle of the common part, in bounds, and how much farther they move than it.
struct parts_tally {
    int points = 0, moves = 0;
    double off = 0, ratio = 0;
};

/// A triangle of small integers, times a power of two: often with corners or edges in another one's plane, or flat.
template <scalar T>
triangle<T> lattice_triangle(draws& d, int half, int flat) {
    vec3<T> p[3];
    for (auto& v : p) {
        const auto coordinate = [&] { return static_cast<T>(d.below(2 * half + 1) - half); };
        v.x = coordinate();
        v.y = coordinate();
        v.z = coordinate();
        // The plane of (1, 2, 0) and (0, -3, 1): in one plane, and along no axis.
        if (flat != 0) v = {v.x, 2 * v.x - 3 * v.z, v.z};
    }
    return {p[0], p[1], p[2]};
}

template <scalar T>
triangle<T> shifted(const triangle<T>& t, const vec3<T>& by) {
    return {t.a + by, t.b + by, t.c + by};
}

/// A move that keeps every coordinate exact: 2^-k along an axis, a diagonal, or in the plane of flat ones.
template <scalar T>
vec3<T> exact_move(draws& d, int flat) {
    const T step = static_cast<T>(std::ldexp(1.0, -1 - d.below(sizeof(T) == 4 ? 16 : 44)));
    vec3<T> by;
    by.x = step * static_cast<T>(d.below(3) - 1);
    by.y = step * static_cast<T>(d.below(3) - 1);
    by.z = step * static_cast<T>(d.below(3) - 1);
    if (flat == 2) by.y = 2 * by.x - 3 * by.z;
    return by;
}

/// The point is the middle of the common part, and goes where that goes: no more than `farther` times as far as any part of
/// it does, and rounding.
template <scalar T>
void check_parts(const triangle<T>& s, const triangle<T>& t, const vec3<T>& by, parts_tally& tally) {
    constexpr double farther = 2, rounding = 1;
    const auto here = contact_of(s, t);
    if (!here) return;
    const wide bound = wide(contact_bound(s, t));
    const auto part = common_part(s, t);
    REQUIRE(!part.empty());
    const double off = static_cast<double>(length_of(widest(here->point) - middle_of(part)) / bound);
    ++tally.points;
    tally.off = std::max(tally.off, off);
    CHECK(off <= rounding);
    const triangle<T> moved = shifted(t, by);
    const auto there = contact_of(s, moved);
    if (!there) return;
    const wide most = distance_between(part, common_part(s, moved));
    const wide far = length_of(widest(there->point) - widest(here->point));
    ++tally.moves;
    if (most > rounding * bound) tally.ratio = std::max(tally.ratio, static_cast<double>(far / most));
    CHECK(far <= farther * most + 2 * rounding * bound);
}

TEMPLATE_TEST_CASE("a contact's point is the middle of what two triangles share, and moves as that does", "", float,
                   double) {
    using T = TestType;
    parts_tally tally;
    for (int flat = 0; flat < 3; ++flat) {  // 1: one plane, 2: moved in it
        for (std::uint64_t i = 0; i < 6000; ++i) {
            draws d(parts_seed, static_cast<std::uint64_t>(flat), i);
            const int half = 1 + d.below(4);
            const auto s = lattice_triangle<T>(d, half, flat), t = lattice_triangle<T>(d, half, flat);
            check_parts(s, t, exact_move<T>(d, flat), tally);
        }
    }
    std::printf("common parts: %d points, off by %.3f bounds; %d moves, %.2f times as far\n", tally.points, tally.off,
                tally.moves, tally.ratio);
    CHECK(tally.points > 6000);
    CHECK(tally.moves > 4000);
}

/// An edge of one lies in the other's plane, which is along no axis, and its ends inside. Near the origin, and small and far
/// from it.
TEMPLATE_TEST_CASE("the point of an edge that lies in the other triangle is its middle", "", float, double) {
    using T = TestType;
    parts_tally tally;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        draws d(parts_seed, 4, i);
        const bool small = d.below(2) == 1;
        const auto put = [&](const vec3<double>& p) -> vec3<T> {
            const double step = small ? 0x1p-16 : 1, shift = small ? 1 : 0;
            return {static_cast<T>(step * p.x + shift), static_cast<T>(step * p.y + shift),
                    static_cast<T>(step * p.z + shift)};
        };
        const auto corner = [&] {
            const auto one = [&] { return 4.0 * (d.below(15) - 7); };
            const double x = one(), y = one(), z = one();
            return vec3<double>{x, y, z};
        };
        const vec3<double> a = corner(), b = corner(), c = corner(), apex = corner();
        const auto inside = [&] {
            const int of_b = d.below(5), of_c = d.below(5 - of_b);
            return a + 0.25 * of_b * (b - a) + 0.25 * of_c * (c - a);
        };
        const vec3<double> p = inside(), q = inside();
        const triangle<T> s{put(a), put(b), put(c)}, t{put(p), put(q), put(apex)};
        const auto found = contact_of(s, t);
        if (has_zero_area(s) || has_zero_area(t) || !found) continue;
        const double off =
            static_cast<double>(length_of(widest(found->point) - middle_of(common_part(s, t))) / wide(contact_bound(s, t)));
        ++tally.points;
        tally.off = std::max(tally.off, off);
        CHECK(off <= 1);
    }
    std::printf("edges in triangles: %d points, off by %.3f bounds\n", tally.points, tally.off);
    CHECK(tally.points > 3000);
}

/// How far the corners of s are from the plane of t at most.
template <scalar T>
wide height_over(const triangle<T>& s, const triangle<T>& t) {
    const wide_point n = wide_normal(t);
    const auto height = [&](const vec3<T>& p) { return wide(abs(dot(n, widest(p) - widest(t.a)))); };
    return std::max({height(s.a), height(s.b), height(s.c)}) / length_of(n);
}

/// An edge of one crosses the other's plane at a small angle, so that small errors of heights would move the point far along
/// it. Small and far from the origin, as most triangles of a mesh are.
TEST_CASE("the point of an edge that hardly crosses the other triangle's plane") {
    parts_tally tally;
    for (std::uint64_t i = 0; i < 6000; ++i) {
        draws d(parts_seed, 5, i);
        const double size = std::ldexp(1.0, -12 + d.below(10));
        const auto rounded = [](const vec3<double>& p) -> vec3<float> {
            return {static_cast<float>(1.25 + p.x), static_cast<float>(1.25 + p.y), static_cast<float>(1.25 + p.z)};
        };
        const vec3<double> a = construction::cube(d, size), b = construction::cube(d, size), c = construction::cube(d, size);
        const vec3<double> up = construction::unit(cross(b - a, c - a));
        const auto beside = [&] {
            const double of_b = d.uniform(0.1, 0.4), of_c = d.uniform(0.1, 0.4);
            return a + of_b * (b - a) + of_c * (c - a);
        };
        const double shallow = std::ldexp(size, -2 - d.below(22));
        const vec3<double> p = beside() + shallow * d.uniform(0.5, 1) * up, q = beside() + -shallow * d.uniform(0.5, 1) * up;
        const vec3<double> apex = beside() + size * d.uniform(0.2, 1) * up;
        const triangle<float> s{rounded(a), rounded(b), rounded(c)}, t{rounded(p), rounded(q), rounded(apex)};
        const auto found = contact_of(s, t);
        const wide bound = wide(contact_bound(s, t));
        if (!found || std::min(height_over(s, t), height_over(t, s)) < bound / 2) continue;  // not all in one plane
        const double off = static_cast<double>(length_of(widest(found->point) - middle_of(common_part(s, t))) / bound);
        ++tally.points;
        tally.off = std::max(tally.off, off);
        CHECK(off <= 1);
    }
    std::printf("shallow edges: %d points, off by %.3f bounds\n", tally.points, tally.off);
    CHECK(tally.points > 3000);
}

/// What lies in one plane hardly does when it has been turned and rounded; the point is still the middle of the polygon.
/// Near the origin, and small and far from it.
TEMPLATE_TEST_CASE("the point of triangles in one plane, turned and rounded", "", float, double) {
    using T = TestType;
    parts_tally tally;
    int small_ones = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        draws d(parts_seed, 3, i);
        const bool small = i % 2 == 1;
        const auto s = lattice_triangle<double>(d, 4, 1), t = lattice_triangle<double>(d, 4, 1);
        const auto part = common_part(s, t);
        if (part.empty() || has_zero_area(s) || has_zero_area(t)) continue;
        const auto axis = construction::unit(construction::cube(d, 1));
        const wide angle = d.uniform(-3, 3), c = cos(angle), sine = sin(angle);
        const wide_point k = widest(axis);
        const auto turned = [&](const wide_point& p) -> wide_point {
            const wide_point there = c * p + sine * cross(k, p) + (1 - c) * dot(k, p) * k;
            return small ? wide(0x1p-10) * there + widest(vec3<double>{1, 1.5, -1.25}) : there;
        };
        const auto rounded = [&](const vec3<double>& p) -> vec3<T> {
            const wide_point q = turned(widest(p));
            return {static_cast<T>(q.x), static_cast<T>(q.y), static_cast<T>(q.z)};
        };
        const triangle<T> a{rounded(s.a), rounded(s.b), rounded(s.c)}, b{rounded(t.a), rounded(t.b), rounded(t.c)};
        const auto found = contact_of(a, b);
        const wide bound = wide(contact_bound(a, b));
        // Thin triangles may have turned farther than that.
        if (!found || std::min(height_over(a, b), height_over(b, a)) > bound / 8) continue;
        const double off = static_cast<double>(length_of(widest(found->point) - turned(middle_of(part))) / bound);
        ++tally.points;
        small_ones += small ? 1 : 0;
        tally.off = std::max(tally.off, off);
        CHECK(off <= 1);
    }
    std::printf("turned planes: %d points, off by %.3f bounds\n", tally.points, tally.off);
    CHECK(tally.points > 1000);
    CHECK(small_ones > 400);
}

/// Two triangles that share the segment from (0, 0, 0) to (1/2, 1/2, 0), and the same a little aside.
TEMPLATE_TEST_CASE("the point of a segment that ends at a corner stays where it is", "", float, double) {
    using T = TestType;
    const triangle<T> s{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, t{{0, 0, 1}, {1, 1, 0}, {0, 0, -1}};
    CHECK(contact_of(s, t)->point == vec3<T>{T(0.25), T(0.25), 0});
    for (const vec3<T>& by : {vec3<T>{T(0.001), 0, 0}, {0, T(0.001), 0}, {0, 0, T(0.001)}, {T(-0.001), 0, 0}}) {
        const auto moved = contact_of(s, shifted(t, by));
        REQUIRE(moved.has_value());
        CHECK(length_of(widest(moved->point) - wide_point{0.25, 0.25, 0}) < wide(0.002));
    }
}

}  // namespace abut::test
