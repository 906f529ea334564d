// SPDX-License-Identifier: MIT
#include <abut/collide/mixed_questions.hpp>

#include <abut/shape/hulls.hpp>

#include "collide/mixed_bodies_cases.hpp"

namespace abut::test {

/// Meshes, hulls, boxes, capsules, spheres and cylinders in one scene.
TEST_CASE("bodies of six kinds in one scene") {
    using T = double;
    const serial on;
    const torus<T> ring(6, 5, 0.7, 0.3);
    const std::vector<vec3<T>> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    const segment<T> up{{0, 0, 0}, {0, 0, 1}};
    mixed_scene<serial, mesh<T>, hulls<T>, boxes<T>, capsules<T>, spheres<T>, cylinders<T>> scene(
        on, {mesh<T>(ring.vertices, ring.faces)}, {hulls<T>(corners, std::vector<std::uint32_t>{0, 5})},
        {boxes<T>(std::vector<aabb<T>>{{{0, 0, 0}, {0.5, 1, 0.25}}})}, {capsules<T>(std::vector<capsule<T>>{{up, 0.25}})},
        {spheres<T>(std::vector<sphere<T>>{{{0, 0, 0}, 0.5}})}, {cylinders<T>(std::vector<cylinder<T>>{{up, 0.25}})});
    draws d(20281130, 91, 0);
    scene.for_each_kind([&](auto& kind) {
        for (int i = 0; i < 4; ++i) kind.add(0, make_pose<T>(d, 2));
    });
    const auto all = scene.made(on);
    std::vector<body_pair> touch;
    for_each_two_shapes(scene.shapes(), [&](const auto& x, const auto& y, const auto& s, const auto& t) {
        if (intersects<exact>(s, t)) touch.push_back({x.body, y.body, x.id, y.id});
    });
    std::sort(touch.begin(), touch.end());
    CHECK(touch.size() > 20);
    CHECK((to_host(pairs(on, all)) == touch));
    CHECK(all.size() == 24);
    // In a row: none touch.
    auto poses = scene.poses();
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].translation = {T(4 * i), 0, 0};
    const auto apart = refit(on, all, poses);
    CHECK(!any(on, apart));
    std::size_t k = 0;
    scene.for_each_kind([&](auto& kind) {
        for (auto& body : kind.bodies) body.pose = poses[k++];
    });
    CHECK(check_mixed_distance(on, scene, apart) > 1);
}

}  // namespace abut::test
