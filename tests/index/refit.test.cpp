// SPDX-License-Identifier: MIT
#include <abut/index/refit.hpp>

#include <thread>
#include <vector>

#include "index/refit_cases.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("refit: tight boxes and the same topology", "", float, double) {
    test::check_refits<TestType>(serial{});
    test::check_refits<TestType>(openmp{3});
}

TEMPLATE_TEST_CASE("refit: queries after each step of a motion", "", float, double) {
    test::check_steps<TestType>(serial{});
    test::check_steps<TestType>(openmp{3});
    test::check_refit_refusals<TestType>(serial{});
}

TEST_CASE("refit: of trees from every builder, the same bits from any number of threads") {
    test::uniform random(53);
    const triangle_soup<float> first(test::random_triangles<float>(20'000, random)),
        second(test::random_triangles<float>(20'000, random));
    for (const auto builder : {bvh_builder::linear, bvh_builder::mean_split, bvh_builder::sah, bvh_builder::ploc}) {
        CAPTURE(static_cast<int>(builder));
        const auto tree = make_bvh(serial{}, first, {.builder = builder});
        test::check_refit(serial{}, tree, second);
        const auto expected = refit(serial{}, tree, second);
        for (const int threads : {2, 3, 8}) {
            CHECK(test::same_bits(expected.stored(), refit(openmp{threads}, tree, second).stored()));
        }
    }
}

TEST_CASE("refit: zeros of both signs do not tell who came first") {
    test::uniform random(57);
    std::vector<triangle<float>> flat;
    for (int i = 0; i < 50'000; ++i) {
        const auto p = random.point<float>(-1, 1);
        const float z = i % 2 ? 0.0f : -0.0f;
        flat.push_back({{p.x, p.y, z}, {p.x, p.y, z}, {p.x, p.y, z}});
    }
    const triangle_soup<float> set(flat);
    const auto tree = make_bvh(serial{}, set);
    const auto expected = refit(serial{}, tree, set);
    CHECK(test::is_tight(expected.view(), set.view()));
    for (int i = 0; i < 20; ++i) CHECK(test::same_bits(expected.stored(), refit(openmp{4}, tree, set).stored()));
}

TEST_CASE("refit: many at once, of one tree that none has refitted before") {
    test::uniform random(59);
    const triangle_soup<float> first(test::random_triangles<float>(3000, random)),
        second(test::random_triangles<float>(3000, random));
    for (int round = 0; round < 20; ++round) {
        const auto tree = make_bvh(serial{}, first);
        std::vector<std::string> flaws(4);
        std::vector<std::thread> threads;
        for (auto& flaw : flaws) {
            threads.emplace_back([&] { flaw = test::find_flaw(refit(serial{}, tree, second).view(), second.view()); });
        }
        for (auto& t : threads) t.join();
        for (const auto& flaw : flaws) CHECK(flaw == "");
    }
}

TEST_CASE("refit: the new tree keeps its set alive and outlives the old one") {
    const auto tree = [] {
        test::uniform random(61);
        const auto old = make_bvh(serial{}, triangle_soup<float>(test::random_triangles<float>(100, random)));
        return refit(serial{}, old, triangle_soup<float>(test::random_triangles<float>(100, random)));
    }();
    CHECK(test::find_flaw(tree.view(), tree.set().view()) == "");
    CHECK(test::find_flaw(refit(serial{}, tree, tree.set()).view(), tree.set().view()) == "");
}
