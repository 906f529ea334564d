// SPDX-License-Identifier: MIT
#include <abut/traverse/self_walk.hpp>

#include <cstdint>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/breadth_first.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"
#include "support/walked_pairs.hpp"

namespace abut::test {

namespace {

template <class Policy>
struct run_all {
    const Policy& on;
    execution::work_queue<std::uint64_t, host_space>& hits;
    template <class Loop>
    void operator()(const Loop& loop) const {
        loop(keep_each{}, hits);
    }
    [[nodiscard]] bool is_over() const { return false; }
};

/// What a walk finds on each policy, from the root and from every depth, is what a plain loop over all boxes finds, each
/// pair once.
template <class T, class Tree, class Overlap>
std::size_t check_self_walk(const std::vector<triangle<T>>& shapes, const Tree& tree, const Overlap& overlap) {
    id_pairs expected;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        for (std::uint32_t j = i + 1; j < shapes.size(); ++j) {
            const auto a = bounds(shapes[i]), b = bounds(shapes[j]);
            if (overlap(a, b) && overlap(b, a)) expected.emplace_back(i, j);
        }
    }
    using walk_type = detail::self_walk<typename Tree::view_type, Overlap>;
    const walked_pairs<walk_type, true> expand{{tree.view(), overlap}};
    const auto check_on = [&](const auto& on) {
        CAPTURE(shapes.size());
        CHECK(gathered(on, [&](auto& hits) { for_each_descendant(on, expand, keep_each{}, hits); }) == expected);
        for (const int depth : {0, 1, 2, 3, 5, most_start_depth}) {
            CAPTURE(depth);
            CHECK(gathered(on, [&](auto& hits) {
                      detail::for_each_on_levels(on, expand, depth, run_all<std::decay_t<decltype(on)>>{on, hits});
                  }) == expected);
        }
    };
    check_on(serial{});
    check_on(openmp{3});
    return expected.size();
}

/// Binary trees and wide ones.
template <class T, class Overlap>
std::size_t check_self_walk(const std::vector<triangle<T>>& shapes, const Overlap& overlap) {
    const auto tree = make_bvh(serial{}, triangle_soup<T>(shapes));
    check_self_walk(shapes, wide(serial{}, tree), overlap);
    return check_self_walk(shapes, tree, overlap);
}

}  // namespace

TEMPLATE_TEST_CASE("a tree with itself: each pair of leaves whose boxes overlap, once", "", float, double) {
    using T = TestType;
    uniform random(20270114);
    std::size_t pairs = 0;
    for (const std::size_t n : {2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 17u, 60u, 700u}) {
        pairs += check_self_walk(random_triangles<T>(n, random), detail::same_frame{});
    }
    CHECK(pairs > 2'500);
    // All triangles in one place: a tree as deep as one gets, and every pair.
    const std::vector<triangle<T>> same(200, triangle<T>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(check_self_walk(same, detail::same_frame{}) == 200 * 199 / 2);
    // Chains: each box overlaps its neighbours alone.
    CHECK(check_self_walk(chain_of_triangles<T>(300), detail::same_frame{}) == 299);
    // A tree that is a list: far more levels than one of that many leaves needs, so that paths end in leaves.
    std::vector<triangle<T>> list;
    for (T x = 1; list.size() < 40; x *= 2) list.push_back({{x, 0, 0}, {2 * x, 0, 0}, {x, x, 0}});
    CHECK(check_self_walk(list, detail::same_frame{}) == 39);
}

}  // namespace abut::test
