// SPDX-License-Identifier: MIT

// Queries of cylinders and cones: in sets and indices, against sets of each shape that they are decided with, posed, and in
// lists. The truth is a plain loop over `intersects<exact>`, whose own truth is tests/predicate/revolution.test.cpp.

#include <abut/abut.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "collide/set_cases.hpp"
#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

using namespace abut;

template <scalar T>
rigid<T> tilted_pose(T x) {
    rigid<T> pose;
    pose.rotation[0] = pose.rotation[8] = T(0.6);
    pose.rotation[2] = T(-0.8);
    pose.rotation[6] = T(0.8);
    pose.translation = {x, T(0.125), T(-0.25)};
    return pose;
}

template <class Solid>
void check_posed(std::uint64_t seed, scalar_type_of<Solid> far, scalar_type_of<Solid> length) {
    using T = scalar_type_of<Solid>;
    CAPTURE(seed, far, length);
    const openmp on{.threads = 2};
    test::uniform random(seed);
    std::vector<Solid> solids = test::shape_maker<Solid>(random, false)(150);
    std::vector<triangle<T>> triangles = test::shape_maker<triangle<T>>(random, false)(150);
    const vec3<T> away{far, far, -far};
    // Flat ones far away, whose axes turn where their ends are rounded.
    for (Solid& s : solids) {
        if constexpr (requires { s.apex; }) {
            s = {away + s.apex, away + s.apex + length * (s.base_center - s.apex), s.radius};
        } else {
            s = {{away + s.axis.a, away + s.axis.a + length * (s.axis.b - s.axis.a)}, s.radius};
        }
    }
    const rigid<T> pose = tilted_pose(T(0.25));
    for (triangle<T>& t : triangles) t = {place(pose, away + t.a), place(pose, away + t.b), place(pose, away + t.c)};
    const shapes<Solid> set(solids);
    const triangle_soup<T> soup(triangles);
    const auto expected = test::all_that_touch(posed_view<typename shapes<Solid>::view_type>{set.view(), pose}, soup.view());
    CHECK(expected.size() > 40);
    CHECK(expected.size() < 150 * 150);
    const auto tree = make_bvh(on, set);
    CHECK(to_host(pairs(on, posed(set, pose), soup)) == expected);
    CHECK(to_host(pairs(on, posed(tree, pose), soup)) == expected);
    CHECK(to_host(pairs(on, posed(tree, pose), make_bvh(on, soup))) == expected);
    using entry = posed_pair<std::remove_const_t<decltype(tree)>, decltype(make_bvh(on, soup))>;
    const std::vector<entry> list{{posed(tree, pose), posed(make_bvh(on, soup), rigid<T>{})}};
    CHECK(count(on, list) == expected.size());
}

}  // namespace

TEST_CASE("queries: sets of cylinders") {
    const openmp on{.threads = 2};
    test::check_pair_of_shapes<cylinder<float>, triangle<float>>(on, 211);
    test::check_pair_of_shapes<triangle<double>, cylinder<double>>(serial{}, 212);
    test::check_pair_of_shapes<cylinder<float>, segment<float>>(on, 213);
    test::check_pair_of_shapes<vec3<float>, cylinder<float>>(on, 214);
    test::check_pair_of_shapes<cylinder<double>, sphere<double>>(on, 215);
    test::check_pair_of_shapes<aabb<float>, cylinder<float>>(on, 216);
    test::check_pair_of_shapes<cylinder<float>, plane<float>>(on, 217);
    test::check_pair_of_shapes<cylinder<float>, cylinder<float>>(on, 218);
    test::check_pair_of_shapes<cylinder<double>, capsule<double>>(serial{}, 219);
    test::check_pair_of_shapes<capsule<float>, cylinder<float>>(on, 220);
}

TEST_CASE("queries: sets of cones") {
    const openmp on{.threads = 2};
    test::check_pair_of_shapes<triangle<float>, cone<float>>(on, 221);
    test::check_pair_of_shapes<cone<double>, triangle<double>>(serial{}, 222);
    test::check_pair_of_shapes<segment<float>, cone<float>>(on, 223);
    test::check_pair_of_shapes<cone<float>, vec3<float>>(on, 224);
    test::check_pair_of_shapes<sphere<float>, cone<float>>(on, 225);
    test::check_pair_of_shapes<cone<double>, aabb<double>>(on, 226);
    test::check_pair_of_shapes<plane<float>, cone<float>>(on, 227);
    test::check_pair_of_shapes<cone<float>, cone<float>>(on, 258);
    test::check_pair_of_shapes<cone<double>, cylinder<double>>(serial{}, 259);
    test::check_pair_of_shapes<capsule<float>, cone<float>>(on, 260);
}

TEST_CASE("queries: grids of cylinders and cones, one of them, and a mesh") {
    const openmp on{.threads = 2};
    test::uniform random(231);
    const cylinders<float> rods(test::shape_maker<cylinder<float>>(random, true)(200));
    const cones<float> tips(test::shape_maker<cone<float>>(random, true)(200));
    const triangle_soup<float> soup(test::shape_maker<triangle<float>>(random, true)(200));
    const auto expected = test::all_that_touch(rods.view(), soup.view());
    CHECK(to_host(pairs(on, make_grid(on, rods), soup)) == expected);
    CHECK(to_host(pairs<exact>(on, soup, make_grid(on, rods))).size() == expected.size());
    CHECK(count(on, tips, make_grid(on, soup)) == test::all_that_touch(tips.view(), soup.view()).size());
    CHECK(any(on, make_grid(on, tips), make_grid(on, soup)));
    const mesh<float> sheet(std::vector<vec3<float>>{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                            std::vector<face>{{0, 1, 2}, {0, 2, 3}});
    CHECK(count(on, cylinder<float>{{{0, 0, 1}, {0, 0, 3}}, 1}, sheet) == 0);
    CHECK(count(on, cylinder<float>{{{0.5f, 0, 0}, {0.5f, 0, 3}}, 0.25f}, sheet) == 1);
    CHECK(count(on, make_bvh(on, sheet), cone<float>{{0, 0, 0}, {0, 0, 3}, 1}) == 2);
    CHECK_FALSE(any(on, cone<float>{{0, 0, 0x1p-20f}, {0, 0, 3}, 1}, sheet));
}

TEST_CASE("queries: posed cylinders and cones") {
    check_posed<cylinder<float>>(241, 0, 1);
    check_posed<cylinder<float>>(242, 4096, 0x1p-8f);
    check_posed<cylinder<double>>(243, 0x1p40, 0x1p-10);
    check_posed<cone<float>>(244, 4096, 0x1p-8f);
    check_posed<cone<double>>(245, 0, 1);
}

TEST_CASE("queries: cylinders among themselves, posed and in lists") {
    const openmp on{.threads = 2};
    test::uniform random(251);
    auto rods = test::shape_maker<cylinder<float>>(random, true)(120);
    rods.push_back({{{0, 0, 0}, {0, 0, 2}}, 1});  // beside each other and on top of each other, touching
    rods.push_back({{{2, 0, 1}, {2, 0, 3}}, 1});
    rods.push_back({{{-3, 0, 3}, {3, 0, 3}}, 1});
    const cylinders<float> set(rods);
    const auto tree = make_bvh(on, set);
    std::vector<index_pair> expected;
    for (std::uint32_t i = 0; i < rods.size(); ++i) {
        for (std::uint32_t j = i + 1; j < rods.size(); ++j) {
            if (intersects<exact>(rods[i], rods[j])) expected.push_back({i, j});
        }
    }
    CHECK(expected.size() > 100);
    CHECK(std::find(expected.begin(), expected.end(), index_pair{120, 121}) != expected.end());
    CHECK(std::find(expected.begin(), expected.end(), index_pair{120, 122}) != expected.end());
    CHECK(to_host(self_pairs(on, tree)) == expected);
    CHECK(to_host(self_pairs<exact>(serial{}, set)) == expected);

    const rigid<float> pose = tilted_pose(0.25f), other = tilted_pose(-0.5f);
    const posed_view<cylinders<float>::view_type> a{set.view(), pose}, b{set.view(), other};
    const auto of_both = test::all_that_touch(a, b);
    CHECK(of_both.size() > 100);
    CHECK(to_host(pairs(on, posed(tree, pose), posed(tree, other))) == of_both);
    using entry = posed_pair<std::remove_const_t<decltype(tree)>, std::remove_const_t<decltype(tree)>>;
    CHECK(count(on, std::vector<entry>{{posed(tree, pose), posed(tree, other)}}) == of_both.size());
}

TEST_CASE("queries: cones among themselves, posed and with cylinders") {
    const openmp on{.threads = 2};
    test::uniform random(261);
    auto caps = test::shape_maker<cone<double>>(random, true)(100);
    caps.push_back({{0, 0, 0}, {0, 0, 4}, 3});  // tip on tip, and side along side
    caps.push_back({{0, 0, 0}, {0, 0, -4}, 3});
    caps.push_back({{3, 0, 4}, {3, 0, 0}, 3});
    const cones<double> set(caps);
    const auto tree = make_bvh(on, set);
    std::vector<index_pair> expected;
    for (std::uint32_t i = 0; i < caps.size(); ++i) {
        for (std::uint32_t j = i + 1; j < caps.size(); ++j) {
            if (intersects<exact>(caps[i], caps[j])) expected.push_back({i, j});
        }
    }
    CHECK(expected.size() > 100);
    CHECK(std::find(expected.begin(), expected.end(), index_pair{100, 101}) != expected.end());
    CHECK(std::find(expected.begin(), expected.end(), index_pair{100, 102}) != expected.end());
    CHECK(to_host(self_pairs(on, tree)) == expected);
    CHECK(to_host(self_pairs<exact>(serial{}, set)) == expected);

    const cylinders<double> rods(test::shape_maker<cylinder<double>>(random, true)(80));
    const rigid<double> pose = tilted_pose(0.25), other = tilted_pose(-0.5);
    const posed_view<cones<double>::view_type> a{set.view(), pose};
    const posed_view<cylinders<double>::view_type> b{rods.view(), other};
    const auto of_both = test::all_that_touch(a, b);
    CHECK(of_both.size() > 50);
    CHECK(to_host(pairs(on, posed(tree, pose), posed(rods, other))) == of_both);
}

TEST_CASE("queries: cylinders and cones that are none are refused") {
    const vec3<double> o{0, 0, 0};
    CHECK_THROWS_WITH(cylinders<double>(std::vector<cylinder<double>>{{{o, o}, 1}, {{o, o}, -1}}),
                      "abut::cylinders: cylinder 1: radius is negative (-1)");
    CHECK_THROWS_WITH(cones<double>(std::vector<cone<double>>{{o, o, -2}}), "abut::cones: cone 0: radius is negative (-2)");
    CHECK_THROWS_AS(
        count(serial{}, cone<double>{o, {0, infinity<double>, 0}, 1}, points<double>(std::vector<vec3<double>>{o})),
        invalid_geometry);
    // Without length they are balls.
    CHECK(count(serial{}, cylinders<double>(std::vector<cylinder<double>>{{{o, o}, 1}}),
                points<double>(std::vector<vec3<double>>{{0, 1, 0}, {1, 1, 0}})) == 1);
}
