// SPDX-License-Identifier: MIT

#include <cstdint>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/walked_pairs.hpp"

namespace abut::test {

/// What a walk finds on each policy is what a plain loop over all boxes finds, each pair once.
template <class T, class TreeA, class TreeB, class Overlap>
std::size_t check_walk(const triangle_soup<T>& a, const TreeA& tree_a, const triangle_soup<T>& b, const TreeB& tree_b,
                       const Overlap& overlap) {
    id_pairs expected;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            if (overlap(bounds(a.view()[i]), bounds(b.view()[j]))) expected.emplace_back(i, j);
        }
    }
    using walk_type = detail::pair_walk<typename TreeA::view_type, typename TreeB::view_type, Overlap>;
    const auto check_on = [&](const auto& on) {
        CAPTURE(a.size(), b.size());
        const walked_pairs<walk_type> expand{{tree_a.view(), tree_b.view(), overlap}};
        CHECK(gathered(on, [&](auto& hits) { for_each_descendant(on, expand, keep_each{}, hits); }) == expected);
    };
    check_on(serial{});
    check_on(openmp{3});
    return expected.size();
}

/// Binary trees, wide ones, and one of each.
template <class T, class Overlap>
std::size_t check_walk(const triangle_soup<T>& a, const triangle_soup<T>& b, const Overlap& overlap) {
    const auto tree_a = make_bvh(serial{}, a), tree_b = make_bvh(serial{}, b);
    const auto wide_a = wide(serial{}, tree_a), wide_b = wide(serial{}, tree_b);
    check_walk(a, wide_a, b, wide_b, overlap);
    check_walk(a, wide_a, b, tree_b, overlap);
    check_walk(a, tree_a, b, wide_b, overlap);
    return check_walk(a, tree_a, b, tree_b, overlap);
}

TEMPLATE_TEST_CASE("two trees at once: each pair of leaves whose boxes overlap, once", "", float, double) {
    using T = TestType;
    uniform random(20261124);
    std::size_t pairs = 0;
    for (const auto& [n, m] : {std::pair{2, 2}, {2, 300}, {300, 2}, {3, 5}, {40, 50}, {700, 600}}) {
        const triangle_soup<T> a(random_triangles<T>(static_cast<std::size_t>(n), random));
        const triangle_soup<T> b(random_triangles<T>(static_cast<std::size_t>(m), random));
        pairs += check_walk(a, b, detail::same_frame{});
        for (std::uint64_t k = 0; k < 4; ++k) {
            draws d(20261124, 81, k);
            const auto pose_a = make_pose<T>(d, 1), pose_b = make_pose<T>(d, 1);
            const auto around = [](const triangle_soup<T>& s) { return make_bvh(serial{}, s).view().root_bounds(); };
            pairs += check_walk(a, b, detail::two_frames<T>{make_relative_pose(pose_a, around(a), pose_b, around(b))});
        }
    }
    CHECK(pairs > 10'000);
    // All triangles in one place: a tree as deep as one gets, and every pair.
    const triangle_soup<T> same(std::vector<triangle<T>>(300, triangle<T>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    CHECK(check_walk(same, same, detail::same_frame{}) == 90'000);
    // Chains: each box overlaps its neighbours alone.
    const triangle_soup<T> chain(chain_of_triangles<T>(500));
    CHECK(check_walk(chain, chain, detail::same_frame{}) == 500 + 2 * 499);
}

}  // namespace abut::test
