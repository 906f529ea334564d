// SPDX-License-Identifier: MIT
#include <abut/collide/body_pairs.hpp>

#include "collide/body_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("many bodies: serial and openmp", "", float, double) {
    check_all_bodies<TestType>(serial{});
    check_all_bodies<TestType>(openmp{.threads = 3});
}

TEST_CASE("many bodies: layouts, schedules, and the set alone") {
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
    const auto expected = to_host(pairs(on, bodies));
    CHECK(expected.size() > 1000);
    CHECK((to_host(pairs(on, coarse_bodies)) == expected));
    const body_options<keep_all, schedule::work_stealing> stealing;
    CHECK((to_host(pairs(on, bodies, stealing)) == expected));
    CHECK(count<fast>(on, bodies) > 0);
    // Of a mesh neighbours are no self pairs; two bodies of that mesh in one place meet in all that they have in common. A
    // list of one body has none, whatever its set has.
    CHECK(self_pairs(on, bodies[0], {.sorted = false}).empty());
    bodies.erase(bodies.begin() + 1, bodies.end());
    CHECK(pairs(on, bodies, {.sorted = false}).empty());
    bodies.push_back(bodies[0]);
    CHECK(count(on, bodies) >= 13 * tree.size());
}

/// A tree of so many shapes that nobody looks at.
bvh<spheres_view<float>, host_space> tree_of(std::size_t n) {
    static const sphere<float> one{{0, 0, 0}, 1};
    auto nodes = std::make_shared<standard_layout::storage<float, host_space>>();
    nodes->root = execution::buffer<bvh_root<float>, host_space>(serial{}, 1);
    nodes->root.data()[0] = {bounds(one), bvh_child::inner(0)};
    return {spheres_view<float>(&one, n), nodes};
}

TEST_CASE("many bodies: what does not fit is refused") {
    const serial on;
    const auto said_of = [&](std::size_t shapes, std::size_t n) -> std::string {
        const auto all =
            make_bodies(on, std::vector{tree_of(shapes)}, std::vector<std::uint32_t>(n), std::vector<rigid<float>>(n));
        try {
            (void)count(on, all);
        } catch (const capacity_error& problem) {
            return problem.what();
        }
        return "";
    };
    // 13 bits for 8,128 pairs, and 26 for each of two ids.
    CHECK(said_of(std::size_t{1} << 26, 128) ==
          "abut::count: a list of 8128 pairs of bodies whose boxes are near with up to 67108864 and 67108864 shapes; expected "
          "positions and ids of 64 bits together");
    const std::size_t many = (std::size_t{1} << 30) + 1;
    CHECK(said_of(many, 3) == "abut::count: a body has 1073741825 shapes; one of many has at most 1073741824");
}

}  // namespace abut::test
