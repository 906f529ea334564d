// SPDX-License-Identifier: MIT
#include <abut/index/lbvh.hpp>

#include <limits>

#include "index/index_cases.hpp"
#include "support/catch.hpp"
#include "support/find_flaw.hpp"

using namespace abut;

static_assert(bvh_layout<bvh_view<float, host_space>> && bvh_layout<bvh_view<double, device_space>>);
static_assert(!bvh_layout<int> && !bvh_layout<mesh_view<float>>);
static_assert(sizeof(bvh_node<float>) == 64);

TEMPLATE_TEST_CASE("bvh: well-formed on every host policy", "", float, double) {
    test::check_trees<TestType>(serial{});
    for (const int threads : {1, 2, 7}) {
        CAPTURE(threads);
        test::check_trees<TestType>(openmp{.threads = threads});
    }
}

TEST_CASE("bvh: find_flaw finds planted flaws") {
    test::uniform random(3);
    const triangle_soup<float> soup(test::random_triangles<float>(50, random));
    const auto built = test::fetch_tree(serial{}, make_bvh(serial{}, soup));
    const auto flaw_after = [&](auto&& spoil) {
        auto tree = built;
        spoil(tree);
        return test::find_flaw(tree.view(50), soup.view());
    };
    CHECK(flaw_after([](auto&) {}) == "");
    // The first node that has a leaf on its left.
    std::size_t k = 0;
    while (!built.nodes[k].child[0].is_leaf()) ++k;
    const auto step_down = [](float& x) { x = std::nextafter(x, -std::numeric_limits<float>::infinity()); };
    CHECK(flaw_after([&](auto& t) { step_down(t.nodes[k].bounds[0].upper.y); }).find("does not hold the shape") !=
          std::string::npos);
    CHECK(flaw_after([&](auto& t) { step_down(t.root[0].bounds.upper.x); }).find("does not hold the child's") !=
          std::string::npos);
    CHECK(flaw_after([&](auto& t) { t.nodes[k].child[0] = bvh_child::leaf(50); }).find("does not exist") !=
          std::string::npos);
    CHECK(flaw_after([&](auto& t) { t.nodes[k].child[0] = t.root[0].child; }).find("reached twice") != std::string::npos);
    CHECK_FALSE(flaw_after([&](auto& t) { t.root[0].child = bvh_child::leaf(0); }).empty());
    CHECK(test::find_flaw(built.view(49), soup.view()) == "the tree has 49 shapes, the set 50");
}

TEST_CASE("bvh: an index keeps its set alive, and views over arrays are checked") {
    const auto tree = [] {
        test::uniform random(5);
        return make_bvh(serial{}, triangle_soup<float>(test::random_triangles<float>(10, random)));
    }();
    CHECK(test::find_flaw(tree.view(), tree.set().view()) == "");
    CHECK(tree.bytes() == 9 * sizeof(bvh_node<float>) + sizeof(bvh_root<float>));
    const std::vector<sphere<float>> bad{{{0, 0, 0}, 1}, {{0, 0, 0}, -1}};
    CHECK_THROWS_WITH(make_bvh(serial{}, spheres_view<float>(bad.data(), 2)),
                      "abut::make_bvh: sphere 1: radius is negative (-1)");
    CHECK(make_bvh(serial{}, spheres_view<float>(bad.data(), 1)).size() == 1);
    CHECK(make_bvh(serial{}, sphere<float>{{1, 2, 3}, 4}).size() == 1);
}

TEST_CASE("morton: codes interleave and clamp") {
    const aabb<float> scene{{0, 0, 0}, {1024, 1024, 1024}};
    const auto code = [&](float x, float y, float z) {
        return detail::morton_code<std::uint32_t>(aabb<float>{{x, y, z}, {x, y, z}}, scene);
    };
    CHECK(code(0, 0, 0) == 0);
    CHECK(code(0, 0, 1) == 1);
    CHECK(code(0, 1, 0) == 2);
    CHECK(code(1, 0, 0) == 4);
    CHECK(code(512, 512, 512) == 0x38000000u);
    CHECK(code(1024, 1024, 1024) == 0x3fffffffu);
    CHECK(code(-5, 2000, 0) == detail::spread_bits(std::uint32_t{1023}) << 1);
    constexpr double huge = std::numeric_limits<double>::max();
    const aabb<double> all{{-huge, -huge, -huge}, {huge, huge, huge}};
    CHECK(detail::morton_code<std::uint64_t>(aabb<double>{{huge, huge, huge}, {huge, huge, huge}}, all) ==
          0x7fffffffffffffffu);
    CHECK(detail::morton_code<std::uint64_t>(aabb<double>{{1, 1, 1}, {1, 1, 1}}, {{1, 1, 1}, {1, 1, 1}}) == 0);
}
