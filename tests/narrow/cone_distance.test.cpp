// SPDX-License-Identifier: MIT
#include <abut/narrow/distance.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/revolution_gap.hpp"
#include "support/revolution_pairs.hpp"
#include "support/samples.hpp"

// Cones with each other, with cylinders and with capsules. revolution_gap.hpp has the oracle.

namespace abut::test {

namespace {

constexpr std::uint64_t cone_seed = 20261128;

/// A solid in the half plane of its axis, as seen from the point of it that is to be the nearest one: where the first end
/// is, along the axis and away from it; and how far the normal there is from the plane across the axis.
struct flat_solid {
    double height, radius, along, out, angle;
};

/// Three cones, of which the second is also taken for a cylinder and a capsule.
template <scalar T>
struct solids_facing {
    cone<T> a, b;
    cylinder<T> c;
};

double small_size(draws& d, int most) {
    const double m = d.uniform(0.5, 1);
    return std::ldexp(m, -d.below(most));
}

/// The nearest point is drawn: on the side, inside of it or not, the apex, the rim, or the base. The normal there is one
/// that the point has, or nearly not: within 2^-60 of the side's or the axis.
flat_solid draw_flat_cone(draws& d) {
    flat_solid s{};
    const int shape = d.below(6);
    s.height = shape == 0 ? small_size(d, 50) : d.uniform(0.5, 2);
    s.radius = d.below(12) == 0 ? 0 : shape == 1 ? small_size(d, 50) : small_size(d, 4);
    const double right = std::acos(-1.0) / 2, side = -std::atan2(s.radius, s.height);
    const double off = d.below(3) == 0 ? small_size(d, 60) : 0;
    const int kind = d.below(8);
    double from_apex = d.below(4) == 0 ? small_size(d, 50) : d.uniform(0, 1), out = from_apex;
    if (kind < 4) {
        s.angle = side + (d.below(2) == 0 ? off : -off);
    } else if (kind == 4) {
        from_apex = out = 0;
        s.angle = d.below(2) == 0 ? -right + off : d.uniform(-right, side);
    } else if (kind < 7) {
        from_apex = out = 1;
        s.angle = d.below(3) == 0 ? side + off : d.below(2) == 0 ? right - off : d.uniform(side, right);
    } else {
        from_apex = 1;
        s.angle = right - off;
    }
    s.along = -from_apex * s.height;
    s.out = -out * s.radius;
    return s;
}
flat_solid draw_flat_cylinder(draws& d) {
    flat_solid s{};
    s.height = d.below(3) == 0 ? small_size(d, 40) : d.uniform(0.5, 2);
    s.radius = d.below(6) == 0 ? 0 : d.below(3) == 0 ? small_size(d, 50) : small_size(d, 3);
    const double off = d.below(3) == 0 ? small_size(d, 60) : 0, right = std::acos(-1.0) / 2;
    const int kind = d.below(5);
    s.angle = kind < 2 ? off : kind == 2 ? right - off : d.uniform(0, right);
    const double along_axis = s.angle < 1e-3 && d.below(2) == 0 ? d.uniform(0, 1) : 1;
    const double from_axis = s.angle > 1.5 && d.below(2) == 0 ? d.uniform(0, 1) : 1;
    s.along = -along_axis * s.height;
    s.out = -from_axis * s.radius;
    return s;
}

/// Solids that face a cone at a distance down to 2^-50, or through it, of any size. Their axes may be in one plane, but for
/// an angle down to 2^-60, or parallel, or about parallel.
template <scalar T>
solids_facing<T> facing_cones(std::uint64_t i) {
    using namespace construction;
    draws d(cone_seed, sizeof(T), i);
    flat_solid a = draw_flat_cone(d), b = draw_flat_cone(d);
    const flat_solid c = draw_flat_cylinder(d);
    const int twin = d.below(8);
    if (twin == 0) {  // sides as steep, or about so
        b = a;
        b.radius *= 1 + (d.below(2) == 0 ? small_size(d, 55) : 0);
    }
    const bool crossing = twin == 4;  // into each other's sides
    if (crossing) {
        for (flat_solid* const x : {&a, &b}) {
            const double t = d.uniform(0.1, 0.9);
            x->angle = -std::atan2(x->radius, x->height);
            x->along = -t * x->height;
            x->out = -t * x->radius;
        }
    }
    const point n = unit(cube(d, 1)), v = unit(cross_product(n, cube(d, 1)));
    point w = unit(cross_product(n, cube(d, 1)));
    if (twin < 4) {
        const double side = d.below(2) == 0 ? 1 : -1, tilt = d.below(3) == 0 ? 0 : small_size(d, 60);
        w = unit(along(along({0, 0, 0}, side, v), tilt, w));
    }
    const point foot = cube(d, d.below(2) == 0 ? 0 : 1);
    const int near = d.below(12);
    const double away = d.below(6) == 0 ? -1 : 1;
    const double gap = crossing    ? d.uniform(0, 1) * std::fmax(a.out, b.out)
                       : near == 0 ? 0
                       : near == 1 ? d.uniform(-0.5, 0)
                       : near < 6  ? d.uniform(0, 2)
                                   : away * small_size(d, 51);
    constexpr int most = std::same_as<T, float> ? 120 : 1000;
    const int exponent = d.below(6) == 0 ? d.below(2 * most) - most : 0;
    const auto placed = [&](const flat_solid& s, const point& at, double up, const point& across, segment<T>& axis,
                            T& radius) {
        const double cosine = std::cos(s.angle), sine = std::sin(s.angle);
        const point first =
            along(along(at, up * (s.along * sine + s.out * cosine), n), s.along * cosine - s.out * sine, across);
        const point last = along(along(first, up * (s.height * sine), n), s.height * cosine, across);
        const auto sized = [&](const point& p) {
            return round_to<T>(point{std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)});
        };
        axis = {sized(first), sized(last)};
        radius = rounded_to<T>(std::ldexp(s.radius, exponent));
    };
    solids_facing<T> made{};
    segment<T> axis{};
    placed(a, foot, 1, v, axis, made.a.radius);
    made.a.apex = axis.a, made.a.base_center = axis.b;
    placed(b, along(foot, gap, n), -1, w, axis, made.b.radius);
    made.b.apex = axis.a, made.b.base_center = axis.b;
    placed(c, along(foot, gap, n), -1, w, made.c.axis, made.c.radius);
    return made;
}

/// Whole numbers: cones on one axis, or on two that are parallel or at a right angle.
template <scalar T>
solids_facing<T> upright_cones(std::uint64_t i) {
    draws d(cone_seed + 1, sizeof(T), i);
    const auto whole = [&](int low, int high) { return static_cast<T>(low + d.below(high - low + 1)); };
    const int up = d.below(3), aside = d.below(3), other = d.below(4) == 0 ? d.below(3) : up;
    const auto from = [](const vec3<T>& p, int axis, T x) {
        vec3<T> q = p;
        (axis == 0 ? q.x : axis == 1 ? q.y : q.z) += x;
        return q;
    };
    const vec3<T> o{whole(-3, 3), whole(-3, 3), whole(-3, 3)};
    const T h = whole(1, 5), l = whole(-5, 5);
    solids_facing<T> made{};
    made.a = {o, from(o, up, h), whole(0, 4)};
    const vec3<T> p = from(from(o, up, whole(-6, 6)), aside, d.below(3) == 0 ? T(0) : whole(-9, 9));
    const T radius = d.below(4) == 0 ? made.a.radius : whole(0, 4);
    made.b = {p, from(p, other, d.below(4) == 0 ? -h : l), radius};
    made.c = {{made.b.apex, made.b.base_center}, radius};
    return made;
}

template <scalar T>
void check_cone_beside(const char* name, std::uint64_t k, const solids_facing<T>& s, gap_tally (&tally)[3]) {
    check_gap(name, k, s.a, s.b, tally[0]);
    check_gap(name, k, s.a, s.c, tally[1]);
    check_gap(name, k, s.a, capsule<T>{s.c.axis, s.c.radius}, tally[2]);
}
void check_cone_totals(const gap_tally (&tally)[3]) {
    check_total("cones", tally[0]);
    check_total("a cone and a cylinder", tally[1]);
    check_total("a cone and a capsule", tally[2]);
}

}  // namespace

TEST_CASE("distance: of cones, by hand, and in constant expressions") {
    // At the apex the side has a slope of 3 : 4.
    constexpr cone<double> hat{{0, 0, 4}, {0, 0, 0}, 3};
    constexpr auto upward = [](double x, double z) { return cone<double>{{x, 0, z + 4}, {x, 0, z}, 3}; };
    constexpr auto downward = [](double x, double z) { return cone<double>{{x, 0, z}, {x, 0, z + 4}, 3}; };
    static_assert(distance(hat, upward(8, 0)) == separation<double>{0, 0, {3, 0, 0}, {5, 0, 0}, 2});
    static_assert(distance(hat, upward(0, 5)) == separation<double>{0, 0, {0, 0, 4}, {0, 0, 5}, 1});
    static_assert(distance(hat, downward(0, 6)).distance == 2);
    static_assert(distance(downward(0, 6), hat).point_a == vec3<double>{0, 0, 6});
    static_assert(distance(hat, downward(0, 4)).distance == 0 && distance(hat, downward(0, 4)).point_b.z == 4);
    static_assert(distance(hat, hat).distance == 0);
    // From side to side: parallel lines, and lines that cross.
    static_assert(distance(hat, downward(8, 0)).distance > 4 - 1e-14 && distance(hat, downward(8, 0)).distance < 4 + 1e-14);
    constexpr cone<double> lying{{5, 9, 2}, {5, -9, 2}, 0};
    static_assert(distance(hat, lying).distance > 2.8 - 1e-14 && distance(hat, lying).distance < 2.8 + 1e-14);
    // With cylinders and capsules.
    static_assert(distance(hat, cylinder<double>{{{5, 0, 0}, {5, 0, 9}}, 1}) ==
                  separation<double>{0, 0, {3, 0, 0}, {4, 0, 0}, 1});
    static_assert(distance(cylinder<double>{{{0, 0, 7}, {0, 0, 9}}, 1}, hat).distance == 3);
    static_assert(distance(hat, capsule<double>{{{0, -9, 7}, {0, 9, 7}}, 1}).distance == 2);
    // Without length they are balls, and with a radius of 0 segments.
    constexpr cone<double> ball{{0, 0, 6}, {0, 0, 6}, 1}, line{{0, -9, 8}, {0, 9, 8}, 0};
    static_assert(distance(hat, ball).distance == 1 && distance(ball, hat).point_b == vec3<double>{0, 0, 4});
    static_assert(distance(ball, ball).distance == 0);
    static_assert(distance(hat, line).distance == 4 && distance(line, ball).distance == 1);
    static_assert(distance(ball, cylinder<double>{{{9, 0, 6}, {9, 0, 6}}, 1}).distance == 7);
    static_assert(detail::measurable<cone<float>, cone<float>> && detail::measurable<cylinder<double>, cone<double>> &&
                  detail::measurable<capsule<double>, cone<double>>);
    static_assert(!detail::measurable<cone<float>, cone<double>> && !detail::measurable<cone<float>, cylinder<double>>);
}

TEMPLATE_TEST_CASE("distance: of cones that are faced, against 300 bits", "", float, double) {
    gap_tally tally[3];
    for (std::uint64_t k = 0; k < some_samples(10); ++k) {
        check_cone_beside("facing", k, facing_cones<TestType>(k), tally);
    }
    for (std::uint64_t k = 0; k < some_samples(20); ++k) {
        check_cone_beside("upright", k, upright_cones<TestType>(k), tally);
    }
    check_cone_totals(tally);
}

TEMPLATE_TEST_CASE("distance: of cones, in each family, against 300 bits", "", float, double) {
    using T = TestType;
    gap_tally tally[3];
    for (int i = 0; i < revolution_family_count; ++i) {
        const auto f = static_cast<revolution_family>(i);
        for (std::uint64_t k = 0; k < some_samples(200); ++k) {
            const auto c = make_revolution_case<T>(cone_seed, f, k, true);
            const T radius = k % 3 == 0 ? c.radius : k % 3 == 1 ? std::fabs(c.corner[2].x) : std::fabs(c.corner[2].x) / 8;
            const segment<T> other{c.corner[0], c.corner[1]};
            check_cone_beside<T>(name_of(f), k,
                                 {{c.axis.a, c.axis.b, c.radius}, {other.a, other.b, radius}, {other, radius}}, tally);
        }
    }
    check_cone_totals(tally);
}

}  // namespace abut::test

namespace abut::test {

// A thin solid over a disc: what is across its axis there is much smaller than what rounding leaves along it.
TEST_CASE("distance: needles over the disc of a cone or a cylinder") {
    using namespace construction;
    const auto off_by = [](const auto& s, const auto& t) {
        const auto bounds = gap_of_solid(s, t);
        if (!(bounds.distance.lower > 0)) return 0.0;
        const auto found = wide(detail::separation_of(s, t, false).distance);
        const auto over = found - bounds.distance.upper, under = bounds.distance.lower - found;
        return static_cast<double>((over > under ? over : under) / bounds.farthest / wide(0x1p-53));
    };
    double worst = 0;
    for (std::uint64_t k = 0; k < sample_count() / 20; ++k) {
        draws d(99, 1, k);
        const point n = unit(cube(d, 1)), v = unit(cross_product(n, cube(d, 1))), w = cross_product(n, v);
        const point o = cube(d, d.below(2));
        const int e = d.below(30) + 15;
        const double gap = std::ldexp(d.uniform(0.5, 1), -e), radius = d.uniform(0.1, 1),
                     tilt = d.uniform(-1, 1) * gap / radius,
                     thin = d.below(3) != 0 ? std::ldexp(d.uniform(0, 1), -d.below(50)) : 0;
        const point axis = unit(along(v, tilt, n));
        const double moved = d.below(2) != 0 ? std::ldexp(d.uniform(-1, 1), -d.below(50)) : 0;
        const point c = along(along(o, gap + thin, n), moved, w);
        const double back = d.uniform(radius, 2), ahead = d.uniform(radius, 2);
        const point p = along(c, -back, axis), q = along(c, ahead, axis), below = along(o, -d.uniform(0.1, 1), n);
        const cylinder<double> rod{{p, q}, thin}, drum{{o, below}, radius};
        const cone<double> needle{p, q, thin}, hill{below, o, radius};
        for (const double off : {off_by(rod, drum), off_by(needle, hill), off_by(needle, drum), off_by(hill, rod)}) {
            worst = std::max(worst, off);
        }
    }
    CHECK(worst < 16);
}

}  // namespace abut::test
