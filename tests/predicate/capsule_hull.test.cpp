// SPDX-License-Identifier: MIT
#include <abut/predicate/capsule_hull.hpp>

#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "support/catch.hpp"
#include "support/hull_families.hpp"
#include "support/hulls.hpp"
#include "support/modes.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"

// Spheres, capsules and planes against hulls. The oracle: hulls meet, by linear programming; or else a ball reaches a hull
// of three of the differences of their points, each of which is decided on the Gram matrix, in unbounded integers.

namespace {

using namespace abut;

constexpr vec3<double> wedge[4] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
constexpr hull<double> corner_of_space(wedge, 4);

// Constant expressions: tangent to a corner, an edge and a face, and one step less.
static_assert(intersects(sphere<double>{{-2, -3, -6}, 7}, corner_of_space));
static_assert(!intersects(corner_of_space, sphere<double>{{-2, -3, -6}, 0x1.bffffffffffffp2}));
static_assert(intersects(corner_of_space, sphere<double>{{-3, 1, -4}, 5}));
static_assert(!intersects<exact>(corner_of_space, sphere<double>{{-3, 1, -4}, 0x1.3ffffffffffffp2}));
static_assert(intersects(capsule<double>{{{-2, 1, 1}, {-2, 1, 9}}, 2}, corner_of_space));
static_assert(!intersects(capsule<double>{{{-2, 1, 1}, {-2, 1, 9}}, 0x1.fffffffffffffp0}, corner_of_space));
static_assert(intersects(capsule<double>{{{-2, 1, 1}, {9, 1, 1}}, 0}, corner_of_space));
static_assert(intersects(plane<double>{{1, 1, 1}, 4}, corner_of_space));
static_assert(intersects(corner_of_space, plane<double>{{1, 1, 1}, 0}));
static_assert(!intersects(corner_of_space, plane<double>{{1, 1, 1}, -0x1p-1074}));
static_assert(!intersects(corner_of_space, plane<double>{{1, 1, 1}, 0x1.0000000000001p2}));
static_assert(decidable_pair<sphere<float>, hull<float>> && decidable_pair<capsule<double>, hull<double>> &&
              !decidable_pair<capsule<double>, hull<float>>);

template <scalar T>
bool ball_reaches(const test::point_list<T>& core, T radius, const test::point_list<T>& points) {
    if (test::oracle::hulls_intersect(core, points)) return true;
    std::vector<T> values{radius};
    for (const test::point_list<T>* list : {&core, &points}) {
        for (const vec3<T>& p : *list) values.insert(values.end(), {p.x, p.y, p.z});
    }
    const std::vector<test::integer> v = test::to_integers(values);
    std::vector<test::integer_point> w;
    for (std::size_t i = 0; i < core.size(); ++i) {
        for (std::size_t j = core.size(); j < core.size() + points.size(); ++j) {
            w.push_back({v[3 * j + 1] - v[3 * i + 1], v[3 * j + 2] - v[3 * i + 2], v[3 * j + 3] - v[3 * i + 3]});
        }
    }
    const test::integer rr = v[0] * v[0];
    for (std::size_t i = 0; i < w.size(); ++i) {
        for (std::size_t j = i; j < w.size(); ++j) {
            for (std::size_t k = j; k < w.size(); ++k) {
                if (test::hull_reaches({w[i], w[j], w[k]}, rr)) return true;
            }
        }
    }
    return false;
}

template <scalar T>
struct judged_case : test::round_case<T> {
    bool truth;
};
template <scalar T>
judged_case<T> judged_round_case(std::uint64_t seed, test::hull_family f, std::uint64_t index) {
    const auto made = test::make_round_case<T>(seed, f, index);
    return {made, ball_reaches(made.core, made.radius, made.points)};
}

template <scalar T, class S>
bool is_right(const S& s, const judged_case<T>& c) {
    const hull<T> h = test::hull_over(c.points);
    const verdict by_filter = decide<filtered>(s, h), by_limbs = decide<exact>(s, h);
    bool right = by_filter != to_verdict(!c.truth) && by_limbs != to_verdict(!c.truth);
    right = right && intersects(s, h) == c.truth && intersects<exact>(h, s) == c.truth && resolve(s, h) == c.truth;
    return right && decide<fast>(s, h) != verdict::unknown;
}

template <scalar T>
bool is_right(const judged_case<T>& c) {
    bool right = is_right(capsule<T>{{c.core.front(), c.core.back()}, c.radius}, c);
    if (c.core.size() == 1) right = right && is_right(sphere<T>{c.core.front(), c.radius}, c);
    return right;
}

}  // namespace

TEMPLATE_TEST_CASE("capsule and hull: every stage is right in every family", "", float, double) {
    std::printf("capsules and hulls, seed %llu\n| family | pairs | hits %% | filter %% | wrong |\n",
                static_cast<unsigned long long>(test::sample_seed));
    for (const test::hull_family f : test::families_of_few_points) {
        std::uint64_t wrong = 0, hits = 0, filter = 0;
        const std::uint64_t samples = test::sample_count() / 20 / (f == test::hull_family::exponents ? 4 : 1);
        for (std::uint64_t k = 0; k < samples; ++k) {
            const auto c = judged_round_case<TestType>(test::sample_seed, f, k);
            wrong += !is_right(c);
            hits += c.truth;
            filter += decide<filtered>(capsule<TestType>{{c.core.front(), c.core.back()}, c.radius},
                                       test::hull_over(c.points)) != verdict::unknown;
        }
        const auto percent = [samples](std::uint64_t n) {
            return 100.0 * static_cast<double>(n) / static_cast<double>(samples);
        };
        std::printf("| %s | %llu | %.1f | %.1f | %llu |\n", test::name_of(f), static_cast<unsigned long long>(samples),
                    percent(hits), percent(filter), static_cast<unsigned long long>(wrong));
        INFO(test::name_of(f));
        CHECK(wrong == 0);
        CHECK(percent(hits) > 5);
        if (f != test::hull_family::denormal) CHECK(percent(hits) < 95);
        if (f == test::hull_family::general) CHECK(percent(filter) > 60);
    }
}

// Differences of two parallel edges lie in a plane, in which rounding must not find a tetrahedron that holds the origin.
TEMPLATE_TEST_CASE("capsule and hull: fast is wrong next to contact alone", "", float, double) {
    using T = TestType;
    std::uint64_t wrong = 0, hits = 0;
    const std::uint64_t samples = 4 * test::sample_count();
    for (std::uint64_t k = 0; k < samples; ++k) {
        const auto both = test::make_hull_pair<T>(
            test::sample_seed + 3, k % 2 == 0 ? test::hull_family::lattice : test::hull_family::general, k);
        test::draws d(test::sample_seed, 11, k);
        const auto h = test::hull_over(both.b);
        const auto capsule_of = [&](double radius) {
            return capsule<T>{{both.a.front(), both.a.back()}, static_cast<T>(radius)};
        };
        const double radius = d.below(4) == 0 ? 0 : d.uniform(0, 1);
        const bool answer = intersects<fast>(capsule_of(radius), h);
        hits += intersects<exact>(capsule_of(radius), h);
        const double below = 0.999 * radius - 1e-5, above = 1.001 * radius + 1e-5;
        wrong += answer ? !intersects<exact>(capsule_of(above), h) : below >= 0 && intersects<exact>(capsule_of(below), h);
    }
    CHECK(wrong * 100'000 <= samples);  // a thin hull now and then
    CHECK(hits * 20 > samples);
    CHECK(hits * 20 < 19 * samples);
}

// The middle of a box is on many triangles and tetrahedra of its corners.
TEMPLATE_TEST_CASE("capsule and hull: fast misses nothing that begins in the middle of a box", "", float, double) {
    using T = TestType;
    std::uint64_t missed = 0;
    const std::uint64_t samples = test::sample_count() / 4;
    for (std::uint64_t k = 0; k < samples; ++k) {
        test::draws d(test::sample_seed, 12, k);
        namespace make = test::construction;
        const auto across = make::unit(make::cube(d, 1)), aside = make::unit(make::cube(d, 1));
        const auto third = make::unit(cross(across, aside)), second = cross(third, across);
        const make::point middle = k % 2 == 0 ? make::point{} : make::cube(d, 2);
        const double sizes[3] = {d.uniform(0.1, 1), d.uniform(0.1, 1), d.uniform(0.1, 1)};
        const auto at = [&](double x, double y, double z) {
            const auto along = make::along(make::along(middle, x * sizes[0], across), y * sizes[1], second);
            return make::round_to<T>(make::along(along, z * sizes[2], third));
        };
        test::point_list<T> corners;
        for (int c = 0; c < 8; ++c) corners.push_back(at(c % 2 == 0 ? 1 : -1, c / 2 % 2 == 0 ? 1 : -1, c / 4 == 0 ? 1 : -1));
        const hull<T> h = test::hull_over(corners);
        const double radii[] = {0, 1e-6, 1e-3};
        const auto radius = static_cast<T>(radii[k % 3]);
        missed += !intersects<fast>(capsule<T>{{at(0, 0, 0), at(0.5, 0, 0)}, radius}, h);
        missed += !intersects<fast>(sphere<T>{at(0, 0, 0), radius}, h);
        missed += !within<fast>(h, hull<T>(&corners[1], 4), 0.0);
    }
    CHECK(missed == 0);
}

TEMPLATE_TEST_CASE("capsule and hull: right in every rounding mode, and where denormals are flushed", "", float, double) {
    std::vector<judged_case<TestType>> cases;
    for (const test::hull_family f : test::families_of_few_points) {
        for (std::uint64_t k = 0; k < 20; ++k) cases.push_back(judged_round_case<TestType>(test::sample_seed + 2, f, k));
    }
    for (const test::floating_mode& mode : test::floating_modes()) {
        std::size_t wrong = 0;
        test::in_mode(mode, [&] {
            for (const auto& c : cases) wrong += !is_right(c);
        });
        INFO(mode.name);
        CHECK(wrong == 0);
    }
}

TEMPLATE_TEST_CASE("plane and hull: as the heights of the points say", "", float, double) {
    std::uint64_t wrong = 0, hits = 0, touches = 0;
    const std::uint64_t samples = test::sample_count() / 4;
    for (std::uint64_t k = 0; k < samples; ++k) {
        const auto c = test::make_plane_case<TestType>(test::sample_seed, k);
        const plane<TestType>& p = c.p;
        std::vector<TestType> values{1, p.offset, p.normal.x, p.normal.y, p.normal.z};
        for (const vec3<TestType>& q : c.points) values.insert(values.end(), {q.x, q.y, q.z});
        const std::vector<test::integer> v = test::to_integers(values);
        bool above = false, below = false, in = false;
        for (std::size_t i = 5; i < v.size(); i += 3) {
            const test::integer height = v[2] * v[i] + v[3] * v[i + 1] + v[4] * v[i + 2] - v[0] * v[1];
            above = above || height > 0, below = below || height < 0, in = in || height == 0;
        }
        const bool truth = in || (above && below);
        const hull<TestType> h = test::hull_over(c.points);
        hits += truth;
        touches += truth && !(above && below);
        wrong += intersects(p, h) != truth || intersects<exact>(h, p) != truth || resolve(p, h) != truth;
        wrong += decide<fast>(p, h) == verdict::unknown;
    }
    CHECK(wrong == 0);
    CHECK(hits * 10 > samples);
    CHECK(hits * 10 < samples * 9);
    CHECK(touches * 50 > samples);
}
