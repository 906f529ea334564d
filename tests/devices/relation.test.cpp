// SPDX-License-Identifier: MIT
//
// A relation of a caller's own (support/opposite_triangles.hpp) on several policies, and what is said of each entry of a list.

#include "devices/host_team.hpp"

#include <cstdint>
#include <vector>

#include <abut/devices/bodies.hpp>
#include <abut/devices/query.hpp>

#include "support/catch.hpp"
#include "support/opposite_triangles.hpp"

TEST_CASE("devices: a relation of a caller's own") {
    using namespace abut;
    using namespace abut::test;
    const host_team<serial> team(GENERATE(1, 2, 3, 5));
    const auto one = lattice_triangles(300, 11), other = lattice_triangles(250, 12);
    const shapes<triangle<float>> a(one), b(other);
    const auto expected = opposite_by_definition(one, other), among = opposite_by_definition(one, one, true);
    const auto everywhere = make_bvh(team, replicate(team, a));
    const auto part_a = divide(team, a), part_b = divide(team, b);
    CHECK((to_host(opposite_pairs(team, everywhere, b)) == expected));
    CHECK((to_host(opposite_pairs(team, part_a, part_b)) == expected));
    CHECK((to_host(opposite_pairs(team, make_bvh(team, part_a), make_bvh(team, part_b))) == expected));
    CHECK(count_opposite(team, make_bvh(team, part_a), part_b) == expected.size());
    CHECK((to_host(opposite_self_pairs(team, everywhere)) == among));
    CHECK((to_host(opposite_self_pairs(team, part_a)) == among));

    std::vector<posed_pair<std::remove_const_t<decltype(everywhere)>>> list;
    std::vector<posed_pair<bvh<shapes<triangle<float>>, host_space>>> alone;
    const auto tree = make_bvh(serial{}, a);
    std::vector<std::uint32_t> index_of;
    std::vector<rigid<float>> poses;
    for (int i = 0; i < 7; ++i) {
        rigid<float> away;
        away.translation = {static_cast<float>(i), 0, static_cast<float>(i) / 4};
        list.push_back({posed(everywhere, rigid<float>{}), posed(everywhere, away)});
        alone.push_back({posed(tree, rigid<float>{}), posed(tree, away)});
        index_of.push_back(0);
        poses.push_back(away);
    }
    CHECK((to_host(opposite_pairs(team, list)) == to_host(opposite_pairs(serial{}, alone))));
    CHECK((to_host(any_each(team, list)) == to_host(any_each(serial{}, alone))));
    CHECK((to_host(count_each(team, list)) == to_host(count_each(serial{}, alone))));
    CHECK((to_host(any_within_each(team, list, 0.5)) == to_host(any_within_each(serial{}, alone, 0.5))));
    const auto bodies = make_bodies(team, std::vector{everywhere}, index_of, poses);
    CHECK((to_host(opposite_pairs(team, bodies)) ==
           to_host(opposite_pairs(serial{}, make_bodies(serial{}, std::vector{tree}, index_of, poses)))));
}
