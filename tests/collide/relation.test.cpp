// SPDX-License-Identifier: MIT
//
// A relation of a caller's own (support/opposite_triangles.hpp) is there for every form of arguments at once; and what is said
// of each entry of a list.

#include "support/opposite_triangles.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "support/catch.hpp"
#include "support/poses.hpp"

namespace abut::test {

namespace {

template <class Policy>
void check_own_relation(const Policy& on) {
    const auto one = lattice_triangles(300, 11), other = lattice_triangles(250, 12);
    const shapes<triangle<float>> a(one), b(other);
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
    const auto expected = opposite_by_definition(one, other);
    const auto all = to_host(pairs(on, a, b));
    CHECK(expected.size() > 150);
    CHECK(all.size() > expected.size() + 150);
    CHECK((to_host(opposite_pairs(on, a, b)) == expected));
    CHECK((to_host(opposite_pairs(on, tree_a, b)) == expected));
    CHECK((to_host(opposite_pairs<exact>(on, tree_a, tree_b)) == expected));
    CHECK((to_host(opposite_pairs(on, a, make_grid(on, b))) == expected));
    CHECK(count_opposite(on, tree_a, tree_b) == expected.size());
    const auto among = opposite_by_definition(one, one, true);
    CHECK(among.size() > 100);
    CHECK((to_host(opposite_self_pairs(on, a)) == among));
    CHECK((to_host(opposite_self_pairs(on, tree_a)) == among));

    std::vector<posed_pair<decltype(make_bvh(on, a))>> list;
    std::vector<posed_object<decltype(make_bvh(on, a))>> bodies;
    rigid<float> away;
    for (int i = 0; i < 5; ++i) {
        away.translation = {static_cast<float>(i), 0, static_cast<float>(i) / 4};
        list.push_back({posed(tree_a, rigid<float>{}), posed(tree_b, away)});
        bodies.push_back(posed(i % 2 == 0 ? tree_a : tree_b, away));
    }
    std::vector<tagged_pair> of_list;
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        for (const auto [x, y] : to_host(opposite_pairs(on, list[i].a, list[i].b))) of_list.push_back({i, x, y});
    }
    CHECK(of_list.size() > expected.size());
    CHECK((to_host(opposite_pairs(on, list)) == of_list));
    std::vector<body_pair> of_bodies;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
            for (const auto [x, y] : to_host(opposite_pairs(on, bodies[i], bodies[j]))) of_bodies.push_back({i, j, x, y});
        }
    }
    CHECK((to_host(opposite_pairs(on, bodies)) == of_bodies));
    CHECK((to_host(opposite_pairs(on, make_bodies(on, bodies))) == of_bodies));
}

struct keep_odd {
    ABUT_HD bool operator()(const tagged_pair& of) const { return (of.a + of.b) % 2 != 0; }
};

template <class Policy>
void check_each_entry(const Policy& on) {
    const shapes<triangle<float>> a(lattice_triangles(200, 13)), few(lattice_triangles(3, 14)), one(lattice_triangles(1, 15)), none;
    const std::vector<bvh<shapes<triangle<float>>, host_space>> trees{make_bvh(on, a), make_bvh(on, few), make_bvh(on, one),
                                                                      make_bvh(on, none)};
    std::vector<posed_pair<bvh<shapes<triangle<float>>, host_space>>> list;
    for (std::uint32_t i = 0; i < 120; ++i) {
        draws d(31, 0, i);
        auto here = make_rotation<float>(d);
        here.translation = {static_cast<float>(d.uniform(0, 6)), static_cast<float>(d.uniform(0, 3)), 0};
        list.push_back({posed(trees[i % 3 == 0 ? 1 : 0], rigid<float>{}), posed(trees[i % 7 == 6 ? 3 : i % 4], here)});
    }
    const auto is = to_host(any_each(on, list)), near = to_host(any_within_each(on, list, 0.25));
    const auto counts = to_host(count_each(on, list));
    const list_options<keep_odd> odd{.filter = {}};
    const auto is_odd = to_host(any_each<exact>(on, list, odd));
    const auto count_odd = to_host(count_each(on, list, odd));
    REQUIRE(is.size() == list.size());
    REQUIRE(counts.size() == list.size());
    std::size_t wrong = 0, touching = 0, more = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto pairs_of_entry = to_host(pairs(serial{}, list[i].a, list[i].b));
        const auto odd_ones = static_cast<std::uint64_t>(std::count_if(
            pairs_of_entry.begin(), pairs_of_entry.end(), [](const index_pair& p) { return (p.a + p.b) % 2 != 0; }));
        const bool is_near = any_within(serial{}, list[i].a, list[i].b, 0.25);
        wrong += is[i] != !pairs_of_entry.empty() || counts[i] != pairs_of_entry.size() || is_odd[i] != (odd_ones > 0) ||
                 count_odd[i] != odd_ones || near[i] != is_near;
        touching += is[i];
        more += is_near;
    }
    CHECK(wrong == 0);
    CHECK(touching > 10);
    CHECK(more > touching + 2);
    CHECK(more < list.size() - 20);
    CHECK(any_each(on, std::vector<posed_pair<bvh<shapes<triangle<float>>, host_space>>>{}).size() == 0);
    CHECK_THROWS_WITH(any_within_each(on, list, -1.0),
                      "abut::any_within_each: distance is -1; expected a finite number, 0 or more");
    list[7].b.pose.rotation[0] = 3;
    CHECK_THROWS_WITH(count_each(on, list), Catch::Matchers::Contains("entry 7 of the list"));
}

}  // namespace

TEST_CASE("relation: one of a caller's own, of two, one, lists and bodies") {
    check_own_relation(serial{});
    check_own_relation(openmp{.threads = 3});
}

TEST_CASE("relation: what is said of each entry of a list") {
    check_each_entry(serial{});
    check_each_entry(openmp{.threads = 3});
}

}  // namespace abut::test
