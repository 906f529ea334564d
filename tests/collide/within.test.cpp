// SPDX-License-Identifier: MIT
#include <abut/collide/within.hpp>
#include <abut/experimental/leafless.hpp>

#include <algorithm>
#include <mutex>

#include "collide/within_cases.hpp"
#include "support/modes.hpp"

using namespace abut;

TEST_CASE("within: points, segments, triangles, spheres and capsules") {
    const serial on;
    std::printf("within: seeds 141 to 151\n");
    test::check_within_of<vec3<float>, vec3<float>>(on, 141);
    test::check_within_of<vec3<double>, triangle<double>>(on, 142);
    test::check_within_of<triangle<float>, triangle<float>>(on, 143);
    test::check_within_of<triangle<double>, sphere<double>>(on, 144);
    test::check_within_of<capsule<float>, segment<float>>(on, 145);
    test::check_self_within<vec3<float>>(on, 146);
    test::check_within_by_hand(on);
}

TEST_CASE("within: cylinders and cones, with points, spheres and planes") {
    const openmp on{.threads = 3};
    std::printf("within, cylinders and cones: seeds 301 to 311\n");
    test::check_within_of<cylinder<float>, vec3<float>>(on, 301);
    test::check_within_of<sphere<double>, cylinder<double>>(serial{}, 302);
    test::check_within_of<cone<float>, sphere<float>>(on, 303);
    test::check_within_of<vec3<double>, cone<double>>(serial{}, 304);
    test::check_within_of<cylinder<float>, plane<float>>(on, 310);
    test::check_within_of<plane<double>, cone<double>>(serial{}, 311);
    test::check_posed_within_of<cylinder<float>, sphere<float>>(on, 305);
    test::check_posed_within_of<cone<double>, vec3<double>>(serial{}, 306);
    test::uniform random(307);
    const cylinders<float> rods(test::shape_maker<cylinder<float>>(random, true)(150));
    const spheres<float> balls(test::shape_maker<sphere<float>>(random, true)(150));
    const auto expected = test::within_by_definition(rods.view(), balls.view(), 0.25);
    CHECK(expected.size() > 200);
    const auto tree = make_bvh(on, rods);
    CHECK(to_host(within(on, make_grid(on, rods), balls, 0.25)) == expected);
    CHECK(to_host(within<exact>(serial{}, wide(on, tree), balls, 0.25)) == expected);
    CHECK(to_host(within(on, quantised(on, tree), make_bvh(on, balls), 0.25)) == expected);
    std::vector<index_pair> visited;
    std::mutex one_at_a_time;
    for_each_within(on, tree, balls, 0.25, [&](index_pair pair) {
        const std::lock_guard lock(one_at_a_time);
        visited.push_back(pair);
        return visit::proceed;
    });
    std::sort(visited.begin(), visited.end());
    CHECK(visited == expected);
    CHECK(test::refusal_of([&] { (void)count_within(on, tree, balls, -1); }) ==
          "abut::count_within: distance is -1; expected a finite number, 0 or more");
    CHECK(test::refusal_of([&] {
              (void)any_within(on, balls, rods, std::numeric_limits<double>::quiet_NaN());
          }).find("expected a finite number") != std::string::npos);
    CHECK(count_within(on, cylinder<float>{{{0, 0, 0}, {0, 0, 2}}, 5}, sphere<float>{{8, 0, 6}, 2}, 3) == 1);
}

TEST_CASE("within: posed meshes") {
    test::check_within_of_meshes<double>(serial{});
    for (const int threads : {3, 17}) {
        CAPTURE(threads);
        test::check_within_of_meshes<float>(openmp{threads});
        test::check_within_by_hand(openmp{threads});
    }
}

TEST_CASE("within: trees of all layouts, grids, fast and exact, and a visitor") {
    const serial on;
    const test::two_tori<float> of;
    const rigid<float> pose = of.poses()[0];
    constexpr double distance = 0.7;
    const auto expected = of.expected({}, pose, distance), here = of.expected({}, {}, distance);
    const auto a = make_bvh(on, of.a), b = make_bvh(on, of.b);
    const auto check = [&](const auto& x, const auto& y) {
        CHECK(to_host(within(on, x, y, distance)) == here);
        CHECK(to_host(within(on, x, posed(y, pose), distance)) == expected);
    };
    check(wide(on, a), wide(on, b));
    check(quantised(on, a), leafless(on, b));
    check(oriented(on, a), oriented(on, b));
    check(make_grid(on, of.a), of.b);
    CHECK(to_host(within<exact>(on, a, b, distance)) == here);
    const auto quick = to_host(within<fast>(on, a, b, distance));
    CHECK(quick.size() * 100 > here.size() * 99);
    CHECK(quick.size() * 100 < here.size() * 101);
    std::vector<index_pair> visited;
    std::mutex one_at_a_time;
    for_each_within(openmp{3}, a, b, distance, [&](index_pair pair) {
        const std::lock_guard lock(one_at_a_time);
        visited.push_back(pair);
        return visit::proceed;
    });
    std::sort(visited.begin(), visited.end());
    CHECK(visited == here);
    const auto odd = [](std::uint32_t i, std::uint32_t j) { return (i + j) % 2 == 1; };
    CHECK(count_within(on, a, b, distance, query_options<decltype(odd)>{.filter = odd}) ==
          static_cast<std::uint64_t>(std::count_if(here.begin(), here.end(), [&](auto p) { return odd(p.a, p.b); })));
}

TEMPLATE_TEST_CASE("within: boxes lose nothing in any floating-point mode", "", float, double) {
    using T = TestType;
    const serial on;
    std::size_t hits = 0, asked = 0;
    for (std::uint64_t k = 0; k < 16; ++k) {
        test::draws d(148, sizeof(T), k);
        const auto p = test::extreme_points<T>(d, 14), q = test::extreme_points<T>(d, 14);
        const points<T> a(p), b(q);
        std::vector<vec3<T>> both = p;
        both.insert(both.end(), q.begin(), q.end());
        const double distance = test::extreme_distance(d, both);
        const auto expected = test::within_by_definition(a.view(), b.view(), distance);
        hits += expected.size();
        asked += p.size() * q.size();
        for (const test::floating_mode& mode : test::floating_modes()) {
            CAPTURE(k, distance, mode.name);
            std::vector<index_pair> plain, looked, walked, wider, among_cells;
            test::in_mode(mode, [&] {
                const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
                plain = to_host(within(on, a, b, distance));
                looked = to_host(within(on, tree_a, b, distance));
                walked = to_host(within(on, tree_a, tree_b, distance));
                wider = to_host(within(on, wide(on, tree_a), wide(on, tree_b), distance));
                among_cells = to_host(within(on, make_grid(on, a), b, distance));
            });
            CHECK(plain == expected);
            CHECK(looked == expected);
            CHECK(walked == expected);
            CHECK(wider == expected);
            CHECK(among_cells == expected);
        }
    }
    CHECK(hits > 100);
    CHECK(hits < asked * 9 / 10);
    for (const test::floating_mode& mode : test::floating_modes()) {
        CAPTURE(mode.name);
        test::in_mode(mode, [&] { test::check_within_at_pairs<T>(on, 151); });
    }
}
