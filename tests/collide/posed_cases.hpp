// SPDX-License-Identifier: MIT
#pragma once

// What queries of posed sets and indices promise on every policy: the pairs of a plain loop over placed shapes and
// `intersects<exact>`. `place` itself is tests/shape's.

#include <cstdint>
#include <vector>

#include <abut/abut.hpp>

#include "query_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/touching.hpp"

namespace abut::test {

template <class A, class B>
pair_list placed_truth(const A& a, const B& b) {
    pair_list touching;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        const auto s = a[i];
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            if (intersects<exact>(s, b[j])) touching.push_back({i, j});
        }
    }
    return touching;
}

/// Two sets under two poses, in all the ways that a query may be asked. Returns the number of pairs.
template <class Policy, class A, class B, class T>
std::size_t check_posed(const Policy& on, const A& set_a, const rigid<T>& pose_a, const B& set_b, const rigid<T>& pose_b) {
    const pair_list expected = placed_truth(posed_view<typename A::view_type>{set_a.view(), pose_a},
                                            posed_view<typename B::view_type>{set_b.view(), pose_b});
    CAPTURE(set_a.size(), set_b.size(), expected.size());
    const auto a = copy_to(on, set_a);
    const auto b = copy_to(on, set_b);
    const auto pa = posed(a, pose_a);
    const auto pb = posed(b, pose_b);
    const auto tree_a = posed(make_bvh(on, a), pose_a);
    const auto tree_b = posed(make_bvh(on, b), pose_b);
    CHECK(to_host(pairs(on, pa, pb)) == expected);
    CHECK(to_host(pairs(on, tree_a, pb)) == expected);
    CHECK(to_host(pairs(on, pa, tree_b)) == expected);
    CHECK(to_host(pairs(on, tree_a, tree_b)) == expected);
    CHECK(to_host(pairs(on, tree_b, tree_a)) == mirrored(expected));
    CHECK(to_host(pairs(on, pa, posed(make_grid(on, b), pose_b))) == expected);
    CHECK(count(on, tree_a, tree_b) == expected.size());
    CHECK(any(on, tree_a, tree_b) == !expected.empty());
    if (pose_a == rigid<T>{}) {
        CHECK(to_host(pairs(on, a, tree_b)) == expected);
        CHECK(to_host(pairs(on, tree_a.object, pb)) == expected);
        CHECK(to_host(pairs(on, tree_a.object, tree_b)) == expected);
    }
    return expected.size();
}

/// Shapes that share a part of the world, of side 2 and `center` away from its origin, in the frames of their objects.
template <scalar T>
triangle_soup<T> brought_back(const std::vector<triangle<T>>& triangles, const rigid<T>& pose, const vec3<T>& center) {
    std::vector<triangle<T>> frame;
    const auto back = [&](const vec3<T>& p) { return construction::taken_back(pose, p + center); };
    for (const auto& t : triangles) frame.push_back({back(t.a), back(t.b), back(t.c)});
    return triangle_soup<T>(frame);
}
template <scalar T>
spheres<T> brought_back(const std::vector<sphere<T>>& balls, const rigid<T>& pose, const vec3<T>& center) {
    std::vector<sphere<T>> frame;
    for (const auto& s : balls) frame.push_back({construction::taken_back(pose, s.center + center), s.radius});
    return spheres<T>(frame);
}

template <class T, class Policy>
void check_posed_scenes(const Policy& on) {
    constexpr std::uint64_t seed = 20261121;
    std::printf("posed scenes: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    std::size_t hits = 0;
    int scene = 0;
    for (const double far : {0.0, 1.0, 1e3, 1e6}) {
        for (const bool a_moves : {false, true}) {
            for (int k = 0; k < 4; ++k) {
                draws d(seed, 77, static_cast<std::uint64_t>(scene++));
                const auto drawn = [&] { return k % 2 == 0 ? make_pose<T>(d, far) : make_loose_pose<T>(d, far); };
                const rigid<T> pose_a = a_moves ? drawn() : rigid<T>{}, pose_b = drawn();
                const auto center = random.point<T>(-far, far);
                CAPTURE(far, a_moves, k);
                const std::size_t n = k == 0 ? 1 : 150;
                const auto a = brought_back(random_triangles<T>(n, random), pose_a, center);
                const auto b = brought_back(random_triangles<T>(200, random), pose_b, center);
                const auto balls = brought_back(random_spheres<T>(150, random), pose_b, center);
                hits += check_posed(on, a, pose_a, b, pose_b);
                hits += check_posed(on, a, pose_a, balls, pose_b);
            }
        }
    }
    CHECK(hits > 3000);
    draws d(seed, 78, 0);
    const auto pose = make_pose<T>(d, 1);
    CHECK(check_posed(on, triangle_soup<T>(), rigid<T>{}, triangle_soup<T>(random_triangles<T>(3, random)), pose) == 0);
    CHECK(check_posed(on, triangle_soup<T>(random_triangles<T>(3, random)), pose, triangle_soup<T>(), rigid<T>{}) == 0);
}

/// A closed mesh that lies on itself: under the same pose every triangle meets itself and its neighbours; shifted by its own
/// pose's last digits it nearly does.
template <class T, class Policy>
void check_posed_onto_itself(const Policy& on) {
    const torus<T> shape(12, 8, 2, 1);
    const mesh<T> surface(shape.vertices, shape.faces);
    for (std::uint64_t k = 0; k < 12; ++k) {
        draws d(20261122, 79, k);
        const rigid<T> pose = make_pose<T>(d, k % 3 == 0 ? 0 : 1e3);
        rigid<T> beside = pose;
        beside.translation.x += static_cast<T>(1e-6) * (1 + beside.translation.x);
        CAPTURE(k);
        CHECK(check_posed(on, surface, pose, surface, pose) >= surface.size());
        CHECK(check_posed(on, surface, pose, surface, beside) > 0);
    }
}

/// Triangles under different poses that meet in a point, or miss it by an ulp, in boxes that end there.
template <class T, class Policy>
void check_posed_touches(const Policy& on) {
    std::size_t meet = 0;
    for (std::uint64_t i = 0; i < 200; ++i) {
        draws d(20261123, 80, i);
        const auto c = make_posed_contact<T>(d, i % 2 == 1);
        if (!detail::is_finite(detail::magnitudes(place(c.pose_a, c.a).a)) ||
            !detail::is_finite(detail::magnitudes(place(c.pose_b, c.b).a))) {
            continue;
        }
        const auto a = posed(make_bvh(on, copy_to(on, triangle_soup<T>({c.a, c.a}))), c.pose_a);
        const auto b = posed(make_bvh(on, copy_to(on, triangle_soup<T>({c.b, c.b, c.b}))), c.pose_b);
        const bool truly = intersects<exact>(place(c.pose_a, c.a), place(c.pose_b, c.b));
        meet += truly ? 1 : 0;
        CAPTURE(i);
        CHECK(count(on, a, b) == (truly ? 6u : 0u));
        CHECK(count(on, b, a) == (truly ? 6u : 0u));
    }
    CHECK(meet > 50);
}

/// Balls under poses that shrink all else, and triangles that touch them where they reach farthest, or miss them by a
/// little.
template <class T, class Policy>
void check_posed_balls(const Policy& on) {
    std::size_t meet = 0;
    for (std::uint64_t i = 0; i < 60; ++i) {
        draws d(20261124, 81, i);
        const double shrink = -0.49 * rotation_tolerance, by[3][3] = {{shrink, 0, 0}, {0, shrink, 0}, {0, 0, shrink}};
        rigid<T> pose = make_pose<T>(d, 1);
        if (d.below(3) == 0) construction::set_quarter_turns(pose, d);
        pose = construction::strained(pose, by);
        const sphere<T> ball{construction::round_to<T>(construction::cube(d, 0.1)), T(1)};
        const vec3<double> c = construction::widened(place(pose, ball).center);
        std::vector<triangle<T>> points;
        for (const double along : {1.0, 1 - 1e-6, 1 - 1e-5, 1 - 1e-4, 1 - 1e-3, 1 + 1e-6}) {
            for (int side = 0; side < 6; ++side) {
                const double off = side < 3 ? along : -along;
                const auto p = construction::round_to<T>(
                    {c.x + (side % 3 == 0 ? off : 0), c.y + (side % 3 == 1 ? off : 0), c.z + (side % 3 == 2 ? off : 0)});
                points.push_back({p, p, p});
            }
        }
        CAPTURE(i);
        meet += check_posed(on, triangle_soup<T>(points), rigid<T>{}, spheres<T>({ball, ball}), pose);
    }
    CHECK(meet > 60 * 2 * 24);
}

template <class T, class Policy>
void check_posed_errors(const Policy& on) {
    const auto soup = copy_to(on, triangle_soup<T>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{9, 9, 9}, {8, 8, 8}, {7, 7, 7}}}));
    const auto tree = make_bvh(on, soup);
    rigid<T> bent;
    bent.rotation[4] = T(1.0006);
    CHECK_THROWS_AS(any(on, posed(soup, bent), soup), invalid_geometry);
    CHECK_THROWS_AS(any(on, soup, posed(tree, bent)), invalid_geometry);
    rigid<T> away;
    away.translation.y = std::numeric_limits<T>::max();
    const auto far =
        copy_to(on, triangle_soup<T>(std::vector<triangle<T>>{{{0, 0, 0}, {1, 0, 0}, {0, away.translation.y / 2, 0}}}));
    CHECK_THROWS_AS(any(on, posed(far, away), soup), invalid_geometry);
    CHECK_THROWS_AS(any(on, posed(make_bvh(on, far), away), soup), invalid_geometry);
    CHECK_FALSE(any(on, posed(soup, away), soup));  // huge and yet finite
    CHECK_FALSE(any(on, posed(tree, away), soup));
    CHECK(count(on, posed(tree, away), posed(tree, away)) >= 2);
}

template <class T, class Policy>
void check_all_posed(const Policy& on) {
    check_posed_scenes<T>(on);
    check_posed_onto_itself<T>(on);
    check_posed_touches<T>(on);
    check_posed_balls<T>(on);
    check_posed_errors<T>(on);
}

}  // namespace abut::test
