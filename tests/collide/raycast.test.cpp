// SPDX-License-Identifier: MIT
#include <abut/collide/raycast.hpp>

#include "collide/raycast_cases.hpp"
#include "support/catch.hpp"
#include "support/modes.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("raycast: serial", "", float, double) {
    test::check_raycast<TestType>(serial{});
    test::check_watertight<TestType>(serial{});
    test::check_raycast_scales<TestType>(serial{});
}

TEST_CASE("raycast: openmp on 1 and 3 threads") {
    for (const int threads : {1, 3}) {
        CAPTURE(threads);
        test::check_watertight<float>(openmp{threads});
    }
}

TEMPLATE_TEST_CASE("raycast: nothing is culled that rounding or flushing moves", "", float, double) {
    for (const test::floating_mode& mode : test::floating_modes()) {
        INFO(mode.name);
        std::size_t wrong = 0, hits = 0;
        test::uniform random(94);
        for (const TestType scale : {TestType(1), std::numeric_limits<TestType>::min(), std::numeric_limits<TestType>::min() / 64}) {
            std::vector<triangle<TestType>> triangles;
            const auto point = [&] { return scale * random.point<TestType>(-4, 4); };
            for (int i = 0; i < 40; ++i) {
                const vec3<TestType> a = point();
                triangles.push_back({a, point(), a});
            }
            const triangle_soup<TestType> soup(triangles);
            std::vector<ray<TestType>> lines;
            for (const auto& t : triangles) lines.push_back({point(), t.b}), lines.back().direction = t.b - lines.back().origin;
            const shapes<ray<TestType>> rays(lines);
            const auto expected = pairs(serial{}, soup, rays).to_host();
            const auto tree = make_bvh(serial{}, soup);
            test::in_mode(mode, [&] {
                const auto found = pairs(serial{}, tree, rays).to_host();
                wrong += found != expected;
                const auto small = pairs(serial{}, quantised(serial{}, tree), rays).to_host();
                wrong += small != expected;
            });
            hits += expected.size();
        }
        CHECK(wrong == 0);
        CHECK(hits > 40);
    }
}

TEST_CASE("raycast: nothing to meet, and nothing that looks") {
    const mesh<float> none;
    const triangle<float> floor{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    const auto hit = raycast(serial{}, none, ray<float>{{0, 0, 1}, {0, 0, -1}}).to_host();
    REQUIRE(hit.size() == 1);
    CHECK(hit[0] == ray_hit<float>{no_id, std::numeric_limits<float>::infinity()});
    CHECK(raycast(serial{}, floor, rays<float>()).size() == 0);
    CHECK(raycast(serial{}, floor, ray<float>{{0, 0, 1}, {0, 0, -1}}).to_host()[0] == ray_hit<float>{0, 1});
    CHECK(raycast<fast>(serial{}, floor, ray<float>{{0, 0, 1}, {0, 0, -1}}).to_host()[0] == ray_hit<float>{0, 1});
    CHECK(raycast(serial{}, floor, segment<float>{{0, 0, 1}, {0, 0, 0.5f}}).to_host()[0].id == no_id);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_AS(raycast(serial{}, floor, ray<float>{{0, 0, nan}, {0, 0, 1}}), invalid_geometry);
    CHECK_THROWS_AS(rays<float>({{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {nan, 0, 1}}}), invalid_geometry);
}

TEST_CASE("raycast: all that rays meet is what pairs finds") {
    const auto data = test::ball_surface<float>(2, 1);
    const mesh<float> ball(data.vertices, data.faces);
    test::uniform random(96);
    std::vector<ray<float>> lines;
    for (int i = 0; i < 50; ++i) {
        const vec3<float> from = random.point<float>(-2, 2);
        lines.push_back({from, random.point<float>(-1, 1) - from});
    }
    const rays<float> all(lines);
    std::vector<index_pair> expected;
    for (std::uint32_t i = 0; i < ball.size(); ++i) {
        for (std::uint32_t k = 0; k < lines.size(); ++k) {
            if (intersects<exact>(lines[k], ball.view()[i])) expected.push_back({i, k});
        }
    }
    CHECK(expected.size() > 20);
    CHECK(pairs(serial{}, make_bvh(serial{}, ball), all).to_host() == expected);
    CHECK(pairs(serial{}, make_grid(serial{}, ball), all).to_host() == expected);
    CHECK(pairs(openmp{2}, ball, all).to_host() == expected);
    CHECK(count(serial{}, make_bvh(serial{}, ball), all) == expected.size());
    CHECK(pairs(serial{}, posed(make_bvh(serial{}, ball), rigid<float>{}), all).to_host() == expected);
}
