// SPDX-License-Identifier: MIT
//
// A relation of a caller's own (support/opposite_triangles.hpp) on a device, and what is said of each entry of a list: the
// answers of the host.

#include <abut/cuda.hpp>

#include <algorithm>
#include <type_traits>
#include <vector>

#include "support/catch.hpp"
#include "support/opposite_triangles.hpp"

TEST_CASE("relation: one of a caller's own on a device") {
    using namespace abut;
    using namespace abut::test;
    const abut::cuda on;
    const auto one = lattice_triangles(300, 11), other = lattice_triangles(250, 12);
    const shapes<triangle<float>> a(one), b(other);
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
    const auto there_a = make_bvh(serial{}, a), there_b = make_bvh(serial{}, b);
    const auto expected = opposite_by_definition(one, other);
    CHECK((to_host(opposite_pairs(on, a, b)) == expected));
    CHECK((to_host(opposite_pairs(on, tree_a, tree_b)) == expected));
    CHECK((to_host(opposite_pairs<exact>(on, tree_a, tree_b)) == expected));
    CHECK((to_host(opposite_self_pairs(on, tree_a)) == opposite_by_definition(one, one, true)));
    async_result<index_pair> found(on, 10'000);
    opposite_pairs(async(on, found), tree_a, tree_b);
    CHECK((to_host(wait(on, found)) == expected));

    std::vector<posed_pair<std::remove_const_t<decltype(tree_a)>>> list;
    std::vector<posed_pair<std::remove_const_t<decltype(there_a)>>> there;
    for (int i = 0; i < 200; ++i) {
        rigid<float> away;
        away.translation = {static_cast<float>(i) / 32, 0, static_cast<float>(i % 7) / 4};
        list.push_back({posed(tree_a, rigid<float>{}), posed(tree_b, away)});
        there.push_back({posed(there_a, rigid<float>{}), posed(there_b, away)});
    }
    CHECK((to_host(opposite_pairs(on, list)) == to_host(opposite_pairs(serial{}, there))));
    const auto each = to_host(any_each(serial{}, there));
    CHECK(std::count(each.begin(), each.end(), 1) > 50);
    CHECK(std::count(each.begin(), each.end(), 0) > 20);
    CHECK((to_host(any_each(on, list)) == each));
    CHECK((to_host(count_each(on, list)) == to_host(count_each(serial{}, there))));
    CHECK((to_host(any_within_each(on, list, 0.5)) == to_host(any_within_each(serial{}, there, 0.5))));
}
