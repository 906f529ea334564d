// SPDX-License-Identifier: MIT
#include <abut/predicate/intersects.hpp>

#include <cmath>

#include <rapidcheck.h>

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/hulls.hpp"
#include "support/modes.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"
#include "support/stages.hpp"
#include "support/triangle_families.hpp"

// The other pairs of shapes against the oracle, and what must not change an answer: the order of arguments and of corners,
// powers of two, mirrors, and when it is computed.

namespace {

using namespace abut;
using test::family;
using test::triangle_family;

constexpr triangle<float> corner{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
constexpr sphere<double> unit_ball{{0, 0, 0}, 1};

// Constant expressions, in either order; closed sets; the whole range.
static_assert(intersects(sphere<float>{{0, 0, 5}, 5}, corner));
static_assert(!intersects(sphere<float>{{0, 0, 5}, 0x1.3ffffep2f}, corner));
static_assert(intersects<exact>(corner, sphere<float>{{0, 0, -5}, 5}));
static_assert(intersects<fast>(corner, sphere<float>{{0, 0, -4}, 5}));
static_assert(intersects(vec3<float>{0, 0, 0}, corner) && !intersects(corner, vec3<float>{0, 0, 0x1p-149f}));
static_assert(intersects(unit_ball, sphere<double>{{2, 0, 0}, 1}) &&
              !intersects(unit_ball, sphere<double>{{2, 0x1p-1074, 0}, 1}));
static_assert(intersects(segment<double>{{1, -5, 0}, {1, 5, 0}}, unit_ball));
static_assert(!intersects(segment<double>{{0x1.0000000000001p0, -5, 0}, {0x1.0000000000001p0, 5, 0}}, unit_ball));
// The last stage: a corner in a plane, or just above it; a corner on a ball, or just below it.
constexpr triangle<double> floor_at_1e_300{{-1, -1, 1e-300}, {1, -1, 1e-300}, {0, 1, 1e-300}};
static_assert(intersects(triangle<double>{{0, 0, 1e-300}, {1, 0, 1}, {0, 1, 1}}, floor_at_1e_300));
static_assert(!intersects(triangle<double>{{0, 0, 2e-300}, {1, 0, 1}, {0, 1, 1}}, floor_at_1e_300));
static_assert(intersects(sphere<float>{{0, 0, 1}, 1}, triangle<float>{{0, 0, 1e-40f}, {1, 0, -3}, {0, 1, -3}}));
static_assert(!intersects(sphere<float>{{0, 0, 1}, 1}, triangle<float>{{0, 0, -1e-40f}, {1, 0, -3}, {0, 1, -3}}));

static_assert(decidable_pair<sphere<float>, triangle<float>> && decidable_pair<vec3<double>, triangle<double>>);
static_assert(decidable_pair<triangle<float>, triangle<float>> && decidable_pair<segment<double>, triangle<double>>);
static_assert(!decidable_pair<sphere<float>, triangle<double>>);  // mixed scalars
static_assert(!decidable_pair<triangle<float>, triangle<double>> && !decidable_pair<segment<float>, triangle<double>>);
static_assert(!decidable_pair<triangle<double>, sphere<float>>);

/// Each family of spheres and triangles, read as pairs of other shapes.
template <class Examine>
void check_families(const char* title, const char* file_name, const Examine& examine) {
    test::check_every_family<family>(
        title, file_name, false, test::family_count, [](family f) { return test::name_of(f); },
        [&]<class T>(T, family f, std::uint64_t k, test::stage_tally& sum) {
            examine(test::make_pair<T>(test::sample_seed, f, k), k, sum);
        });
}

/// Each family of pairs of triangles, alike.
template <class Examine>
void check_triangle_families(const char* title, const char* file_name, bool late, const Examine& examine) {
    test::check_every_family<triangle_family>(
        title, file_name, late, test::triangle_family_count, [](triangle_family f) { return test::name_of(f); },
        [&]<class T>(T, triangle_family f, std::uint64_t k, test::stage_tally& sum) {
            examine(test::make_triangle_pair<T>(test::sample_seed, f, k), k, sum);
        });
}

template <scalar T>
void examine_point(const vec3<T>& p, const triangle<T>& t, std::uint64_t k, test::stage_tally& sum) {
    test::examine_stages<detail::ball_meets_triangle>(p, t, detail::values_of(sphere<T>{p, 0}, t).value,
                                                      test::oracle::intersects(p, t), k, sum);
}

}  // namespace

TEST_CASE("sphere and segment: every stage is right in every family") {
    check_families("Sphere against segment", "sphere-segment.md",
                   []<class T>(const test::sphere_triangle_pair<T>& p, std::uint64_t k, test::stage_tally& sum) {
                       const segment<T> e = test::segment_beside_ball(p, k);
                       test::examine_stages<detail::ball_meets_segment>(p.s, e, detail::values_of(p.s, e).value,
                                                                        test::oracle::intersects(p.s, e), k, sum);
                   });
}

TEST_CASE("sphere and sphere: every stage is right in every family") {
    check_families("Sphere against sphere", "sphere-sphere.md",
                   []<class T>(const test::sphere_triangle_pair<T>& p, std::uint64_t k, test::stage_tally& sum) {
                       const auto [s, o] = test::two_balls(p, k);
                       test::examine_stages<detail::ball_meets_ball>(s, o, detail::values_of(s, o).value,
                                                                     test::oracle::intersects(s, o), k, sum);
                   });
}

TEST_CASE("point and triangle: a sphere of radius 0") {
    std::uint64_t wrong = 0;
    for (const family f : {family::radius_zero, family::lattice_4, family::degenerate, family::all_bit_patterns}) {
        for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
            const auto p = test::make_pair<double>(test::sample_seed, f, k);
            const auto q = test::make_pair<float>(test::sample_seed, f, k);
            wrong += intersects(p.s.center, p.t) != intersects(sphere<double>{p.s.center, 0}, p.t);
            wrong += intersects(q.s.center, q.t) != intersects(sphere<float>{q.s.center, 0}, q.t);
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("segment and triangle: every stage is right in every family of triangles") {
    check_triangle_families("Segment against triangle", "segment-triangle.md", true,
                            []<class T>(const test::triangle_pair<T>& p, std::uint64_t k, test::stage_tally& sum) {
                                const segment<T> e = test::segment_beside_triangle(p, k);
                                const auto values = detail::values_of(detail::as_triangle(e), p.b);
                                test::examine_stages<detail::triangle_meets_triangle>(
                                    e, p.b, values.value, test::oracle::intersects(e, p.b), k, sum);
                            });
}

TEST_CASE("point and triangle: every stage is right in every family of triangles") {
    check_triangle_families("Point against triangle", "point-triangle.md", false,
                            []<class T>(const test::triangle_pair<T>& p, std::uint64_t k, test::stage_tally& sum) {
                                examine_point(test::point_beside_triangle(p, k), p.b, k, sum);
                            });
}

TEMPLATE_TEST_CASE("answers do not depend on the order of corners, on powers of two, or on mirrors", "", float, double) {
    using T = TestType;
    CHECK(rc::check("sphere and triangle", [] {
        const auto f = static_cast<family>(*rc::gen::inRange(0, test::family_count));
        const auto index = *rc::gen::arbitrary<std::uint32_t>();
        const auto [s, t] = test::make_pair<T>(test::sample_seed, f, index);
        const bool answer = intersects(s, t);

        const triangle<T> orders[] = {{t.a, t.c, t.b}, {t.b, t.a, t.c}, {t.b, t.c, t.a}, {t.c, t.a, t.b}, {t.c, t.b, t.a}};
        for (const triangle<T>& o : orders) RC_ASSERT(intersects(o, s) == answer);

        const auto swapped = [](const vec3<T>& v) { return vec3<T>{-v.z, v.x, -v.y}; };
        RC_ASSERT(intersects(sphere<T>{swapped(s.center), s.radius},
                             triangle<T>{swapped(t.a), swapped(t.b), swapped(t.c)}) == answer);

        const T scale = std::ldexp(T(1), *rc::gen::inRange(-20, 20));
        bool exact_scale = true;
        const auto scaled = [&](T x) {
            exact_scale = exact_scale && (x * scale) / scale == x;
            return x * scale;
        };
        const auto scaled_point = [&](const vec3<T>& v) { return vec3<T>{scaled(v.x), scaled(v.y), scaled(v.z)}; };
        const sphere<T> s2{scaled_point(s.center), scaled(s.radius)};
        const triangle<T> t2{scaled_point(t.a), scaled_point(t.b), scaled_point(t.c)};
        if (exact_scale) RC_ASSERT(intersects(s2, t2) == answer);
    }));
}

TEMPLATE_TEST_CASE("sphere and triangle: right in every floating-point mode", "", float, double) {
    std::uint64_t wrong = 0;
    for (int i = 0; i < test::family_count; ++i) {
        for (std::uint64_t k = 0; k < test::sample_count() / 10; ++k) {
            const auto p = test::make_pair<TestType>(test::sample_seed, static_cast<family>(i), k);
            const bool truth = test::oracle::intersects(p.s, p.t);
            wrong += test::modes_in_which([&] { return intersects(p.s, p.t) != truth; });
        }
    }
    CHECK(wrong == 0);
}
