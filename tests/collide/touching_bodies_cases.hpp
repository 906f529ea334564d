// SPDX-License-Identifier: MIT
#pragma once

// What is asked of bodies as wholes, on every policy: which of them touch or are near, with a filter of bodies, and two
// scenes of different kinds of shapes with each other, against plain loops over the placed shapes.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

/// A matrix of allowed collisions: bodies that are neighbours in a chain may touch.
struct not_neighbours {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return a + 1 != b; }
};
/// Keeps some pairs of shapes.
struct even_shapes {
    ABUT_HD bool operator()(const body_pair& p) const { return (p.a + p.b) % 2 == 0; }
};

/// A scene of one kind of shapes: sets on the host, trees of the policy over them.
template <class Policy, class Set>
struct scene_of_kind {
    using T = typename Set::scalar_type;
    using tree = decltype(make_bvh(std::declval<const Policy&>(), std::declval<const Set&>()));
    std::vector<Set> sets;
    std::vector<tree> trees;
    std::vector<std::uint32_t> kinds;
    std::vector<rigid<T>> poses;

    scene_of_kind(const Policy& on, std::vector<Set> of) : sets(std::move(of)) {
        for (const Set& set : sets) trees.push_back(make_bvh(on, set));
    }
    void add(std::uint32_t kind, const rigid<T>& pose) {
        kinds.push_back(kind);
        poses.push_back(pose);
    }
    [[nodiscard]] auto at(std::size_t i) const { return posed(sets[kinds[i]], poses[i]); }
    [[nodiscard]] auto made(const Policy& on) const { return make_bodies(on, trees, kinds, poses); }
};

/// All pairs of shapes of bodies i of a and j of b, that `find(shapes of i, shapes of j)` names.
template <class A, class B, class Find>
std::vector<body_pair> pairs_of(const A& a, const B& b, bool itself, const Find& find) {
    std::vector<body_pair> all;
    for (std::uint32_t i = 0; i < a.poses.size(); ++i) {
        for (std::uint32_t j = itself ? i + 1 : 0; j < b.poses.size(); ++j) {
            for (const index_pair& p : find(a.at(i), b.at(j))) all.push_back({i, j, p.a, p.b});
        }
    }
    return all;
}
inline std::vector<index_pair> bodies_in(const std::vector<body_pair>& all) {
    std::vector<index_pair> two;
    for (const body_pair& p : all) {
        if (two.empty() || two.back() != index_pair{p.body_a, p.body_b}) two.push_back({p.body_a, p.body_b});
    }
    return two;
}

/// All that is asked of a scene, or of two, whose pairs and near pairs are known.
template <class Policy, class Scene>
void check_scene(const Policy& on, const Scene& scene, const std::vector<body_pair>& touching,
                 const std::vector<body_pair>& near, double distance) {
    CHECK((to_host(pairs(on, scene)) == touching));
    CHECK((to_host(touching_bodies(on, scene)) == bodies_in(touching)));
    CHECK((to_host(bodies_within(on, scene, distance)) == bodies_in(near)));

    const body_options<even_shapes> of_shapes{.filter = {}};
    auto some = touching;
    std::erase_if(some, [](const body_pair& p) { return !even_shapes{}(p); });
    CHECK((to_host(touching_bodies(on, scene, of_shapes)) == bodies_in(some)));

    const body_options<keep_all, schedule::shared_list, not_neighbours> of_bodies{.bodies = {}};
    some = touching;
    std::erase_if(some, [](const body_pair& p) { return !not_neighbours{}(p.body_a, p.body_b); });
    CHECK((to_host(pairs(on, scene, of_bodies)) == some));
    if constexpr (host_policy<Policy>) {
        CHECK((to_host(within(on, scene, distance)) == near));
        CHECK((to_host(touching_bodies(on, scene, of_bodies)) == bodies_in(some)));
        CHECK(count(on, scene) == touching.size());
        CHECK(any(on, scene) == !touching.empty());
        auto unsorted = to_host(touching_bodies(on, scene, {.sorted = false}));
        std::sort(unsorted.begin(), unsorted.end());
        CHECK((unsorted == bodies_in(touching)));
    }
}

/// Faces and balls, in sets of none, one, two and many.
template <class T, class Policy>
void check_whole_bodies(const Policy& on) {
    constexpr std::uint64_t seed = 20270611;
    constexpr double distance = 0.25;
    uniform random(seed);
    std::vector<triangle_soup<T>> faces;
    std::vector<spheres<T>> balls;
    for (const std::size_t n : {0u, 1u, 2u, 40u}) {
        faces.emplace_back(random_triangles<T>(n, random));
        std::vector<sphere<T>> some;
        for (std::size_t i = 0; i < n; ++i) {
            some.push_back({{static_cast<T>(random() - 0.5), static_cast<T>(random() - 0.5), static_cast<T>(random() - 0.5)},
                            static_cast<T>(0.2 * random())});
        }
        balls.emplace_back(some);
    }
    for (const double far : {0.3, 1.5}) {
        scene_of_kind<Policy, triangle_soup<T>> meshes(on, faces);
        scene_of_kind<Policy, spheres<T>> grains(on, balls);
        draws d(seed, 94, static_cast<std::uint64_t>(10 * far));
        for (std::uint32_t i = 0; i < 24; ++i) {
            meshes.add(static_cast<std::uint32_t>(random.below(faces.size())), make_pose<T>(d, far));
            grains.add(static_cast<std::uint32_t>(random.below(balls.size())), make_pose<T>(d, far));
        }
        const auto touch = [](const auto& a, const auto& b) { return pairs<exact>(serial{}, a, b); };
        const auto come_near = [&](const auto& a, const auto& b) { return within<exact>(serial{}, a, b, distance); };
        const auto all_meshes = meshes.made(on);
        const auto all_grains = grains.made(on);
        const auto touching = pairs_of(meshes, meshes, true, touch);
        CHECK(touching.size() > (far < 1 ? 20u : 0u));
        check_scene(on, all_meshes, touching, pairs_of(meshes, meshes, true, come_near), distance);
        const auto crossing = pairs_of(meshes, grains, false, touch);
        CHECK(crossing.size() > (far < 1 ? 100u : 5u));
        check_scene(on, between(all_meshes, all_grains), crossing, pairs_of(meshes, grains, false, come_near), distance);
    }
}

}  // namespace abut::test
