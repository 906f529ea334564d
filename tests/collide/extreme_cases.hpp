// SPDX-License-Identifier: MIT
#pragma once

// Pairs and queries at the extremes of support/extremes.hpp: each step gives the answers of unbounded integers.

#include <cstdint>
#include <cstdio>
#include <vector>

#include "collide/query_cases.hpp"
#include "support/extreme_truth.hpp"
#include "support/samples.hpp"

namespace abut::test {

template <class S>
auto set_of(const std::vector<S>& shapes_of_kind) {
    return shapes(shapes_of_kind);
}
template <class T>
hulls<T> set_of(const std::vector<four_points<T>>& lists) {
    std::vector<std::vector<vec3<T>>> points;
    for (const four_points<T>& list : lists) points.emplace_back(list.at, list.at + 4);
    return hulls<T>(points);
}

/// A step's pairs as two sets, and which pairs touch in truth: of all, or of each with its own alone.
template <class Kind, class T>
struct extreme_sets {
    using pair = decltype(make_extreme_pair<Kind, T>(0, {}, 0));
    std::vector<decltype(pair::a)> a;
    std::vector<decltype(pair::b)> b;
    pair_list touching;

    extreme_sets(const extreme_step& step, std::uint32_t n) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const pair p = make_extreme_pair<Kind, T>(sample_seed, step, i);
            a.push_back(p.a);
            b.push_back(p.b);
        }
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j = 0; j < n; ++j) {
                if (touch_in_truth<T>(pair{a[i], b[j]})) touching.push_back({i, j});
            }
        }
    }
};

/// All against all in both arithmetics: plain sets, and an index on one side; `more` asks in further ways.
template <class Kind, class T, bool more, class Policy>
void check_extreme_queries(const Policy& on, std::uint32_t n) {
    std::size_t hits = 0, steps = 0;
    for (const extreme what : extremes) {
        for (const extreme_step& step : steps_of<T>(what)) {
            CAPTURE(Kind::name(), name_of(what), step.value);
            const extreme_sets<Kind, T> sets(step, n);
            const auto a = copy_to(on, set_of(sets.a));
            const auto b = copy_to(on, set_of(sets.b));
            const auto b_tree = make_bvh(on, b);
            CHECK(to_host(pairs<exact>(on, a, b)) == sets.touching);
            CHECK(to_host(pairs<filtered>(on, a, b_tree)) == sets.touching);
            if constexpr (more) {
                CHECK(count<filtered>(on, make_bvh(on, a), b_tree) == sets.touching.size());
                CHECK(to_host(pairs<filtered>(on, a, b)) == sets.touching);
                CHECK(to_host(pairs<filtered>(on, make_bvh(on, a), b)) == sets.touching);
                if constexpr (requires { make_grid(on, a); }) {
                    CHECK(to_host(pairs<filtered>(on, make_grid(on, a), b)) == sets.touching);
                }
                CHECK(any<filtered>(on, a, b_tree) == !sets.touching.empty());
            }
            hits += sets.touching.size();
            ++steps;
        }
    }
    std::printf("%s, %zu steps of %u against %u: %zu hits\n", Kind::name().c_str(), steps, n, n, hits);
    CHECK(hits > steps * n / 4);
}

/// Of the kinds that are asked in more ways, of most others, and of hulls: three functions, since a compiler for devices
/// takes minutes for each.
///@{
template <class T, class Policy>
void check_first_extreme_queries(const Policy& on) {
    for_each_kind(first_extreme_kinds{},
                  [&]<class Kind>(Kind) { check_extreme_queries<Kind, T, true>(on, Kind::moving ? 6 : 20); });
}
template <class T, class Policy>
void check_other_extreme_queries(const Policy& on) {
    for_each_kind(other_extreme_kinds{}, [&]<class Kind>(Kind) { check_extreme_queries<Kind, T, false>(on, 6); });
}
template <class T, class Policy>
void check_hull_extreme_queries(const Policy& on) {
    for_each_kind(hull_extreme_kinds{}, [&]<class Kind>(Kind) { check_extreme_queries<Kind, T, false>(on, 6); });
}
///@}

template <class T, class Policy>
void check_all_extreme_queries(const Policy& on) {
    check_first_extreme_queries<T>(on);
    check_other_extreme_queries<T>(on);
    check_hull_extreme_queries<T>(on);
}

}  // namespace abut::test
