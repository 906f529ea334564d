// SPDX-License-Identifier: MIT
#pragma once

// Convex hulls on several devices, each of which has the set whole: pairs, distances and rays are those of one policy.

#include <vector>

#include <abut/abut.hpp>
#include <abut/devices/distance.hpp>
#include <abut/devices/rows.hpp>

#include "collide/hull_cases.hpp"
#include "devices/device_cases.hpp"
#include "devices/question_cases.hpp"
#include "support/catch.hpp"

namespace abut::test::device_cases {

template <scalar T, class Team>
void check_hulls(const Team& team) {
    uniform random(74);
    const auto a = random_hulls<T>(80, random, true);
    const spheres<T> balls(shape_maker<sphere<T>>(random, true)(60));
    const auto expected = to_host(pairs(serial{}, a, balls));
    CHECK(expected.size() > 50);
    const auto tree = make_bvh(team, a);
    check_pairs(team, replicate(team, a), replicate(team, balls), expected);
    check_pairs(team, tree, make_bvh(team, balls), expected);
    check_pairs(team, tree, make_bvh(team, divide(team, balls)), expected);
    CHECK(to_host(self_pairs(team, tree)) == to_host(self_pairs(serial{}, a)));

    rigid<T> beside = pose_of_hulls<T>();
    beside.translation.x = 9;
    const auto apart = distance(serial{}, posed(a, beside), a);
    CHECK(apart->distance > 0);
    check_same(distance(team, posed(tree, beside), tree), apart);

    const rays<T> lines(some_rays<T>(100, 75));
    CHECK(to_host(raycast(team, tree, lines)) == to_host(raycast(serial{}, make_bvh(serial{}, a), lines)));
}

}  // namespace abut::test::device_cases
