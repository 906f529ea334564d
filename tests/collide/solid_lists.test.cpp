// SPDX-License-Identifier: MIT
//
// Solids in lists and scenes of several kinds, two scenes, and by a rule, against the cells that they are made of.

#include <abut/collide/solid_entries.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <abut/abut.hpp>
#include <abut/index/quantised.hpp>

#include "collide/solid_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

namespace {

using solid_tree = decltype(make_bvh(serial{}, mesh<float>()));
using small_solid_tree = decltype(quantised(serial{}, std::declval<const solid_tree&>()));

/// Sets of cells, a large one among them, as bodies of two kinds.
struct solid_scene {
    std::vector<cells> sets;
    std::vector<posed_object<solid_tree>> first;
    std::vector<posed_object<small_solid_tree>> second;

    template <class Policy>
    solid_scene(const Policy& on, std::uint64_t k) {
        draws d(20271201, 1, k);
        const frame_of_grid f = draw_frame(d);
        const rigid<float> there{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {2, 0, -1}};
        for (int i = 0; i < 10; ++i) {
            cells c = draw_cells(d, 1 + d.below(4), 1 + d.below(2), 4);
            if (i == 2) {
                c = {};
                for (int p = 0; p < 125; ++p) c.in.insert({p % 5, p / 5 % 5, p / 25});
                c.offset = {-1, -1, -1};
            }
            // In its interior, and at its surface from within.
            if (i == 0 || i == 3) c = {{{1 + d.below(2), 1, 2}}, 1, {0, 0, 0}};
            if (i == 1 || i == 9) c = {{{-1, d.below(4), -1}}, 1, {0, 0, 0}};
            if (i == 7) c = sets[1];
            const auto index = make_bvh(on, surface_of<float>(c, f, d));
            sets.push_back(c);
            if (i < 5) {
                first.push_back(posed(index, there));
            } else {
                second.push_back(posed(quantised(on, index), there));
            }
        }
    }
    [[nodiscard]] solid_relation truth(std::size_t i, std::size_t j) const { return truth_of(sets[i], sets[j]); }
};

bool do_overlap(solid_relation r) { return r > solid_relation::externally_connected; }

/// Bodies that are looked at: one type for all scenes of several kinds here, since each takes a compiler as long as there are two kinds.
auto bodies_below(std::uint32_t end) { return body_options<keep_all, schedule::shared_list, only_below>{.bodies = only_below{end}}; }

template <class Policy>
void check_kinds_of_solids(const Policy& on) {
    std::size_t of[8] = {};
    for (std::uint64_t k = 0; k < 3; ++k) {
        const solid_scene scene(on, k);
        const solid_options options{.known_solid = k % 2 == 0};
        const auto all = make_bodies(on, scene.first, scene.second);
        const auto two = between(make_bodies(on, scene.first), scene.second);
        std::vector<body_relation> truth, truth_of_two;
        std::vector<index_pair> overlapping, overlapping_of_two;
        using entry = std::variant<posed_pair<solid_tree>, posed_pair<small_solid_tree, solid_tree>, posed_pair<solid_tree, small_solid_tree>>;
        std::vector<entry> list;
        std::vector<solid_relation> of_list;
        std::vector<std::uint8_t> meet;
        for (std::uint32_t i = 0; i < 10; ++i) {
            for (std::uint32_t j = i + 1; j < 10; ++j) {
                const solid_relation is = scene.truth(i, j);
                ++of[static_cast<int>(is)];
                const bool between_both = i < 5 && j >= 5;
                if (is != solid_relation::disconnected) {
                    truth.push_back({i, j, is});
                    if (between_both) truth_of_two.push_back({i, j - 5, is});
                }
                if (do_overlap(is)) {
                    overlapping.push_back({i, j});
                    if (between_both) overlapping_of_two.push_back({i, j - 5});
                }
                if (j < 5) {
                    list.push_back(posed_pair<solid_tree>{scene.first[i], scene.first[j]});
                    of_list.push_back(is);
                } else if (between_both && (i + j) % 2 == 0) {
                    list.push_back(posed_pair<solid_tree, small_solid_tree>{scene.first[i], scene.second[j - 5]});
                    of_list.push_back(is);
                } else if (between_both) {
                    list.push_back(posed_pair<small_solid_tree, solid_tree>{scene.second[j - 5], scene.first[i]});
                    of_list.push_back(scene.truth(j, i));
                } else {
                    continue;
                }
                meet.push_back(do_overlap(is) ? 1 : 0);
            }
        }
        CHECK((relation(on, all, options, bodies_below(10)) == truth));
        CHECK((overlaps(on, list, options) == meet));
        CHECK((overlaps(on, all, options, bodies_below(10)) == overlapping));
        CHECK((relation(on, two, options) == truth_of_two));
        CHECK((overlaps(on, two, options) == overlapping_of_two));
        CHECK((relation(on, list, options) == of_list));
        // By a rule the same, of surfaces that pass through nothing.
        const solid_options by{.known_solid = k % 2 == 1, .rule = inside_rule::nonzero};
        CHECK((relation(on, all, by, bodies_below(10)) == truth));
        CHECK((overlaps(on, list, by) == meet));
        // Filters of bodies are told of numbers in the scene, and filters of shapes are not asked.
        std::erase_if(truth, [](const body_relation& r) { return r.body_b >= 7; });
        CHECK((relation(on, all, options, bodies_below(7)) == truth));
        const auto none = [](const body_pair&) { return false; };
        const body_options<decltype(none), schedule::shared_list, only_below> no_shapes{.filter = none, .bodies = only_below{10}};
        CHECK((overlaps(on, all, options, no_shapes) == overlapping));
    }
    for (const std::size_t some : of) CHECK(some > 0);
}

template <class Call>
std::string said_of(const Call& call) {
    try {
        call();
    } catch (const error& problem) {
        return problem.what();
    }
    return "nothing";
}

}  // namespace

TEST_CASE("solids in lists and scenes: several kinds, and two scenes") {
    check_kinds_of_solids(openmp{.threads = 3});
}

TEST_CASE("solids in lists and scenes: what is no solid is named by its place in the whole") {
    const openmp on{.threads = 2};
    const mesh<float> open({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}});
    const mesh<float> part({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
    const auto bad = make_bvh(on, open), good = make_bvh(on, part);
    const rigid<float> here{}, moved{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0}};
    const std::vector first{posed(good, here), posed(good, moved)};
    const std::vector<posed_object<small_solid_tree>> second{posed(quantised(on, good), moved), posed(quantised(on, bad), here)};
    const auto all = make_bodies(on, first, second);
    CHECK(said_of([&] { (void)relation(on, all, {}, bodies_below(4)); }).starts_with("abut::relation: body 3, face"));
    CHECK(said_of([&] { (void)overlaps(on, all, {.rule = inside_rule::nonzero}, bodies_below(4)); }).starts_with("abut::overlaps: body 3, face"));
    using entry = std::variant<posed_pair<solid_tree>, posed_pair<solid_tree, small_solid_tree>>;
    std::vector<entry> list{posed_pair<solid_tree>{first[0], first[1]}, posed_pair<solid_tree, small_solid_tree>{first[0], second[0]},
                            posed_pair<solid_tree, small_solid_tree>{first[0], second[1]}};
    CHECK(said_of([&] { (void)overlaps(on, list); }).starts_with("abut::overlaps: entry 2, face"));
    list.pop_back();
    CHECK((overlaps(on, list) == std::vector<std::uint8_t>{1, 1}));
    std::get<0>(list[0]).a.pose.rotation[0] = 3;
    CHECK(said_of([&] { (void)relation(on, list); }).find("entry 0 of the list") != std::string::npos);
    CHECK(overlaps(on, std::vector<entry>{}).empty());
    CHECK(relation(on, std::vector<posed_pair<solid_tree>>{}).empty());
    CHECK(overlaps(on, std::vector<posed_object<solid_tree>>{}).empty());
    // Without faces it is empty: bodies that are told of have an interior.
    const auto empty = make_bvh(on, mesh<float>());
    const std::vector<posed_pair<solid_tree>> with_none{{posed(good, here), posed(empty, here)}, {posed(empty, here), posed(empty, here)}};
    CHECK((overlaps(on, with_none) == std::vector<std::uint8_t>{0, 0}));
    CHECK((relation(on, with_none) == std::vector(2, solid_relation::disconnected)));
    CHECK((overlaps(on, with_none, {.rule = inside_rule::parity}) == std::vector<std::uint8_t>{0, 0}));
}

}  // namespace abut::test
