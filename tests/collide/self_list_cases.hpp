// SPDX-License-Identifier: MIT
#pragma once

// What self_pairs(policy, bodies) promises on every policy: of each two bodies what a plain loop over their placed shapes
// says of them, named and sorted.

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "posed_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/touching.hpp"

namespace abut::test {

/// Keeps some pairs, by all four numbers.
struct some_bodies {
    ABUT_HD bool operator()(body_pair p) const { return (p.body_a + 2 * p.body_b + p.a + 3 * p.b) % 5 != 0; }
};

template <scalar T>
std::vector<triangle<T>> triangles_of(const std::vector<vec3<T>>& vertices, const std::vector<face>& faces) {
    std::vector<triangle<T>> all;
    for (const face& f : faces) all.push_back({vertices[f[0]], vertices[f[1]], vertices[f[2]]});
    return all;
}

/// A scene of bodies: sets on the host, the policy's trees over them, and which set each body has.
template <class Policy, class Set>
struct scene_of_bodies {
    using T = typename Set::scalar_type;
    using tree = decltype(make_bvh(std::declval<const Policy&>(), std::declval<const Set&>()));

    std::vector<Set> sets;
    std::vector<tree> trees;
    std::vector<std::size_t> kinds;
    std::vector<posed_object<tree>> bodies;

    scene_of_bodies(const Policy& on, std::vector<Set> of) : sets(std::move(of)) {
        for (const Set& set : sets) trees.push_back(make_bvh(on, set));
    }
    void add(std::size_t kind, const rigid<T>& pose) {
        kinds.push_back(kind);
        bodies.push_back(posed(trees[kind], pose));
    }
    [[nodiscard]] std::vector<body_pair> truth() const {
        std::vector<body_pair> all;
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            for (std::uint32_t j = i + 1; j < bodies.size(); ++j) {
                const auto a = posed(sets[kinds[i]], bodies[i].pose), b = posed(sets[kinds[j]], bodies[j].pose);
                for (const index_pair& p : pairs<exact>(serial{}, a, b)) all.push_back({i, j, p.a, p.b});
            }
        }
        return all;
    }
};

/// Asks in all ways, and on a device in some, since each takes nvcc half a minute. Returns the number of pairs.
template <class Policy, class Set>
std::size_t check_bodies(const Policy& on, const scene_of_bodies<Policy, Set>& scene) {
    const auto& bodies = scene.bodies;
    const std::vector<body_pair> expected = scene.truth();
    CAPTURE(bodies.size(), expected.size());
    CHECK((to_host(self_pairs(on, bodies)) == expected));
    auto unsorted = to_host(self_pairs(on, bodies, {.sorted = false, .most_pairs = 3}));
    std::sort(unsorted.begin(), unsorted.end());
    CHECK((unsorted == expected));
    CHECK(count_self_pairs(on, bodies) == expected.size());
    CHECK(any_self_pairs(on, bodies) == !expected.empty());

    const body_options<some_bodies> with_filter{.filter = {}};
    auto some = expected;
    std::erase_if(some, [](const body_pair& p) { return !some_bodies{}(p); });
    CHECK((to_host(self_pairs(on, bodies, with_filter)) == some));
    if constexpr (host_policy<Policy>) {
        CHECK(count_self_pairs(on, bodies, with_filter) == some.size());
        CHECK(any_self_pairs(on, bodies, with_filter) == !some.empty());
        CHECK((to_host(self_pairs<exact>(on, bodies)) == expected));
    }
    return expected.size();
}

/// Bodies of none to some hundred faces, near each other and far, some in one place.
template <class T, class Policy>
void check_random_bodies(const Policy& on) {
    constexpr std::uint64_t seed = 20270401;
    std::printf("self pairs of bodies: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    std::vector<triangle_soup<T>> sets;
    for (const std::size_t n : {0, 1, 2, 3, 100}) sets.emplace_back(random_triangles<T>(n, random));
    const torus<T> shape(12, 8, T(0.7), T(0.3));
    sets.emplace_back(triangles_of(shape.vertices, shape.faces));
    for (const std::size_t n : {0, 1, 2, 60}) {
        for (const double far : {0.5, 2.0, 1e3}) {
            scene_of_bodies<Policy, triangle_soup<T>> scene(on, sets);
            draws d(seed, 94, n);
            for (std::size_t i = 0; i < n; ++i) {
                const auto pose = i % 2 == 0 ? make_pose<T>(d, far) : make_loose_pose<T>(d, far);
                scene.add(random.below(sets.size()), i % 7 == 6 ? scene.bodies.back().pose : pose);
            }
            CAPTURE(n, far);
            const std::size_t hits = check_bodies(on, scene);
            CHECK((n < 60 || hits > (far < 1 ? 3000u : far < 3 ? 300u : 0u)));
        }
    }
}

/// Cubes of a lattice meet in faces, edges and corners, and in nothing where they are one unit in the last place apart.
template <class T, class Policy>
void check_cube_lattice(const Policy& on) {
    const std::vector<vec3<T>> vertices{{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                        {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
    const std::vector<face> faces{{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                  {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
    draws d(20270402, 95, 0);
    for (const bool apart : {false, true}) {
        scene_of_bodies<Policy, triangle_soup<T>> scene(on, {triangle_soup<T>(triangles_of(vertices, faces))});
        std::size_t neighbours = 0;
        for (int k = 0; k < 27; ++k) {
            rigid<T> pose;
            construction::set_quarter_turns(pose, d);
            const auto along = [&](int step) {
                const T x = static_cast<T>(2 * step);
                return apart && step == 2 ? detail::next_up(x) : x;
            };
            pose.translation = {along(k % 3), along(k / 3 % 3), along(k / 9)};
            scene.add(0, pose);
            const auto near = [&](int j, int by) {
                return std::abs(k / by % 3 - j / by % 3) <= 1 && !(apart && (k / by % 3 == 2) != (j / by % 3 == 2));
            };
            for (int j = 0; j < k; ++j) neighbours += near(j, 1) && near(j, 3) && near(j, 9) ? 1 : 0;
        }
        CAPTURE(apart);
        check_bodies(on, scene);
        std::set<std::pair<std::uint32_t, std::uint32_t>> met;
        for (const body_pair& p : to_host(self_pairs(on, scene.bodies))) met.emplace(p.body_a, p.body_b);
        CHECK(met.size() == neighbours);
        CHECK(neighbours == (apart ? 49u : 158u));
    }
}

/// Two triangles under two poses that meet in a point, or miss it by little, wherever and as large as numbers allow.
template <class T, class Policy>
void check_touching_bodies(const Policy& on) {
    std::vector<triangle_soup<T>> sets;
    std::vector<rigid<T>> poses;
    const auto is_finite = [](const triangle<T>& t) {
        return detail::is_finite(detail::magnitudes(t.a) + detail::magnitudes(t.b) + detail::magnitudes(t.c));
    };
    std::size_t meet = 0;
    for (std::uint64_t i = 0; i < 150; ++i) {
        draws d(20270403, 96, i);
        const auto c = make_posed_contact<T>(d, i % 2 == 1);
        if (!is_finite(place(c.pose_a, c.a)) || !is_finite(place(c.pose_b, c.b))) continue;
        // The one whose box is smaller has the later number every other time.
        const std::vector<triangle<T>> two_a{c.a, c.a}, some_b(i % 3 + 1, c.b);
        sets.emplace_back(i % 2 == 0 ? two_a : some_b);
        sets.emplace_back(i % 2 == 0 ? some_b : two_a);
        poses.push_back(i % 2 == 0 ? c.pose_a : c.pose_b);
        poses.push_back(i % 2 == 0 ? c.pose_b : c.pose_a);
        meet += intersects<exact>(place(c.pose_a, c.a), place(c.pose_b, c.b)) ? 1 : 0;
    }
    CHECK(meet > 40);
    scene_of_bodies<Policy, triangle_soup<T>> scene(on, sets);
    for (std::size_t i = 0; i < sets.size(); ++i) scene.add(i, poses[i]);
    CHECK(check_bodies(on, scene) >= meet);
}

/// Balls that touch in one point, under poses that shrink all but their radii; some bodies are one ball.
template <class T, class Policy>
void check_ball_bodies(const Policy& on) {
    const spheres<T> one({{{0, 0, 0}, 1}}), two({{{0, 0, 0}, 1}, {{0, 0, 0}, T(0.5)}});
    scene_of_bodies<Policy, spheres<T>> scene(on, {one, two, spheres<T>()});
    const T s = T(1) - T(0x1p-12);
    for (int i = 0; i < 12; ++i) {
        scene.add(static_cast<std::size_t>(i % 5 == 4 ? 2 : i % 2),
                  {{s, 0, 0, 0, s, 0, 0, 0, s}, {static_cast<T>(2 * i), 0, 0}});
    }
    CHECK(check_bodies(on, scene) == 7);
}

/// What a call throws has to name the function and the body.
template <class Policy, class Bodies>
void check_refused(const Policy& on, const Bodies& bodies, const std::string& words) {
    const auto check_one = [&](const auto& call, const std::string& name) {
        try {
            call();
            FAIL("not refused: " << words);
        } catch (const invalid_geometry& problem) {
            CAPTURE(problem.what());
            CHECK(std::string(problem.what()).find(name + ": " + words) == 0);
        }
    };
    check_one([&] { (void)self_pairs(on, bodies); }, "abut::self_pairs");
    check_one([&] { (void)count_self_pairs(on, bodies); }, "abut::count_self_pairs");
    check_one([&] { (void)any_self_pairs(on, bodies); }, "abut::any_self_pairs");
}

template <class T, class Policy>
void check_body_errors(const Policy& on) {
    constexpr T far = largest_finite<T> / 2;
    const triangle<T> small{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, large{{0, 0, 0}, {far, 0, 0}, {0, far, 0}};
    const std::vector<triangle<T>> none, one{small}, two{small, large};
    scene_of_bodies<Policy, triangle_soup<T>> scene(on,
                                                    {triangle_soup<T>(none), triangle_soup<T>(one), triangle_soup<T>(two)});
    rigid<T> bent, shifted;
    bent.rotation[0] = T(1.01);
    shifted.translation = {far, 0, 0};
    for (const std::size_t kind : {1, 2, 0}) scene.add(kind, {});
    auto bad = scene;
    bad.add(1, bent);
    check_refused(on, bad.bodies, "body 3: rotation row 0");
    bad.bodies.back() = posed(scene.trees[0], bent);  // also where there is nothing to place
    check_refused(on, bad.bodies, "body 3: rotation row 0");
    rigid<T> farther = shifted;
    farther.translation.x = T(1.5) * far;
    bad.bodies[1] = posed(scene.trees[2], farther);
    check_refused(on, bad.bodies, "body 1: posed shape 1");
    // Huge, and yet finite: their boxes are all of space.
    scene.add(2, {});
    scene.add(1, shifted);
    rigid<T> elsewhere = shifted;
    elsewhere.translation.y = -far;
    scene.add(2, elsewhere);
    scene.add(1, elsewhere);
    CHECK(check_bodies(on, scene) > 5);
}

template <class T, class Policy>
void check_all_bodies(const Policy& on) {
    check_random_bodies<T>(on);
    check_cube_lattice<T>(on);
    check_touching_bodies<T>(on);
    if constexpr (host_policy<Policy>) check_ball_bodies<T>(on);  // for the boxes, which a host makes
    check_body_errors<T>(on);
}

}  // namespace abut::test
