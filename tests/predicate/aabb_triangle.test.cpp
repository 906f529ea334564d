// SPDX-License-Identifier: MIT
#include <abut/predicate/aabb_triangle.hpp>

#include "predicate/shape_cases.hpp"

namespace {

using namespace abut;

constexpr triangle<float> slope{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};

// Constant expressions, in either order: the corner (1, 1, 1) lies on the slope.
static_assert(intersects(aabb<float>{{1, 1, 1}, {2, 2, 2}}, slope));
static_assert(!intersects(slope, aabb<float>{{1, 1, 0x1.000002p0f}, {2, 2, 2}}));
static_assert(intersects<exact>(slope, aabb<float>{{0, 0, 0}, {1, 1, 1}}));
static_assert(!intersects<exact>(aabb<double>{{0, 0, 0}, {1, 1, 0x1.fffffffffffffp-1}},
                                 triangle<double>{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}));
static_assert(intersects<fast>(aabb<float>{{0, 0, 0}, {2, 2, 2}}, slope));
// A box is solid, a triangle inside of it touches it; a box may be a point, and so may a triangle.
static_assert(intersects(aabb<double>{{-9, -9, -9}, {9, 9, 9}}, triangle<double>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
static_assert(intersects(aabb<float>{{1, 1, 1}, {1, 1, 1}}, slope));
static_assert(!intersects(aabb<float>{{1, 1, 0x1.fffffep-1f}, {1, 1, 0x1.fffffep-1f}}, slope));
static_assert(intersects(aabb<float>{{0, 0, 0}, {5, 5, 5}}, triangle<float>{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}));
// The filter knows ties of shapes that lie along the axes.
constexpr triangle<float> base_triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
static_assert(decide<filtered>(aabb<float>{{1, 1, 0}, {2, 2, 1}}, base_triangle) == verdict::yes);
static_assert(decide<filtered>(aabb<float>{{4, -5, -1}, {5, 5, 0}}, base_triangle) == verdict::yes);
static_assert(decide<filtered>(aabb<float>{{-1, -1, -1}, {0, 1, 0}}, base_triangle) == verdict::yes);
static_assert(decide<filtered>(aabb<float>{{-1, -1, -1}, {0, 1, -0x1p-149f}}, base_triangle) == verdict::no);

static_assert(decidable_pair<aabb<float>, triangle<float>> && decidable_pair<aabb<double>, triangle<double>>);
static_assert(!decidable_pair<aabb<float>, triangle<double>>);

}  // namespace

TEST_CASE("box and triangle: every stage is right in every family") {
    test::check_every_stage<aabb>("Box against triangle", "box-triangle.md",
                                  {{"touching: corner, box", "touching: edges", "touching: face, corner",
                                    "touching: along axes", "touching: long edges"}});
}

TEST_CASE("box and triangle: right in every floating-point mode") { test::check_every_mode<aabb>(); }

TEST_CASE("box and triangle: one answer for every order, mirror and power of two") { test::check_one_answer<aabb>(); }

TEMPLATE_TEST_CASE("box and triangle: a point where it has no extent", "", float, double) {
    std::uint64_t wrong = 0, hits = 0, pairs = 0;
    for (int i = 0; i < test::shape_family_count; ++i) {
        for (std::uint64_t k = 0; k < test::sample_count() / 10; ++k) {
            const auto [box, t] =
                test::make_shape_pair<aabb, TestType>(test::sample_seed, static_cast<test::shape_family>(i), k);
            const vec3<TestType> point = k % 2 == 0 ? box.upper : t.a;
            const bool truth = test::oracle::intersects(sphere<TestType>{point, 0}, t);
            const aabb<TestType> as_box{point, point};
            wrong += intersects(as_box, t) != truth || intersects<exact>(as_box, t) != truth;
            hits += truth;
            ++pairs;
        }
    }
    CHECK(wrong == 0);
    CHECK(hits * 20 > pairs);
}
