// SPDX-License-Identifier: MIT
#pragma once

// What pairs(policy, list) promises on every policy: of each entry what `pairs` says of it alone, tagged and sorted.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "posed_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// Entry by entry, from the plain loop over placed shapes.
template <class Host, class T>
std::vector<tagged_pair> tagged_truth(const std::vector<Host>& sets, const std::vector<std::size_t>& a,
                                      const std::vector<std::size_t>& b, const std::vector<rigid<T>>& poses) {
    using view = typename Host::view_type;
    std::vector<tagged_pair> all;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const posed_view<view> first{sets[a[i]].view(), poses[2 * i]}, second{sets[b[i]].view(), poses[2 * i + 1]};
        for (const index_pair& p : placed_truth(first, second)) all.push_back({static_cast<std::uint32_t>(i), p.a, p.b});
    }
    return all;
}

template <class T, class Policy>
void check_batches(const Policy& on) {
    uniform random(20261130);
    const torus<T> shape(12, 8, T(0.7), T(0.3));
    std::vector<mesh<T>> sets;
    for (const std::size_t n : {0u, 1u, 2u, 3u, 40u, 120u}) {
        std::vector<vec3<T>> vertices;
        std::vector<face> faces;
        for (std::uint32_t i = 0; i < n; ++i) {
            const auto t = random_triangles<T>(1, random)[0];
            vertices.insert(vertices.end(), {t.a, t.b, t.c});
            faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        sets.emplace_back(vertices, faces);
    }
    sets.emplace_back(shape.vertices, shape.faces);
    using tree = decltype(make_bvh(on, sets[0]));
    std::vector<tree> trees;
    for (const auto& set : sets) trees.push_back(make_bvh(on, set));

    using entry = posed_pair<tree>;
    for (const std::size_t n : {0u, 1u, 2u, 400u}) {
        std::vector<std::size_t> a, b;
        std::vector<rigid<T>> poses;
        std::vector<entry> list;
        for (std::size_t i = 0; i < n; ++i) {
            draws d(20261130, 84, i + 1000 * n);
            a.push_back(static_cast<std::size_t>(random() * static_cast<double>(sets.size())));
            b.push_back(i % 7 == 0 ? a.back() : static_cast<std::size_t>(random() * static_cast<double>(sets.size())));
            poses.push_back(make_pose<T>(d, 1));
            poses.push_back(i % 7 == 0 ? poses.back() : make_pose<T>(d, 1));
            list.push_back({posed(trees[a.back()], poses[2 * i]), posed(trees[b.back()], poses[2 * i + 1])});
        }
        const auto expected = tagged_truth(sets, a, b, poses);
        CAPTURE(n);
        CHECK((n < 400 || expected.size() > 5000));
        CHECK((to_host(pairs(on, list)) == expected));
        auto unsorted = to_host(pairs(on, list, {.sorted = false}));
        std::sort(unsorted.begin(), unsorted.end());
        CHECK((unsorted == expected));
    }

    // A pose that is none is refused by the number of its entry.
    rigid<T> bent;
    bent.rotation[0] = T(1.01);
    const std::vector<entry> bad{{posed(trees[4], {}), posed(trees[5], {})}, {posed(trees[4], {}), posed(trees[5], bent)}};
    try {
        (void)pairs(on, bad);
        FAIL("a bent pose was taken");
    } catch (const invalid_geometry& problem) {
        CHECK(std::string(problem.what()).find("entry 1 of the list") != std::string::npos);
    }
}

/// Trees of spheres against trees of triangles.
template <class T, class Policy>
void check_mixed_batch(const Policy& on) {
    uniform random(20261201);
    const triangle_soup<T> soup(random_triangles<T>(60, random));
    const spheres<T> balls(random_spheres<T>(50, random));
    const auto tree = make_bvh(on, soup);
    const auto ball_tree = make_bvh(on, balls);
    std::vector<posed_pair<std::remove_const_t<decltype(tree)>, std::remove_const_t<decltype(ball_tree)>>> list;
    std::vector<tagged_pair> expected;
    for (std::uint32_t i = 0; i < 20; ++i) {
        draws d(20261201, 85, i);
        const auto pose_a = make_pose<T>(d, 1), pose_b = make_pose<T>(d, 1);
        list.push_back({posed(tree, pose_a), posed(ball_tree, pose_b)});
        const posed_view<typename triangle_soup<T>::view_type> a{soup.view(), pose_a};
        const posed_view<typename spheres<T>::view_type> b{balls.view(), pose_b};
        for (const index_pair& p : placed_truth(a, b)) expected.push_back({i, p.a, p.b});
    }
    CHECK(expected.size() > 100);
    CHECK((to_host(pairs(on, list)) == expected));
}

}  // namespace abut::test
