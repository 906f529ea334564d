// SPDX-License-Identifier: MIT
#include <abut/predicate/capsule_triangle.hpp>

#include "predicate/shape_cases.hpp"

namespace {

using namespace abut;

constexpr triangle<float> ground{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
constexpr triangle<double> wide{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};

// Constant expressions, in either order: an end over the face, the axis beside a corner and an edge, and across the face.
static_assert(intersects(capsule<float>{{{0, 0, 5}, {0, 7, 9}}, 5}, ground));
static_assert(!intersects(ground, capsule<float>{{{0, 0, 5}, {0, 7, 9}}, 0x1.3ffffep2f}));
static_assert(intersects<exact>(ground, capsule<float>{{{-7, 5, 3}, {7, 5, 3}}, 5}));
static_assert(!intersects<exact>(ground, capsule<float>{{{-7, 5, 3}, {7, 5, 3}}, 0x1.3ffffep2f}));
static_assert(intersects(wide, capsule<double>{{{0, -13, 9}, {0, -13, -9}}, 4}));
static_assert(!intersects(wide, capsule<double>{{{0, -13, 9}, {0, -13, -9}}, 0x1.fffffffffffffp1}));
static_assert(intersects<fast>(capsule<float>{{{0, 0, -9}, {0, 0, 9}}, 0}, ground));
// Without radius, without length, without both.
static_assert(intersects(capsule<double>{{{0, 0, -9}, {0, 0, 9}}, 0}, wide));
static_assert(!intersects(capsule<double>{{{0, 0, 0x1p-52}, {0, 0, 9}}, 0}, wide));
static_assert(intersects(capsule<double>{{{0, 0, 4}, {0, 0, 4}}, 4}, wide));
static_assert(intersects(capsule<double>{{{0, 0, 0}, {0, 0, 0}}, 0}, wide));
// The filter knows an axis that crosses the face.
static_assert(decide<filtered>(capsule<double>{{{0, 0, -9}, {0, 1, 9}}, 0}, wide) == verdict::yes);

static_assert(decidable_pair<capsule<float>, triangle<float>> && decidable_pair<capsule<double>, triangle<double>>);
static_assert(!decidable_pair<capsule<float>, triangle<double>>);

}  // namespace

TEST_CASE("capsule and triangle: every stage is right in every family") {
    test::check_every_stage<capsule>("Capsule against triangle", "capsule-triangle.md",
                                     {{"touching: end, corner", "touching: end, edge", "touching: end, face",
                                       "touching: axis, corner", "touching: axis, edge"}});
}

TEST_CASE("capsule and triangle: right in every floating-point mode") { test::check_every_mode<capsule>(); }

TEST_CASE("capsule and triangle: one answer for every order, mirror and power of two") { test::check_one_answer<capsule>(); }

TEMPLATE_TEST_CASE("capsule and triangle: a sphere where it has no length, a segment where it has no radius", "", float,
                   double) {
    std::uint64_t wrong = 0, hits = 0, pairs = 0;
    for (int i = 0; i < test::shape_family_count; ++i) {
        for (std::uint64_t k = 0; k < test::sample_count() / 10; ++k) {
            const auto [s, t] =
                test::make_shape_pair<capsule, TestType>(test::sample_seed, static_cast<test::shape_family>(i), k);
            const sphere<TestType> ball{s.axis.b, s.radius};
            const bool as_ball = test::oracle::intersects(ball, t), as_segment = test::oracle::intersects(s.axis, t);
            const capsule<TestType> short_one{{s.axis.b, s.axis.b}, s.radius}, thin_one{s.axis, TestType(0)};
            wrong +=
                test::oracle::intersects(short_one, t) != as_ball || test::oracle::intersects(thin_one, t) != as_segment;
            wrong += intersects(short_one, t) != as_ball || intersects<exact>(short_one, t) != as_ball;
            wrong += intersects(thin_one, t) != as_segment || intersects<exact>(thin_one, t) != as_segment;
            wrong += intersects(ball, t) != as_ball;
            hits += as_ball + as_segment;
            pairs += 2;
        }
    }
    CHECK(wrong == 0);
    CHECK(hits * 20 > pairs);
}
