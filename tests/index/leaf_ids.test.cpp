// SPDX-License-Identifier: MIT
#include <abut/index/leaf_ids.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/leafless.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using namespace abut;

namespace {

/// Least and greatest place, and number, of the shapes below a child.
struct stretch {
    std::size_t first, last, count;
};

/// False, below a child, where the shapes of a node lie apart, or those of a slot before those of an earlier one.
template <class View>
bool lie_together(const View& tree, bvh_child at, const std::vector<std::size_t>& place, stretch& here) {
    if (at.is_leaf()) {
        here = {place[at.index()], place[at.index()], 1};
        return true;
    }
    const auto node = tree.fetch(at.index());
    for (int slot = 0; slot < tree.children(node); ++slot) {
        stretch below{};
        if (!lie_together(tree, tree.child(node, slot), place, below)) return false;
        if (slot > 0 && below.first != here.last + 1) return false;
        here = slot == 0 ? below : stretch{here.first, below.last, here.count + below.count};
    }
    return here.last - here.first + 1 == here.count;
}

template <class Tree>
void check_leaf_ids(const Tree& tree) {
    const std::vector<std::uint32_t> ids = leaf_ids(tree);
    CHECK(ids.size() == tree.size());
    std::vector<std::uint32_t> sorted = ids, all(tree.size());
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), std::uint32_t{0});
    REQUIRE(sorted == all);
    if (ids.empty()) return;
    std::vector<std::size_t> place(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) place[ids[i]] = i;
    stretch whole{};
    CHECK(lie_together(tree.view(), tree.view().root(), place, whole));
    CHECK(whole.count == tree.size());
}

}  // namespace

TEMPLATE_TEST_CASE("leaf ids: each once, and what is below a node lies together", "", float, double) {
    test::uniform random(71);
    for (const unsigned n : {0u, 1u, 2u, 3u, 5u, 1000u}) {
        const triangle_soup<TestType> soup(test::random_triangles<TestType>(n, random));
        for (const bvh_builder builder :
             {bvh_builder::linear, bvh_builder::mean_split, bvh_builder::sah, bvh_builder::ploc}) {
            CAPTURE(n, static_cast<int>(builder));
            const auto tree = make_bvh(openmp{2}, soup, {.builder = builder});
            check_leaf_ids(tree);
            check_leaf_ids(wide(serial{}, tree));
            check_leaf_ids(quantised(serial{}, tree));
            check_leaf_ids(leafless(serial{}, tree));
            check_leaf_ids(oriented(serial{}, tree));
        }
    }
}

TEST_CASE("leaf ids: a set in their order has the same answers by other ids") {
    test::uniform random(72);
    const std::vector<triangle<float>> shapes = test::random_triangles<float>(2000, random);
    const triangle_soup<float> soup(shapes), other(test::random_triangles<float>(500, random));
    const serial on;
    const std::vector<std::uint32_t> ids = leaf_ids(make_bvh(on, soup, {.builder = bvh_builder::sah}));
    std::vector<triangle<float>> in_order;
    for (const std::uint32_t id : ids) in_order.push_back(shapes[id]);
    const auto tree = wide(on, make_bvh(on, triangle_soup<float>(in_order), {.builder = bvh_builder::sah}));
    auto found = to_host(pairs(on, tree, other));
    for (index_pair& p : found) p.a = ids[p.a];
    std::sort(found.begin(), found.end(),
              [](const index_pair& p, const index_pair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
    CHECK(found.size() > 500);
    CHECK((found == to_host(pairs(on, soup, other))));
}
