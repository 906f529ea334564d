// SPDX-License-Identifier: MIT
#include <limits>

#include <abut/collide/distance.hpp>

#include "collide/distance_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("distance: serial", "", float, double) { test::check_all_distances<TestType>(serial{}); }

TEST_CASE("distance: openmp on 1, 3 and 17 threads") {
    for (const int threads : {1, 3, 17}) {
        CAPTURE(threads);
        test::check_distance_by_hand<float>(openmp{threads});
        test::check_distance_of_meshes<float>(openmp{threads});
        test::check_distance_of_lists<float>(openmp{threads});
        test::check_first_of_many_touches<float>(openmp{threads});
    }
}

TEST_CASE("distance: points, segments, capsules, boxes, planes and spheres") {
    test::check_distance_of<vec3<float>, triangle<float>>(serial{}, 94);
    test::check_distance_of<segment<double>, triangle<double>>(serial{}, 95);
    test::check_distance_of<triangle<float>, capsule<float>>(serial{}, 96);
    test::check_distance_of<triangle<double>, aabb<double>>(serial{}, 97);
    test::check_distance_of<plane<float>, triangle<float>>(serial{}, 98);
    test::check_distance_of<sphere<double>, segment<double>>(serial{}, 99);
    test::check_distance_of<sphere<float>, sphere<float>>(serial{}, 100);
}

TEST_CASE("distance: wide trees and those of other builders") {
    test::uniform random(101);
    const test::torus<float> ring(24, 12, 2, 0.5f);
    const mesh<float> a(ring.vertices, ring.faces);
    const serial on;
    const auto tree = make_bvh(on, a);
    const rigid<float> pose{{0.6f, -0.8f, 0, 0.8f, 0.6f, 0, 0, 0, 1}, {4, 1, 3}};
    const auto expected = test::distance_by_definition(a.view(), posed_view<mesh_view<float>>{a.view(), pose});
    test::check_same(distance(on, wide(on, tree), posed(wide(on, tree), pose)), expected);
    test::check_same(distance(openmp{3}, wide(on, tree), posed(tree, pose)), expected);
    const auto sah = make_bvh(on, a, {.builder = bvh_builder::sah});
    test::check_same(distance(on, sah, posed(make_bvh(on, a, {.builder = bvh_builder::mean_split}), pose)), expected);
    test::check_first_of_many_touches<float, true>(on);
}

TEST_CASE("distance: surfaces of one distance everywhere, where more pairs of nodes are near than may wait") {
    const test::torus<float> outer(44, 20, 2, 0.5f), inner(40, 22, 2, 0.49f);
    const mesh<float> a(outer.vertices, outer.faces), b(inner.vertices, inner.faces);
    double least = std::numeric_limits<double>::infinity();
    index_pair nearest{};
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            const double d = detail::measure_apart{}.measure(a.view()[i], b.view()[j], least);
            if (d < least) least = d, nearest = {i, j};
        }
    }
    const serial on;
    REQUIRE_FALSE(any(on, make_bvh(on, a), make_bvh(on, b)));
    const auto check = [&](const auto& policy, const auto& tree_a, const auto& tree_b) {
        const auto found = distance(policy, tree_a, tree_b);
        REQUIRE(found);
        CHECK((index_pair{found->a, found->b} == nearest));
        CHECK(found->distance == static_cast<float>(least));
    };
    check(on, make_bvh(on, a), make_bvh(on, b));
    check(openmp{3}, make_bvh(on, a), make_bvh(on, b));
    check(on, oriented(on, make_bvh(on, a)), posed(oriented(on, make_bvh(on, b)), rigid<float>{}));
}
