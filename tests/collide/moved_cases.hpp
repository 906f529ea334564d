// SPDX-License-Identifier: MIT
#pragma once

// What queries of sets and indices that go along a way promise on every policy: which pairs touch on the way, and which touch
// first, when and where, with and without trees on either side, under poses. The truth is a plain loop over sweeps of pairs,
// in integers; that these are right is tests/narrow's matter.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "collide/sweep_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// Pairs that touch on the way, and the first of them, where a's shapes go.
template <class T>
struct moved_truth {
    std::vector<index_pair> pairs;
    std::optional<sweep_impact<T>> first;
};
/// By definition; `GoesB` says whose shapes go.
template <bool GoesB, shape_view A, shape_view B, class T, class Keep>
moved_truth<T> moved_by_definition(const A& a, const B& b, const vec3<T>& way, const Keep& keep) {
    moved_truth<T> truth;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            if (!keep(i, j)) continue;
            const auto see = [&](const auto& mover, const auto& met) {
                const double time = detail::sweep_time<exact>(swept{mover, way}, met);
                if (time < 0) return;
                truth.pairs.push_back({i, j});
                if (!(time < least)) return;
                least = time;
                const auto hit = sweep(mover, met, way);
                truth.first = sweep_impact<T>{i, j, hit.t, hit.point, hit.normal};
            };
            if constexpr (GoesB) {
                see(b[j], a[i]);
            } else {
                see(a[i], b[j]);
            }
        }
    }
    return truth;
}

template <arithmetic A = filtered, class Policy, class X, class Y, class T>
void check_moved_pairs(const Policy& on, const X& x, const Y& y, const moved_truth<T>& truth) {
    CHECK(to_host(pairs<A>(on, x, y)) == truth.pairs);
    CHECK(any<A>(on, x, y) == !truth.pairs.empty());
}
template <arithmetic A = filtered, class Policy, class X, class Y, class T>
void check_first_touch(const Policy& on, const X& x, const Y& y, const moved_truth<T>& truth) {
    const auto first = first_impact<A>(on, x, y);
    REQUIRE(first.has_value() == truth.first.has_value());
    if (!first) return;
    CAPTURE(first->a, first->b, truth.first->a, truth.first->b, first->t, truth.first->t);
    CHECK(*first == *truth.first);
}
template <arithmetic A = filtered, class Policy, class X, class Y, class T>
void check_moved(const Policy& on, const X& x, const Y& y, const moved_truth<T>& truth) {
    check_moved_pairs<A>(on, x, y, truth);
    check_first_touch<A>(on, x, y, truth);
}

struct odd_moved_only {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return (a + b) % 2 == 1; }
};

/// Sets on either side, with a tree or without; with `All` in all forms that a tree has.
template <bool All, class Policy, class SetA, class SetB, class T>
void check_moved_sets(const Policy& on, const SetA& a, const SetB& b, const vec3<T>& way) {
    const auto always = [](std::uint32_t, std::uint32_t) { return true; };
    const auto truth = moved_by_definition<false>(a.view(), b.view(), way, always);
    const auto x = copy_to(on, a);
    const auto y = copy_to(on, b);
    const auto tree_x = make_bvh(on, x);
    const auto tree_y = make_bvh(on, y);
    check_moved(on, moving(x, way), y, truth);
    check_moved(on, moving(x, way), tree_y, truth);
    check_moved(on, moving(tree_x, way), y, truth);
    check_moved(on, moving(tree_x, way), tree_y, truth);
    if constexpr (All) {
        const auto back = moved_by_definition<true>(a.view(), b.view(), way, always);
        check_moved(on, tree_x, moving(tree_y, way), back);
        check_moved_pairs(on, x, moving(tree_y, way), back);
        check_first_touch(on, tree_x, moving(y, way), back);
        CHECK(count(on, moving(tree_x, way), tree_y) == truth.pairs.size());
        const auto quick = quantised(on, tree_y);
        check_moved(on, moving(quantised(on, tree_x), way), quick, truth);
        check_moved_pairs(on, moving(make_grid(on, x), way), y, truth);
        check_moved_pairs(on, moving(tree_x, way), make_grid(on, y), truth);
        const auto odd = moved_by_definition<false>(a.view(), b.view(), way, odd_moved_only{});
        const auto found = first_impact(on, moving(tree_x, way), tree_y, sweep_options<odd_moved_only>{{}});
        CHECK(found == odd.first);
        if constexpr (host_policy<Policy>) {
            check_moved(on, moving(wide(on, tree_x), way), wide(on, tree_y), truth);
            check_moved<exact>(on, moving(tree_x, way), tree_y, truth);
            check_moved_pairs(on, moving(bounded_by<kdop<T, 18>>(on, tree_x), way), bounded_by<kdop<T, 18>>(on, tree_y), truth);
        }
    }
}

/// Both under poses, the movers in turn with a tree and without.
template <class Policy, class SetA, class SetB, class T>
void check_moved_posed(const Policy& on, const SetA& a, const SetB& b, const vec3<T>& way, draws& d) {
    const rigid<T> pose_a = make_pose<T>(d, 2), pose_b = make_loose_pose<T>(d, 2);
    const posed_view<typename SetA::view_type> at_a{a.view(), pose_a};
    const posed_view<typename SetB::view_type> at_b{b.view(), pose_b};
    const auto truth = moved_by_definition<false>(at_a, at_b, way, [](std::uint32_t, std::uint32_t) { return true; });
    const auto x = copy_to(on, a);
    const auto y = copy_to(on, b);
    const auto tree_x = make_bvh(on, x);
    const auto tree_y = make_bvh(on, y);
    check_moved(on, moving(posed(tree_x, pose_a), way), posed(tree_y, pose_b), truth);
    check_moved(on, moving(posed(x, pose_a), way), posed(tree_y, pose_b), truth);
    check_moved(on, moving(posed(tree_x, pose_a), way), posed(y, pose_b), truth);
    const auto back = moved_by_definition<true>(at_a, at_b, way, [](std::uint32_t, std::uint32_t) { return true; });
    check_moved_pairs(on, posed(tree_x, pose_a), moving(posed(tree_y, pose_b), way), back);
}

/// Triangles, balls and rods of a place, at points of a lattice with all its ties or anywhere.
template <class T>
struct moved_scene {
    std::vector<triangle<T>> triangles;
    std::vector<sphere<T>> balls;
    std::vector<capsule<T>> rods;

    moved_scene(uniform& random, int n, const vec3<T>& middle, bool snaps, T size = 1) {
        for (int i = 0; i < n; ++i) {
            const auto at = [&](T far) { return size * on_sweep_lattice(random.point<T>(-static_cast<double>(far), static_cast<double>(far)), snaps); };
            const vec3<T> p = middle + at(3), q = p + at(T(1.5)), r = p + at(T(1.5));
            const T radius = size * (snaps ? static_cast<T>(random.below(3)) / 2 : static_cast<T>(random(0, 0.4)));
            triangles.push_back({p, q, r});
            balls.push_back({q, radius});
            rods.push_back({{q, r}, radius});
        }
    }
};

template <class T, bool All, class Policy>
void check_moved_scenes(const Policy& on, int n) {
    uniform random(211);
    int touched = 0;
    for (int k = 0; k < 6; ++k) {
        const bool snaps = k % 2 == 0;
        CAPTURE(k);
        const vec3<T> apart = on_sweep_lattice(random.point<T>(-8, 8), snaps);
        const moved_scene<T> a(random, n, {0, 0, 0}, snaps), b(random, n - 7, apart, snaps);
        const vec3<T> way = k == 4 ? vec3<T>{0, 0, 0} : k == 3 ? T(0.3) * apart : k == 2 ? vec3<T>{apart.x, 0, 0} : apart;
        const triangle_soup<T> soup_a(a.triangles), soup_b(b.triangles);
        check_moved_sets<All>(on, soup_a, soup_b, way);
        check_moved_sets<false>(on, spheres<T>(a.balls), soup_b, way);
        check_moved_sets<false>(on, capsules<T>(a.rods), spheres<T>(b.balls), way);
        draws d(sample_seed, 97, static_cast<std::uint64_t>(k));
        if constexpr (All) check_moved_posed(on, soup_a, capsules<T>(b.rods), way, d);
        touched += any(on, moving(copy_to(on, soup_a), way), copy_to(on, soup_b)) ? 1 : 0;
    }
    CHECK(touched > 2);
}

/// One shape that goes, rows with a way each, and one that is met; sets of one; and none.
template <class Policy>
void check_moved_single(const Policy& on) {
    const sphere<float> ball{{0, 0, 5}, 1};
    const vec3<float> down{0, 0, -8};
    const triangle_soup<float> floors{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {{-9, -9, 2}, {9, -9, 2}, {0, 9, 2}}, {{-9, -9, 2}, {9, -9, 2}, {0, 9, 2}}};
    const sweep_impact<float> expected{0, 1, 0.25f, {0, 0, 2}, {0, 0, 1}};
    CHECK(first_impact(on, moving(ball, down), floors) == expected);
    CHECK(first_impact(on, moving(ball, down), make_bvh(on, floors)) == expected);
    const spheres<float> alone{ball};
    CHECK(first_impact(on, moving(make_bvh(on, alone), down), make_bvh(on, floors)) == expected);
    CHECK(first_impact(on, make_bvh(on, floors), moving(make_bvh(on, alone), down)) ==
          sweep_impact<float>{1, 0, 0.25f, {0, 0, 2}, {0, 0, 1}});
    const std::vector<swept<sphere<float>>> several{{ball, {0, 0, -1}}, {ball, down}};
    CHECK(first_impact(on, shapes<swept<sphere<float>>>(several), floors) == sweep_impact<float>{1, 1, 0.25f, {0, 0, 2}, {0, 0, 1}});
    CHECK(!first_impact(on, moving(ball, vec3<float>{0, 0, 1}), floors));
    CHECK(!first_impact(on, moving(spheres<float>(), down), floors));
    CHECK(!first_impact(on, moving(make_bvh(on, alone), down), make_bvh(on, triangle_soup<float>())));
    // The rows of a sweep may have one way.
    const auto hits = to_host(sweep(on, make_bvh(on, floors), moving(alone, down)));
    REQUIRE(hits.size() == 1);
    CHECK((hits[0].id == 1 && hits[0].t == 0.25f));
}

/// At the ends of the range, where boxes overflow and squares are flushed.
template <class T, class Policy>
void check_moved_scales(const Policy& on) {
    uniform random(223);
    const T largest = std::numeric_limits<T>::max(), smallest = std::numeric_limits<T>::min();
    for (const T scale : {largest / 16, smallest * 64, smallest / 64}) {
        CAPTURE(scale);
        const vec3<T> apart = scale * vec3<T>{9, 2, -8};
        const moved_scene<T> a(random, 12, T(-0.5) * apart, false, scale), b(random, 12, T(0.5) * apart, false, scale);
        check_moved_sets<false>(on, spheres<T>(a.balls), triangle_soup<T>(b.triangles), apart);
    }
}

}  // namespace abut::test
