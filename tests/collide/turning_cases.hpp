// SPDX-License-Identifier: MIT
#pragma once

// What meetings of bodies that turn promise on every policy: the first pair of shapes by time, as it is computed of one
// pair, and of equal times the least ids; with any index. The truth is a plain loop; that one pair is right is
// tests/narrow's matter.

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <abut/collide/turning.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/index/quantised.hpp>
#include <abut/index/wide.hpp>
#include <abut/shape/set.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"

namespace abut::test {

template <class T>
vec3<T> point_that_turns(draws& d, double half) {
    const T x = static_cast<T>(d.uniform(-half, half)), y = static_cast<T>(d.uniform(-half, half));
    return {x, y, static_cast<T>(d.uniform(-half, half))};
}
template <class T>
rigid<T> pose_that_turns(draws& d, double reach) {
    rigid<T> pose;
    const double w = d.uniform(-1, 1), x = d.uniform(-1, 1), y = d.uniform(-1, 1);
    construction::set_rotation(pose, w, x, y, d.uniform(-1, 1));
    pose.translation = point_that_turns<T>(d, reach);
    return pose;
}

/// Motions of two indices; of some the second rests, of some both begin where they touch.
template <class T, class IndexA, class IndexB>
std::vector<moving_pair<IndexA, IndexB>> drawn_motions(const IndexA& a, const IndexB& b, std::size_t n) {
    std::vector<moving_pair<IndexA, IndexB>> list;
    for (std::size_t i = 0; i < n; ++i) {
        draws d(sample_seed, 77, i);
        const double reach = i % 3 == 0 ? 2 : 5;
        const rigid<T> from = pose_that_turns<T>(d, reach), to = pose_that_turns<T>(d, reach), at = pose_that_turns<T>(d, 3);
        turning<T> about;
        about.axis = i % 4 == 1 ? vec3<T>{0, 0, 1} : vec3<T>{0, 0, 0};
        if (i % 4 == 1) {  // about z
            rigid<T> turned;
            const double half = d.uniform(0.2, 1.2);
            construction::set_rotation(turned, std::cos(half), 0, 0, -std::sin(half));
            turned.translation = to.translation;
            list.push_back(
                {moving(posed(a, rigid<T>{{1, 0, 0, 0, 1, 0, 0, 0, 1}, from.translation}), posed(a, turned), about),
                 posed(b, at)});
            continue;
        }
        about.centre = point_that_turns<T>(d, 1);
        const posed_motion<IndexB> other =
            i % 2 == 0 ? posed_motion<IndexB>(posed(b, at)) : moving(posed(b, at), posed(b, pose_that_turns<T>(d, 3)));
        list.push_back({moving(posed(a, from), posed(a, to), about), other});
    }
    return list;
}

/// By definition.
template <class IndexA, class IndexB, class ShapesA, class ShapesB>
std::vector<meeting> meetings_by_definition(const std::vector<moving_pair<IndexA, IndexB>>& list, const ShapesA& a,
                                            const ShapesB& b, double tolerance) {
    std::vector<meeting> all;
    for (const auto& one : list) {
        const auto motion = [](const auto& body) {
            return detail::make_rigid_motion(body.from, body.to, body.about, "test");
        };
        const detail::turning_pair both{motion(one.a), motion(one.b)};
        meeting first{std::numeric_limits<double>::infinity(), no_id, no_id, std::numeric_limits<double>::infinity()};
        for (std::uint32_t i = 0; i < a.size(); ++i) {
            for (std::uint32_t j = 0; j < b.size(); ++j) {
                const auto found = detail::turning_time_of(a[i], b[j], both, tolerance);
                if (found.time < first.time) first = {found.time, i, j, found.distance};
            }
        }
        all.push_back(first);
    }
    return all;
}

template <class Policy, class IndexA, class IndexB, class T = typename IndexA::scalar_type>
void check_motions_of(const Policy& on, const IndexA& a, const IndexB& b, const std::vector<meeting>& expected,
                      double tolerance) {
    const auto list = drawn_motions<T>(a, b, expected.size());
    const auto found = to_host(first_meetings(on, list, {tolerance}));
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i] == expected[i]) continue;
        CAPTURE(i, found[i].time, expected[i].time, found[i].a, expected[i].a, found[i].b, expected[i].b, found[i].distance);
        FAIL_CHECK("another answer than by definition");
    }
    const auto any = to_host(any_each(on, list, {tolerance}));
    bool same = any.size() == expected.size();
    for (std::size_t i = 0; same && i < any.size(); ++i) same = (any[i] != 0) == (expected[i].a != no_id);
    CHECK(same);
}

/// Sets in host memory, in trees of several kinds if `All`.
template <bool All = false, class Policy, class SetA, class SetB>
void check_turning_sets(const Policy& on, const SetA& a, const SetB& b, std::size_t n, double tolerance) {
    using T = typename SetA::scalar_type;
    const serial here;
    const auto expected =
        meetings_by_definition(drawn_motions<T>(make_bvh(here, a), make_bvh(here, b), n), a.view(), b.view(), tolerance);
    std::size_t met = 0, at_start = 0;
    for (const meeting& m : expected) met += m.a != no_id, at_start += m.time == 0;
    CAPTURE(n, met, at_start);
    CHECK(met * 8 > n);
    CHECK(met < n);
    CHECK(at_start < met);
    const auto there_a = copy_to(on, a);
    const auto there_b = copy_to(on, b);
    const auto tree_a = make_bvh(on, there_a);
    const auto tree_b = make_bvh(on, there_b);
    check_motions_of(on, tree_a, tree_b, expected, tolerance);
    if constexpr (All) check_motions_of(on, quantised(on, tree_a), tree_b, expected, tolerance);
    if constexpr (All && host_policy<Policy>) {
        check_motions_of(on, wide(on, tree_a), make_bvh(on, there_b, {.builder = bvh_builder::sah}), expected, tolerance);
    }
}

template <class T>
std::vector<triangle<T>> triangles_that_turn(std::size_t n, double thin) {
    std::vector<triangle<T>> all;
    for (std::size_t i = 0; i < n; ++i) {
        draws d(sample_seed, 78, i);
        const vec3<T> at = point_that_turns<T>(d, 1.5), p = point_that_turns<T>(d, 0.6),
                      q = static_cast<T>(thin) * point_that_turns<T>(d, 0.6);
        all.push_back({at, at + p, at + q});
    }
    return all;
}

template <class T, bool All = false, class Policy>
void check_turning_triangles(const Policy& on, std::size_t n) {
    check_turning_sets<All>(on, triangle_soup<T>(triangles_that_turn<T>(30, 1)),
                            triangle_soup<T>(triangles_that_turn<T>(25, 1e-4)), n, 1e-3);
}
template <class T, class Policy>
void check_turning(const Policy& on, std::size_t n) {
    check_turning_triangles<T, true>(on, n);
    const triangle_soup<T> soup(triangles_that_turn<T>(30, 1));
    std::vector<capsule<T>> rods;
    std::vector<sphere<T>> balls;
    std::vector<aabb<T>> crates;
    for (std::uint64_t i = 0; i < 12; ++i) {
        draws d(sample_seed, 79, i);
        const vec3<T> at = point_that_turns<T>(d, 1.5), way = point_that_turns<T>(d, 0.8);
        rods.push_back({{at, at + way}, T(0.125)});
        balls.push_back({at + way, T(0.25)});
        crates.push_back(bounds(segment<T>{at, at + way}));
    }
    check_turning_sets(on, capsules<T>(rods), soup, n, 1e-2);
    check_turning_sets(on, spheres<T>(balls), boxes<T>(crates), n, 1e-3);
    // One shape against many, and alone.
    check_turning_sets(on, spheres<T>({balls[0]}), soup, 2 * n, 0.3);
    check_turning_sets(on, spheres<T>({{{0, 0, 0}, 1}}), triangle_soup<T>({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}}), n, 1e-1);
}

}  // namespace abut::test
