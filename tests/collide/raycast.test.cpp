// SPDX-License-Identifier: MIT
#include <abut/collide/raycast_all.hpp>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "collide/raycast_cases.hpp"
#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/ray_oracle.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("raycast: serial", "", float, double) {
    test::check_raycast<TestType>(serial{});
    test::check_near_times<TestType>(serial{});
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
        for (const TestType scale :
             {TestType(1), std::numeric_limits<TestType>::min(), std::numeric_limits<TestType>::min() / 64}) {
            std::vector<triangle<TestType>> triangles;
            const auto point = [&] { return scale * random.point<TestType>(-4, 4); };
            for (int i = 0; i < 40; ++i) {
                const vec3<TestType> a = point();
                triangles.push_back({a, point(), a});
            }
            const triangle_soup<TestType> soup(triangles);
            std::vector<ray<TestType>> lines;
            for (const auto& t : triangles)
                lines.push_back({point(), t.b}), lines.back().direction = t.b - lines.back().origin;
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

TEMPLATE_TEST_CASE("raycast: rays of denormal directions meet what they meet, whatever becomes of denormals", "", float,
                   double) {
    using T = TestType;
    constexpr T least = std::numeric_limits<T>::denorm_min(), smallest = std::numeric_limits<T>::min();
    std::vector<triangle<T>> triangles;
    std::vector<sphere<T>> balls;
    for (int i = 0; i < 4; ++i) {
        const T z = static_cast<T>(i);
        triangles.push_back({{-1, -1, z}, {1, -1, z}, {0, 1, z}});
        balls.push_back({{0, 0, z}, T(0.25)});
    }
    test::draws d(test::sample_seed, 96, 0);
    const rigid<T> pose = test::make_pose<T>(d, 10);
    std::vector<ray<T>> lines, turned;
    for (const T length : {least, 3 * least, smallest / 2, smallest - least, smallest, smallest * 3}) {
        for (const vec3<T>& way : {vec3<T>{0, 0, 1}, vec3<T>{1, 0, 1}, vec3<T>{-1, 1, 3}, vec3<T>{0, 0, -1}}) {
            const vec3<T> direction = length * way;
            lines.push_back({T(-3) * way, direction});
            const vec3<T> there = T(8) * (place(pose, way) - pose.translation),
                          whole{std::round(there.x), std::round(there.y), std::round(there.z)};
            turned.push_back({place(pose, vec3<T>{0, 0, T(0.5)}) - T(0.5) * whole, length * whole});
        }
    }
    const triangle_soup<T> soup(triangles);
    const spheres<T> round(balls);
    const rays<T> looking(lines), looking_there(turned);
    std::vector<triangle<T>> placed;
    for (const auto& t : triangles) placed.push_back(place(pose, t));
    const triangle_soup<T> there(placed);
    const auto ids = [](const auto& hits) {
        std::vector<std::uint32_t> all;
        for (const auto& hit : to_host(hits)) all.push_back(hit.id);
        return all;
    };
    const serial on;
    const auto expected = ids(raycast<exact>(on, soup, looking)),
               expected_of_balls = ids(raycast<exact>(on, round, looking)),
               expected_there = ids(raycast<exact>(on, there, looking_there));
    const auto any = to_host(raycast_any<exact>(on, soup, looking)),
               any_there = to_host(raycast_any<exact>(on, there, looking_there));
    const auto all = to_host(raycast_all<exact>(on, soup, looking)).size();
    const auto met = [](const auto& found) {
        return std::count_if(found.begin(), found.end(), [](auto id) { return id != no_id; });
    };
    CHECK(met(expected) == 24);
    CHECK(met(expected_of_balls) == 24);
    CHECK(met(expected_there) > 12);
    const auto tree = make_bvh(on, soup);
    const auto tree_of_balls = make_bvh(on, round);
    for (const test::floating_mode& mode : test::floating_modes()) {
        INFO(mode.name);
        test::in_mode(mode, [&] {
            CHECK(ids(raycast(on, tree, looking)) == expected);
            CHECK(ids(raycast(on, wide(on, tree), looking)) == expected);
            CHECK(ids(raycast(on, quantised(on, tree), looking)) == expected);
            CHECK(ids(raycast(on, tree_of_balls, looking)) == expected_of_balls);
            CHECK(to_host(raycast_any(on, tree, looking)) == any);
            CHECK(raycast_all(on, tree, looking).size() == all);
            // A posed tree places its triangles in the mode that is in force.
            if (mode.rounding != FE_TONEAREST) return;
            CHECK(ids(raycast(on, posed(tree, pose), looking_there)) == expected_there);
            CHECK(to_host(raycast_any(on, posed(tree, pose), looking_there)) == any_there);
        });
    }
}

TEMPLATE_TEST_CASE("raycast: segments longer than the largest number", "", float, double) {
    using T = TestType;
    const T large = std::numeric_limits<T>::max() / T(1.125);
    test::uniform random(97);
    std::vector<triangle<T>> triangles{{{0, -large, -large}, {0, large, -large}, {0, 0, large}}};
    for (int i = 0; i < 20; ++i) {
        const T z = static_cast<T>(i - 10);
        triangles.push_back({{-1, -1, z - T(0.5)}, {1, -1, z + T(0.5)}, {0, 2, z}});
    }
    std::vector<segment<T>> lines;
    for (int i = 0; i < 40; ++i) {
        const vec3<T> end = large * random.point<T>(-1, 1);
        lines.push_back({T(-1) * end, i % 2 == 0 ? end : vec3<T>{large, end.y, end.z}});
    }
    for (int i = 0; i < 40; ++i) lines.push_back({{-large, large / -2, 0}, {large, large / 2, 0}});
    const triangle_soup<T> soup(triangles);
    const auto expected = test::hits_by_definition(soup.view(), lines);
    CHECK(test::share_of_hits(expected) > 0.5);
    const auto tree = make_bvh(serial{}, soup);
    test::check_hits(serial{}, soup, lines, expected);
    test::check_hits(serial{}, tree, lines, expected);
    test::check_hits(serial{}, wide(serial{}, tree), lines, expected);
}

TEMPLATE_TEST_CASE("raycast: rows of rays go down a wide tree as one", "", float, double) {
    // Waves one behind the other: 64 rays of a row may reach more shapes than a bundle keeps. Some rays pass through corners.
    using T = TestType;
    const int side = 48, layers = 4;
    std::vector<vec3<T>> corners;
    std::vector<face> faces;
    for (int layer = 0; layer < layers; ++layer) {
        for (int k = 0; k < (side + 1) * (side + 1); ++k) {
            const T x = static_cast<T>(k % (side + 1)) / side, y = static_cast<T>(k / (side + 1)) / side;
            corners.push_back({x, y, T(0.25) * static_cast<T>(layer) + T(0.0625) * std::sin(20 * x) * std::cos(17 * y)});
        }
        for (int k = 0; k < side * side; ++k) {
            if ((k + layer) % 5 == 0) continue;  // holes
            const auto at = static_cast<std::uint32_t>(layer * (side + 1) * (side + 1) + k / side * (side + 1) + k % side);
            const auto next = at + static_cast<std::uint32_t>(side) + 1;
            faces.push_back({at, at + 1, next});
            faces.push_back({at + 1, next + 1, next});
        }
    }
    const mesh<T> waves(corners, faces);
    const openmp on{3};
    const auto tree = make_bvh(on, waves, {.builder = bvh_builder::sah});
    const auto wide_tree = wide(on, tree);
    for (const int kind : {0, 1, 2}) {
        std::vector<ray<T>> rays;
        for (int i = 0; i < 193 * 40; ++i) {
            const T x = static_cast<T>(i % 193) / 192, y = static_cast<T>(i / 193) / 39;
            if (kind == 0) rays.push_back({{T(0.4), T(0.6), 3}, {x - T(0.4), y - T(0.6), T(-2.5)}});
            if (kind == 1) rays.push_back({{x, y, 2}, {0, 0, -1}});
            if (kind == 2) rays.push_back({{x, T(-1), y}, {T(0.125), 1, T(-0.25)}});
        }
        const shapes<ray<T>> looking(rays);
        const auto expected = to_host(raycast<exact>(on, tree, looking));
        CHECK(test::share_of_hits(expected) > 0.5);
        CHECK(to_host(raycast(serial{}, wide_tree, looking)) == expected);
        CHECK(to_host(raycast(on, wide_tree, looking)) == expected);
        CHECK(to_host(raycast(on, wide_tree, looking, {.most_t = 1})) == to_host(raycast<exact>(on, tree, looking, {.most_t = 1})));
        CHECK(to_host(raycast_any(serial{}, wide_tree, looking)) == to_host(raycast_any<exact>(on, tree, looking)));
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
    const ray<float> down{{0, 0, 1}, {0, 0, -1}};
    CHECK(raycast_all(serial{}, none, down).size() == 0);
    CHECK(raycast_all(serial{}, floor, rays<float>()).size() == 0);
    CHECK(raycast_all<fast>(serial{}, floor, down).to_host() == std::vector<hit_of_ray<float>>{{0, 0, 1}});
    CHECK(raycast_any(serial{}, none, down).to_host() == std::vector<std::uint8_t>{0});
    CHECK(raycast_any(serial{}, floor, rays<float>()).size() == 0);
    CHECK(raycast_any<fast>(serial{}, floor, down).to_host() == std::vector<std::uint8_t>{1});
    CHECK(raycast_any(serial{}, floor, segment<float>{{0, 0, 1}, {0, 0, 0.5f}})[0] == 0);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_AS(raycast(serial{}, floor, ray<float>{{0, 0, nan}, {0, 0, 1}}), invalid_geometry);
    CHECK_THROWS_AS(raycast_any(serial{}, floor, ray<float>{{0, 0, nan}, {0, 0, 1}}), invalid_geometry);
    CHECK_THROWS_AS(raycast_all(serial{}, floor, ray<float>{{0, 0, nan}, {0, 0, 1}}), invalid_geometry);
    CHECK_THROWS_AS(rays<float>({{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {nan, 0, 1}}}), invalid_geometry);
}

TEST_CASE("raycast: all hits in the order of their true times, in rational numbers") {
    // On a lattice, where rays start on triangles, run along sides and through corners, and meet many at one time; there
    // times that differ do so by more than doubles are apart.
    test::uniform random(97);
    const auto on_lattice = [&](int half) {
        const auto one = [&] {
            return static_cast<float>(static_cast<int>(random.below(std::size_t(2 * half + 1))) - half);
        };
        return vec3<float>{one(), one(), one()};
    };
    std::vector<triangle<float>> triangles;
    for (int i = 0; i < 60; ++i) {
        const vec3<float> a = on_lattice(2);
        triangles.push_back({a, a + on_lattice(1), a + on_lattice(2)});
    }
    const triangle_soup<float> soup(triangles);
    std::vector<ray<float>> lines;
    for (int i = 0; i < 300; ++i) lines.push_back({on_lattice(3), on_lattice(2)});
    std::vector<index_pair> expected;
    std::vector<double> times;
    std::size_t ties = 0, at_start = 0;
    for (std::uint32_t k = 0; k < lines.size(); ++k) {
        std::vector<std::pair<test::rational, std::uint32_t>> mine;
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            if (const auto t = test::first_time(lines[k], triangles[i])) mine.emplace_back(*t, i);
        }
        std::sort(mine.begin(), mine.end());
        for (std::size_t i = 0; i < mine.size(); ++i) {
            expected.push_back({k, mine[i].second});
            ties += i > 0 && mine[i].first == mine[i - 1].first;
            at_start += mine[i].first == 0;
        }
    }
    CHECK(expected.size() > 500);
    CHECK(ties > 100);
    CHECK(at_start > 50);
    const rays<float> all(lines);
    const auto tree = make_bvh(serial{}, soup);
    const auto in_order = [&](const auto& found) {
        std::vector<index_pair> ids;
        for (const auto& hit : found) ids.push_back({hit.ray, hit.id});
        return ids;
    };
    CHECK(in_order(raycast_all(serial{}, tree, all)) == expected);
    CHECK(in_order(raycast_all(openmp{3}, wide(serial{}, tree), all)) == expected);
    CHECK(in_order(raycast_all(serial{}, soup, all)) == expected);
    const auto any = raycast_any(serial{}, wide(serial{}, tree), all);
    const auto first = raycast(serial{}, tree, all);
    for (std::uint32_t k = 0; k < lines.size(); ++k) {
        const auto begin = std::find_if(expected.begin(), expected.end(), [&](const index_pair& p) { return p.a == k; });
        CHECK(any[k] == (begin != expected.end() ? 1 : 0));
        CHECK(first[k].id == (begin != expected.end() ? begin->b : no_id));
    }
}

TEST_CASE("raycast: thousands of hits on one ray are in order") {
    // Sheets in disorder, some at one height.
    test::uniform random(98);
    std::vector<triangle<double>> sheets;
    for (int i = 0; i < 3000; ++i) {
        const auto z = static_cast<double>(random.below(2000));
        sheets.push_back({{-9, -9, z}, {9, -9, z}, {0, 9, z}});
    }
    const auto all =
        raycast_all(serial{}, make_bvh(serial{}, triangle_soup<double>(sheets)), ray<double>{{0, 0, -1}, {0, 0, 2}});
    REQUIRE(all.size() == sheets.size());
    std::vector<bool> seen(sheets.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
        CHECK(all[k].t == (sheets[all[k].id].a.z + 1) / 2);
        if (k > 0) CHECK((all[k].t > all[k - 1].t || (all[k].t == all[k - 1].t && all[k].id > all[k - 1].id)));
        seen[all[k].id] = true;
    }
    CHECK(std::find(seen.begin(), seen.end(), false) == seen.end());
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
