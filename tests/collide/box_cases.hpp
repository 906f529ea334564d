// SPDX-License-Identifier: MIT
#pragma once

// Oriented boxes, posed boxes and half spaces in queries, on every policy. A box of either kind is the hull of its corners:
// so each query has to say, to the bit, what it says of a set of such hulls, of which hull_cases.hpp knows the truth. Half
// spaces are compared with a plain loop over one pair at a time.

#include <cstdint>
#include <cstdio>
#include <vector>

#include <abut/abut.hpp>

#include "collide/contact_cases.hpp"
#include "collide/distance_cases.hpp"
#include "collide/raycast_cases.hpp"
#include "collide/set_cases.hpp"
#include "collide/within_cases.hpp"
#include "support/catch.hpp"
#include "support/oriented_boxes.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// The same as hulls.
template <class Box>
auto as_hulls(const std::vector<Box>& boxes) {
    std::vector<std::vector<vec3<scalar_type_of<Box>>>> lists;
    for (const Box& box : boxes) lists.push_back(corners_of(box));
    return hulls<scalar_type_of<Box>>(lists);
}

template <class T>
std::vector<oriented_box<T>> random_oriented_boxes(std::size_t n, uniform& random, std::uint64_t seed, bool on_lattice) {
    std::vector<oriented_box<T>> all;
    for (std::size_t i = 0; i < n; ++i) all.push_back(random_oriented_box<T>(random, seed, i, on_lattice));
    return all;
}

/// Pairs of boxes `a` and any set `b`, where boxes are as they are or posed.
template <class Policy, class Boxes, class Hulls, class Set>
std::size_t check_boxes_against(const Policy& on, const Boxes& a, const Hulls& same, const Set& b, bool posed_only) {
    using T = scalar_type_of<typename Boxes::shape_type>;
    const auto boxes_there = copy_to(on, a);
    const auto hulls_there = copy_to(on, same);
    const auto b_there = copy_to(on, b);
    const auto tree = make_bvh(on, boxes_there);
    const auto hull_tree = make_bvh(on, hulls_there);
    const auto b_tree = make_bvh(on, b_there);
    std::size_t hits = 0;
    for (std::uint64_t k = 0; k < 3; ++k) {
        draws d(861, 3, k);
        rigid<T> pose = make_pose<T>(d, 0.5);
        if (k == 0) construction::set_quarter_turns(pose, d), pose.translation = {T(0.25), 0, T(-0.5)};
        const auto expected = to_host(pairs(on, posed(hull_tree, pose), b_there));
        hits += expected.size();
        CHECK(to_host(pairs(on, posed(tree, pose), b_there)) == expected);
        CHECK(to_host(pairs(on, posed(boxes_there, pose), b_there)) == expected);
        CHECK(to_host(pairs(on, posed(tree, pose), b_tree)) == expected);
        CHECK(to_host(pairs<exact>(on, posed(tree, pose), b_tree)) == expected);
        CHECK(count(on, posed(tree, pose), b_tree) == expected.size());
        CHECK(any(on, posed(tree, pose), b_tree) == !expected.empty());
    }
    if (posed_only) return hits;
    const auto expected = to_host(pairs(on, hulls_there, b_there));
    CHECK(to_host(pairs(on, tree, b_there)) == expected);
    CHECK(to_host(pairs(on, boxes_there, b_tree)) == expected);
    CHECK(to_host(pairs(on, make_grid(on, boxes_there), b_there)) == expected);
    const auto mirrored = to_host(pairs(on, b_there, tree));
    CHECK(mirrored.size() == expected.size());
    return hits + expected.size();
}

template <class T, class Policy>
void check_sets_of_boxes(const Policy& on) {
    std::printf("sets of oriented boxes: seeds 861 to 863\n");
    uniform random(861);
    for (const bool on_lattice : {false, true}) {
        CAPTURE(on_lattice);
        const auto some = random_oriented_boxes<T>(70, random, 862, on_lattice);
        const oriented_boxes<T> set(some);
        const auto same = as_hulls(some);
        const auto others = random_oriented_boxes<T>(50, random, 863, on_lattice);
        CHECK(check_boxes_against(on, set, same, oriented_boxes<T>(others), false) > 100);
        CHECK(check_boxes_against(on, set, same, triangle_soup<T>(shape_maker<triangle<T>>(random, on_lattice)(60)), false) >
              100);
        CHECK(check_boxes_against(on, set, same, spheres<T>(shape_maker<sphere<T>>(random, on_lattice)(60)), false) > 100);
        CHECK(check_boxes_against(on, set, same, boxes<T>(shape_maker<aabb<T>>(random, on_lattice)(60)), false) > 100);
        const auto along = shape_maker<aabb<T>>(random, on_lattice)(60);
        CHECK(check_boxes_against(on, boxes<T>(along), as_hulls(along), oriented_boxes<T>(others), true) > 50);
        CHECK(check_boxes_against(on, boxes<T>(along), as_hulls(along),
                                  triangle_soup<T>(shape_maker<triangle<T>>(random, on_lattice)(60)), true) > 50);
    }
    const auto none = oriented_boxes<T>();
    CHECK(count(on, copy_to(on, none), copy_to(on, none)) == 0);
}

/// What else there is: within, contacts, distance, nearest and rays, of boxes at rest and under a pose.
template <class T, class Policy>
void check_more_of_boxes(const Policy& on) {
    uniform random(864);
    draws d(864, 3, 1);
    const rigid<T> pose = make_pose<T>(d, 0.5);
    const auto some = random_oriented_boxes<T>(40, random, 864, true);
    const auto along = shape_maker<aabb<T>>(random, true)(40);
    const auto tree = make_bvh(on, copy_to(on, oriented_boxes<T>(some)));
    const auto same = make_bvh(on, copy_to(on, as_hulls(some)));
    const auto along_tree = make_bvh(on, copy_to(on, boxes<T>(along)));
    const auto along_same = make_bvh(on, copy_to(on, as_hulls(along)));
    const auto soup = copy_to(on, triangle_soup<T>(shape_maker<triangle<T>>(random, false)(40)));
    const auto far = copy_to(on, triangle_soup<T>({{{T(7), 0, 0}, {T(8), 1, 0}, {T(7), 1, T(3)}}}));

    CHECK(to_host(self_pairs(on, tree)) == to_host(self_pairs(on, same)));
    CHECK(to_host(self_pairs(on, tree)).size() > 50);
    CHECK(to_host(within(on, posed(tree, pose), soup, 0.25)) == to_host(within(on, posed(same, pose), soup, 0.25)));
    CHECK(to_host(within(on, posed(along_tree, pose), tree, 0.25)) ==
          to_host(within(on, posed(along_same, pose), same, 0.25)));
    CHECK(count_self_within(on, tree, 0.25) == count_self_within(on, same, 0.25));

    const auto how = to_host(contacts(on, tree, soup));
    CHECK(how.size() > 50);
    CHECK(same_bits(how, to_host(contacts(on, same, soup))));
    CHECK(same_bits(to_host(contacts(on, posed(along_tree, pose), tree)),
                    to_host(contacts(on, posed(along_same, pose), same))));
    for (const auto& other : {soup, far}) {
        CHECK(distance(on, posed(tree, pose), other) == distance(on, posed(same, pose), other));
        CHECK(distance(on, posed(along_tree, pose), other) == distance(on, posed(along_same, pose), other));
    }
    CHECK(distance(on, tree, far)->distance > 0);

    std::vector<vec3<T>> asking;
    for (int i = 0; i < 60; ++i) asking.push_back(random.template point<T>(-2, 2));
    const auto at = copy_to(on, points<T>(asking));
    CHECK(to_host(nearest(on, tree, at)) == to_host(nearest(on, same, at)));
    CHECK(to_host(nearest(on, posed(along_tree, pose), at)) == to_host(nearest(on, posed(along_same, pose), at)));

    std::vector<ray<T>> lines;
    for (int i = 0; i < 60; ++i) lines.push_back({random.template point<T>(-3, 3), random.template point<T>(-1, 1)});
    for (std::size_t i = 0; i < 60; ++i) lines.push_back({lines[i].origin, corners_of(some[i % 40])[i % 8] - lines[i].origin});
    const auto rows = copy_to(on, rays<T>(lines));
    CHECK(to_host(raycast(on, tree, rows)) == to_host(raycast(on, same, rows)));
    CHECK(to_host(raycast(on, posed(along_tree, pose), rows)) == to_host(raycast(on, posed(along_same, pose), rows)));
    CHECK(to_host(raycast_any(on, tree, rows)) == to_host(raycast_any(on, same, rows)));
    CHECK(to_host(raycast_all(on, posed(tree, pose), rows)) == to_host(raycast_all(on, posed(same, pose), rows)));
    CHECK(to_host(pairs(on, rows, tree)) == to_host(pairs(on, rows, same)));
}

/// Bodies and lists of boxes, along the axes and oriented.
template <class Box, class Policy>
void check_bodies_of_boxes(const Policy& on, const std::vector<Box>& some) {
    using T = scalar_type_of<Box>;
    const auto tree = make_bvh(on, copy_to(on, shapes<Box>(some)));
    const auto same = make_bvh(on, copy_to(on, as_hulls(some)));
    std::vector<posed_object<std::remove_const_t<decltype(tree)>>> bodies;
    std::vector<posed_object<std::remove_const_t<decltype(same)>>> hull_bodies;
    for (std::uint64_t k = 0; k < 8; ++k) {
        draws d(865, 3, k);
        const rigid<T> pose = make_pose<T>(d, 0.5);
        bodies.push_back(posed(tree, pose));
        hull_bodies.push_back(posed(same, pose));
    }
    const auto scene = make_bodies(on, bodies);
    const auto hull_scene = make_bodies(on, hull_bodies);
    const auto expected = to_host(pairs(on, hull_scene));
    CHECK(expected.size() > 40);
    CHECK(to_host(pairs(on, scene)) == expected);
    CHECK(count(on, scene) == expected.size());
    CHECK(to_host(within(on, scene, 0.25)) == to_host(within(on, hull_scene, 0.25)));
    CHECK(to_host(contacts(on, scene)) == to_host(contacts(on, hull_scene)));
    std::vector<posed_pair<std::remove_const_t<decltype(tree)>>> list;
    std::vector<posed_pair<std::remove_const_t<decltype(same)>>> hull_list;
    for (std::size_t k = 0; k + 1 < bodies.size(); ++k) {
        list.push_back({bodies[k], bodies[k + 1]});
        hull_list.push_back({hull_bodies[k], hull_bodies[k + 1]});
    }
    CHECK(to_host(pairs(on, list)) == to_host(pairs(on, hull_list)));
    CHECK(to_host(distance(on, list)) == to_host(distance(on, hull_list)));
}

template <class T, class Policy>
void check_scenes_of_boxes(const Policy& on) {
    uniform random(865);
    check_bodies_of_boxes(on, random_oriented_boxes<T>(12, random, 865, false));
    check_bodies_of_boxes(on, shape_maker<aabb<T>>(random, true)(12));
}

/// One half space against a set, by a plain loop; a tree of the set, posed or not.
template <class T, class Policy, class Set>
void check_half_space_and(const Policy& on, const Set& set) {
    const half_space<T> floors[] = {{{0, 0, 1}, T(-0.25)}, {{T(-1), T(2), T(2)}, T(-1)}, {{0, 0, T(-1)}, T(-40)}};
    const auto there = copy_to(on, set);
    const auto tree = make_bvh(on, there);
    draws d(866, 3, 1);
    const rigid<T> pose = make_pose<T>(d, 0.5);
    std::size_t hits = 0;
    for (const half_space<T>& s : floors) {
        const shapes<half_space<T>> alone(std::vector<half_space<T>>{s});
        const auto expected = all_that_touch(alone.view(), set.view());
        hits += expected.size();
        CHECK(to_host(pairs(on, s, there)) == expected);
        CHECK(to_host(pairs(on, s, tree)) == expected);
        CHECK(to_host(pairs(on, copy_to(on, alone), tree)) == expected);
        CHECK(count(on, tree, s) == expected.size());
        CHECK(any(on, tree, s) == !expected.empty());
        const posed_view<typename Set::view_type> placed{set.view(), pose};
        CHECK(count(on, posed(tree, pose), s) == all_that_touch(placed, alone.view()).size());
        const single_view<half_space<T>> moved{place(pose, s)};
        CHECK(to_host(pairs(on, posed(s, pose), tree)) == all_that_touch(moved, set.view()));
        CHECK(to_host(within(on, tree, s, 0.25)) == within_by_definition(set.view(), alone.view(), 0.25));
        CHECK(same_bits(to_host(contacts(on, tree, s)), true_contacts(set.view(), alone.view())));
        check_same(distance(on, tree, s), distance_by_definition(set.view(), alone.view()));
    }
    CHECK(hits > 10);
    CHECK(hits < 2 * set.size());
}

template <class T, class Policy>
void check_half_spaces(const Policy& on) {
    uniform random(866);
    check_half_space_and<T>(on, oriented_boxes<T>(random_oriented_boxes<T>(60, random, 866, true)));
    check_half_space_and<T>(on, triangle_soup<T>(shape_maker<triangle<T>>(random, true)(60)));
    check_half_space_and<T>(on, spheres<T>(shape_maker<sphere<T>>(random, true)(60)));
    check_half_space_and<T>(on, capsules<T>(shape_maker<capsule<T>>(random, false)(60)));
    check_half_space_and<T>(on, boxes<T>(shape_maker<aabb<T>>(random, true)(60)));
    check_half_space_and<T>(on, cylinders<T>(shape_maker<cylinder<T>>(random, false)(60)));
    check_half_space_and<T>(on, cones<T>(shape_maker<cone<T>>(random, true)(60)));
}

}  // namespace abut::test
