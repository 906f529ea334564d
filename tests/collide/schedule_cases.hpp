// SPDX-License-Identifier: MIT
#pragma once

// Queries by every schedule find what the default one finds, and what a plain loop finds: few shapes and none, sets that
// make deep trees, posed or not, lists, and scenes nearly all of whose work lies in one corner. With tiny queues, and on one
// block.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "collide/traversal_cases.hpp"
#include "execution/schedule_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

template <schedule Schedule, class Filter = keep_all, traversal Traversal = traversal::both_at_once>
using by_schedule = query_options<Filter, Traversal, Schedule>;

inline constexpr schedule_options tight_options[] = {
    {}, {.queue_capacity = 1}, {.queue_capacity = 70}, {.most_blocks = 1}, {.most_blocks = 3, .queue_capacity = 5}};

template <schedule Schedule, class Policy, class X, class Y>
void check_scheduled(const Policy& on, const X& a, const Y& b, const pair_list& expected) {
    for (const schedule_options& scheduling : tight_options) {
        CAPTURE(static_cast<int>(Schedule), scheduling.queue_capacity, scheduling.most_blocks, a.size(), b.size());
        CHECK(to_host(pairs(on, a, b, by_schedule<Schedule>{.scheduling = scheduling})) == expected);
    }
}

/// Few triangles all over a box of side 20, and `dense` of them in a corner of side 0.2.
template <class T>
triangle_soup<T> skewed_soup(std::size_t sparse, std::size_t dense, uniform& random) {
    std::vector<triangle<T>> all;
    const auto add = [&](std::size_t n, double lower, double upper, double side) {
        for (std::size_t i = 0; i < n; ++i) {
            const auto at = random.point<T>(lower, upper);
            all.push_back({at, at + random.point<T>(-side, side), at + random.point<T>(-side, side)});
        }
    };
    add(sparse, -10, 10, 0.05);
    add(dense, 9.8, 10, 0.02);
    return triangle_soup<T>(all);
}

/// Sets of all sizes that are few, uneven ones, such that make deep trees, and a skewed pair.
template <class T, schedule Schedule, class Policy>
void check_scheduled_sets(const Policy& on) {
    constexpr std::uint64_t seed = 20261231;
    uniform random(seed);
    std::uint64_t turn = 0;
    for (const auto& [n, m] : std::array<std::pair<std::size_t, std::size_t>, 7>{
             {{0, 3}, {1, 1}, {2, 2}, {1, 300}, {2, 3}, {3, 1000}, {300, 300}}}) {
        draws d(seed, 92, turn++);
        const rigid<T> pose = make_pose<T>(d, 1);
        const auto a = random_soup<T>(n, random);
        const auto b = brought_back(random_triangles<T>(m, random), pose, {0, 0, 0});
        using view = posed_view<typename triangle_soup<T>::view_type>;
        const auto x = make_bvh(on, copy_to(on, a));
        const auto y = posed(make_bvh(on, copy_to(on, b)), pose);
        check_scheduled<Schedule>(on, x, y, placed_truth(a.view(), view{b.view(), pose}));
    }
    for (const auto& [name, set] : hard_sets<T>(60)) {
        CAPTURE(name);
        const auto tree = make_bvh(on, copy_to(on, set));
        check_scheduled<Schedule>(on, tree, tree, placed_truth(set.view(), set.view()));
    }
    const auto a = skewed_soup<T>(200, 900, random), b = skewed_soup<T>(900, 300, random);
    const pair_list expected = placed_truth(a.view(), b.view());
    CHECK(expected.size() > 100);
    check_scheduled<Schedule>(on, make_bvh(on, copy_to(on, a)), make_bvh(on, copy_to(on, b)), expected);
}

/// The other forms of a query, of two posed trees that are walked by another traversal.
template <class T, schedule Schedule, class Policy>
void check_scheduled_forms(const Policy& on) {
    uniform random(20270101);
    const near_and_away<T> sets = random_near_and_away<T>(random);
    const auto x = make_bvh(on, copy_to(on, sets.a)), y = make_bvh(on, copy_to(on, sets.b));
    const auto away = make_bvh(on, copy_to(on, sets.away));
    const pair_list expected = placed_truth(sets.a.view(), sets.b.view());
    CHECK(to_host(pairs(on, x, y)) == expected);
    const query_options<id_filter> filtered_default{};
    using walked_filtered = by_schedule<Schedule, id_filter, traversal::larger_first>;
    CHECK(to_host(pairs(on, x, y, walked_filtered{})) == to_host(pairs(on, x, y, filtered_default)));
    for (const schedule_options& scheduling : tight_options) {
        CAPTURE(static_cast<int>(Schedule), scheduling.queue_capacity, scheduling.most_blocks);
        const by_schedule<Schedule> options{.scheduling = scheduling};
        check_forms(on, x, y, away, expected, options);
    }
}

/// A list with entries of trees of one shape and of none among others, and one of which most is to be done in one.
template <class T, schedule Schedule, class Policy>
void check_scheduled_lists(const Policy& on) {
    uniform random(20270102);
    draws d(20270102, 93, 0);
    const auto empty = make_bvh(on, copy_to(on, triangle_soup<T>(std::vector<triangle<T>>{})));
    const auto one = make_bvh(on, copy_to(on, random_soup<T>(1, random)));
    const auto few = make_bvh(on, copy_to(on, random_soup<T>(30, random)));
    const auto many = make_bvh(on, copy_to(on, random_soup<T>(700, random)));
    std::vector<posed_pair<std::remove_const_t<decltype(few)>>> list;
    for (int i = 0; i < 500; ++i) {
        const auto& other = i == 17 ? empty : i == 30 ? one : i % 100 == 50 ? many : few;
        list.push_back({posed(other, {}), posed(i == 250 ? many : few, make_pose<T>(d, 0.3))});
    }
    const auto expected = to_host(pairs(on, list));
    CHECK(expected.size() > 300);
    for (const schedule_options& scheduling : tight_options) {
        CAPTURE(static_cast<int>(Schedule), scheduling.queue_capacity, scheduling.most_blocks);
        const list_options<keep_all, Schedule> options{.scheduling = scheduling};
        CHECK(to_host(pairs(on, list, options)) == expected);
        CHECK(count(on, list, options) == expected.size());
    }
}

/// Nearly all of the work comes of one pair of nodes. Each schedule does there what it alone does.
template <class T, schedule Schedule, class Policy>
void check_scheduled_skew(const Policy& on, int tries = 1) {
    uniform random(20270103);
    const auto a = make_bvh(on, copy_to(on, skewed_soup<T>(20'000, 6'000, random)));
    const auto b = make_bvh(on, copy_to(on, skewed_soup<T>(20'000, 6'000, random)));
    const std::uint64_t expected = count(on, a, b);
    CHECK(expected > 10'000);
    schedule_report report;
    for (int k = 0; k < tries && report.steals == 0; ++k) {
        forget_lost_time();
        CHECK(count(on, a, b, by_schedule<Schedule>{.scheduling = {.report = &report}}) == expected);
    }
    check_report(report, Schedule, false);
}

template <class T, schedule Schedule, class Policy>
void check_scheduled_queries(const Policy& on, int tries = 1) {
    check_scheduled_sets<T, Schedule>(on);
    check_scheduled_forms<T, Schedule>(on);
    check_scheduled_lists<T, Schedule>(on);
    check_scheduled_skew<T, Schedule>(on, tries);
}

}  // namespace abut::test
