// SPDX-License-Identifier: MIT
#pragma once

// How solids lie to each other, and stretches of rays inside, where several policies have the solids or parts of them: what is known
// of their cells, and the answers of one policy.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <abut/abut.hpp>
#include <abut/devices/bodies.hpp>
#include <abut/devices/rows.hpp>
#include <abut/devices/solids.hpp>

#include "collide/patch_cases.hpp"
#include "collide/solid_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

template <class Team>
void check_relations_of_team(const Team& team) {
    const serial on;
    using tree = std::remove_cvref_t<decltype(make_bvh(team, replicate(team, mesh<float>()))[0])>;
    using tree_here = decltype(make_bvh(on, mesh<float>()));
    std::uint64_t of[8] = {}, wrong = 0, patches = 0;
    std::vector<replicated<tree>> indices;
    std::vector<tree_here> alone;
    std::vector<std::uint32_t> index_of;
    std::vector<rigid<float>> poses;
    std::vector<posed_pair<replicated<tree>>> list;
    std::vector<posed_pair<tree_here>> list_here;
    std::vector<solid_relation> of_list;
    const rigid<float> there{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {2, 0, -1}};
    for (std::uint64_t k = 0; k < 60; ++k) {
        draws d(20270514, 6, k);
        const auto [a, b] = draw_two_of_all_kinds(d, k);
        const frame_of_grid f;
        const auto x = surface_of<float>(a, f, d), y = surface_of<float>(b, f, d);
        const auto tree_x = make_bvh(team, replicate(team, x)), tree_y = make_bvh(team, replicate(team, y));
        const solid_relation truth = truth_of(a, b);
        ++of[static_cast<int>(truth)];
        wrong += relation(team, tree_x, posed(tree_y, rigid<float>{})) != truth;
        wrong += relation<exact>(team, x, tree_y, {.known_solid = true}) != truth;
        wrong += overlaps(team, tree_x, tree_y, {.known_solid = k % 2 == 0}) != (truth > solid_relation::externally_connected);
        const auto part_x = divide(team, x), part_y = divide(team, y);
        wrong += relation(team, part_x, make_bvh(team, part_y)) != truth;
        wrong += relation(team, posed(part_x, rigid<float>{}), tree_y, {.known_solid = true}) != truth;
        wrong += overlaps(team, tree_x, part_y, {.known_solid = true}) != (truth > solid_relation::externally_connected);
        const auto here = contact_patches(on, x, y, {.known_solid = true}), on_team = contact_patches(team, tree_x, tree_y, {.known_solid = true});
        patches += here.size();
        REQUIRE(here.size() == on_team.size());
        for (std::size_t i = 0; i < here.size(); ++i) {
            wrong += here[i].center != on_team[i].center || here[i].normal != on_team[i].normal || here[i].depth != on_team[i].depth ||
                     here[i].points != on_team[i].points || here[i].curves.size() != on_team[i].curves.size();
        }
        list.push_back({posed(tree_x, there), posed(tree_y, there)});
        list_here.push_back({posed(make_bvh(on, x), there), posed(make_bvh(on, y), there)});
        of_list.push_back(truth);
        if (k >= 12) continue;
        index_of.push_back(static_cast<std::uint32_t>(indices.size()));
        indices.push_back(tree_x);
        alone.push_back(make_bvh(on, x));
        poses.push_back(there);
    }
    CHECK(wrong == 0);
    CHECK(patches > 20);
    for (const std::uint64_t some : of) CHECK(some > 0);
    CHECK((relation(team, list) == of_list));
    CHECK((relation(team, list, {.known_solid = true}) == of_list));
    const auto here = make_bodies(on, alone, index_of, poses);
    const auto there_all = make_bodies(team, indices, index_of, poses);
    const auto expected = relation(on, here);
    CHECK(expected.size() > 20);
    CHECK((relation(team, there_all) == expected));
    CHECK((relation(team, between(there_all, there_all)) == relation(on, between(here, here))));
    CHECK((overlaps(team, there_all, {.known_solid = true}) == overlaps(on, here)));
    std::vector<std::uint8_t> meet;
    for (const solid_relation truth : of_list) meet.push_back(truth > solid_relation::externally_connected ? 1 : 0);
    CHECK((overlaps(team, list) == meet));
    const auto patches_here = contact_patches(on, list_here), patches_there = contact_patches(team, list);
    CHECK(std::equal(patches_here.begin(), patches_here.end(), patches_there.begin(), patches_there.end(), [](const auto& x, const auto& y) { return are_same(x, y); }));
    const auto of_bodies = contact_patches(on, here), of_bodies_there = contact_patches(team, there_all);
    CHECK(std::equal(of_bodies.begin(), of_bodies.end(), of_bodies_there.begin(), of_bodies_there.end(), [](const auto& x, const auto& y) {
        return x.body_a == y.body_a && x.body_b == y.body_b && are_same(x.patches, y.patches);
    }));
    const std::vector few(list.begin(), list.begin() + 7);
    const std::vector few_here(list_here.begin(), list_here.begin() + 7);
    CHECK((penetration(team, few, {.tolerance = 2}) == penetration(on, few_here, {.tolerance = 2})));
    const auto only_four = body_options<keep_all, schedule::shared_list, only_below>{.bodies = only_below{4}};
    CHECK((penetration(team, there_all, {.tolerance = 2}, only_four) == penetration(on, here, {.tolerance = 2}, only_four)));
    const auto far = hausdorff(team, few, {.tolerance = 1}), far_here = hausdorff(on, few_here, {.tolerance = 1});
    CHECK(std::equal(far.begin(), far.end(), far_here.begin(), far_here.end(), [](const auto& x, const auto& y) {
        return x.a_from_b == y.a_from_b && x.b_from_a == y.b_from_a;
    }));
    const aabb<float> room{{0, 0, 0}, {4, 3, 3}}, cupboard{{3, 0, 0}, {4, 1, 2}};
    CHECK(relation(team, cupboard, room) == solid_relation::tangential_part);
}

template <class Team>
void check_spans_of_team(const Team& team) {
    std::size_t stretches = 0;
    for (std::uint64_t k = 0; k < 6; ++k) {
        draws d(20270514, 8, k);
        const auto x = surface_of<float>(draw_two_sets(d, k).first, frame_of_grid{}, d);
        const rays<float> lines(draw_rays_of_grid<float>(d, k == 5 ? 9000 : 700));
        const auto expected = spans(serial{}, make_bvh(serial{}, x), lines);
        stretches += expected.size();
        CHECK((spans(team, make_bvh(team, replicate(team, x)), lines) == expected));
        CHECK((spans(team, x, replicate(team, lines), {.known_closed = true}) == expected));
        CHECK((spans(team, divide(team, x), lines, {.known_closed = true}) == expected));
        CHECK((spans<exact>(team, posed(make_bvh(team, divide(team, x)), rigid<float>{}), lines, {.known_closed = true}) == expected));
        // Turned inside out, by rules: of a divided mesh too.
        const auto turned = surface_of<float>(draw_two_sets(d, k).first, frame_of_grid{}, d, true);
        CHECK(spans(team, divide(team, turned), lines, {.known_closed = true, .rule = inside_rule::positive}).empty());
        CHECK((spans(team, divide(team, turned), lines, {.known_closed = true, .rule = inside_rule::nonzero}) == spans(serial{}, turned, lines)));
        CHECK_THROWS_AS(spans(team, divide(team, x), lines), error);
    }
    CHECK(stretches > 2000);
}

/// What is no solid is named by its place in the whole. Of a team of two, and another one of three.
template <class Team>
void check_errors_of_solids(const Team& team, const Team& other) {
    const mesh<float> open({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}});
    const mesh<float> part({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
    const auto bad = make_bvh(team, replicate(team, open)), good = make_bvh(team, replicate(team, part));
    CHECK_THROWS_AS(relation(team, bad, good), invalid_geometry);
    using tree = std::remove_cvref_t<decltype(good[0])>;
    std::vector<posed_pair<replicated<tree>>> list(5, {posed(good, rigid<float>{}), posed(good, rigid<float>{})});
    list[3].b = posed(bad, rigid<float>{});
    try {
        (void)relation(team, list);
        FAIL("an open mesh was taken");
    } catch (const invalid_geometry& e) {
        CHECK(std::string(e.what()).find("entry 3, face") != std::string::npos);
    }
    CHECK_THROWS_AS(relation(other, good, good), error);
}

}  // namespace abut::test
