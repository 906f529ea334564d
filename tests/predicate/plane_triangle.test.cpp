// SPDX-License-Identifier: MIT
#include <abut/predicate/plane_core.hpp>

#include "predicate/shape_cases.hpp"

namespace {

using namespace abut;

constexpr triangle<float> tilted{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};

// Constant expressions, in either order. A plane is a surface: a triangle on either side of it does not touch it.
static_assert(intersects(plane<float>{{1, 0, 0}, 3}, tilted) && intersects<exact>(tilted, plane<float>{{-1, 0, 0}, 0}));
static_assert(!intersects(plane<float>{{1, 0, 0}, 0x1.800002p1f}, tilted) && !intersects(tilted, plane<float>{{1, 0, 0}, -1}));
static_assert(intersects(plane<float>{{1, 1, 1}, 3}, tilted) && intersects<fast>(plane<float>{{1, 1, 1}, 3}, tilted));
static_assert(!intersects(plane<float>{{1, 1, 1}, 0x1.7ffffep1f}, tilted));
// A plane without normal is everything, or nothing.
static_assert(intersects(plane<double>{{0, 0, 0}, 0}, triangle<double>{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}));
static_assert(!intersects(plane<double>{{0, 0, 0}, 0x1p-1074}, triangle<double>{{1, 2, 3}, {4, 5, 7}, {0, 0, 0}}));

static_assert(decidable_pair<plane<float>, triangle<float>> && decidable_pair<plane<double>, triangle<double>>);
static_assert(!decidable_pair<plane<double>, triangle<float>>);

}  // namespace

TEST_CASE("plane and triangle: every stage is right in every family") {
    test::check_every_stage<plane>(
        "Plane against triangle", "plane-triangle.md",
        {{"touching: corner", "touching: edge", "touching: face", "touching: along axes", "touching: corner, far off"}});
}

TEST_CASE("plane and triangle: right in every floating-point mode") { test::check_every_mode<plane>(); }

TEST_CASE("plane and triangle: one answer for every order, mirror and power of two") { test::check_one_answer<plane>(); }
