// SPDX-License-Identifier: MIT
#pragma once

// Queries that need not see all pairs do not: `any` after its first hit, and for_each_pair after visit::stop. Every pair of
// the scene touches, and what is counted are calls of a filter, one before each decision, and of the visitor. Who ignores
// the wish to stop makes all of them. A policy may have begun some when it learns of it, so the limit is a share of all.

#include <cstdint>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/descent_rules.hpp>

#include "support/catch.hpp"

namespace abut::test {

/// Counts its calls, and keeps each pair.
struct counting_filter {
    std::uint64_t* calls;
    ABUT_HD bool operator()(std::uint32_t, std::uint32_t) const {
        execution::atomic_add(calls, std::uint64_t{1});
        return true;
    }
    ABUT_HD bool operator()(tagged_pair pair) const { return (*this)(pair.a, pair.b); }
};

/// Counts its calls, and stops at each.
struct counting_visitor {
    std::uint64_t* calls;
    ABUT_HD visit operator()(index_pair) const {
        execution::atomic_add(calls, std::uint64_t{1});
        return visit::stop;
    }
    ABUT_HD visit operator()(tagged_pair pair) const { return (*this)(index_pair{pair.a, pair.b}); }
};

/// What `ask(counter)` adds to a counter in the policy's memory.
template <class Policy, class Ask>
std::uint64_t counted(const Policy& on, const Ask& ask) {
    execution::buffer_of<Policy, std::uint64_t> counter(on, 1);
    fill(on, counter.data(), 1, std::uint64_t{0});
    ask(counter.data());
    std::uint64_t calls = 0;
    counter.read(&calls);
    return calls;
}

template <traversal Traversal, schedule Schedule = default_schedule<Traversal>, class Policy, class X, class Y>
void check_stops_between(const Policy& on, const X& a, const Y& b, std::uint64_t limit) {
    using counting_options = query_options<counting_filter, Traversal, Schedule>;
    CAPTURE(static_cast<int>(Traversal), static_cast<int>(Schedule));
    const auto decided =
        counted(on, [&](std::uint64_t* calls) { CHECK(any(on, a, b, counting_options{.filter = {calls}})); });
    CHECK(decided > 0);
    CHECK(decided < limit);
    const auto visited = counted(on, [&](std::uint64_t* calls) {
        for_each_pair(on, a, b, counting_visitor{calls}, query_options<keep_all, Traversal, Schedule>{});
    });
    CHECK(visited > 0);
    CHECK(visited < limit);
}

/// All ways to find pairs of n triangles with m triangles or spheres; of n m pairs less than `limit` may be looked at.
template <class Policy>
void check_stops(const Policy& on, std::size_t n, std::size_t m, std::uint64_t limit) {
    const triangle_soup<float> flat(std::vector<triangle<float>>(n, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}));
    const triangle_soup<float> upright(std::vector<triangle<float>>(m, {{1, 1, -1}, {2, 1, 1}, {1, 2, 1}}));
    const equal_spheres<float> balls(std::vector<vec3<float>>(m, {1, 1, 0.5f}), 1);
    const auto a = copy_to(on, flat);
    const auto b = copy_to(on, upright);
    const auto c = copy_to(on, balls);
    const auto tree_a = make_bvh(on, a);
    const auto tree_b = make_bvh(on, b);
    constexpr traversal usual = traversal::both_at_once;
    SECTION("two trees") {
        check_stops_between<usual>(on, tree_a, tree_b, limit);
        check_stops_between<usual, schedule::shared_list>(on, tree_a, tree_b, limit);
        check_stops_between<usual, schedule::work_stealing>(on, tree_a, tree_b, limit);
        check_stops_between<traversal::one_first>(on, tree_a, tree_b, limit);
        check_stops_between<traversal::breadth_first>(on, tree_a, tree_b, limit);
    }
    SECTION("a tree and a set") {
        check_stops_between<usual>(on, tree_a, b, limit);
        check_stops_between<usual>(on, tree_a, c, limit);
    }
    SECTION("a grid and a set") { check_stops_between<usual>(on, make_grid(on, c), a, limit); }
    SECTION("two sets") {
        check_stops_between<usual>(on, a, b, limit);
        check_stops_between<usual>(on, a, c, limit);
    }
    SECTION("a list of pairs") {
        using entry = posed_pair<bvh<triangle_soup<float, space_of<Policy>>, space_of<Policy>>,
                                 bvh<triangle_soup<float, space_of<Policy>>, space_of<Policy>>>;
        const std::vector<entry> list(3, entry{posed(tree_a, {}), posed(tree_b, {})});
        const auto decided = counted(
            on, [&](std::uint64_t* calls) { CHECK(any(on, list, list_options<counting_filter>{.filter = {calls}})); });
        const auto visited = counted(on, [&](std::uint64_t* calls) { for_each_pair(on, list, counting_visitor{calls}); });
        CHECK(decided > 0);
        CHECK(decided < limit);
        CHECK(visited > 0);
        CHECK(visited < limit);
    }
}

}  // namespace abut::test
