// SPDX-License-Identifier: MIT
#include <abut/traverse/even_nodes.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using namespace abut;

namespace {

/// Spheres of which 15 of 16 crowd in a corner of 2^-skew of the scene's side.
spheres<float> crowded(std::size_t n, int skew, test::uniform& random) {
    std::vector<sphere<float>> all(n);
    for (std::size_t i = 0; i < n; ++i) {
        const float scale = i % 16 == 0 ? 1.0f : std::ldexp(1.0f, -skew);
        all[i] = {scale * random.point<float>(0, 1), 0.01f * scale};
    }
    return spheres<float>(all);
}

struct keep_nodes {
    std::vector<std::uint32_t>* found;
    void push(std::uint32_t half_item) const { found->push_back(half_item); }
};

}  // namespace

TEST_CASE("trees are cut into nodes that have each shape once, and none of them many") {
    test::uniform random(20261124);
    for (const std::size_t n : {2u, 3u, 5u, 255u, 256u, 257u, 1000u, 20'000u}) {
        for (const int skew : {0, 3, 12, 40}) {
            for (const std::size_t nodes : {2u, 7u, 256u}) {
                CAPTURE(n, skew, nodes);
                const auto tree = make_bvh(serial{}, crowded(n, skew, random));
                CHECK(tree.stored().along_curve);
                const auto view = tree.view();
                const detail::nodes_below<decltype(tree)::view_type> below(view, nodes);
                std::vector<std::uint32_t> found;
                const keep_nodes keep{&found};
                for (std::size_t k = 0; k < below.places(); ++k) below.find(k, keep);

                std::vector<int> times(n);
                std::size_t most = 0;
                for (const std::uint32_t half_item : found) {
                    std::vector<bvh_child> open{bvh_child{half_item}};
                    if (open[0].is_leaf()) {
                        const std::uint32_t link = open[0].index();
                        open[0] = view.child(view.fetch(link / 2), static_cast<int>(link % 2));
                    }
                    std::size_t count = 0;
                    while (!open.empty()) {
                        const bvh_child at = open.back();
                        open.pop_back();
                        if (at.is_leaf()) {
                            ++times[at.index()];
                            ++count;
                            continue;
                        }
                        for (const int slot : {0, 1}) open.push_back(view.child(view.fetch(at.index()), slot));
                    }
                    most = std::max(most, count);
                }
                CHECK(std::all_of(times.begin(), times.end(), [](int k) { return k == 1; }));
                CHECK(most <= below.most);
                CHECK(found.size() < 4 * nodes + 64);
            }
        }
    }
}

TEST_CASE("what does not number its nodes by places says so, and refit keeps it") {
    test::uniform random(7);
    const auto set = crowded(300, 3, random);
    CHECK(!make_bvh(serial{}, set, {.builder = bvh_builder::ploc}).stored().along_curve);
    CHECK(!make_bvh(serial{}, set, {.builder = bvh_builder::sah}).stored().along_curve);
    const auto tree = make_bvh(openmp{}, set, {});
    CHECK(tree.stored().along_curve);
    CHECK(refit(serial{}, tree, set).stored().along_curve);
}
