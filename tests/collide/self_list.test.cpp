// SPDX-License-Identifier: MIT
#include <abut/collide/self_list.hpp>

#include "collide/self_list_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("self pairs of a list of bodies: serial and openmp", "", float, double) {
    check_all_bodies<TestType>(serial{});
    check_all_bodies<TestType>(openmp{.threads = 3});
}

TEST_CASE("self pairs of a list of bodies: layouts, schedules, and the set alone") {
    uniform random(20270404);
    draws d(20270404, 97, 0);
    const openmp on{.threads = 3};
    const torus<float> shape(24, 16, 0.7, 0.3);
    const auto tree = make_bvh(on, mesh<float>(shape.vertices, shape.faces));
    const auto coarse = quantised(on, tree);
    std::vector<posed_object<std::remove_const_t<decltype(tree)>>> bodies;
    std::vector<posed_object<std::remove_const_t<decltype(coarse)>>> coarse_bodies;
    for (int i = 0; i < 20; ++i) {
        const auto pose = make_pose<float>(d, 2);
        bodies.push_back(posed(tree, pose));
        coarse_bodies.push_back(posed(coarse, pose));
    }
    const auto expected = to_host(self_pairs(on, bodies));
    CHECK(expected.size() > 1000);
    CHECK((to_host(self_pairs(on, coarse_bodies)) == expected));
    const body_options<keep_all_bodies, schedule::work_stealing> stealing;
    CHECK((to_host(self_pairs(on, bodies, stealing)) == expected));
    CHECK(count_self_pairs<fast>(on, bodies) > 0);
    // Of a mesh neighbours are no self pairs; two bodies of that mesh in one place meet in all that they have in common. A
    // list of one body has none, whatever its set has.
    CHECK(self_pairs(on, bodies[0], {.sorted = false}).empty());
    bodies.erase(bodies.begin() + 1, bodies.end());
    CHECK(self_pairs(on, bodies, {.sorted = false}).empty());
    bodies.push_back(bodies[0]);
    CHECK(count_self_pairs(on, bodies) >= 13 * tree.size());
}

}  // namespace abut::test
