// SPDX-License-Identifier: MIT
#include <abut/narrow/distance.hpp>

#include <cmath>
#include <cstdint>
#include <utility>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/revolution_gap.hpp"
#include "support/revolution_pairs.hpp"
#include "support/samples.hpp"

// Cylinders with each other, and with capsules. revolution_gap.hpp has the oracle.

namespace abut::test {

namespace {

constexpr std::uint64_t cylinder_seed = 20261127;

template <scalar T>
struct cylinder_pair {
    cylinder<T> a, b;
};

/// Two cylinders whose nearest points are of features that are drawn, a side, a rim or an end, at a distance down to 2^-50.
/// The normal may be orthogonal to either axis, or along it, but for an angle down to 2^-60; the axes may be in one plane.
template <scalar T>
cylinder_pair<T> facing_cylinders(std::uint64_t i) {
    using namespace construction;
    draws d(cylinder_seed, sizeof(T), i);
    const auto small = [&](int most) {
        const double m = d.uniform(0.5, 1);
        return std::ldexp(m, -d.below(most));
    };
    const auto angle = [&] {
        const int kind = d.below(5);
        const double off = d.below(3) == 0 ? small(60) : 0, right = std::acos(-1.0) / 2;
        return kind < 2 ? off : kind == 2 ? right - off : d.uniform(0, right);
    };
    const auto turned = [](double x, const point& u, double y, const point& v) {
        return along(along({0, 0, 0}, x, u), y, v);
    };
    struct body {
        double height, radius;
        point first_from_foot, axis;
    };
    const auto draw = [&](double phi, const point& axis, const point& out) {
        body s{};
        s.height = d.below(3) == 0 ? small(40) : d.uniform(0.5, 2);
        s.radius = d.below(6) == 0 ? 0 : d.below(3) == 0 ? small(50) : small(3);
        const double along_axis = phi < 1e-3 && d.below(2) == 0 ? d.uniform(0, 1) : 1;
        const double from_axis = phi > 1.5 && d.below(2) == 0 ? d.uniform(0, 1) : 1;
        s.first_from_foot = turned(-along_axis * s.height, axis, -from_axis * s.radius, out);
        s.axis = axis;
        return s;
    };
    const point axis = unit(cube(d, 1)), out = unit(cross_product(axis, cube(d, 1)));
    const double phi = angle(), psi = angle();
    const point n = turned(std::cos(phi), out, std::sin(phi), axis);
    const point in_plane = turned(-std::sin(phi), out, std::cos(phi), axis);
    point w = unit(cross_product(n, cube(d, 1)));
    if (d.below(3) == 0) {
        const double side = d.below(2) == 0 ? 1 : -1;
        w = unit(turned(side, in_plane, small(60), w));
    }
    const body a = draw(phi, axis, out),
               b = draw(psi, turned(-std::sin(psi), n, std::cos(psi), w), turned(-std::cos(psi), n, -std::sin(psi), w));
    const point foot = cube(d, d.below(2) == 0 ? 0 : 1);
    const double away = d.below(6) == 0 ? -1 : 1;
    const double gap = d.below(8) == 0 ? 0 : d.below(3) == 0 ? d.uniform(0, 2) : away * small(51);
    const auto made = [&](const body& s, const point& at) {
        segment<T> x{round_to<T>(along(at, 1, s.first_from_foot)),
                     round_to<T>(along(along(at, 1, s.first_from_foot), s.height, s.axis))};
        if (d.below(2) == 0) std::swap(x.a, x.b);
        return cylinder<T>{x, rounded_to<T>(s.radius)};
    };
    return {made(a, foot), made(b, along(foot, gap, n))};
}

template <scalar T>
capsule<T> capsule_of(const cylinder<T>& s) {
    return {s.axis, s.radius};
}

}  // namespace

TEST_CASE("distance: of cylinders, by hand, and in constant expressions") {
    constexpr cylinder<double> rod{{{0, 0, 0}, {0, 0, 2}}, 1};
    constexpr auto at = [](double x, double z) { return cylinder<double>{{{x, 0, z}, {x, 0, z + 2}}, 1}; };
    static_assert(distance(rod, at(5, 0)).distance == 3);
    static_assert(distance(rod, at(0, 5)).distance == 3);
    static_assert(distance(rod, at(5, 5)) ==
                  separation<double>{0, 0, {1, 0, 2}, {4, 0, 5}, distance(at(5, 5), rod).distance});
    static_assert(distance(rod, at(6, 5)).distance == 5);
    static_assert(distance(rod, at(2, 2)).distance == 0);
    static_assert(distance(rod, cylinder<double>{{{5, -5, 1}, {5, 5, 1}}, 1}) ==
                  separation<double>{0, 0, {1, 0, 1}, {4, 0, 1}, 3});
    static_assert(distance(rod, cylinder<double>{{{0, -5, 4}, {0, 5, 4}}, 1}).distance == 1);
    static_assert(distance(capsule<double>{{{6, 0, 6}, {9, 0, 9}}, 1}, rod).distance > 5.4);
    // Without length they are balls, and with a radius of 0 segments.
    constexpr cylinder<double> ball{{{0, 0, 6}, {0, 0, 6}}, 1}, line{{{4, -1, 6}, {4, 1, 6}}, 0};
    static_assert(distance(rod, ball).distance == 3 && distance(ball, rod).point_b == vec3<double>{0, 0, 2});
    static_assert(distance(ball, ball).distance == 0);
    static_assert(distance(rod, line).distance == 5 && distance(line, ball).distance == 3);
    static_assert(detail::measurable<cylinder<float>, cylinder<float>> &&
                  detail::measurable<capsule<double>, cylinder<double>>);
    static_assert(!detail::measurable<cylinder<float>, cylinder<double>>);
}

TEMPLATE_TEST_CASE("distance: of cylinders that face each other, against 300 bits", "", float, double) {
    gap_tally cylinders, capsules;
    for (std::uint64_t k = 0; k < some_samples(4); ++k) {
        const auto [a, b] = facing_cylinders<TestType>(k);
        check_gap("facing", k, a, b, cylinders);
        check_gap("facing", k, a, capsule_of(b), capsules);
    }
    check_total("cylinders that face each other", cylinders);
    check_total("a cylinder that faces a capsule", capsules);
}

TEMPLATE_TEST_CASE("distance: of cylinders, in each family, against 300 bits", "", float, double) {
    using T = TestType;
    gap_tally cylinders, capsules;
    for (int i = 0; i < revolution_family_count; ++i) {
        const auto f = static_cast<revolution_family>(i);
        for (std::uint64_t k = 0; k < some_samples(100); ++k) {
            const auto c = make_revolution_case<T>(cylinder_seed, f, k, false);
            const T radius = k % 3 == 0 ? c.radius : k % 3 == 1 ? std::fabs(c.corner[2].x) : std::fabs(c.corner[2].x) / 8;
            const cylinder<T> a{c.axis, c.radius}, b{{c.corner[0], c.corner[1]}, radius};
            check_gap(name_of(f), k, a, b, cylinders);
            check_gap(name_of(f), k, a, capsule_of(b), capsules);
        }
    }
    check_total("cylinders", cylinders);
    check_total("a cylinder and a capsule", capsules);
}

}  // namespace abut::test
