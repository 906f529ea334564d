// SPDX-License-Identifier: MIT
#pragma once

// `distance` and `nearest` of sets, indices and lists of cylinders and cones, on every policy, against plain loops over all
// pairs. That one pair is right is tests/narrow's matter.

#include <cstdint>
#include <utility>
#include <vector>

#include "collide/distance_cases.hpp"
#include "collide/nearest_cases.hpp"

namespace abut::test {

/// Trees and sets of solids and of triangles, both posed, and lists of them; flat solids far away too, whose axes turn where
/// their ends are rounded.
template <class Solid, class Policy>
void check_distance_of_posed_solids(const Policy& on, std::uint64_t seed) {
    using T = scalar_type_of<Solid>;
    CAPTURE(seed);
    uniform random(seed);
    int touching = 0, asked = 0;
    for (const T away : {T(0), T(4096)}) {
        auto solids = shape_maker<Solid>(random, false)(60);
        const vec3<T> by{away, away, -away};
        for (Solid& s : solids) {
            s = place(rigid<T>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, by}, s);
            if (away > 0) s.radius = s.radius * 2;
        }
        const shapes<Solid> set(solids);
        const triangle_soup<T> soup(shape_maker<triangle<T>>(random, false)(50));
        const auto there = copy_to(on, set);
        const auto tree = make_bvh(on, there);
        const auto there_soup = copy_to(on, soup);
        const auto tree_soup = make_bvh(on, there_soup);
        using entry = posed_pair<std::remove_const_t<decltype(tree)>, std::remove_const_t<decltype(tree_soup)>>;
        std::vector<entry> list;
        std::vector<maybe_apart<T>> expected;
        for (const rigid<T>& pose : poses_of_distances<T>()) {
            rigid<T> other{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {T(0.1), T(-0.2), T(0.3)}};
            if (asked % 2 == 0) other.translation = place(pose, by);
            const posed_view<typename shapes<Solid>::view_type> a{set.view(), pose};
            const posed_view<typename triangle_soup<T>::view_type> b{soup.view(), other};
            expected.push_back(distance_by_definition(a, b));
            list.push_back({posed(tree, pose), posed(tree_soup, other)});
            touching += expected.back()->distance == 0;
            ++asked;
            CAPTURE(asked);
            check_same(distance(on, posed(tree, pose), posed(tree_soup, other)), expected.back());
            check_same(distance(on, posed(there, pose), posed(tree_soup, other)), expected.back());
            check_same(distance(on, posed(make_grid(on, there), pose), posed(there_soup, other)), expected.back());
            const auto reversed = distance(on, posed(tree_soup, other), posed(tree, pose));
            REQUIRE(reversed);
            CHECK(reversed->distance == expected.back()->distance);
        }
        const auto found = to_host(distance(on, list));
        REQUIRE(found.size() == list.size());
        for (std::size_t i = 0; i < list.size(); ++i) check_same<T>(found[i], expected[i]);
        const double below = static_cast<double>(expected[1]->distance) / 2 + 1e-3;
        const auto near = to_host(distance(on, list, {.below = below}));
        for (std::size_t i = 0; i < list.size(); ++i) {
            CHECK((near[i].a != no_id) == (static_cast<double>(expected[i]->distance) < below));
        }
    }
    CHECK(touching > 0);
    CHECK(touching < asked);
}

}  // namespace abut::test
