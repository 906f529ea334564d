// SPDX-License-Identifier: MIT
#pragma once

// Every traversal finds on every policy what a plain loop finds: random triangles of uneven numbers, sets that give builders
// trouble, few shapes or none, posed or not, in every form of a query.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/breadth_first.hpp>

#include "collide/posed_cases.hpp"
#include "index/tree_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

template <traversal Traversal, class Filter = keep_all>
using walked = query_options<Filter, Traversal>;

/// Depths that matter to breadth_first alone; for the others one will do.
template <traversal Traversal>
std::vector<int> start_depths() {
    if (Traversal == traversal::breadth_first) return {0, 1, 5, most_start_depth};
    return {0};
}

template <traversal Traversal, class Policy, class X, class Y>
void check_walked(const Policy& on, const X& a, const Y& b, const pair_list& expected) {
    for (const int depth : start_depths<Traversal>()) {
        CAPTURE(static_cast<int>(Traversal), depth, a.size(), b.size(), expected.size());
        CHECK(to_host(pairs(on, a, b, walked<Traversal>{.start_depth = depth})) == expected);
    }
}

template <class T>
triangle_soup<T> random_soup(std::size_t n, uniform& random) {
    return triangle_soup<T>(random_triangles<T>(n, random));
}

/// Sets of all sizes that are few, and uneven ones, under two poses, one of which may be none.
template <class T, traversal Traversal, class Policy>
void check_walked_poses(const Policy& on) {
    constexpr std::uint64_t seed = 20261201;
    uniform random(seed);
    const std::array<std::size_t, 2> sizes[] = {{0, 0},    {0, 3},    {1, 0},   {1, 1},     {1, 2},    {2, 1},
                                                {2, 2},    {2, 3},    {3, 3},   {1, 300},   {300, 1},  {3, 1000},
                                                {1000, 3}, {2, 1000}, {40, 70}, {300, 300}, {700, 150}};
    std::size_t hits = 0;
    std::uint64_t turn = 0;
    for (const auto& [n, m] : sizes) {
        draws d(seed, 90, turn);
        const rigid<T> pose_a = turn % 3 == 1 ? rigid<T>{} : make_pose<T>(d, 1);
        const rigid<T> pose_b = turn % 3 == 2 ? rigid<T>{} : make_pose<T>(d, 1);
        const vec3<T> center = random.point<T>(-1, 1);
        const auto a = brought_back(random_triangles<T>(n, random), pose_a, center);
        const auto b = brought_back(random_triangles<T>(m, random), pose_b, center);
        using view = posed_view<typename triangle_soup<T>::view_type>;
        const pair_list expected = placed_truth(view{a.view(), pose_a}, view{b.view(), pose_b});
        const auto x = posed(make_bvh(on, copy_to(on, a)), pose_a), y = posed(make_bvh(on, copy_to(on, b)), pose_b);
        check_walked<Traversal>(on, x, y, expected);
        check_walked<Traversal>(on, y, x, mirrored(expected));
        hits += expected.size();
        ++turn;
    }
    CHECK(hits > 150);
}

/// Sets that make deep trees, boxes at the ends of all numbers, and many boxes in one place; each against itself and against
/// random triangles.
template <class T, traversal Traversal, class Policy>
void check_walked_hard_sets(const Policy& on) {
    uniform random(20261202);
    const triangle_soup<T> other = random_soup<T>(100, random);
    const auto other_tree = make_bvh(on, copy_to(on, other));
    for (const auto& [name, set] : hard_sets<T>(60)) {
        CAPTURE(name);
        const auto tree = make_bvh(on, copy_to(on, set));
        check_walked<Traversal>(on, tree, tree, placed_truth(set.view(), set.view()));
        check_walked<Traversal>(on, tree, other_tree, placed_truth(set.view(), other.view()));
    }
}

/// The other forms of a query.
template <class T, traversal Traversal, class Policy>
void check_walked_forms(const Policy& on) {
    uniform random(20261203);
    const near_and_away<T> sets = random_near_and_away<T>(random);
    const pair_list expected = placed_truth(sets.a.view(), sets.b.view());
    pair_list kept;
    for (const index_pair& p : expected) {
        if (id_filter{}(p.a, p.b)) kept.push_back(p);
    }
    CHECK(kept.size() > 10);
    CHECK(kept.size() < expected.size());
    const auto x = make_bvh(on, copy_to(on, sets.a)), y = make_bvh(on, copy_to(on, sets.b));
    const auto away = make_bvh(on, copy_to(on, sets.away));
    for (const int depth : start_depths<Traversal>()) {
        CAPTURE(static_cast<int>(Traversal), depth);
        const walked<Traversal> options{.most_pairs = 100, .start_depth = depth};
        check_forms(on, x, y, away, expected, options);
        CHECK(to_host(pairs(on, x, y, walked<Traversal, id_filter>{.start_depth = depth})) == kept);
    }
}

template <class Policy>
void check_start_depths(const Policy& on) {
    uniform random(20261204);
    const auto tree = make_bvh(on, copy_to(on, random_soup<float>(20, random)));
    const auto asks = [&](int depth) { return any(on, tree, tree, walked<traversal::breadth_first>{.start_depth = depth}); };
    CHECK(asks(most_start_depth));
    CHECK_THROWS_AS(asks(-1), error);
    CHECK_THROWS_AS(asks(most_start_depth + 1), error);
    std::string said;
    try {
        (void)asks(11);
    } catch (const error& problem) {
        said = problem.what();
    }
    CHECK(said == "abut::any: start_depth is 11, not in 0..10");
}

/// What every policy is asked of a traversal.
template <class T, traversal Traversal, class Policy>
void check_traversal(const Policy& on) {
    check_walked_poses<T, Traversal>(on);
    check_walked_hard_sets<T, Traversal>(on);
}

}  // namespace abut::test
