// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <memory>
#include <thread>
#include <vector>

#include "index/layout_cases.hpp"
#include "index/refit_cases.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("refit: cuda", "", float, double) {
    test::check_refits<TestType>(abut::cuda{});
    test::check_steps<TestType>(abut::cuda{});
    test::check_refit_refusals<TestType>(abut::cuda{});
}

TEST_CASE("refit: the same bits on the device as on the host") {
    test::uniform random(71);
    const triangle_soup<float> first(test::random_triangles<float>(200'000, random)),
        second(test::random_triangles<float>(200'000, random));
    const auto expected = refit(serial{}, make_bvh(serial{}, first), second);
    const auto tree = make_bvh(abut::cuda{}, first);
    for (int i = 0; i < 5; ++i) {
        CHECK(test::same_bits(expected.stored(), refit(abut::cuda{}, tree, second).stored().to_host()));
    }
}

TEST_CASE("refit: a plan that is made in one stream is used in another") {
    test::uniform random(72);
    const triangle_soup<float> first(test::random_triangles<float>(1'000'000, random)),
        second(test::random_triangles<float>(1'000'000, random));
    cudaStream_t streams[2] = {};
    for (auto& stream : streams) REQUIRE(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking) == cudaSuccess);
    {
        const abut::cuda on[2] = {{.stream = streams[0]}, {.stream = streams[1]}};
        const auto moved = copy_to(on[0], second);
        const auto build = [&] { return make_bvh(on[0], first); };
        const auto expected = refit(on[0], build(), moved).stored().to_host();
        // One after the other.
        const auto tree = build();
        CHECK(test::same_bits(expected, refit(on[0], tree, moved).stored().to_host()));
        CHECK(test::same_bits(expected, refit(on[1], tree, moved).stored().to_host()));
        // At once: one of two makes the plan, and the other takes it as soon as it is there.
        for (int i = 0; i < 10; ++i) {
            const auto fresh = build();
            int same[2] = {0, 0};
            std::vector<std::thread> threads;
            for (const int k : {0, 1}) {
                threads.emplace_back(
                    [&, k] { same[k] = test::same_bits(expected, refit(on[k], fresh, moved).stored().to_host()); });
            }
            for (std::thread& t : threads) t.join();
            CHECK(same[0] + same[1] == 2);
        }
        // The tree and its plan go while nothing is waited for but the refit itself.
        auto gone = std::make_unique<decltype(build())>(build());
        (void)refit(on[0], *gone, moved);
        const auto last = refit(on[1], *gone, moved);
        gone.reset();
        CHECK(test::same_bits(expected, last.stored().to_host()));
    }
    for (auto& stream : streams) cudaStreamDestroy(stream);
}

TEMPLATE_TEST_CASE("builders: ploc makes the same tree on the device as on the host", "", float, double) {
    using T = TestType;
    const auto check = [](const auto& set) {
        for (const int bits : {0, 63}) {
            const bvh_options options{.morton_bits = bits, .builder = bvh_builder::ploc};
            const auto tree = make_bvh(abut::cuda{}, set, options);
            CHECK(test::same_bits(make_bvh(serial{}, set, options).stored(), tree.stored().to_host()));
        }
    };
    test::uniform random(73);
    for (const std::size_t n : {0u, 1u, 2u, 3u, 100u, 256u, 257u, 1000u, 200'000u}) {
        CAPTURE(n);
        check(triangle_soup<T>(test::random_triangles<T>(n, random)));
    }
    for (const auto& [name, set] : test::hard_sets<T>(5000)) {
        CAPTURE(name);
        check(set);
    }
    std::vector<sphere<T>> nested;  // one pair joins at a time
    for (int i = 0; i < 5000; ++i) nested.push_back({{0, 0, 0}, 1 + static_cast<T>(i) / 64});
    check(spheres<T>(nested));
    check(test::endless_spheres<T>(3000));
    const triangle_soup<T> first(test::random_triangles<T>(20'000, random)),
        second(test::random_triangles<T>(20'000, random));
    test::check_refit(abut::cuda{}, make_bvh(abut::cuda{}, first, {.builder = bvh_builder::ploc}), second);
}

TEST_CASE("builders: a device has two") {
    const triangle_soup<float> set(std::vector<triangle<float>>(3));
    CHECK_THROWS_WITH(
        make_bvh(abut::cuda{}, set, {.builder = bvh_builder::sah}),
        "abut::make_bvh: on a device the builder is bvh_builder::linear or ploc; serial and openmp have mean_split and sah");
    const auto q = quality(abut::cuda{}, make_bvh(abut::cuda{}, set));
    CHECK(q.shapes == 3);
    CHECK(q.greatest_depth == 2);
    CHECK(q.sah_cost == 5);
}

TEMPLATE_TEST_CASE("layouts: cuda", "", float, double) {
    test::check_all_layouts<TestType>(abut::cuda{});
    if constexpr (std::same_as<TestType, float>) test::check_layout_queries<TestType>(abut::cuda{});
}
