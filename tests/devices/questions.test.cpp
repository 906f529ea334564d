// SPDX-License-Identifier: MIT
#include "devices/host_team.hpp"

#include <algorithm>

#include "collide/ray_options_cases.hpp"
#include "collide/sweep_cases.hpp"
#include "devices/question_cases.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

TEST_CASE("devices: points, rays and distances are asked of several policies as of one") {
    const int n = GENERATE(1, 2, 3, 5);
    abut::test::check_questions<float>(abut::test::host_team<abut::serial>(n));
}

TEST_CASE("devices: points, rays and distances in double, on several threads each") {
    const abut::test::host_team<abut::openmp> team(3, abut::openmp{.threads = 2});
    abut::test::device_cases::check_nearest_few<double>(team);
    abut::test::device_cases::check_distance_on<double>(team);
}

TEST_CASE("devices: balls touch on their ways what they touch on one policy") {
    using namespace abut;
    const test::host_team<serial> team(GENERATE(1, 3));
    const test::sweep_scene scene(150, 300);
    const triangle_soup<float> soup(scene.triangles);
    const shapes<swept<sphere<float>>> balls(scene.balls);
    const auto expected = to_host(sweep(serial{}, make_bvh(serial{}, soup), balls));
    CHECK(std::count_if(expected.begin(), expected.end(), [](const auto& hit) { return hit.t > 0 && hit.t < 1; }) > 100);
    CHECK((to_host(sweep(team, make_bvh(team, soup), balls)) == expected));
    CHECK((to_host(sweep(team, make_bvh(team, divide(team, soup)), balls)) == expected));
    CHECK((to_host(sweep<exact>(team, make_bvh(team, divide(team, soup)), replicate(team, balls))) == expected));
}

TEST_CASE("devices: rays meet solids on several policies as on one") {
    namespace cases = abut::test::device_cases;
    const abut::test::host_team<abut::serial> team(3);
    const auto centers = cases::some_points<float>(200, 41);
    std::vector<abut::sphere<float>> balls;
    std::vector<abut::cone<float>> hats;
    for (std::size_t i = 0; i + 1 < centers.size(); ++i) {
        balls.push_back({centers[i], 0.25f});
        hats.push_back({centers[i], centers[i + 1], 0.25f});
    }
    const abut::rays<float> lines(cases::some_rays<float>(300, 42));
    const auto check = [&](const auto& set) {
        const auto expected = cases::met_by<float>(abut::serial{}, set, lines);
        CHECK(expected.all.size() > 50);
        CHECK((cases::met_by<float>(team, make_bvh(team, set), lines) == expected));
        CHECK((cases::met_by<float>(team, make_bvh(team, divide(team, set)), lines) == expected));
    };
    check(abut::spheres<float>(balls));
    check(abut::cones<float>(hats));
}

TEST_CASE("devices: options of rays and points") {
    const int n = GENERATE(1, 3);
    const abut::test::host_team<abut::serial> team(n);
    abut::test::check_ray_options<float>(team, [&](const auto& set) { return make_bvh(team, set); });
    abut::test::check_ray_options<double>(team, [&](const auto& set) { return make_bvh(team, divide(team, set)); });
    abut::test::check_nearest_options<float>(team, [&](const auto& set) { return make_bvh(team, set); });
    abut::test::check_nearest_options<double>(team, [&](const auto& set) { return make_bvh(team, divide(team, set)); });
    // More rows than go to one device at a time: a filter is given the numbers that they have in the call.
    const abut::test::lattice_scene<float> scene(60, 9'000, 19);
    const abut::triangle_soup<float> set(scene.triangles);
    const abut::rays<float> rows(scene.rays);
    const abut::raycast_options<abut::test::some_rows> options{.filter = {}};
    CHECK((to_host(raycast(team, make_bvh(team, set), rows, options)) ==
           to_host(raycast(abut::serial{}, set, rows, options))));
    CHECK((to_host(raycast_all(team, divide(team, set), rows, options)) ==
           to_host(raycast_all(abut::serial{}, set, rows, options))));
}

TEST_CASE("devices: points and rays among bodies") {
    const abut::test::host_team<abut::serial> team(3);
    const abut::test::lattice_scene<float> scene(40, 5'000, 23);
    const abut::triangle_soup<float> set(scene.triangles);
    const std::vector<abut::rigid<float>> poses{{}, {.translation = {3, 0, 1}}, {.translation = {3, 0, 1}}};
    const std::vector<std::uint32_t> all_of_one{0, 0, 0};
    const auto there = make_bodies(team, std::vector{make_bvh(team, set)}, all_of_one, poses);
    const auto here = make_bodies(abut::serial{}, std::vector{make_bvh(abut::serial{}, set)}, all_of_one, poses);
    const abut::rays<float> rows(scene.rays);
    std::vector<abut::vec3<float>> from;
    for (const auto& r : scene.rays) from.push_back(r.origin);
    const auto hits = to_host(raycast_all(abut::serial{}, here, rows));
    CHECK(hits.size() > 1'000);
    CHECK((to_host(raycast_all(team, there, rows)) == hits));
    CHECK((to_host(raycast(team, there, rows)) == to_host(raycast(abut::serial{}, here, rows))));
    CHECK((to_host(raycast_any(team, there, rows)) == to_host(raycast_any(abut::serial{}, here, rows))));
    CHECK((to_host(nearest(team, there, from, 3)) == to_host(nearest(abut::serial{}, here, from, 3))));
}

TEST_CASE("devices: how far bodies are apart") {
    namespace cases = abut::test;
    const int n = GENERATE(1, 2, 5);
    const cases::host_team<abut::serial> team(n);
    const cases::torus<float> ring(8, 5, 0.7, 0.3);
    const abut::mesh<float> set(ring.vertices, ring.faces);
    const auto tree = make_bvh(team, set);
    const auto alone = make_bvh(abut::serial{}, set);
    int touch = 0, apart = 0;
    for (const double spread : {1.5, 8.0, 60.0}) {
        cases::draws d(3, 97, static_cast<std::uint64_t>(spread));
        cases::uniform random(4);
        std::vector<abut::rigid<float>> poses;
        for (int i = 0; i < 12; ++i) {
            poses.push_back(cases::make_rotation<float>(d));
            for (float* x : {&poses.back().translation.x, &poses.back().translation.y, &poses.back().translation.z}) {
                *x = static_cast<float>(random(-spread, spread));
            }
        }
        for (int i = 0; i < 12; ++i) {  // the same far away: each distance comes twice
            poses.push_back(poses[static_cast<std::size_t>(i)]);
            poses.back().translation.x += 1024;
        }
        const std::vector<std::uint32_t> all_of_one(poses.size(), 0);
        const auto there = make_bodies(team, std::vector{tree}, all_of_one, poses);
        const auto expected = distance(abut::serial{}, make_bodies(abut::serial{}, std::vector{alone}, all_of_one, poses));
        REQUIRE(expected.has_value());
        (expected->distance == 0 ? touch : apart) += 1;
        CHECK(distance(team, there) == expected);
        CHECK(!distance(team, there, {.below = static_cast<double>(expected->distance)}).has_value());
    }
    CHECK((touch > 0 && apart > 0));
}

TEST_CASE("devices: errors of questions") {
    using abut::serial;
    abut::test::device_cases::check_question_errors<float>(abut::test::host_team<serial>(2), abut::test::host_team<serial>(3));
}

TEST_CASE("devices: bodies as wholes") {
    using namespace abut;
    const test::host_team<serial> team(GENERATE(1, 2, 5));
    const test::torus<float> shape(12, 8, 0.7F, 0.3F);
    const triangle_soup<float> set(test::triangles_of(shape.vertices, shape.faces));
    const spheres<float> grains({{{0, 0, 0}, 0.25F}, {{0.5F, 0, 0}, 0.125F}});
    std::vector<rigid<float>> poses;
    for (int i = 0; i < 30; ++i) {
        poses.push_back({.translation = {0.4F * static_cast<float>(i % 5), 0.3F * static_cast<float>(i / 5), 0}});
    }
    const std::vector<std::uint32_t> all_of_one(poses.size());
    const auto meshes = make_bodies(team, std::vector{make_bvh(team, replicate(team, set))}, all_of_one, poses);
    const auto balls = make_bodies(team, std::vector{make_bvh(team, replicate(team, grains))}, all_of_one, poses);
    const serial on;
    const auto meshes_here = make_bodies(on, std::vector{make_bvh(on, set)}, all_of_one, poses);
    const auto balls_here = make_bodies(on, std::vector{make_bvh(on, grains)}, all_of_one, poses);
    const auto touching = to_host(touching_bodies(on, meshes_here));
    CHECK(touching.size() > 30);
    CHECK((to_host(touching_bodies(team, meshes)) == touching));
    CHECK((to_host(bodies_within(team, meshes, 0.1)) == to_host(bodies_within(on, meshes_here, 0.1))));
    const auto both = between(meshes, balls);
    const auto both_here = between(meshes_here, balls_here);
    CHECK((to_host(touching_bodies(team, both)) == to_host(touching_bodies(on, both_here))));
    CHECK((to_host(pairs(team, both)) == to_host(pairs(on, both_here))));
    CHECK(count(team, both) == count(on, both_here));
}

TEST_CASE("devices: crossings") {
    using namespace abut;
    const test::host_team<serial> team(GENERATE(1, 2, 5));
    const auto data = test::ball_surface<float>(2, 1);
    const mesh<float> ball(data.vertices, data.faces);
    const rigid<float> pose{{1, 0, 0, 0, 0.8F, -0.6F, 0, 0.6F, 0.8F}, {0.3F, 0.2F, 0}};
    const auto there = make_bvh(team, replicate(team, ball));
    const auto expected = to_host(crossings(serial{}, ball, posed(ball, pose)));
    CHECK(expected.size() > 20);
    CHECK(to_host(crossings(team, there, posed(there, pose))) == expected);
}
