// SPDX-License-Identifier: MIT
#pragma once

// Lists of posed pairs on several devices: what one policy says of them, bit for bit, and in its order.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/abut.hpp>
#include <abut/devices/query.hpp>

#include "devices/device_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

namespace device_cases {

struct keep_some_entries {
    ABUT_HD bool operator()(const tagged_pair& of) const { return (of.pair + of.a + of.b) % 3 != 0; }
};
/// Counts the pairs of each entry.
struct count_by_entry {
    std::uint64_t* counts;
    ABUT_HD visit operator()(const tagged_pair& of) const {
        execution::atomic_add(counts + of.pair, std::uint64_t{1});
        return visit::proceed;
    }
};

template <scalar T, class Team>
void check_list_of(const Team& team, std::uint32_t entries) {
    const auto large = ball_surface<T>(2, 1.0), small = ball_surface<T>(1, 0.5);
    const std::vector<mesh<T>> sets{mesh<T>(large.vertices, large.faces), mesh<T>(small.vertices, small.faces), mesh<T>()};
    std::vector<bvh<mesh<T>, host_space>> whole;
    std::vector<decltype(make_bvh(team, sets[0]))> there;
    for (const auto& set : sets) {
        whole.push_back(make_bvh(serial{}, set));
        there.push_back(make_bvh(team, set));
    }
    std::vector<posed_pair<bvh<mesh<T>, host_space>>> alone;
    std::vector<posed_pair<decltype(make_bvh(team, sets[0]))>> list;
    for (std::uint32_t i = 0; i < entries; ++i) {
        draws d(12, 0, i);
        const std::size_t a = i % 2, b = i % 7 == 3 ? 2 : i % 3 == 0 ? 0 : 1;
        auto here = make_rotation<T>(d), other = make_rotation<T>(d);
        other.translation = {static_cast<T>(d.uniform(0, 2.5)), static_cast<T>(d.uniform(0, 1)), 0};
        alone.push_back({posed(whole[a], here), posed(whole[b], other)});
        list.push_back({posed(there[a], here), posed(there[b], other)});
    }
    const auto expected = to_host(pairs(serial{}, alone));
    CAPTURE(team.size(), entries, expected.size());
    CHECK((entries < 40 || expected.size() > 400));
    CHECK((to_host(pairs(team, list)) == expected));
    CHECK(count(team, list) == expected.size());
    CHECK(any(team, list) == !expected.empty());
    CHECK((to_host(contacts(team, list)) == to_host(contacts(serial{}, alone))));
    CHECK((to_host(distance(team, list)) == to_host(distance(serial{}, alone))));
    CHECK((to_host(distance(team, list, {.below = 0.25})) == to_host(distance(serial{}, alone, {.below = 0.25}))));
    const list_options<keep_some_entries> some{.filter = {}};
    CHECK((to_host(pairs(team, list, some)) == to_host(pairs(serial{}, alone, some))));
    if constexpr (host_policy<typename Team::local_policy>) {
        std::vector<std::uint64_t> counts(entries), in_order(entries);
        for_each_pair(team, list, [&](int) { return count_by_entry{counts.data()}; });
        for (const tagged_pair& of : expected) ++in_order[of.pair];
        CHECK(counts == in_order);
        auto unsorted = to_host(pairs(team, list, {.sorted = false}));
        std::sort(unsorted.begin(), unsorted.end());
        CHECK((unsorted == expected));
    }
    constexpr double near = 0.0625;
    const auto expected_within = to_host(within(serial{}, alone, near));
    CHECK((entries < 40 || expected_within.size() > expected.size() + 200));
    CHECK((to_host(within(team, list, near)) == expected_within));
    CHECK(count_within(team, list, near) == expected_within.size());
    CHECK(any_within(team, list, near) == !expected_within.empty());
    CHECK((to_host(within(team, list, near, some)) == to_host(within(serial{}, alone, near, some))));
    if constexpr (host_policy<typename Team::local_policy>) {
        std::vector<std::uint64_t> counts(entries), in_order(entries);
        for_each_within(team, list, near, [&](int) { return count_by_entry{counts.data()}; });
        for (const tagged_pair& of : expected_within) ++in_order[of.pair];
        CHECK(counts == in_order);
    }
    CHECK(message_of([&] { (void)within(team, list, -1); }).find("abut::within") == 0);
    if (entries < 2) return;
    rigid<T> mirror;
    mirror.rotation[0] = -1;
    list[1].a = posed(there[0], mirror);
    CHECK(message_of([&] { (void)count(team, list); }).find("entry 1 of the list") != std::string::npos);
}

template <scalar T, class Team>
void check_lists(const Team& team) {
    for (const std::uint32_t entries : {0u, 1u, 2u, 3u, 50u}) check_list_of<T>(team, entries);
}

}  // namespace device_cases

}  // namespace abut::test
