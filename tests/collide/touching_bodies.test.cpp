// SPDX-License-Identifier: MIT
#include <abut/collide/touching_bodies.hpp>

#include "collide/touching_bodies_cases.hpp"
#include "support/catch.hpp"

#include <atomic>

namespace abut::test {

TEMPLATE_TEST_CASE("bodies as wholes: serial and openmp", "", float, double) {
    check_whole_bodies<TestType>(serial{});
    check_whole_bodies<TestType>(openmp{.threads = 3});
}

/// Counts how often it is asked.
struct counted_bodies {
    std::atomic<int>* asked;
    bool operator()(std::uint32_t, std::uint32_t) const { return ++*asked < 0; }
};
struct counted_shapes {
    std::atomic<int>* asked;
    bool operator()(const body_pair&) const {
        ++*asked;
        return true;
    }
};

TEST_CASE("bodies as wholes: a filter of bodies is asked once, and two bodies are looked at until they touch") {
    const serial on;
    const torus<float> shape(24, 16, 0.7F, 0.3F);
    const auto tree = make_bvh(on, triangle_soup<float>(triangles_of(shape.vertices, shape.faces)));
    const std::vector two{posed(tree, rigid<float>{}), posed(tree, rigid<float>{.translation = {0.001F, 0.002F, 0.003F}})};
    const auto scene = make_bodies(on, two);
    std::atomic<int> asked{0};
    CHECK(count(on, scene, body_options<keep_all, schedule::shared_list, counted_bodies>{.bodies = {&asked}}) == 0);
    CHECK(asked == 1);

    std::atomic<int> all{0}, few{0};
    CHECK(count(on, scene, body_options<counted_shapes>{.filter = {&all}}) > 200);
    CHECK((to_host(touching_bodies(on, scene, body_options<counted_shapes>{.filter = {&few}})) ==
           std::vector<index_pair>{{0, 1}}));
    CHECK(few * 4 < all);
}

TEST_CASE("bodies as wholes: lists of posed indices, one scene with itself, and contacts") {
    const serial on;
    const auto ball = make_bvh(on, spheres<double>({{{0, 0, 0}, 1}}));
    const auto box = make_bvh(on, boxes<double>({aabb<double>{{-1, -1, -1}, {1, 1, 1}}}));
    const std::vector balls{posed(ball, rigid<double>{}), posed(ball, rigid<double>{.translation = {3, 0, 0}})};
    const std::vector crates{posed(box, rigid<double>{.translation = {2, 0, 0}}),
                             posed(box, rigid<double>{.translation = {9, 0, 0}})};
    const auto both = between(balls, crates);
    CHECK((to_host(touching_bodies(on, both)) == std::vector<index_pair>{{0, 0}, {1, 0}}));
    const auto found = to_host(contacts(on, both));
    REQUIRE(found.size() == 2);
    CHECK((found[0].body_a == 0 && found[0].body_b == 0 && found[0].depth == 0));
    CHECK((found[1].body_a == 1 && found[1].body_b == 0));
    const auto scene = make_bodies(on, balls);
    CHECK((to_host(touching_bodies(on, between(scene, scene))) == std::vector<index_pair>{{0, 0}, {1, 1}}));
    CHECK(touching_bodies(on, scene).empty());
    CHECK((to_host(bodies_within(on, scene, 1.0)) == std::vector<index_pair>{{0, 1}}));
    CHECK_THROWS_AS(bodies_within(on, scene, -1.0), error);
}

}  // namespace abut::test
