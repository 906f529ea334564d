// SPDX-License-Identifier: MIT
#pragma once

// Bodies that turn on several devices, in lists and in scenes: what one policy says of them, bit for bit, and in its order.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <abut/abut.hpp>
#include <abut/devices/bodies.hpp>
#include <abut/devices/query.hpp>

#include "collide/turning_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

template <class Team>
void check_meetings_of_team(const Team& team, const Team& other) {
    const serial on;
    const triangle_soup<float> soup(triangles_that_turn<float>(30, 1)), thin(triangles_that_turn<float>(25, 1e-3));
    const std::vector here{make_bvh(on, soup), make_bvh(on, thin)};
    const std::vector there{make_bvh(team, soup), make_bvh(team, thin)};
    using index = typename std::remove_cvref_t<decltype(here)>::value_type;
    using index_there = typename std::remove_cvref_t<decltype(there)>::value_type;
    constexpr std::size_t n = 23;
    const std::vector<moving_pair<index>> alone = drawn_motions<float>(here[0], here[1], n);
    std::vector<moving_pair<index_there>> list;
    for (const auto& one : alone) {
        const auto way = moving(posed(there[0], one.a.from), posed(there[0], one.a.to), one.a.about);
        const bool rests = std::memcmp(&one.b.from, &one.b.to, sizeof one.b.to) == 0;
        if (rests) {
            list.push_back({way, posed(there[1], one.b.from)});
        } else {
            list.push_back({way, moving(posed(there[1], one.b.from), posed(there[1], one.b.to), one.b.about)});
        }
    }
    const meeting_options options{.tolerance = 1e-3};
    const auto expected = to_host(first_meetings(on, alone, options));
    std::size_t met = 0;
    for (const meeting& m : expected) met += m.a != no_id;
    CAPTURE(team.size(), met);
    CHECK(met > 3);
    CHECK(met < n);
    CHECK(to_host(first_meetings(team, list, options)) == expected);
    CHECK(to_host(any_each(team, list, options)) == to_host(any_each(on, alone, options)));
    CHECK(first_meetings(team, std::vector<moving_pair<index_there>>{}, options).size() == 0);

    std::vector<std::uint32_t> index_of;
    std::vector<rigid<float>> from, to;
    for (std::uint32_t i = 0; i < 20; ++i) {
        draws d(sample_seed, 81, i);
        index_of.push_back(i % 2);
        from.push_back(pose_that_turns<float>(d, 5));
        to.push_back(pose_that_turns<float>(d, 5));
    }
    const auto scene = make_bodies(on, here, index_of, from);
    const auto scene_there = make_bodies(team, there, index_of, from);
    const auto frame = moving(scene, refit(on, scene, to));
    const auto frame_there = moving(scene_there, refit(team, scene_there, to));
    const scene_meeting_options<> of_scene{.tolerance = 1e-3};
    const auto bodies = to_host(first_meetings(on, frame, of_scene));
    CHECK(bodies.size() > 10);
    CHECK(to_host(first_meetings(team, frame_there, of_scene)) == bodies);
    CHECK(to_host(touching_bodies(team, frame_there, of_scene)) == to_host(touching_bodies(on, frame, of_scene)));
    CHECK(to_host(first_meetings(team, scene_there, frame_there, of_scene)) == to_host(first_meetings(on, scene, frame, of_scene)));

    // An entry is named by its number in the whole list.
    const rigid<float> start, half{{-1, 0, 0, 0, -1, 0, 0, 0, 1}, {0, 0, 0}};
    list[17].a = moving(posed(there[0], start), posed(there[0], half));
    const auto says = [](const auto& ask, const std::string& what) {
        try {
            (void)ask();
            FAIL_CHECK("was taken");
        } catch (const error& e) {
            CAPTURE(e.what());
            CHECK(std::string(e.what()).find(what) == 0);
        }
    };
    says([&] { return first_meetings(team, list, options); }, "abut::first_meetings: entry 17 of the list: the first body: a half turn");
    list[17].a = moving(posed(there[0], start), posed(there[0], start));
    list[0].b = posed(make_bvh(other, soup), start);
    says([&] { return any_each(team, list, options); }, "abut::any_each: ");
    says([&] { return touching_bodies(other, frame_there, of_scene); }, "abut::touching_bodies: ");
}

}  // namespace abut::test
