// SPDX-License-Identifier: MIT
#include <abut/collide/query.hpp>

#include <thread>

#include "collide/query_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("queries: serial", "", float, double) { test::check_all_queries<TestType>(serial{}); }

TEMPLATE_TEST_CASE("queries: openmp on 1, 2 and 7 threads", "", float, double) {
    for (const int threads : {1, 2, 7}) {
        CAPTURE(threads);
        test::check_all_queries<TestType>(openmp{.threads = threads});
    }
}

TEST_CASE("queries: fast answers too, and is right far from contact") {
    test::uniform random(8);
    const triangle_soup<float> soup(test::random_triangles<float>(300, random));
    const spheres<float> balls(test::random_spheres<float>(300, random));
    const auto expected = test::truth(soup.view(), balls.view());
    const auto quick = to_host(pairs<fast>(serial{}, make_bvh(serial{}, soup), balls));
    CHECK(quick.size() > expected.size() * 9 / 10);
    CHECK(quick.size() < expected.size() * 11 / 10);
}

TEST_CASE("queries: views over the caller's arrays are checked at each call") {
    std::vector<sphere<float>> balls{{{0, 0, 0}, 1}, {{5, 0, 0}, 1}};
    const triangle<float> t{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
    const spheres_view<float> view(balls.data(), balls.size());
    CHECK(to_host(pairs(serial{}, view, t)) == test::pair_list{{0, 0}});
    balls[1].radius = -3;
    CHECK_THROWS_WITH(pairs(serial{}, view, t), "abut::pairs: sphere 1: radius is negative (-3)");
}

TEST_CASE("queries: many threads may query one index at a time") {
    test::uniform random(21);
    const triangle_soup<float> soup(test::random_triangles<float>(2000, random));
    const spheres<float> balls(test::random_spheres<float>(2000, random));
    const auto tree = make_bvh(openmp{}, soup);
    const auto expected = to_host(pairs(serial{}, tree, balls));
    std::vector<std::thread> threads;
    std::vector<int> same(4, 0);
    for (std::size_t k = 0; k < same.size(); ++k) {
        threads.emplace_back([&, k] {
            for (int i = 0; i < 5; ++i) same[k] += to_host(pairs(openmp{.threads = 2}, tree, balls)) == expected;
        });
    }
    for (std::thread& t : threads) t.join();
    CHECK(same == std::vector<int>(4, 5));
}

namespace {

/// Keeps every pair and counts how often it was asked.
struct counting_filter {
    std::uint32_t* calls;
    bool operator()(std::uint32_t, std::uint32_t) const {
        execution::atomic_add(calls, 1u);
        return true;
    }
};

}  // namespace

TEST_CASE("queries: any stops at the first pair found") {
    const triangle_soup<float> soup(std::vector<triangle<float>>(500, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    const spheres<float> balls(std::vector<sphere<float>>(5000, {{0, 0, 0}, 1}));
    std::uint32_t calls = 0;
    const query_options<counting_filter> options{.filter = {&calls}};
    CHECK(any(serial{}, soup, balls, options));
    CHECK(calls <= 500);  // brute force: one row of a tile, not all 2,500,000 pairs
    calls = 0;
    CHECK(any(serial{}, make_bvh(serial{}, soup), balls, options));
    CHECK(calls == 1);
    calls = 0;
    CHECK(any(serial{}, make_grid(serial{}, soup), balls, options));
    CHECK(calls == 1);
    calls = 0;
    CHECK(any(openmp{.threads = 2}, make_bvh(serial{}, soup), balls, options));
    CHECK(calls < 1000);
}

TEST_CASE("queries: pairs that a first try leaves open are all found, and once") {
    // The truth of the truth: the engine's own pairs against a plain loop.
    const auto soup = test::coplanar_triangles<double>(150);
    test::pair_list expected;
    for (std::uint32_t i = 0; i < soup.size(); ++i) {
        for (std::uint32_t j = 0; j < soup.size(); ++j) {
            if (intersects<exact>(soup.view()[i], soup.view()[j])) expected.push_back({i, j});
        }
    }
    CHECK(to_host(pairs(serial{}, soup, soup)) == expected);
    test::check_dense<double>(serial{}, 150);
    test::check_dense<float>(openmp{.threads = 3}, 700);
}
