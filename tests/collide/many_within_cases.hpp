// SPDX-License-Identifier: MIT
#pragma once

// What `within` promises of lists of posed pairs and of scenes of many bodies, on every policy: of each entry, and of each
// two bodies, what a plain loop over their placed shapes says, tagged and sorted. The loop is that of within_cases.hpp.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "collide/body_cases.hpp"
#include "collide/hull_cases.hpp"
#include "collide/set_cases.hpp"
#include "collide/within_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// Pairs of posed sets, with the policy's trees over them.
template <class Policy, class SetA, class SetB = SetA>
struct list_of_sets {
    using T = typename SetA::scalar_type;
    using tree_a = decltype(make_bvh(std::declval<const Policy&>(), std::declval<const SetA&>()));
    using tree_b = decltype(make_bvh(std::declval<const Policy&>(), std::declval<const SetB&>()));

    std::vector<SetA> sets_a;
    std::vector<SetB> sets_b;
    std::vector<tree_a> trees_a;
    std::vector<tree_b> trees_b;
    std::vector<std::pair<std::size_t, std::size_t>> kinds;
    std::vector<posed_pair<tree_a, tree_b>> entries;

    list_of_sets(const Policy& on, std::vector<SetA> of_a, std::vector<SetB> of_b)
        : sets_a(std::move(of_a)), sets_b(std::move(of_b)) {
        for (const SetA& set : sets_a) trees_a.push_back(make_bvh(on, copy_to(on, set)));
        for (const SetB& set : sets_b) trees_b.push_back(make_bvh(on, copy_to(on, set)));
    }
    void add(std::size_t kind_a, const rigid<T>& pose_a, std::size_t kind_b, const rigid<T>& pose_b) {
        kinds.emplace_back(kind_a, kind_b);
        entries.push_back({posed(trees_a[kind_a], pose_a), posed(trees_b[kind_b], pose_b)});
    }
    [[nodiscard]] std::vector<tagged_pair> within(double distance) const {
        std::vector<tagged_pair> all;
        for (std::uint32_t i = 0; i < entries.size(); ++i) {
            const auto [kind_a, kind_b] = kinds[i];
            const posed_view<typename SetA::view_type> a{sets_a[kind_a].view(), entries[i].a.pose};
            const posed_view<typename SetB::view_type> b{sets_b[kind_b].view(), entries[i].b.pose};
            for (const index_pair& p : within_by_definition(a, b, distance)) all.push_back({i, p.a, p.b});
        }
        return all;
    }
};

template <class Policy, class Set>
std::vector<body_pair> bodies_within(const scene_of_bodies<Policy, Set>& scene, double distance) {
    using view = posed_view<typename Set::view_type>;
    std::vector<body_pair> all;
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
        for (std::uint32_t j = i + 1; j < scene.bodies.size(); ++j) {
            const view a{scene.sets[scene.kinds[i]].view(), scene.bodies[i].pose};
            const view b{scene.sets[scene.kinds[j]].view(), scene.bodies[j].pose};
            for (const index_pair& p : within_by_definition(a, b, distance)) all.push_back({i, j, p.a, p.b});
        }
    }
    return all;
}

/// Sums up what it is shown, by all numbers.
struct sum_of_named {
    std::uint64_t* sum;
    ABUT_HD static std::uint64_t of(const tagged_pair& p) { return (p.pair * std::uint64_t{1009} + p.a) * 10007 + p.b + 1; }
    ABUT_HD static std::uint64_t of(const body_pair& p) { return sum_of_bodies::of(p); }
    template <class Pair>
    ABUT_HD visit operator()(const Pair& p) const {
        execution::atomic_add(sum, of(p));
        return visit::proceed;
    }
};

/// Keeps some pairs of a list, or of bodies.
struct ids_of_odd_sum {
    template <class Pair>
    ABUT_HD bool operator()(const Pair& p) const {
        return (p.a + p.b) % 2 == 1;
    }
};

/// Asks in all ways; `Options` are list_options or body_options. On a device in few, since each takes nvcc half a minute.
template <template <class, schedule> class Options, class Policy, class Many, class Pair>
void check_many_within(const Policy& on, const Many& many, double distance, const std::vector<Pair>& expected) {
    CAPTURE(distance, expected.size());
    CHECK((to_host(within(on, many, distance)) == expected));
    CHECK(any_within(on, many, distance) == !expected.empty());
    std::uint64_t sum = 0, expected_sum = 0;
    execution::buffer_of<Policy, std::uint64_t> there(on, 1);
    fill(on, there.data(), 1, std::uint64_t{0});
    for_each_within(on, many, distance, sum_of_named{there.data()});
    download(on, there.data(), 1, &sum);
    for (const Pair& p : expected) expected_sum += sum_of_named::of(p);
    CHECK(sum == expected_sum);
    if constexpr (host_policy<Policy>) {
        CHECK(count_within(on, many, distance) == expected.size());
        CHECK((to_host(within<exact>(on, many, distance)) == expected));
        auto unsorted = to_host(within(on, many, distance, {.sorted = false, .most_pairs = 3}));
        std::sort(unsorted.begin(), unsorted.end());
        CHECK((unsorted == expected));
        const Options<ids_of_odd_sum, schedule::shared_list> with_filter{.filter = {}};
        auto some = expected;
        std::erase_if(some, [](const Pair& p) { return !ids_of_odd_sum{}(p); });
        CHECK((to_host(within(on, many, distance, with_filter)) == some));
        CHECK(count_within(on, many, distance, with_filter) == some.size());
        CHECK(any_within(on, many, distance, with_filter) == !some.empty());
    }
}

/// Sets of none to some dozen triangles.
template <class T>
std::vector<triangle_soup<T>> sets_of_triangles(uniform& random) {
    std::vector<triangle_soup<T>> sets;
    for (const std::size_t n : {0u, 1u, 2u, 3u, 14u}) sets.emplace_back(random_triangles<T>(n, random));
    const torus<T> shape(5, 4, T(0.7), T(0.3));
    sets.emplace_back(triangles_of(shape.vertices, shape.faces));
    return sets;
}

/// Entries of all kinds with all kinds, near each other and far.
template <class T, class Policy>
void check_lists_within(const Policy& on) {
    constexpr std::uint64_t seed = 20270501;
    std::printf("within, lists and bodies: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    const auto sets = sets_of_triangles<T>(random);
    const std::size_t most = sets.size() * sets.size();
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, most, 2 * most}) {
        list_of_sets<Policy, triangle_soup<T>> list(on, sets, sets);
        draws d(seed, 100, n);
        for (std::size_t i = 0; i < n; ++i) {
            const auto pose_a = make_pose<T>(d, i < most ? 0.25 : 1), pose_b = make_loose_pose<T>(d, i < most ? 0.25 : 1);
            list.add(i % sets.size(), pose_a, i / sets.size() % sets.size(), pose_b);
        }
        std::size_t fewer = 20;
        for (const double distance : {0.0, 0.1, 0.75, 1e9}) {
            CAPTURE(n);
            const auto expected = list.within(distance);
            check_many_within<list_options>(on, list.entries, distance, expected);
            if (n < most) continue;
            CHECK(expected.size() > fewer);
            fewer = expected.size();
        }
        CHECK((to_host(within(on, list.entries, 0)) == to_host(pairs(on, list.entries))));
    }
}

/// Lists of cylinders or cones and what they go with.
template <class Solid, class Other, class Policy>
void check_lists_of_solids_within(const Policy& on) {
    using T = scalar_type_of<Solid>;
    constexpr std::uint64_t seed = 20270506;
    uniform random(seed);
    std::vector<shapes<Solid>> solids;
    std::vector<shapes<Other>> others;
    for (const std::size_t n : {0u, 1u, 5u, 30u}) {
        solids.emplace_back(shape_maker<Solid>(random, true)(n));
        others.emplace_back(shape_maker<Other>(random, true)(n));
    }
    list_of_sets<Policy, shapes<Solid>, shapes<Other>> list(on, solids, others);
    draws d(seed, 105, 0);
    list.add(3, {}, 3, {});
    for (std::size_t i = 0; i < 32; ++i) {
        const auto pose_a = make_pose<T>(d, 0.5), pose_b = make_loose_pose<T>(d, 0.5);
        list.add(i % 4, pose_a, i / 4 % 4, pose_b);
    }
    for (const double distance : {0.0, 0.25}) {
        CAPTURE(distance);
        const auto expected = list.within(distance);
        CHECK(expected.size() > (distance > 0 ? 40 : 5));
        CHECK((to_host(within(on, list.entries, distance)) == expected));
        CHECK(count_within(on, list.entries, distance) == expected.size());
        CHECK(any_within(on, list.entries, distance));
    }
}

/// Two clouds, far apart and exactly as far as is asked, under poses as loose as are accepted. Nothing but slacks keeps
/// their boxes, which are small, and nothing but a distance lets those of bodies meet.
template <class T, class Policy>
void check_far_clouds_within(const Policy& on) {
    constexpr std::uint64_t seed = 20270502;
    uniform random(seed);
    std::vector<points<T>> sets;
    for (const std::size_t n : {1u, 2u, 5u}) {
        std::vector<vec3<T>> some;
        for (std::size_t i = 0; i < n; ++i) some.push_back(random.template point<T>(-1e-3, 1e-3));
        sets.emplace_back(some);
    }
    for (std::uint64_t k = 0; k < 270; ++k) {
        draws d(seed, 101, k);
        const std::size_t kind_a = k / 2 % 3, kind_b = k / 6 % 3;
        const auto pose_a = make_loose_pose<T>(d, 1);
        auto pose_b = make_loose_pose<T>(d, 1e4);
        // Along an axis of a's boxes, whose length may be more than 1.
        const vec3<T> axis = detail::column(pose_a.rotation, k % 3 == 0 ? 0 : 2);
        if (k % 2 == 0) pose_b.translation = pose_a.translation + T(100) * axis;
        list_of_sets<Policy, points<T>> list(on, sets, sets);
        list.add(kind_a, pose_a, kind_b, pose_b);
        list.add(kind_b, pose_b, kind_a, pose_a);
        scene_of_bodies<Policy, points<T>> scene(on, sets);
        scene.add(kind_a, pose_a);
        scene.add(kind_b, pose_b);
        const posed_view<points_view<T>> a{sets[kind_a].view(), pose_a}, b{sets[kind_b].view(), pose_b};
        double distance = std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < a.size(); ++i) {
            for (std::size_t j = 0; j < b.size(); ++j) distance = std::min(distance, least_distance(a[i], b[j]));
        }
        CAPTURE(k, distance);
        const auto expected = list.within(distance);
        CHECK(expected.size() >= 2);
        CHECK((to_host(within(on, list.entries, distance)) == expected));
        CHECK((to_host(within(on, scene.bodies, distance)) == bodies_within(scene, distance)));
        const double nearer = std::nextafter(distance, 0);
        CHECK(within(on, list.entries, nearer).empty());
        CHECK(within(on, scene.bodies, nearer).empty());
        // And with some more of the points.
        const double farther = distance * (1 + 1e-5 * d.uniform(0, 1));
        CHECK((to_host(within(on, list.entries, farther)) == list.within(farther)));
    }
}

/// Bodies of all kinds, by their list and as `bodies`, before and after they move.
template <class T, class Policy>
void check_bodies_within(const Policy& on) {
    constexpr std::uint64_t seed = 20270503;
    uniform random(seed);
    const auto sets = sets_of_triangles<T>(random);
    for (const std::size_t n : {0u, 1u, 2u, 18u}) {
        CAPTURE(n);
        scene_of_bodies<Policy, triangle_soup<T>> scene(on, sets);
        draws d(seed, 102, n);
        for (std::size_t i = 0; i < n; ++i) {
            scene.add(i % sets.size(), i % 2 == 0 ? make_pose<T>(d, 0.8) : make_loose_pose<T>(d, 0.8));
        }
        std::size_t fewer = 20;
        for (const double distance : {0.0, 0.1, 0.5, 1e9}) {
            const auto expected = bodies_within(scene, distance);
            check_many_within<body_options>(on, scene.bodies, distance, expected);
            if (n < 18) continue;
            CHECK(expected.size() > fewer);
            fewer = expected.size();
        }
        const auto all = make_bodies(on, scene.bodies);
        CHECK((to_host(within(on, all, 0)) == to_host(pairs(on, all))));
        auto poses = scene.poses();
        for (auto& pose : poses) pose.translation = T(0.75) * pose.translation;
        scene.move_to(poses);
        const auto moved = bodies_within(scene, 0.1);
        CHECK((n < 18 || moved.size() > 100));
        CHECK((to_host(within(on, refit(on, all, poses), 0.1)) == moved));
    }
}

/// Points of a lattice, each a body: how many pairs are no farther apart than what is known by counting.
template <class T, class Policy>
void check_lattice_of_bodies_within(const Policy& on) {
    // Two points in one place have nodes, and one has none.
    scene_of_bodies<Policy, points<T>> scene(
        on, {points<T>({{0, 0, 0}}), points<T>(std::vector<vec3<T>>{{0, 0, 0}, {0, 0, 0}})});
    for (const std::size_t kind : {0u, 1u}) {
        scene.kinds.clear();
        scene.bodies.clear();
        for (int k = 0; k < 27; ++k) {
            rigid<T> pose;
            pose.translation = {static_cast<T>(k % 3), static_cast<T>(k / 3 % 3), static_cast<T>(k / 9)};
            scene.add(kind, pose);
        }
        const std::size_t each = kind == 0 ? 1 : 4;
        const auto found = [&](double distance) { return within(on, scene.bodies, distance).size(); };
        CHECK(found(std::nextafter(1, 0)) == 0);
        CHECK(found(1) == 54 * each);
        CHECK(found(std::nextafter(2, 0)) == (54 + 72 + 32) * each);  // 1 apart, sqrt 2, and sqrt 3
        CHECK(found(2) == (54 + 72 + 32 + 27) * each);
        CHECK(found(4) == 351 * each);
    }
}

/// Entries of two kinds: hulls and balls.
template <class T, class Policy>
void check_hull_lists_within(const Policy& on) {
    constexpr std::uint64_t seed = 20270504;
    uniform random(seed);
    list_of_sets<Policy, hulls<T>, spheres<T>> list(
        on, {random_hulls<T>(12, random, true), random_hulls<T>(1, random, false), hulls<T>()},
        {spheres<T>(shape_maker<sphere<T>>(random, true)(20)), spheres<T>(shape_maker<sphere<T>>(random, false)(1))});
    for (std::size_t i = 0; i < 24; ++i) {
        draws d(seed, 103, i);
        const auto pose = i % 4 == 0 ? rigid<T>{} : make_loose_pose<T>(d, 1.5);
        list.add(i % 3, pose, i / 3 % 2, make_pose<T>(d, 1.5));
    }
    std::size_t fewer = 20;
    for (const double distance : {0.0, 0.25, 1.0, 1e9}) {
        const auto expected = list.within(distance);
        CAPTURE(distance);
        CHECK(expected.size() > fewer);
        fewer = expected.size();
        CHECK((to_host(within(on, list.entries, distance)) == expected));
    }
}

/// What is refused, in the name of which function.
template <class T, class Policy>
void check_refused_many_within(const Policy& on) {
    const triangle_soup<T> one(std::vector<triangle<T>>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    list_of_sets<Policy, triangle_soup<T>> list(on, {one}, {one});
    scene_of_bodies<Policy, triangle_soup<T>> scene(on, {one});
    const auto refusals = [&](double distance, const std::string& of_list, const std::string& of_bodies) {
        std::uint64_t* const none = nullptr;
        const auto check_one = [](const std::string& said, const std::string& function, const std::string& words) {
            CHECK(said.rfind(function + words, 0) == 0);
        };
        const auto check_all = [&](const auto& many, const std::string& words) {
            check_one(refusal_of([&] { (void)within(on, many, distance); }), "abut::within: ", words);
            check_one(refusal_of([&] { (void)any_within(on, many, distance); }), "abut::any_within: ", words);
            check_one(refusal_of([&] { for_each_within(on, many, distance, sum_of_named{none}); }),
                      "abut::for_each_within: ", words);
            if constexpr (host_policy<Policy>) {
                check_one(refusal_of([&] { (void)count_within(on, many, distance); }), "abut::count_within: ", words);
            }
        };
        check_all(list.entries, of_list);
        check_all(scene.bodies, of_bodies);
    };
    for (int k = 0; k < 2; ++k) {  // also where nobody would look at the distance
        for (const double distance :
             {-1.0, -0x1p-1074, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
            refusals(distance, "distance is ", "distance is ");
        }
        list.add(0, {}, 0, {});
        scene.add(0, {});
        scene.add(0, {});
    }
    rigid<T> bent;
    bent.rotation[0] = T(1.01);
    list.add(0, {}, 0, bent);
    scene.add(0, bent);
    refusals(1, "entry 2 of the list: rotation row 0", "body 4: rotation row 0");
}

template <class T, class Policy>
void check_all_many_within(const Policy& on) {
    check_lists_within<T>(on);
    check_far_clouds_within<T>(on);
    check_bodies_within<T>(on);
    check_lattice_of_bodies_within<T>(on);
    check_hull_lists_within<T>(on);
    check_refused_many_within<T>(on);
}

}  // namespace abut::test
