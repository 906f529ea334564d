// SPDX-License-Identifier: MIT
#include <abut/collide/raycast_all.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "collide/raycast_solids_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("raycast of solids: serial", "", sphere<float>, aabb<float>, capsule<float>, cylinder<float>, cone<float>,
                   sphere<double>, aabb<double>, capsule<double>, cylinder<double>, cone<double>) {
    test::check_raycast_of<TestType>(serial{});
    test::check_raycast_scales_of<TestType>(serial{});
}

TEMPLATE_TEST_CASE("raycast of solids: openmp", "", sphere<float>, aabb<double>, capsule<double>, cylinder<float>,
                   cone<float>) {
    test::check_raycast_of<TestType>(openmp{3});
}

TEST_CASE("raycast of solids: by hand") {
    const auto first = [](const auto& shape, const auto& line) {
        const auto hits = raycast(serial{}, shape, line).to_host();
        REQUIRE(hits.size() == 1);
        CHECK(raycast_any(serial{}, shape, line)[0] == (hits[0].id == 0 ? 1 : 0));
        CHECK((hits[0].id == no_id) == std::isinf(hits[0].t));
        return hits[0].id == 0 ? hits[0].t : -1;
    };
    using line = ray<float>;
    const sphere<float> ball{{0, 0, 5}, 2};
    CHECK(first(ball, line{{0, 0, 0}, {0, 0, 2}}) == 1.5f);
    CHECK(first(ball, line{{0, 0, 0}, {0, 0, -2}}) == -1);
    CHECK(first(ball, line{{2, 0, 0}, {0, 0, 2}}) == 2.5f);  // touches
    CHECK(first(ball, line{{std::nextafter(2.0f, 3.0f), 0, 0}, {0, 0, 2}}) == -1);
    CHECK(first(ball, line{{0, 1, 5}, {1, 0, 0}}) == 0);  // begins inside
    CHECK(first(ball, line{{0, 0, 7}, {0, 0, 1}}) == 0);  // and on the surface
    CHECK(first(ball, line{{0, 0, 7}, {0, 0, 0}}) == 0);  // goes nowhere
    CHECK(first(ball, line{{0, 0, 7.5f}, {0, 0, 0}}) == -1);
    CHECK(first(ball, segment<float>{{0, 0, 0}, {0, 0, 3}}) == 1);
    CHECK(first(ball, segment<float>{{0, 0, 0}, {0, 0, 2.75f}}) == -1);
    const sphere<float> point{{3, 3, 3}, 0};
    CHECK(first(point, line{{0, 0, 0}, {2, 2, 2}}) == 1.5f);
    CHECK(first(point, line{{0, 0, 0}, {2, 2, 2.5f}}) == -1);
    const aabb<float> box{{1, 1, 1}, {2, 3, 4}}, sheet{{1, 1, 1}, {2, 3, 1}};
    CHECK(first(box, line{{0, 0, 0}, {1, 1, 1}}) == 1);      // through a corner
    CHECK(first(box, line{{0, 3, 1}, {4, 0, 0}}) == 0.25f);  // along an edge
    CHECK(first(box, line{{2, 3, 4}, {1, 1, 1}}) == 0);
    CHECK(first(box, line{{0, 0, 0}, {0, 0, 0}}) == -1);
    CHECK(first(sheet, line{{1.5f, 2, 0}, {0, 0, 3}}) == 1 / 3.0f);
    CHECK(first(sheet, line{{0, 2, 1}, {2, 0, 0}}) == 0.5f);  // in its plane
    const capsule<float> rod{{{0, 0, 0}, {0, 0, 4}}, 1};
    CHECK(first(rod, line{{-3, 0, 2}, {1, 0, 0}}) == 2);
    CHECK(first(rod, line{{0, 0, -3}, {0, 0, 1}}) == 2);  // a cap
    CHECK(first(rod, line{{1, 0, -3}, {0, 0, 1}}) == 3);  // along the side
    CHECK(first(rod, line{{-3, 1, 4}, {1, 0, 0}}) == 3);  // touches where both meet
    const cylinder<float> tin{{{0, 0, 0}, {0, 0, 4}}, 1};
    CHECK(first(tin, line{{0, 0, -3}, {0, 0, 1}}) == 3);   // an end
    CHECK(first(tin, line{{1, 0, -3}, {0, 0, 1}}) == 3);   // along the side
    CHECK(first(tin, line{{-3, 0, 4}, {1, 0, 0}}) == 2);   // in an end
    CHECK(first(tin, line{{-2, 0, -1}, {1, 0, 1}}) == 1);  // at the rim
    CHECK(first(tin, line{{-2, 0, -1}, {1, 0, 0.96875f}}) == 32 / 31.0f);
    const cone<float> hat{{0, 0, 4}, {0, 0, 0}, 2};
    CHECK(first(hat, line{{-3, 0, 2}, {1, 0, 0}}) == 2);
    CHECK(first(hat, line{{0, 0, 6}, {0, 0, -1}}) == 2);      // at the apex
    CHECK(first(hat, line{{-1, 0, 6}, {0.5f, 0, -1}}) == 2);  // along a ruling
    CHECK(first(hat, line{{-1, 0, 4}, {1, 0, 0}}) == 1);      // through the apex alone
    CHECK(first(hat, line{{-1, 0, 4.5f}, {1, 0, 0}}) == -1);  // above it there is nothing
    CHECK(first(hat, line{{-1, 0, 8}, {0, 0, -1}}) == 6);     // through where the other half would be
    CHECK(first(hat, line{{-1, 0, 8}, {0, 0, 1}}) == -1);
    // Without length they are balls.
    CHECK(first(cylinder<float>{{ball.center, ball.center}, 2}, line{{0, 0, 0}, {0, 0, 2}}) == 1.5f);
    CHECK(first(cone<float>{ball.center, ball.center, 2}, line{{0, 0, 0}, {0, 0, 2}}) == 1.5f);
    CHECK(first(capsule<float>{{ball.center, ball.center}, 2}, line{{0, 0, 0}, {0, 0, 2}}) == 1.5f);
    // A time above the largest number is that.
    CHECK(first(sphere<float>{{0, 0, 1e30f}, 1}, line{{0, 0, 0}, {0, 0, 1e-30f}}) == std::numeric_limits<float>::max());
    CHECK(raycast<fast>(serial{}, ball, line{{0, 0, 0}, {0, 0, 2}}).to_host()[0] == ray_hit<float>{0, 1.5f});
    CHECK(raycast<fast>(serial{}, hat, line{{-1, 0, 6}, {0.5f, 0, -1}}).to_host()[0] == ray_hit<float>{0, 2});
    const line beside_ruling{{-2, 0, 4}, {0.5f, 0, -1}}, to_ruling{{1, 0, 0}, {-0.5f, 0, 1}};
    CHECK(first(hat, beside_ruling) == 2);
    CHECK(raycast<fast>(serial{}, hat, beside_ruling).to_host()[0] == ray_hit<float>{0, 2});
    CHECK(raycast<fast>(serial{}, hat, to_ruling).to_host()[0] == ray_hit<float>{0, 0});
    static_assert(intersects(ray<float>{{0, 0, 0}, {0, 0, 2}}, sphere<float>{{0, 0, 5}, 2}));
    static_assert(!intersects(cone<float>{{0, 0, 4}, {0, 0, 0}, 2}, ray<float>{{-1, 0, 4.5f}, {1, 0, 0}}));
    static_assert(intersects<fast>(ray<float>{{0, 0, 0}, {0, 0, 2}}, capsule<float>{{{0, 0, 5}, {1, 0, 5}}, 2}));
}

TEST_CASE("raycast of solids: sets and views of each kind") {
    const std::vector<sphere<float>> balls{{{0, 0, 5}, 1}, {{0, 0, 9}, 1}, {{5, 0, 5}, 1}};
    const rays<float> lines({{{0, 0, 0}, {0, 0, 1}}, {{5, 0, 0}, {0, 0, 2}}, {{9, 9, 9}, {0, 0, 1}}});
    const std::vector<ray_hit<float>> expected{{0, 4}, {2, 2}, {no_id, std::numeric_limits<float>::infinity()}};
    CHECK(raycast(serial{}, spheres<float>(balls), lines).to_host() == expected);
    CHECK(raycast(serial{}, spheres_view<float>(balls.data(), balls.size()), lines).to_host() == expected);
    CHECK(
        raycast(serial{}, make_bvh(serial{}, equal_spheres<float>({{0, 0, 5}, {0, 0, 9}, {5, 0, 5}}, 1)), lines).to_host() ==
        expected);
    CHECK(raycast_all(serial{}, spheres<float>(balls), lines).to_host() ==
          std::vector<hit_of_ray<float>>{{0, 0, 4}, {0, 1, 8}, {1, 2, 2}});
    CHECK(raycast_any(serial{}, spheres<float>(balls), lines).to_host() == std::vector<std::uint8_t>{1, 1, 0});
    std::vector<aabb<float>> around;
    std::vector<capsule<float>> rods;
    std::vector<cylinder<float>> tins;
    std::vector<cone<float>> hats;
    for (const auto& s : balls) {
        around.push_back(bounds(s));
        const vec3<float> low{s.center.x, s.center.y, s.center.z - 1}, high{s.center.x, s.center.y, s.center.z + 1};
        rods.push_back({{s.center, s.center}, 1});
        tins.push_back({{low, high}, 1});
        hats.push_back({low, high, 1});
    }
    CHECK(raycast(serial{}, capsules<float>(rods), lines).to_host() == expected);
    CHECK(raycast(serial{}, cylinders<float>(tins), lines).to_host() == expected);
    CHECK(raycast(serial{}, cones<float>(hats), lines).to_host() == expected);
    const auto in_boxes = raycast(serial{}, boxes<float>(around), lines).to_host();
    CHECK(in_boxes[0].id == 0);
    CHECK(in_boxes[0].t <= 4);
}

TEST_CASE("raycast: times that are rounded far, at the ends of the range, are equal in trees too") {
    // The last shape is met first, at a time that is rounded to that of all others.
    const auto check = [](const auto& all, const ray<double>& line) {
        const serial on;
        const auto tree = make_bvh(on, all);
        CHECK(raycast(on, all, line)[0].id == 0);
        CHECK(raycast(on, tree, line)[0].id == 0);
        CHECK(raycast(on, wide(on, tree), line)[0].id == 0);
        CHECK(raycast(on, quantised(on, tree), line)[0].id == 0);
    };
    std::vector<sphere<double>> late, near;
    std::vector<triangle<double>> faces;
    const auto face_at = [](double x) { return triangle<double>{{x, -1, -1}, {x, 1, -1}, {x, 0, 2}}; };
    for (int i = 0; i < 40; ++i) {
        late.push_back({{140 - 0.1 * i, 0, 0}, 1});
        near.push_back({{0x1p-80 * (1 + 0.001 * i), 0, 0}, 0x1p-95});
        faces.push_back(face_at(140 - 0.1 * i));
    }
    late.push_back({{60, 0, 0}, 1});
    near.push_back({{0, 0, 0}, 0x1p-100});
    faces.push_back(face_at(60));
    const ray<double> slow{{0, 0, 0}, {0x1p-1020, 0, 0}}, fast_one{{0, 0, 0}, {0x1p1000, 0, 0}};
    check(spheres<double>(late), slow);
    check(triangle_soup<double>(faces), slow);
    check(spheres<double>(near), fast_one);
}
