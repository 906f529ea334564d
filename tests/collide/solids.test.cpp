// SPDX-License-Identifier: MIT

// Queries of boxes, spheres, capsules, segments, points and planes with each other: in sets and indices, within one set,
// posed, and in lists beside meshes. The truth is a plain loop over `intersects<exact>`, whose own truth is
// tests/predicate/without_triangle.test.cpp.

#include <abut/abut.hpp>

#include <cstdint>
#include <vector>

#include "collide/set_cases.hpp"
#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

using namespace abut;

rigid<float> tilted_pose(float x) {
    rigid<float> pose;
    pose.rotation[0] = pose.rotation[8] = 0.6f;
    pose.rotation[2] = -0.8f;
    pose.rotation[6] = 0.8f;
    pose.translation = {x, 0.125f, -0.25f};
    return pose;
}

template <class Shape>
std::vector<index_pair> placed_pairs(const shapes<Shape>& set, const rigid<float>& pose, const auto& other) {
    return test::all_that_touch(posed_view<typename shapes<Shape>::view_type>{set.view(), pose}, other);
}

/// A list of two entries, of indices that are posed each time anew, against the plain loop.
template <class A, class B>
void check_list(const A& a, const B& b) {
    const openmp on{.threads = 2};
    auto tree_a = make_bvh(on, a);
    auto tree_b = make_bvh(on, b);
    std::vector<posed_pair<decltype(tree_a), decltype(tree_b)>> list;
    std::vector<tagged_pair> expected;
    for (const float x : {0.f, 0.25f, 9.f}) {
        const rigid<float> pose = tilted_pose(x), home = tilted_pose(0);
        list.push_back({posed(tree_a, pose), posed(tree_b, home)});
        const posed_view<typename A::view_type> there_a{a.view(), pose};
        const posed_view<typename B::view_type> there_b{b.view(), home};
        for (const index_pair& p : test::all_that_touch(there_a, there_b)) {
            expected.push_back({static_cast<std::uint32_t>(list.size() - 1), p.a, p.b});
        }
    }
    CHECK(expected.size() > 40);
    CHECK(expected.size() < 2 * a.size() * b.size());
    CHECK(to_host(pairs(on, list)) == expected);
    CHECK(count(on, list) == expected.size());
    CHECK(any(on, list));
}

}  // namespace

TEST_CASE("queries: sets without triangles") {
    test::check_sets_without_triangles<float>(openmp{.threads = 2});
    test::check_pair_of_shapes<aabb<double>, capsule<double>>(serial{}, 98);
}

TEST_CASE("queries: pairs within one set of boxes, capsules or points") {
    test::check_self_pairs_of<aabb<float>>(openmp{.threads = 2}, 101);
    test::check_self_pairs_of<capsule<double>>(serial{}, 102);
}

TEST_CASE("queries: posed capsules, and boxes and planes that stay where they are") {
    const serial on;
    test::uniform random(103);
    const capsules<float> rods(test::shape_maker<capsule<float>>(random, false)(150));
    const boxes<float> crates(test::shape_maker<aabb<float>>(random, true)(150));
    const rigid<float> pose = tilted_pose(0.25f);
    const auto expected = placed_pairs(rods, pose, crates.view());
    CHECK(expected.size() > 100);
    CHECK(to_host(pairs(on, posed(rods, pose), crates)) == expected);
    CHECK(to_host(pairs(on, posed(make_bvh(on, rods), pose), make_bvh(on, crates))) == expected);
    const plane<float> ground{{0, 0.5f, 2}, 0.125f};
    const auto standing = placed_pairs(rods, pose, std::vector<plane<float>>{ground});
    CHECK(standing.size() > 10);
    CHECK(standing.size() < 140);
    CHECK(to_host(pairs(on, posed(make_bvh(on, rods), pose), ground)) == standing);
    std::uint64_t met = 0;
    for_each_pair(on, ground, posed(rods, pose), [&met](const index_pair&) {
        ++met;
        return visit::proceed;
    });
    CHECK(met == standing.size());
}

TEST_CASE("queries: boxes and a plane within a distance") {
    const openmp on{.threads = 2};
    test::uniform random(105);
    const boxes<float> crates(test::shape_maker<aabb<float>>(random, true)(120));
    const capsules<float> rods(test::shape_maker<capsule<float>>(random, true)(120));
    const triangle_soup<float> soup(test::shape_maker<triangle<float>>(random, true)(120));
    const auto check = [&](const auto& b) {
        std::vector<index_pair> expected;
        for (std::uint32_t i = 0; i < crates.size(); ++i) {
            for (std::uint32_t j = 0; j < b.size(); ++j) {
                if (within<exact>(crates.view()[i], b.view()[j], 0.25)) expected.push_back({i, j});
            }
        }
        CHECK(expected.size() > count(on, crates, b));
        CHECK(expected.size() * 2 < crates.size() * b.size());
        CHECK(to_host(within(on, make_bvh(on, crates), make_bvh(on, b), 0.25)) == expected);
        CHECK(to_host(within(on, crates, b, 0.25)) == expected);
    };
    check(rods);
    check(soup);
    const plane<float> ground{{0, 0, 2}, 0.25f};
    std::size_t near = 0;
    for (std::uint32_t i = 0; i < crates.size(); ++i) near += within<exact>(crates.view()[i], ground, 0.25);
    CHECK(near > count(on, crates, ground));
    CHECK(near < crates.size());
    CHECK(count_within(on, make_bvh(on, crates), ground, 0.25) == near);
    CHECK(count_self_within(on, make_bvh(on, crates), 0.25) > count_self_pairs(on, crates));
}

TEST_CASE("queries: contacts and the distance of boxes, capsules and a plane") {
    const openmp on{.threads = 2};
    test::uniform random(106);
    const boxes<float> crates(test::shape_maker<aabb<float>>(random, false)(60));
    const capsules<float> rods(test::shape_maker<capsule<float>>(random, false)(60));
    const auto touching = to_host(pairs(on, crates, rods));
    const auto how = to_host(contacts(on, make_bvh(on, crates), make_bvh(on, rods)));
    CHECK(touching.size() > 20);
    REQUIRE(how.size() == touching.size());
    for (std::size_t i = 0; i < how.size(); ++i) {
        contact<float> one = *contact_of(crates.view()[touching[i].a], rods.view()[touching[i].b]);
        one.a = touching[i].a, one.b = touching[i].b;
        CHECK(how[i] == one);
    }
    CHECK(distance(on, crates, rods)->distance == 0);
    // Far away: the least of all pairs.
    rigid<float> away;
    away.translation = {3, 4, 0};
    const posed_view<capsules<float>::view_type> there{rods.view(), away};
    float least = 1e9f;
    for (std::uint32_t i = 0; i < crates.size(); ++i) {
        for (std::uint32_t j = 0; j < rods.size(); ++j) {
            least = detail::least(distance(crates.view()[i], there[j]).distance, least);
        }
    }
    CHECK(least > 1);
    CHECK(distance(on, make_bvh(on, crates), posed(make_bvh(on, rods), away))->distance == least);
}

TEST_CASE("queries: lists of capsules with spheres, segments and a mesh") {
    test::uniform random(104);
    const capsules<float> rods(test::shape_maker<capsule<float>>(random, true)(120));
    const spheres<float> balls(test::shape_maker<sphere<float>>(random, false)(120));
    const segments<float> lines(test::shape_maker<segment<float>>(random, false)(120));
    const triangle_soup<float> soup(test::shape_maker<triangle<float>>(random, false)(120));
    check_list(rods, balls);
    check_list(lines, rods);
    check_list(soup, rods);
}
