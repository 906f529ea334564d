// SPDX-License-Identifier: MIT
#include <abut/collide/body_rows.hpp>

#include "collide/body_rows_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("bodies: rays and points", "", float, double) {
    check_all_body_rows<TestType>(serial{});
    check_all_body_rows<TestType>(openmp{.threads = 3});
}

TEMPLATE_TEST_CASE("bodies: how far apart", "", float, double) {
    check_body_distance<TestType>(serial{});
    check_body_distance<TestType>(openmp{.threads = 3});
}

TEST_CASE("bodies: rays and points in trees of other layouts") {
    const openmp on{.threads = 2};
    const torus<float> ring(12, 8, 0.7, 0.3);
    const auto tree = make_bvh(on, mesh<float>(ring.vertices, ring.faces));
    const auto in_fours = wide(on, tree);
    const auto coarse = quantised(on, tree);
    std::vector<posed_object<std::remove_const_t<decltype(tree)>>> plain;
    std::vector<posed_object<std::remove_const_t<decltype(in_fours)>>> fours;
    std::vector<posed_object<std::remove_const_t<decltype(coarse)>>> bytes;
    draws d(5, 99, 0);
    std::vector<ray<float>> lines;
    std::vector<vec3<float>> from;
    for (int i = 0; i < 30; ++i) {
        const auto pose = make_pose<float>(d, 3);
        plain.push_back(posed(tree, pose)), fours.push_back(posed(in_fours, pose)), bytes.push_back(posed(coarse, pose));
        const auto at = make_pose<float>(d, 3).translation, to = make_pose<float>(d, 3).translation;
        lines.push_back({at, to - at});
        from.push_back(at);
    }
    const rays<float> rows(lines);
    const auto expected = to_host(raycast_all(on, make_bodies(on, plain), rows));
    CHECK(expected.size() > 20);
    CHECK((to_host(raycast_all(on, make_bodies(on, fours), rows)) == expected));
    CHECK((to_host(raycast_all(on, bytes, rows)) == expected));
    CHECK((to_host(raycast(on, fours, rows)) == to_host(raycast(on, plain, rows))));
    CHECK((to_host(nearest(on, fours, from, 4)) == to_host(nearest(on, plain, from, 4))));
    CHECK((to_host(nearest(on, bytes, from)) == to_host(nearest(on, plain, from))));
}

}  // namespace abut::test

TEST_CASE("bodies of boxes, which poses turn, are asked by rays, points and distances") {
    using namespace abut;
    const serial on;
    const boxes<float> one(std::vector<aabb<float>>{{{0, 0, 0}, {1, 1, 1}}});
    const auto tree = make_bvh(on, one);
    rigid<float> away;
    away.translation = {3, 0, 0};
    const std::vector<posed_object<std::remove_const_t<decltype(tree)>>> all{posed(tree, rigid<float>{}), posed(tree, away)};
    const auto hit = to_host(raycast(on, all, ray<float>{{3.5f, 0.5f, -3}, {0, 0, 1}}));
    CHECK((hit[0].body == 1 && hit[0].id == 0 && hit[0].t == 3));
    const auto near = to_host(nearest(on, all, vec3<float>{2.5f, 0.5f, 0.5f}));
    CHECK((near[0].body == 1 && near[0].distance == 0.5f));
    CHECK(distance(on, all)->distance == 2);
    CHECK_FALSE(any(on, all));
    CHECK(any_within(on, all, 2.0));
    CHECK_FALSE(any_within(on, all, 1.9375));
}
