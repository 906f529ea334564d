// SPDX-License-Identifier: MIT
//
// A relation of a caller's own (support/opposite_triangles.hpp) of all parts, and what is said of each entry of a list.

#include <abut/mpi.hpp>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "collide/turning_cases.hpp"
#include "distributed/world.hpp"
#include "support/opposite_triangles.hpp"

TEST_CASE("distributed: a relation of a caller's own") {
    using namespace abut;
    using namespace abut::test;
    const distributed on(world(), serial{});
    const auto& ranks = on.ranks();
    const auto one = lattice_triangles(200, 11), other = lattice_triangles(150, 12);
    const auto expected = in_all_parts(opposite_by_definition(one, other));
    for (const division how : divisions) {
        const shapes<triangle<float>> a(part_of(one, how, on.rank(), on.size()));
        const shapes<triangle<float>> b(part_of(other, division::uneven, on.rank(), on.size()));
        const auto tree = make_bvh(on.local(), a);
        CHECK((lists_of_all(ranks, to_host(opposite_pairs(on, a, b))) == expected));
        CHECK((lists_of_all(ranks, to_host(opposite_pairs(on, tree, make_bvh(on.local(), b)))) == expected));
        CHECK(count_opposite(on, tree, b) == expected.size());
        CHECK((lists_of_all(ranks, to_host(opposite_self_pairs(on, tree))) ==
               in_all_parts(opposite_by_definition(one, one, true))));
    }
    const auto whole = make_bvh(on.local(), shapes<triangle<float>>(one));
    std::vector<posed_pair<std::remove_const_t<decltype(whole)>>> all;
    for (int i = 0; i < 9; ++i) {
        rigid<float> away;
        away.translation = {static_cast<float>(i) / 2, 0, static_cast<float>(i) / 4};
        all.push_back({posed(whole, rigid<float>{}), posed(whole, away)});
    }
    const auto mine = part_of(all, division::uneven, on.rank(), on.size());
    std::vector<global_tagged_pair> of_list;
    for (const tagged_pair& p : to_host(opposite_pairs(serial{}, all))) of_list.push_back({p.pair, p.a, p.b});
    CHECK((lists_of_all(ranks, to_host(opposite_pairs(on, mine))) == of_list));
    CHECK((lists_of_all(ranks, to_host(any_each(on, mine))) == to_host(any_each(serial{}, all))));
    CHECK((lists_of_all(ranks, to_host(count_each(on, mine))) == to_host(count_each(serial{}, all))));
}

TEST_CASE("distributed: lists of bodies that turn") {
    using namespace abut;
    using namespace abut::test;
    const distributed on(world(), serial{});
    const auto tree = make_bvh(on.local(), triangle_soup<float>(triangles_that_turn<float>(30, 1)));
    using index = std::remove_const_t<decltype(tree)>;
    const meeting_options options{.tolerance = 1e-3};
    std::vector<moving_pair<index>> all = drawn_motions<float>(tree, tree, 17);
    const auto expected = to_host(first_meetings(serial{}, all, options));
    for (const division how : divisions) {
        const auto mine = part_of(all, how, on.rank(), on.size());
        CHECK((lists_of_all(on.ranks(), to_host(first_meetings(on, mine, options))) == expected));
        CHECK((lists_of_all(on.ranks(), to_host(any_each(on, mine, options))) == to_host(any_each(serial{}, all, options))));
    }
    // An entry is named by its number in the list of all ranks, on all of them.
    const rigid<float> half{{-1, 0, 0, 0, -1, 0, 0, 0, 1}, {0, 0, 0}};
    all[15].a = moving(posed(tree, rigid<float>()), posed(tree, half));
    try {
        (void)first_meetings(on, part_of(all, division::even, on.rank(), on.size()), options);
        FAIL_CHECK("was taken");
    } catch (const error& e) {
        CHECK(std::string(e.what()).find("abut::first_meetings: entry 15 of the list: the first body: a half turn") != std::string::npos);
    }
}
