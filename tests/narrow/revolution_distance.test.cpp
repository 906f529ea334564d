// SPDX-License-Identifier: MIT
#include <abut/narrow/distance.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/draws.hpp"
#include "support/revolution_gap.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_solid.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

constexpr std::uint64_t gap_seed = 20261126;

}  // namespace

TEMPLATE_TEST_CASE("nearest_point: of cylinders and cones, in each family, against 300 bits", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    double worst = 0, worst_point = 0;
    std::uint64_t inside = 0, points = 0;
    for (int i = 0; i < revolution_family_count; ++i) {
        const auto f = static_cast<revolution_family>(i);
        for (std::uint64_t k = 0; k < some_samples(50); ++k) {
            const auto c = make_revolution_case<T>(gap_seed + 1, f, k, is_cone);
            const auto s = solid_of<TestType>(c.axis, c.radius);
            const vec3<T> p = c.corner[k % 3];
            if (!is_valid(s) || !is_valid(p)) continue;
            CAPTURE(name_of(f), k);
            const auto unit = detail::unit_for(bounds(s), p);
            const vec3<double> way = detail::way_to(s, p, unit);
            const double square = detail::plain_dot(way, way);
            // The way to the box is no longer, as computed, bit for bit; nor is that to a box around the box.
            const aabb<T> box = bounds(s), around = merge(box, aabb<T>{c.corner[0], c.corner[0]});
            const vec3<double> to_box = detail::way_to(box, p, unit), to_around = detail::way_to(around, p, unit);
            CHECK(detail::plain_dot(to_box, to_box) <= square);
            CHECK(detail::plain_dot(to_around, to_around) <= detail::plain_dot(to_box, to_box));
            const vec3<T> q = nearest_point(s, p);
            CHECK(contains(box, bounds(q)));
            const wide_solid solid = in_bits(s);
            const wide step = wide(0x1p-53) * solid.farthest_from(widest(p)), exact = distance_from_solid(widest(p), solid);
            if (!(step > 0)) continue;
            ++points;
            inside += exact == 0;
            const wide measured = wide(std::sqrt(square)) * wide(unit.length(1));
            worst = std::max(worst, static_cast<double>(abs(measured - exact) / step));
            if (!is_valid(q) || is_at_end(q)) continue;  // where T has no number
            const wide off = distance_from_solid(widest(q), solid) - rounding_of(q);
            if (off > 0) worst_point = std::max(worst_point, static_cast<double>(off / step));
        }
    }
    std::printf("nearest_point: %llu points, %llu inside; off by %.2f, points by %.2f\n",
                static_cast<unsigned long long>(points), static_cast<unsigned long long>(inside), worst, worst_point);
    CHECK(inside > points / 30);
    CHECK(worst < 8);
    CHECK(worst_point < 8);
}

TEST_CASE("distance: of cylinders and cones, by hand, and in constant expressions") {
    using vec = vec3<double>;
    constexpr cylinder<double> rod{{{0, 0, 0}, {0, 0, 2}}, 1};
    constexpr cone<double> tip{{0, 0, 4}, {0, 0, 0}, 3};
    static_assert(distance(rod, vec{3, 0, 1}) == separation<double>{0, 0, {1, 0, 1}, {3, 0, 1}, 2});
    static_assert(distance(vec{0, 0, 5}, rod) == separation<double>{0, 0, {0, 0, 5}, {0, 0, 2}, 3});
    static_assert(distance(rod, vec{4, 0, 6}).distance == 5);
    static_assert(distance(rod, segment<double>{{3, -5, 1}, {3, 5, 1}}).distance == 2);
    static_assert(distance(rod, triangle<double>{{-5, -5, 4}, {5, -5, 4}, {0, 9, 4}}) ==
                  separation<double>{0, 0, {0, 0, 2}, {0, 0, 4}, 2});
    static_assert(distance(rod, triangle<double>{{-5, -5, 1}, {5, -5, 1}, {0, 9, 1}}).distance == 0);
    static_assert(distance(aabb<double>{{4, -1, -1}, {5, 1, 1}}, rod).distance == 3);
    static_assert(distance(sphere<double>{{5, 0, 1}, 1}, rod).distance == 3);
    static_assert(distance(rod, plane<double>{{0, 0, 2}, 10}) == separation<double>{0, 0, {0, 0, 2}, {0, 0, 5}, 3});
    static_assert(distance(rod, plane<double>{{2, 0, 0}, 10}) == separation<double>{0, 0, {1, 0, 0}, {5, 0, 0}, 4});
    static_assert(distance(rod, plane<double>{{0, 0, 0}, 1}).distance == infinity<double>);
    static_assert(distance(tip, vec{0, 0, 6}) == separation<double>{0, 0, {0, 0, 4}, {0, 0, 6}, 2});
    static_assert(distance(tip, vec{0, 0, -2}).distance == 2);
    static_assert(distance(tip, plane<double>{{4, 0, 3}, 22}).distance == 2);
    CHECK(distance(tip, vec{4, 0, 3}).distance == Approx(2.6));
    // Without length they are balls, and with a radius of 0 segments.
    static_assert(distance(cylinder<double>{{{0, 0, 0}, {0, 0, 0}}, 1}, vec{0, 3, 4}).distance == 4);
    static_assert(distance(cone<double>{{0, 0, 0}, {0, 0, 0}, 1}, aabb<double>{{3, -1, -1}, {4, 1, 1}}).distance == 2);
    static_assert(distance(cone<double>{{0, 0, 0}, {0, 0, 2}, 0}, vec{3, 0, 1}).distance == 3);
    CHECK(nearest_point(rod, vec{4, 0, 1}) == vec{1, 0, 1});
    CHECK(nearest_point(rod, vec{0, 0.5, 1}) == vec{0, 0.5, 1});
    CHECK(nearest_point(tip, vec{0, 0, 7}) == vec{0, 0, 4});
    static_assert(approachable<cylinder<float>> && approachable<cone<double>>);
    static_assert(detail::measurable<triangle<float>, cone<float>> && detail::measurable<cylinder<double>, plane<double>>);
    static_assert(!detail::measurable<cone<float>, vec3<double>>);
    // A disc that is as flat as numbers are, far below the other's size.
    constexpr double least = std::numeric_limits<double>::denorm_min();
    CHECK(distance(cylinder<double>{{{0, 0, 0}, {0, 0, least}}, 1}, vec{0, 0, 1}).distance == 1);
    CHECK(distance(cylinder<double>{{{0, 0, 0}, {0, 0, least}}, 1}, vec{3, 0, 0}).distance == 2);
    CHECK(distance(cone<double>{{0, 0, least}, {0, 0, 0}, 1}, vec{0.5, 0, 1}).distance == 1);
}

TEMPLATE_TEST_CASE("distance: cylinders and cones over thin triangles, against 300 bits", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    gap_tally triangles;
    for (std::uint64_t k = 0; k < some_samples(10); ++k) {
        const auto c = over_needle<TestType>(k);
        const auto s = solid_of<TestType>(c.axis, c.radius);
        check_gap("over a needle", k, s,
                  triangle<scalar_type_of<TestType>>{c.corner[k % 3], c.corner[(k + 1) % 3], c.corner[(k + 2) % 3]},
                  triangles);
    }
    check_total("triangles, thin", triangles);
}

TEST_CASE("distance: of a cone and a segment of the smallest floats that touch is 0") {
    constexpr float u = 0x1p-149f;
    const cone<float> s{{-u, -3 * u, -4 * u}, {-2 * u, -3 * u, u}, 2 * u};
    const segment<float> t{{-u, 2 * u, 4 * u}, {-2 * u, -u, u}};
    CHECK(intersects<exact>(s, t));
    CHECK(distance(s, t).distance == 0);
}

TEMPLATE_TEST_CASE("distance: of cylinders and cones, in each family, against 300 bits", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    std::printf("distance: seed %llu\n", static_cast<unsigned long long>(gap_seed));
    std::array<gap_tally, kinds_beside.size()> tallies;
    for (int i = 0; i < revolution_family_count; ++i) {
        const auto f = static_cast<revolution_family>(i);
        const std::string name = name_of(f);
        for (std::uint64_t k = 0; k < some_samples(250); ++k) {
            const auto c = make_revolution_case<T>(gap_seed, f, k, is_cone);
            const auto s = solid_of<TestType>(c.axis, c.radius);
            each_beside(c, k, is_cone, [&](std::size_t kind, const auto& t) { check_gap(name, k, s, t, tallies[kind]); });
        }
    }
    for (std::size_t kind = 0; kind < tallies.size(); ++kind) {
        const gap_tally& t = tallies[kind];
        check_total(kinds_beside[kind], t);
        CHECK(t.touching > t.pairs / 25);
        CHECK(t.touching < t.pairs * 19 / 20);
    }
}

TEMPLATE_TEST_CASE("distance: edges that are nearly parallel to a cylinder or a cone, against 300 bits", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    gap_tally segments, triangles, boxes;
    for (std::uint64_t k = 0; k < some_samples(20); ++k) {
        const auto c = nearly_parallel<TestType>(k);
        const auto s = solid_of<TestType>(c.axis, c.radius);
        check_gap("nearly parallel", k, s, segment<T>{c.corner[0], c.corner[1]}, segments);
        check_gap("nearly parallel", k, s, triangle<T>{c.corner[0], c.corner[1], c.corner[2]}, triangles);
        if (k % 4 == 0) check_gap("nearly parallel", k, s, bounds(segment<T>{c.corner[0], c.corner[1]}), boxes);
    }
    check_total("segments, nearly parallel", segments);
    check_total("triangles, nearly parallel", triangles);
    check_total("boxes, nearly parallel", boxes);
}

TEST_CASE("nearest_point: a cylinder that reaches to where the scalar has no number") {
    const cylinder<double> far{{{1.79e308, 1e307, 0}, {1.7901e308, 1.01e307, 0}}, 5e307};
    const auto p = nearest_point(far, vec3<double>{1.79e308, -1e308, 0});
    CHECK((p.x == largest_finite<double> && p.y < 1e307 && p.y > 8e306 && p.z == 0));
    const cylinder<float> far_too{{{3.4e38f, 1e37f, 0}, {3.4001e38f, 1.01e37f, 0}}, 5e37f};
    const auto q = nearest_point(far_too, vec3<float>{3.4e38f, -1e38f, 0});
    CHECK((q.x == largest_finite<float> && q.y < 1e37f && q.z == 0));
}

}  // namespace abut::test
