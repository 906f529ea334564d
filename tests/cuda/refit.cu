// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

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

TEST_CASE("builders: a device has one") {
    const triangle_soup<float> set(std::vector<triangle<float>>(3));
    CHECK_THROWS_WITH(
        make_bvh(abut::cuda{}, set, {.builder = bvh_builder::sah}),
        "abut::make_bvh: on a device the builder is bvh_builder::linear; serial and openmp have mean_split and sah");
    const auto q = quality(abut::cuda{}, make_bvh(abut::cuda{}, set));
    CHECK(q.shapes == 3);
    CHECK(q.greatest_depth == 2);
    CHECK(q.sah_cost == 5);
}

TEMPLATE_TEST_CASE("layouts: cuda", "", float, double) {
    test::check_all_layouts<TestType>(abut::cuda{});
    if constexpr (std::same_as<TestType, float>) test::check_layout_queries<TestType>(abut::cuda{});
}
