// SPDX-License-Identifier: MIT
#include <abut/experimental/leafless.hpp>
#include <abut/index/quantised.hpp>

#include <atomic>
#include <concepts>
#include <limits>

#include <abut/index/wide.hpp>

#include "index/layout_cases.hpp"

using namespace abut;

static_assert(bvh_layout_kind<standard_layout> && bvh_layout_kind<quantised_layout> && bvh_layout_kind<leafless_layout>);
static_assert(!bvh_layout_kind<int> && !bvh_layout_kind<bvh_view<float, host_space>>);
static_assert(bvh_layout<quantised_view<double, device_space>> && bvh_layout<leafless_view<double, device_space>>);
static_assert(bvh_layout_kind<wide_layout> && bvh_layout<wide_view<double, host_space>>);
static_assert(detail::wide_bvh_layout<wide_view<float, host_space>> &&
              !detail::wide_bvh_layout<bvh_view<float, host_space>>);
static_assert(sizeof(wide_node<float>) == 128 && sizeof(wide_node<double>) == 224);
static_assert(sizeof(quantised_node) == 32 && sizeof(leafless_node<float>) == 32 && sizeof(leafless_node<double>) == 56);

TEMPLATE_TEST_CASE("layouts: well-formed, and no box smaller than it was built", "", float, double) {
    test::check_all_layouts<TestType>(serial{});
    test::check_all_layouts<TestType>(openmp{3});
}

TEMPLATE_TEST_CASE("wide: well-formed, with boxes as they were built, of any builder", "", float, double) {
    test::check_all_wide<TestType>(serial{});
    test::check_all_wide<TestType>(openmp{3});
}

TEMPLATE_TEST_CASE("wide: boxes that are all of space, and places without a child", "", float, double) {
    using T = TestType;
    // The box of a child that a node has not must not be met, not even by infinite ones.
    const spheres<T> endless = test::endless_spheres<T>(333), few = test::endless_spheres<T>(7);
    const triangle_soup<T> soup = test::hard_sets<T>(200).back().set;
    for (const auto& on : {openmp{1}, openmp{3}}) {
        const auto a = wide(on, make_bvh(on, endless)), b = wide(on, make_bvh(on, few));
        const auto c = wide(on, make_bvh(on, soup));
        const auto expected = to_host(pairs(on, soup, endless)), with_few = to_host(pairs(on, soup, few));
        CHECK(expected.size() > 1000);
        CHECK(to_host(pairs(on, c, a)) == expected);
        CHECK(to_host(pairs(on, c, b)) == with_few);
        CHECK(to_host(pairs(on, soup, a)) == expected);
        CHECK(to_host(pairs(on, c, make_bvh(on, endless))) == expected);
    }
}

TEMPLATE_TEST_CASE("wide: every kind of query, beside every kind of side", "", float, double) {
    using T = TestType;
    test::uniform random(84);
    const triangle_soup<T> a(test::random_triangles<T>(700, random)), b(test::random_triangles<T>(900, random));
    const spheres<T> balls(test::random_spheres<T>(300, random));
    const auto check_on = [&](const auto& on) {
        auto tree = make_bvh(on, a);
        auto index = wide(on, tree), other = wide(on, make_bvh(on, b, {.builder = bvh_builder::sah}));
        const auto expected = to_host(pairs(on, a, b)), with_balls = to_host(pairs(on, balls, a));
        CHECK(expected.size() > 500);
        CHECK(count(on, index, other) == expected.size());
        CHECK(any(on, index, other));
        CHECK(!any(on, index, posed(other, rigid<T>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {100, 0, 0}})));
        CHECK(to_host(pairs(on, index, make_grid(on, b))) == expected);
        CHECK(to_host(pairs(on, index, b)) == expected);
        CHECK(to_host(pairs(on, balls, index)) == with_balls);
        CHECK(to_host(pairs(on, make_grid(on, balls), index)) == with_balls);
        for (const std::size_t most : {std::size_t{1} << 20, std::size_t{100}}) {
            std::atomic<std::size_t> seen{0}, sum{0};
            std::size_t expected_sum = 0;
            for (const auto& [i, j] : expected) expected_sum += std::size_t{i} * 1009 + j;
            const auto visitor = [&](const index_pair& p) {
                ++seen;
                sum += std::size_t{p.a} * 1009 + p.b;
                return visit::proceed;
            };
            for_each_pair(on, index, other, visitor, {.most_pairs = most});
            CHECK(seen == expected.size());
            CHECK(sum == expected_sum);
        }
        // A list of pairs, wide on both sides and on one.
        const rigid<T> quarter{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {T(0.1), T(0.2), T(0.3)}};
        const auto moved = to_host(pairs(on, posed(a, quarter), b));
        CHECK(moved.size() > 100);
        const std::vector<posed_pair<decltype(index), decltype(other)>> list{{posed(index, {}), posed(other, {})},
                                                                             {posed(index, quarter), posed(other, {})}};
        const std::vector<posed_pair<decltype(tree), decltype(other)>> mixed{{posed(tree, {}), posed(other, {})},
                                                                             {posed(tree, quarter), posed(other, {})}};
        std::vector<tagged_pair> tagged;
        for (const auto& [i, j] : expected) tagged.push_back({0, i, j});
        for (const auto& [i, j] : moved) tagged.push_back({1, i, j});
        CHECK((to_host(pairs(on, list)) == tagged));
        CHECK((to_host(pairs(on, mixed)) == tagged));
    };
    check_on(openmp{3});
    if constexpr (std::same_as<T, float>) check_on(serial{});  // the same walks: compiling them takes long
}

TEMPLATE_TEST_CASE("layouts: queries do not depend on them", "", float, double) {
    // Each policy with one scalar: the walks are the same, and to compile them for sixteen pairs of layouts takes long.
    if constexpr (std::same_as<TestType, float>) {
        test::check_layout_queries<TestType>(openmp{3});
    } else {
        test::check_layout_queries<TestType>(serial{});
    }
}

TEMPLATE_TEST_CASE("quantiser: the nearest cells on either side, for any numbers", "", float, double) {
    using T = TestType;
    constexpr T huge = std::numeric_limits<T>::max(), tiny = std::numeric_limits<T>::denorm_min(),
                least = std::numeric_limits<T>::min(), far = std::numeric_limits<T>::infinity();
    const std::pair<T, T> axes[] = {
        {-huge, huge},    {-far, far},        {-far, 0},       {0, far},
        {huge / 2, huge}, {-huge, -huge},     {0, 0},          {-T(0), tiny},
        {-tiny, tiny},    {0, 70'000 * tiny}, {-least, least}, {-tiny, huge},
        {T(0.1), T(0.1)}, {T(0.1), T(0.3)},   {-1, T(1e-30)},  {T(1e6), T(1e6) + 1},
        {0, 65535},       {0, 65536},         {-3, 1000},      {std::nextafter(T(1), T(0)), std::nextafter(T(1), T(2))}};
    test::uniform random(91);
    for (const auto& [lower, upper] : axes) {
        const auto axis = detail::make_quantiser(lower, upper);
        CAPTURE(lower, upper, axis.first, axis.step());
        const auto at = [&](int cell) {
            return quantised_frame<T>::at(axis.first, axis.step(), static_cast<std::uint16_t>(cell));
        };
        const auto check = [&](T x) {
            CAPTURE(x);
            const int below = axis.lower(x), above = axis.upper(x);
            CHECK(at(below) <= x);
            CHECK(at(above) >= x);
            // The nearest: the next one is on the other side. Cells of infinity have no next.
            if (std::isfinite(at(below)) && below < 65535) CHECK((at(below + 1) > x || below == above));
            if (std::isfinite(at(above)) && above > 0) CHECK((at(above - 1) < x || below == above));
        };
        check(lower);
        check(upper);
        const T first = std::max(lower, -huge), last = std::min(upper, huge);
        for (int i = 0; i < 200; ++i) {
            const T t = static_cast<T>(random());
            check(std::min(std::max(first * (1 - t) + last * t, lower), upper));
            const T small = std::ldexp(i % 2 ? T(1) : T(-1), -static_cast<int>(random.below(i < 100 ? 149 : 1074)));
            check(std::min(std::max(small, lower), upper));
        }
        // As fine as may be without a denormal step: half of it would not do.
        CHECK(axis.step() >= least);
        const bool exact = axis.step() == least ||
                           std::fabs(axis.first) * 2 > std::ldexp(T(1), std::numeric_limits<T>::digits) ||
                           axis.upper(upper) >= 32767 ||
                           std::fabs(axis.first + axis.upper(upper)) * 2 > std::ldexp(T(1), std::numeric_limits<T>::digits);
        CHECK(exact);
    }
}

TEST_CASE("layouts: what they cost") {
    const test::torus<float> shape(200, 80, 1, 0.4);
    const auto tree = make_bvh(serial{}, mesh<float>(shape.vertices, shape.faces), {.builder = bvh_builder::sah});
    const auto standard = quality(tree), small = quality(quantised(serial{}, tree)),
               bare = quality(leafless(serial{}, tree)), broad = quality(wide(serial{}, tree));
    CHECK(standard.bytes_per_shape == Approx(64).margin(0.01));
    CHECK(small.bytes_per_shape == Approx(32).margin(0.01));
    CHECK(bare.bytes_per_shape == Approx(32).margin(0.01));
    CHECK(small.sah_cost > standard.sah_cost);
    CHECK(small.sah_cost < 1.02 * standard.sah_cost);
    CHECK(bare.sah_cost > standard.sah_cost);
    CHECK(small.greatest_depth == standard.greatest_depth);
    CHECK(broad.bytes_per_shape < 70);
    CHECK(broad.sah_cost < 0.9 * standard.sah_cost);
    CHECK(broad.mean_depth < 0.7 * standard.mean_depth);
}

TEST_CASE("layouts: a converted tree stands alone, and a refitted one can be converted") {
    test::uniform random(95);
    const triangle_soup<float> next(test::random_triangles<float>(500, random));
    const auto [small, bare] = [&] {
        const auto tree = make_bvh(serial{}, triangle_soup<float>(test::random_triangles<float>(500, random)));
        return std::pair{quantised(serial{}, tree), leafless(serial{}, refit(serial{}, tree, next))};
    }();
    CHECK(test::find_flaw(small.view(), small.set().view()) == "");
    CHECK(test::find_flaw(bare.view(), next.view()) == "");
}
