// SPDX-License-Identifier: MIT
#pragma once

// What `within` promises on every policy: all pairs that are no farther apart than a distance, whatever the indices, their
// layouts and the poses. The truth is a plain loop over `within<exact>` of two shapes, whose own truth is
// tests/predicate's matter.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "collide/set_cases.hpp"
#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace abut::test {

template <shape_view A, shape_view B>
std::vector<index_pair> within_by_definition(const A& a, const B& b, double distance, bool among_itself = false) {
    std::vector<index_pair> near;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = among_itself ? i + 1 : 0; j < b.size(); ++j) {
            if (within<exact>(a[i], b[j], distance)) near.push_back({i, j});
        }
    }
    return near;
}

/// Without an index, with one on one side, and on both; returns how many pairs there are.
template <class Policy, class SetA, class SetB>
std::size_t check_within(const Policy& on, const SetA& a, const SetB& b, double distance) {
    CAPTURE(distance);
    const auto expected = within_by_definition(a.view(), b.view(), distance);
    const auto there_a = copy_to(on, a);
    const auto there_b = copy_to(on, b);
    const auto tree_a = make_bvh(on, there_a);
    const auto tree_b = make_bvh(on, there_b);
    CHECK(to_host(within(on, there_a, there_b, distance)) == expected);
    CHECK(to_host(within(on, tree_a, there_b, distance)) == expected);
    CHECK(to_host(within(on, tree_a, tree_b, distance)) == expected);
    CHECK(count_within(on, tree_a, tree_b, distance) == expected.size());
    return expected.size();
}

/// Shapes in a box of side 2, at random and on a lattice, where many are exactly as far apart as is asked.
template <class A, class B, class Policy>
void check_within_of(const Policy& on, std::uint64_t seed) {
    CAPTURE(seed);
    uniform random(seed);
    std::size_t hits = 0, asked = 0;
    for (const bool on_lattice : {false, true}) {
        CAPTURE(on_lattice);
        const shapes<A> a(shape_maker<A>(random, on_lattice)(40));
        const shapes<B> b(shape_maker<B>(random, on_lattice)(50));
        for (const double distance : {0.0, 0.25, 0x1.fffffffffffffp-3, 0.75, 0x1p-60}) {
            hits += check_within(on, a, b, distance);
            asked += a.size() * b.size();
        }
        if constexpr (detail::decidable<A, B>) {
            const auto there_a = copy_to(on, a);
            const auto there_b = copy_to(on, b);
            CHECK(to_host(within(on, there_a, there_b, 0)) == to_host(pairs(on, there_a, there_b)));
        }
    }
    CHECK(hits > 100);
    CHECK(hits < asked / 2);
}

/// Two tori; the second one is posed, and the first where the caller says so.
template <class T>
struct two_tori {
    torus<T> ring{9, 6, 2, T(0.5)}, small{6, 5, T(0.75), T(0.25)};
    mesh<T> a{ring.vertices, ring.faces}, b{small.vertices, small.faces};
    rigid<T> pose_a{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {T(0.1), T(-0.2), T(0.3)}};

    [[nodiscard]] std::vector<rigid<T>> poses() const {
        std::vector<rigid<T>> all(3, {{T(0.6), T(-0.8), 0, T(0.8), T(0.6), 0, 0, 0, 1}, {T(3.5), T(0.25), T(0.5)}});
        all[1].translation = {T(1.5), 0, 0};  // where they touch
        all[2].rotation[0] *= T(1 + 0x1p-12);
        all[2].rotation[4] *= T(1 - 0x1p-12);
        return all;
    }
    [[nodiscard]] auto expected(const rigid<T>& at_a, const rigid<T>& at_b, double distance) const {
        return within_by_definition(posed_view<mesh_view<T>>{a.view(), at_a}, posed_view<mesh_view<T>>{b.view(), at_b},
                                    distance);
    }
};

/// Trees and plain sets, under poses; and all that may be asked.
template <class T, class Policy>
void check_within_of_meshes(const Policy& on) {
    const two_tori<T> of;
    const auto a = copy_to(on, of.a), b = copy_to(on, of.b);
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
    for (const rigid<T>& pose : of.poses()) {
        for (const double distance : {0.0, 0.3, 1.1}) {
            CAPTURE(distance);
            const auto expected = of.expected({}, pose, distance);
            CHECK(expected.empty() == !any_within(on, tree_a, posed(tree_b, pose), distance));
            CHECK(to_host(within(on, tree_a, posed(tree_b, pose), distance)) == expected);
            CHECK(to_host(within(on, a, posed(tree_b, pose), distance)) == expected);
            CHECK(to_host(within(on, posed(tree_a, of.pose_a), posed(tree_b, pose), distance)) ==
                  of.expected(of.pose_a, pose, distance));
        }
    }
    CHECK(of.expected({}, of.poses()[0], 1.1).size() > 100);
}

/// Sets of two kinds under poses, and their trees; also pairs that are exactly as far apart as is asked.
template <class A, class B, class Policy>
void check_posed_within_of(const Policy& on, std::uint64_t seed) {
    using T = scalar_type_of<A>;
    CAPTURE(seed);
    uniform random(seed);
    const shapes<A> a(shape_maker<A>(random, true)(60));
    const shapes<B> b(shape_maker<B>(random, true)(70));
    const auto there_a = copy_to(on, a);
    const auto there_b = copy_to(on, b);
    const auto tree_a = make_bvh(on, there_a);
    const auto tree_b = make_bvh(on, there_b);
    std::size_t hits = 0, asked = 0;
    for (std::uint64_t k = 0; k < 4; ++k) {
        draws d(seed, 11, k);
        rigid<T> pose_a, pose_b;
        pose_b.rotation[0] = pose_b.rotation[4] = 0;  // whole numbers stay whole
        pose_b.rotation[1] = -1;
        pose_b.rotation[3] = 1;
        pose_b.translation = {T(0.5), T(0.25), T(-0.75)};
        if (k > 0) pose_a = make_loose_pose<T>(d, 0.5), pose_b = make_loose_pose<T>(d, 1);
        const posed_view<typename shapes<A>::view_type> view_a{a.view(), pose_a};
        const posed_view<typename shapes<B>::view_type> view_b{b.view(), pose_b};
        for (const double distance : {0.0, 0.25, 0.6}) {
            CAPTURE(k, distance);
            const auto expected = within_by_definition(view_a, view_b, distance);
            const auto moved_a = posed(tree_a, pose_a);
            const auto moved_b = posed(tree_b, pose_b);
            CHECK(to_host(within(on, moved_a, moved_b, distance)) == expected);
            CHECK(to_host(within(on, posed(there_a, pose_a), moved_b, distance)) == expected);
            CHECK(count_within(on, moved_a, posed(there_b, pose_b), distance) == expected.size());
            CHECK(any_within(on, moved_a, moved_b, distance) == !expected.empty());
            hits += expected.size();
            asked += a.size() * b.size();
        }
    }
    CHECK(hits > asked / 50);
    CHECK(hits < asked / 2);
}

/// Each shape of a set with the others.
template <class Shape, class Policy>
void check_self_within(const Policy& on, std::uint64_t seed) {
    CAPTURE(seed);
    uniform random(seed);
    for (const bool on_lattice : {false, true}) {
        const shapes<Shape> set(shape_maker<Shape>(random, on_lattice)(120));
        const auto there = copy_to(on, set);
        for (const double distance : {0.0, 0.25, 0.5}) {
            CAPTURE(on_lattice, distance);
            const auto expected = within_by_definition(set.view(), set.view(), distance, true);
            CHECK(to_host(self_within(on, there, distance)) == expected);
            CHECK(to_host(self_within(on, make_bvh(on, there), distance)) == expected);
            CHECK(count_self_within(on, make_grid(on, there), distance) == expected.size());
            if (distance > 0) CHECK(expected.size() > 20);
        }
    }
}

template <class F>
std::string refusal_of(const F& f) {
    try {
        f();
    } catch (const error& e) {
        return e.what();
    }
    return "nothing was thrown";
}

/// By hand: a distance that no double below it is, and what is refused.
template <class Policy>
void check_within_by_hand(const Policy& on) {
    const points<float> cloud({{0, 0, 0}, {3, 4, 0}, {0, 0, 0.1f}, {9, 9, 9}});
    const auto there = copy_to(on, cloud);
    const auto tree = make_bvh(on, there);
    const auto near = [&](double distance) { return to_host(self_within(on, tree, distance)); };
    using list = std::vector<index_pair>;
    CHECK(near(5) == list{{0, 1}, {0, 2}});
    CHECK(near(std::nextafter(5.0, 0)) == list{{0, 2}});
    CHECK(near(0.1) == list{});  // which is less than the float
    CHECK(near(static_cast<double>(0.1f)) == list{{0, 2}});
    CHECK(near(std::numeric_limits<double>::max()).size() == 6);
    CHECK(count_within(on, tree, vec3<float>{3, 4, 12}, 12) == 2);
    const auto refusal = [&](double distance) { return refusal_of([&] { (void)within(on, tree, tree, distance); }); };
    CHECK(refusal(-1) == "abut::within: distance is -1; expected a finite number, 0 or more");
    CHECK(refusal(std::numeric_limits<double>::infinity()) ==
          "abut::within: distance is inf; expected a finite number, 0 or more");
    CHECK(refusal(std::numeric_limits<double>::quiet_NaN()).find("expected a finite number") != std::string::npos);
    CHECK(refusal_of([&] { (void)count_self_within(on, tree, -0x1p-1074); })
              .rfind("abut::count_self_within: distance is -4.94", 0) == 0);
    const auto none = copy_to(on, points<float>());
    CHECK(within(on, none, tree, 1).empty());
    CHECK(within(on, make_bvh(on, none), tree, 1).empty());
    CHECK(self_within(on, make_bvh(on, copy_to(on, points<float>({{1, 2, 3}}))), 9).empty());
}

/// Points with a few coordinates at the ends of the range, so that distances tie and boxes overflow and underflow.
template <scalar T>
std::vector<vec3<T>> extreme_points(draws& d, std::size_t n) {
    constexpr T tiny = std::numeric_limits<T>::denorm_min(), normal = smallest_normal<T>, most = largest_finite<T>;
    const T some[4][6] = {{0, tiny, 3 * tiny, normal, normal - tiny, 5 * normal},
                          {most, most / 2, most / 4, 0, 1, tiny},
                          {1, 1 + 2 * unit_roundoff<T>, 1 - unit_roundoff<T>, tiny, normal, T(0.1)},
                          {most * T(0.1), most * T(0.3), normal, 1, T(1e10), 0}};
    const auto& from = some[d.below(4)];
    std::vector<vec3<T>> points;
    for (std::size_t i = 0; i < n; ++i) {
        const auto number = [&] { return d.below(2) == 0 ? from[d.below(6)] : -from[d.below(6)]; };
        const T x = number(), y = number();
        points.push_back({x, y, number()});
    }
    return points;
}

/// The distance of some pair along an axis, and what is next to it.
template <scalar T>
double extreme_distance(draws& d, const std::vector<vec3<T>>& points) {
    const int n = static_cast<int>(points.size());
    const vec3<T> p = points[static_cast<std::size_t>(d.below(n))], q = points[static_cast<std::size_t>(d.below(n))];
    const double x = std::abs(static_cast<double>(p.x) - static_cast<double>(q.x));
    if (!(x < std::numeric_limits<double>::infinity())) return std::numeric_limits<double>::max();
    const int kind = d.below(4);
    return kind == 0 ? std::nextafter(x, 0) : kind == 1 ? std::nextafter(x, std::numeric_limits<double>::max()) : x;
}

/// The least double that the distance of two points does not exceed.
template <scalar T>
double least_distance(const vec3<T>& p, const vec3<T>& q) {
    const auto way = detail::widened(p) - detail::widened(q);
    double d = std::sqrt(dot(way, way));
    while (!within<exact>(p, q, d)) d = std::nextafter(d, 2 * d);
    while (within<exact>(p, q, std::nextafter(d, 0))) d = std::nextafter(d, 0);
    return d;
}

/// Distances that are those of pairs, and boxes that are points: nothing but a slack keeps a pair.
template <scalar T, class Policy>
void check_within_at_pairs(const Policy& on, std::uint64_t seed) {
    CAPTURE(seed);
    uniform random(seed);
    const points<T> cloud(shape_maker<vec3<T>>(random, false)(60));
    const auto set = cloud.view();
    const auto there = copy_to(on, cloud);
    const auto tree = make_bvh(on, there);
    for (std::uint32_t i = 0; i + 1 < set.size(); ++i) {
        const double d = least_distance(set[i], set[i + 1]);
        CAPTURE(i, d);
        const auto expected = within_by_definition(set, set, d, true);
        CHECK(to_host(self_within(on, tree, d)) == expected);
        if (i % 8 == 0) {
            CHECK(to_host(self_within(on, there, d)) == expected);
            CHECK(count_self_within(on, make_grid(on, there), d) == expected.size());
        }
        CHECK(count_self_within(on, tree, std::nextafter(d, 0)) < expected.size());
    }
}

}  // namespace abut::test
