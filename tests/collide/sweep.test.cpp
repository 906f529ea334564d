// SPDX-License-Identifier: MIT
#include <abut/collide/sweep.hpp>

#include <string>

#include "collide/sweep_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("sweep: serial", "", float, double) {
    test::check_sweep_of_sets<TestType>(serial{}, 40);
    test::check_sweep_scales<TestType>(serial{});
}

TEST_CASE("sweep: openmp on 3 threads") { test::check_sweep_scales<float>(openmp{3}); }

TEST_CASE("sweep: contacts at the start") { test::check_start_contacts(serial{}); }

TEST_CASE("sweep: hulls, which refer to their points, go and are met") {
    const serial on;
    const std::vector<vec3<float>> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const hull<float> one(corners.data(), corners.size());
    const triangle_soup<float> floor{{{-9, -9, -2}, {9, -9, -2}, {0, 9, -2}}};
    const auto hit = to_host(sweep(on, floor, moving(one, vec3<float>{0, 0, -4})));
    REQUIRE(hit.size() == 1);
    CHECK((hit[0].id == 0 && hit[0].t == 0.5f && hit[0].normal == vec3<float>{0, 0, 1}));
    const hulls<float> set({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    const auto onto = to_host(sweep(on, make_bvh(on, set), spheres<float>{{{0.25f, 0.25f, -3}, 1}}, points<float>{{0, 0, 4}}));
    REQUIRE(onto.size() == 1);
    CHECK((onto[0].id == 0 && onto[0].t == 0.5f && onto[0].normal == vec3<float>{0, 0, -1}));
}

TEST_CASE("sweep: of nothing, and what is refused") {
    const serial on;
    const triangle_soup<float> none, floor{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}};
    const spheres<float> balls{{{0, 0, 2}, 1}, {{0, 0, 5}, 1}};
    CHECK(sweep(on, floor, spheres<float>(), points<float>()).size() == 0);
    const auto missed = to_host(sweep(on, none, balls, points<float>{{0, 0, -2}, {0, 0, -2}}));
    REQUIRE(missed.size() == 2);
    CHECK(missed[1].id == no_id);
    try {
        (void)sweep(on, floor, balls, points<float>{{0, 0, -2}});
        FAIL_CHECK("one way of two shapes was taken");
    } catch (const error& e) {
        CHECK(std::string(e.what()) == "abut::sweep: 1 ways; expected as many as shapes, 2");
    }
    const float bad = std::numeric_limits<float>::infinity();
    try {
        (void)sweep(on, floor, moving(sphere<float>{{0, 0, 2}, 1}, vec3<float>{0, 0, bad}));
        FAIL_CHECK("a way without end was taken");
    } catch (const invalid_geometry& e) {
        CHECK(std::string(e.what()).find("way z is not finite") != std::string::npos);
    }
}
