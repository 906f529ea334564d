// SPDX-License-Identifier: MIT
#include <abut/collide/turning.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <abut/shape/hulls.hpp>

#include "collide/turning_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEST_CASE("meetings of bodies that turn: serial") {
    test::check_turning<float>(serial{}, 24);
    test::check_turning_triangles<double>(serial{}, 24);
}

TEST_CASE("meetings of bodies that turn: openmp on 3 threads") { test::check_turning_triangles<float>(openmp{3}, 24); }

TEST_CASE("first_meeting: sets, indices and single shapes, in motion and at rest") {
    const serial on;
    const mesh<float> wall{{{3, -9, -9}, {3, 9, -9}, {3, 9, 9}, {3, -9, 9}}, {{0, 1, 2}, {0, 2, 3}}};
    const rigid<float> start, end{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {4, 0, 0}};
    const sphere<float> ball{{0, 0, 0}, 1};
    const meeting_options exact{.tolerance = 1e-6};
    const auto check = [&](const std::optional<meeting>& m) {
        REQUIRE(m.has_value());
        CHECK((m->a == 0 && m->b == 0 && m->time <= 0.5 && m->time > 0.5 - 1e-6 && m->distance <= 1e-6));
    };
    check(first_meeting(on, moving(posed(ball, start), posed(ball, end)), wall, exact));
    const spheres<float> balls{ball};
    check(first_meeting(on, moving(posed(balls, start), posed(balls, end)), make_bvh(on, wall), exact));
    const auto tree = make_bvh(on, balls);
    check(first_meeting(on, moving(posed(tree, start), posed(tree, end)), posed(wall, start), exact));
    const hulls<float> cube(
        {{{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}, {1, 1, 1}}});
    check(first_meeting(on, moving(posed(cube, start), posed(cube, end)), wall, exact));
    CHECK_FALSE(first_meeting(on, moving(posed(cube, start), posed(cube, start)), wall, exact).has_value());
    CHECK_FALSE(first_meeting(on, triangle_soup<float>(), wall, exact).has_value());
    // A quarter turn brings a corner of the cube to 1.41, and so to a wall at 1.4.
    const mesh<float> near_wall{{{1.4f, -9, -9}, {1.4f, 9, -9}, {1.4f, 0, 9}}, {{0, 1, 2}}};
    const rigid<float> quarter{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {0, 0, 0}};
    const auto spun = first_meeting(on, moving(posed(cube, start), posed(cube, quarter)), near_wall, {.tolerance = 1e-9});
    REQUIRE(spun.has_value());
    // sqrt(2) cos(pi / 4 - angle) = 1.4
    const double touch = (0.78539816339744831 - std::acos(static_cast<double>(1.4f) / std::sqrt(2.0))) / 1.57079632679489662;
    CHECK((spun->time <= touch + 1e-12 && spun->time > touch - 1e-8));
    // The same with more points than are kept, of which the corners come last.
    std::vector<vec3<float>> many;
    for (int i = 0; i < 15; ++i) many.push_back({0.05f * static_cast<float>(i), 0.1f, -0.9f});
    for (int i = 0; i < 8; ++i) many.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
    const hull<float> of_many(many.data(), many.size());
    const auto again = first_meeting(on, moving(posed(of_many, start), posed(of_many, quarter)), near_wall, {.tolerance = 1e-9});
    REQUIRE(again.has_value());
    CHECK((again->time <= touch + 1e-12 && again->time > touch - 1e-8));
    // Both in motion: half of the way each.
    const rigid<float> back{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {-2, 0, 0}}, ahead{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {2, 0, 0}};
    check(first_meeting(on, moving(posed(balls, start), posed(balls, ahead)), moving(posed(wall, start), posed(wall, back)),
                        exact));
    CHECK(first_meeting(on, moving(posed(cube, start), posed(cube, quarter), {.centre = {0, 5, 0}}), near_wall, exact)
              .has_value());
}

TEST_CASE("any_each: balls that pass each other where long ways are looked at first") {
    const serial on;
    const double tolerance = 1e-3;
    const auto ball = make_bvh(on, spheres<double>({{{0, 0, 0}, 1}}));
    using index = std::remove_const_t<decltype(ball)>;
    const auto at = [](double x) { return rigid<double>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {x, 0, 0}}; };
    // Aside in y and z: the boxes around them meet.
    const auto aside = [](double r) { return rigid<double>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0.8 * r, 0.6 * r}}; };
    std::vector<moving_pair<index>> list;
    std::vector<double> gaps;
    // Nearest at the end, at the middle, and at a quarter and three quarters of the way.
    for (const double from : {-32.0, -16.0, -8.0, -24.0}) {
        for (const double gap : {-1e-6, 0.25, 0.75, 1.25, 2.0, 3.5, 8.0}) {  // in tolerances
            list.push_back({moving(posed(ball, at(from)), posed(ball, at(from + 32))), posed(ball, aside(2 + gap * tolerance))});
            gaps.push_back(gap);
        }
    }
    const auto met = to_host(any_each(on, list, {tolerance}));
    const auto found = to_host(first_meetings(on, list, {tolerance}));
    for (std::size_t i = 0; i < list.size(); ++i) {
        INFO(i << ", " << gaps[i]);
        CHECK((met[i] != 0) == (found[i].time <= 1));
        if (gaps[i] < 0 || gaps[i] > 1) CHECK((met[i] != 0) == (gaps[i] < 0));
    }
}

TEST_CASE("bodies that turn: of shapes that touch at one time the least ids, where a rotation is off") {
    const serial on;
    std::vector<aabb<float>> crates, others;
    for (int i = 0; i < 16; ++i) {  // side by side, each a little in another one since it is longer than its numbers; the last ones more
        const float y = 10.0F * static_cast<float>(i), in = i == 15 ? 1.0F : 0.0F;
        crates.push_back({{0, y, 0}, {4, y + 4, 4}});
        others.push_back({{4 - in, y + 1, 1}, {8, y + 3, 3}});
    }
    const boxes<float> a(crates), b(others);
    rigid<float> from;
    for (float* x : {&from.rotation[0], &from.rotation[4], &from.rotation[8]}) *x = 1 + 0x1p-12F;
    rigid<float> to = from;
    to.translation = {-1, 0, 0};
    const auto tree = make_bvh(on, a), other = make_bvh(on, b);
    const std::vector<moving_pair<std::remove_const_t<decltype(tree)>>> list{
        {moving(posed(tree, from), posed(tree, to)), posed(other, rigid<float>{})}};
    for (const double tolerance : {1e-6, 1e-4, 1e-2}) {
        CHECK(to_host(first_meetings(on, list, {tolerance})) == test::meetings_by_definition(list, a.view(), b.view(), tolerance));
    }
}

TEST_CASE("bodies that turn: what is refused") {
    const serial on;
    const triangle_soup<float> one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, other{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const auto a = make_bvh(on, one), b = make_bvh(on, other);
    const rigid<float> start, half{{-1, 0, 0, 0, -1, 0, 0, 0, 1}, {0, 0, 9}}, skew{{2, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
    const auto says = [](const auto& f) {
        try {
            f();
        } catch (const error& e) {
            return std::string(e.what());
        }
        return std::string("nothing");
    };
    using entries = std::vector<moving_pair<std::remove_const_t<decltype(a)>>>;
    CHECK(says([&] { (void)moving(posed(a, start), posed(b, start)); }) ==
          "abut::moving: another object at t = 1 than at t = 0");
    const entries rest{{posed(a, start), posed(b, start)}},
        turned{rest[0], {moving(posed(a, start), posed(a, half)), posed(b, start)}};
    CHECK(says([&] { (void)first_meetings(on, turned, {1e-3}); }) ==
          "abut::first_meetings: entry 1 of the list: the first body: a half turn, which goes round either way; an axis "
          "says which: "
          "turning{.axis = ...}");
    CHECK(says([&] { (void)first_meetings(on, rest, {}); }) ==
          "abut::first_meetings: the tolerance is 0; expected a length above 0");
    CHECK(says([&] { (void)any_each(on, rest, {-1}); }) == "abut::any_each: the tolerance is -1; expected a length above 0");
    CHECK(says([&] {
              (void)first_meetings(on, rest, {1e-15});
          }).find("entry 0 of the list: the tolerance is 1e-15; doubles tell ") != std::string::npos);
    CHECK(says([&] { (void)first_meeting(on, moving(posed(a, start), posed(a, skew)), b, {1e-3}); }) ==
          "abut::first_meeting: the first body: at t = 1: rotation row 0: its squared length differs from 1 by more than "
          "2^-10 (3)");
    CHECK(says([&] {
              (void)first_meeting(on, moving(posed(a, start), posed(a, half), {.axis = {1, 0, 0}}), b, {1e-3});
          }) ==
          "abut::first_meeting: the first body: the given axis is 0 of its length along that of the turn; expected more "
          "than 0.5");
    // Either way round, with an axis.
    CHECK(first_meeting(on, moving(posed(a, start), posed(a, half), {.axis = {0, 0, -3}}), b, {1e-3})->time == 0);
    CHECK(first_meetings(on, entries{}, {1e-3}).size() == 0);
}
