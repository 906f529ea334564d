// SPDX-License-Identifier: MIT
#pragma once

// Sets of convex hulls in queries, on every policy: the same with each index and under poses, against a plain loop over
// `intersects<exact>` of hulls in host memory, whose own truth is tests/predicate.

#include <cstdint>
#include <cstdio>
#include <type_traits>
#include <vector>

#include <abut/abut.hpp>

#include "collide/body_cases.hpp"
#include "collide/contact_cases.hpp"
#include "collide/distance_cases.hpp"
#include "collide/nearest_cases.hpp"
#include "collide/raycast_cases.hpp"
#include "collide/set_cases.hpp"
#include "collide/within_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// Hulls of one to twelve points in a box of side 2; on a lattice, many touch exactly.
template <class T>
hulls<T> random_hulls(std::size_t n, uniform& random, bool on_lattice) {
    const shape_maker<triangle<T>> make(random, on_lattice);
    std::vector<vec3<T>> points;
    std::vector<std::uint32_t> offsets(1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> center = make(1)[0].a;
        const auto count = static_cast<std::size_t>(random(1, 12.99));
        for (std::size_t k = 0; k < count; ++k) {
            const triangle<T> t = make(1)[0];
            points.push_back(center + (t.b - t.a));
        }
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    return {points, offsets};
}

template <class T>
rigid<T> pose_of_hulls() {
    rigid<T> pose;
    pose.rotation[0] = pose.rotation[4] = T(0.8);
    pose.rotation[1] = T(-0.6), pose.rotation[3] = T(0.6);
    pose.translation = {T(0.5), T(-0.25), T(0.125)};
    return pose;
}

/// By brute force, indexed on one side and on both, posed, and in the calls that store less.
template <class Policy, class T, class Set>
std::size_t check_hulls_against(const Policy& on, const hulls<T>& a, const Set& b, const rigid<T>& pose) {
    const auto expected = all_that_touch(a.view(), b.view());
    const auto there_a = copy_to(on, a);
    const auto there_b = copy_to(on, b);
    const auto tree = make_bvh(on, there_a);
    CHECK(to_host(pairs(on, there_a, there_b)) == expected);
    CHECK(to_host(pairs(on, tree, there_b)) == expected);
    CHECK(to_host(pairs(on, tree, make_bvh(on, there_b))) == expected);
    CHECK(to_host(pairs<exact>(on, make_grid(on, there_a), there_b)) == expected);
    CHECK(count(on, there_a, make_bvh(on, there_b)) == expected.size());
    CHECK(any(on, tree, there_b) == !expected.empty());
    const auto placed = all_that_touch(posed_view<decltype(a.view())>{a.view(), pose}, b.view());
    CHECK(to_host(pairs(on, posed(tree, pose), there_b)) == placed);
    CHECK(to_host(pairs(on, posed(tree, pose), make_bvh(on, there_b))) == placed);
    CHECK(to_host(pairs(on, posed(there_a, pose), there_b)) == placed);
    return expected.size() + placed.size();
}

/// Distances as by definition, of sets that touch and of ones that do not.
template <class Policy, class T, class Set>
void check_distances_of_hulls(const Policy& on, const hulls<T>& a, const Set& b) {
    const auto there_b = copy_to(on, b);
    const auto tree_a = make_bvh(on, copy_to(on, a));
    for (const T beside : {T(0), T(3.25), T(400)}) {
        rigid<T> pose;
        pose.translation = {beside, T(0.5), T(0)};
        const auto expected = distance_by_definition(posed_view<decltype(a.view())>{a.view(), pose}, b.view());
        CHECK((expected->distance == 0) == (beside == 0));
        check_same(distance(on, posed(tree_a, pose), make_bvh(on, there_b)), expected);
        check_same(distance(on, posed(tree_a, pose), there_b), expected);
    }
}

/// Within a distance: indexed or not, posed, and among themselves.
template <class Policy, class T, class Set>
void check_hulls_within(const Policy& on, const hulls<T>& a, const Set& b, const rigid<T>& pose) {
    std::size_t hits = 0;
    for (const double distance : {0.0, 0.25, 1.5}) hits += check_within(on, a, b, distance);
    CHECK(hits > 100);
    const auto there_b = copy_to(on, b);
    const auto tree = make_bvh(on, copy_to(on, a));
    const auto placed = within_by_definition(posed_view<decltype(a.view())>{a.view(), pose}, b.view(), 0.375);
    CHECK(to_host(within(on, posed(tree, pose), there_b, 0.375)) == placed);
    CHECK(to_host(within(on, posed(tree, pose), make_bvh(on, there_b), 0.375)) == placed);
}

/// Rays at corners and beside them, and segments, some of which end before; a tree, posed or not.
template <class Policy, class T>
void check_rays_at_hulls(const Policy& on, const hulls<T>& a, uniform& random, const rigid<T>& pose) {
    std::vector<ray<T>> lines;
    for (std::size_t i = 0; i < 80; ++i) {
        const vec3<T> origin = random.template point<T>(-3, 3),
                      corner = a.view().points[random.below(a.view().points.count)];
        lines.push_back({origin, i % 3 == 0 ? random.template point<T>(-1, 1) : corner - origin});
        if (i % 5 == 0) lines.back().direction.x = 0;
    }
    const auto tree = make_bvh(on, copy_to(on, a));
    check_hits(on, tree, lines, hits_by_definition(a.view(), lines));
    check_all_hits(on, tree, a.view(), lines);
    const posed_view<typename hulls<T>::view_type> placed{a.view(), pose};
    const auto parts = as_segments(lines);
    check_hits(on, posed(tree, pose), parts, hits_by_definition(placed, parts));
    CHECK(to_host(pairs(on, copy_to(on, rays<T>(lines)), tree)) == all_that_touch(rays<T>(lines).view(), a.view()));
}

template <class T, class Policy>
void check_hulls(const Policy& on) {
    constexpr std::uint64_t seed = 71;
    std::printf("sets of hulls: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    const rigid<T> pose = pose_of_hulls<T>();
    for (const bool on_lattice : {false, true}) {
        CAPTURE(on_lattice);
        const auto a = random_hulls<T>(130, random, on_lattice), b = random_hulls<T>(90, random, on_lattice);
        const std::size_t hits = check_hulls_against(on, a, b, pose);
        CHECK(hits > 200);
        CHECK(hits < 130 * 90);
        const triangle_soup<T> soup(shape_maker<triangle<T>>(random, on_lattice)(90));
        CHECK(check_hulls_against(on, a, soup, pose) > 200);
    }
    const auto a = random_hulls<T>(60, random, true);
    CHECK(check_hulls_against(on, a, spheres<T>(shape_maker<sphere<T>>(random, true)(60)), pose) > 100);
    CHECK(count(on, copy_to(on, a), plane<T>{{0, 0, 1}, 0}) > 20);
    check_distances_of_hulls(on, a, random_hulls<T>(50, random, false));
    check_distances_of_hulls(on, a, triangle_soup<T>(shape_maker<triangle<T>>(random, true)(50)));
    const auto none = hulls<T>();
    check_hulls_against(on, none, random_hulls<T>(3, random, false), pose);
}

/// What else there is of hulls: contacts, distances to compare with, nearest points and rays.
template <class T, class Policy>
void check_more_of_hulls(const Policy& on) {
    uniform random(72);
    const rigid<T> pose = pose_of_hulls<T>();
    const auto few = random_hulls<T>(40, random, true);
    const rigid<T> here;
    CHECK(check_contacts(on, few, here, random_hulls<T>(40, random, true), pose) > 50);
    const auto tree = make_bvh(on, copy_to(on, few));
    const spheres<T> balls(shape_maker<sphere<T>>(random, false)(30));
    const auto with_balls = true_contacts(few.view(), balls.view());
    CHECK(with_balls.size() > 50);
    CHECK(same_bits(to_host(contacts(on, tree, copy_to(on, balls))), with_balls));
    check_hulls_within(on, few, random_hulls<T>(30, random, true), pose);
    const boxes<T> some(shape_maker<aabb<T>>(random, true)(30));
    CHECK(to_host(within(on, tree, copy_to(on, some), 0.25)) == within_by_definition(few.view(), some.view(), 0.25));
    CHECK(to_host(self_within(on, tree, 0.5)) == within_by_definition(few.view(), few.view(), 0.5, true));
    std::vector<vec3<T>> asking;
    for (int i = 0; i < 60; ++i) asking.push_back(random.template point<T>(-2, 2));
    check_nearest(on, few, asking);
    check_nearest_posed(on, few, asking, pose);
    check_rays_at_hulls(on, few, random, pose);
    CHECK(any_within(on, copy_to(on, few), plane<T>{{0, 0, 1}, 9}, 9));
    const plane<T> above{{1, 2, 2}, 40};
    const shapes<plane<T>> planes(std::vector<plane<T>>{above});
    check_same(distance(on, tree, above), distance_by_definition(few.view(), planes.view()));
}

/// Cylinders and cones beside hulls.
template <class Solid, class Policy>
void check_hulls_and_solids(const Policy& on) {
    using T = scalar_type_of<Solid>;
    uniform random(74);
    for (const bool on_lattice : {false, true}) {
        CAPTURE(on_lattice);
        const auto a = random_hulls<T>(70, random, on_lattice);
        const shapes<Solid> solids(shape_maker<Solid>(random, on_lattice)(60));
        const std::size_t hits = check_hulls_against(on, a, solids, pose_of_hulls<T>());
        CHECK(hits > 100);
        CHECK(hits < 2 * 70 * 60);
        if (on_lattice) check_distances_of_hulls(on, a, solids);
        if constexpr (std::is_same_v<T, float>) {  // of doubles they take minutes to compile for devices
            const auto expected = true_contacts(solids.view(), a.view());
            CHECK(same_bits(to_host(contacts(on, copy_to(on, solids), make_bvh(on, copy_to(on, a)))), expected));
        }
    }
}

/// Bodies of hulls; and a list whose entries have hulls and spheres.
template <class T, class Policy>
void check_scenes_of_hulls(const Policy& on) {
    uniform random(73);
    const auto some = random_hulls<T>(25, random, true);
    scene_of_bodies<Policy, hulls<T>> scene(on,
                                            {some, random_hulls<T>(1, random, false), random_hulls<T>(12, random, true)});
    const spheres<T> balls(shape_maker<sphere<T>>(random, true)(40));
    const auto tree = make_bvh(on, some);
    const auto ball_tree = make_bvh(on, balls);
    std::vector<posed_pair<std::remove_const_t<decltype(tree)>, std::remove_const_t<decltype(ball_tree)>>> list;
    std::vector<tagged_pair> expected;
    for (std::uint32_t i = 0; i < 12; ++i) {
        draws d(73, 96, i);
        const auto pose = make_pose<T>(d, 1);
        scene.add(i % 3, pose);
        list.push_back({posed(tree, pose), posed(ball_tree, rigid<T>{})});
        const posed_view<typename hulls<T>::view_type> placed{some.view(), pose};
        for (const index_pair& p : all_that_touch(placed, balls.view())) expected.push_back({i, p.a, p.b});
    }
    CHECK(check_bodies(on, scene) > 100);
    CHECK(expected.size() > 100);
    CHECK((to_host(pairs(on, list)) == expected));
}

}  // namespace abut::test
