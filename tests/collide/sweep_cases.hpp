// SPDX-License-Identifier: MIT
#pragma once

// What `sweep` promises on every policy: of each shape that goes along a vector what it touches first, as times are computed for
// one pair, and of equal times the least id; with and without an index, under poses, with filters; and the point and the normal
// of that pair. The truth is a plain loop; that one pair is right is tests/narrow's matter.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// By definition, of those that are kept.
template <shape_view Shapes, class S, class Keep>
auto sweeps_by_definition(const Shapes& shapes, const std::vector<swept<S>>& movers, const Keep& keep) {
    using T = scalar_type_of<S>;
    std::vector<sweep_hit<T>> all;
    for (std::uint32_t k = 0; k < movers.size(); ++k) {
        double least = std::numeric_limits<double>::infinity();
        sweep_hit<T> first{no_id, std::numeric_limits<T>::infinity(), {0, 0, 0}, {0, 0, 0}};
        for (std::uint32_t i = 0; i < shapes.size(); ++i) {
            if (!keep(k, i)) continue;
            const double time = detail::sweep_time<exact>(movers[k], shapes[i]);
            if (!(time >= 0 && time < least)) continue;
            least = time;
            first = sweep(movers[k].start, shapes[i], movers[k].way);
            first.id = i;
        }
        all.push_back(first);
    }
    return all;
}
template <shape_view Shapes, class S>
auto sweeps_by_definition(const Shapes& shapes, const std::vector<swept<S>>& movers) {
    return sweeps_by_definition(shapes, movers, [](std::uint32_t, std::uint32_t) { return true; });
}

template <arithmetic A = filtered, class Policy, class X, class S, class T>
void check_sweep(const Policy& on, const X& index, const std::vector<swept<S>>& movers, const std::vector<sweep_hit<T>>& expected) {
    const auto found = to_host(sweep<A>(on, index, shapes<swept<S>>(movers)));
    REQUIRE(found.size() == expected.size());
    const auto wrong = std::mismatch(found.begin(), found.end(), expected.begin());
    if (wrong.first != found.end()) {
        CAPTURE(wrong.first - found.begin(), wrong.first->id, wrong.second->id, wrong.first->t, wrong.second->t);
        FAIL_CHECK("another answer than by definition");
    }
}

struct odd_sweeps_only {
    ABUT_HD bool operator()(std::uint32_t row, std::uint32_t id) const { return (row + id) % 2 == 1; }
};

/// Movers of one kind among shapes of another one; of one kind all that takes a sweep.
template <bool All = false, class S, class Policy, class Set>
void check_sweep_indices(const Policy& on, const Set& set, const std::vector<swept<S>>& movers) {
    const auto expected = sweeps_by_definition(set.view(), movers);
    const auto hits = std::count_if(expected.begin(), expected.end(), [](const auto& h) { return h.id != no_id; });
    CHECK(hits * 20 > static_cast<std::ptrdiff_t>(movers.size()));
    CHECK(hits < static_cast<std::ptrdiff_t>(movers.size()));
    const auto there = copy_to(on, set);
    const auto tree = make_bvh(on, there);
    check_sweep(on, tree, movers, expected);
    if constexpr (All) {
        check_sweep(on, there, movers, expected);
        check_sweep(on, quantised(on, tree), movers, expected);
        if constexpr (host_policy<Policy>) {
            check_sweep(on, wide(on, tree), movers, expected);
            check_sweep<exact>(on, tree, movers, expected);
        }
        const auto some = sweeps_by_definition(set.view(), movers, odd_sweeps_only{});
        CHECK(to_host(sweep(on, tree, shapes<swept<S>>(movers), sweep_options<odd_sweeps_only>{{}})) == some);
        // What meets anything on its way are the rows of pairs.
        std::size_t meet = 0;
        for (const auto flag : to_host(any_each(on, tree, shapes<swept<S>>(movers)))) meet += flag;
        CHECK(meet == static_cast<std::size_t>(hits));
        // The same of ways that lie apart.
        using T = scalar_type_of<S>;
        std::vector<S> starts;
        std::vector<vec3<T>> ways;
        for (const auto& m : movers) starts.push_back(m.start), ways.push_back(m.way);
        CHECK(to_host(sweep(on, tree, shapes<S>(starts), points<T>(ways))) == expected);
    }
}

template <class T>
vec3<T> on_sweep_lattice(const vec3<T>& p, bool snaps) {
    return snaps ? vec3<T>{std::round(p.x), std::round(p.y), std::round(p.z)} : p;
}

/// A mesh, or triangles of a lattice with all its ties, and movers of many kinds.
template <class T, class Policy>
void check_sweep_of_sets(const Policy& on, int movers_of_a_kind) {
    uniform random(191);
    for (const bool snaps : {false, true}) {
        CAPTURE(snaps);
        std::vector<triangle<T>> triangles;
        std::vector<capsule<T>> rods;
        for (int i = 0; i < 80; ++i) {
            const vec3<T> at = random.point<T>(-4, 4);
            const vec3<T> p = on_sweep_lattice(at, snaps), q = on_sweep_lattice(at + random.point<T>(-1.5, 1.5), snaps),
                          r = on_sweep_lattice(at + random.point<T>(-1.5, 1.5), snaps);
            triangles.push_back({p, q, r});
            if (i % 4 == 0) rods.push_back({{p, q}, snaps ? T(0.5) : static_cast<T>(random(0, 0.5))});
        }
        const triangle_soup<T> soup(triangles);
        const capsules<T> met_rods(rods);
        std::vector<swept<sphere<T>>> balls;
        std::vector<swept<capsule<T>>> characters;
        std::vector<swept<vec3<T>>> grains;
        std::vector<swept<aabb<T>>> boxes;
        for (int i = 0; i < movers_of_a_kind; ++i) {
            const vec3<T> from = on_sweep_lattice(random.point<T>(-6, 6), snaps), to = on_sweep_lattice(random.point<T>(-4, 4), snaps);
            const vec3<T> side = on_sweep_lattice(random.point<T>(-1, 1), snaps);
            const vec3<T> way = i % 9 == 0 ? vec3<T>{0, 0, 0} : i % 2 == 0 ? T(0.5) * (to - from) : to - from;
            const T radius = snaps ? static_cast<T>(random.below(3)) / 2 : static_cast<T>(random(0, 0.4));
            balls.push_back({{from, radius}, way});
            characters.push_back({{{from, from + side}, radius}, way});
            grains.push_back({from, way});
            boxes.push_back({merge(bounds(from), bounds(from + side)), way});
        }
        check_sweep_indices<true>(on, soup, balls);
        check_sweep_indices(on, soup, characters);
        check_sweep_indices(on, soup, grains);
        check_sweep_indices(on, soup, boxes);
        check_sweep_indices(on, met_rods, characters);
        const auto tree = make_bvh(on, soup);
        for (std::uint64_t k = 0; k < 4; ++k) {
            draws d(sample_seed, 96, k);
            const rigid<T> pose = k % 2 == 0 ? make_pose<T>(d, 10) : make_loose_pose<T>(d, 1000);
            CAPTURE(k);
            const posed_view<typename triangle_soup<T>::view_type> placed{soup.view(), pose};
            auto moved = characters;
            rigid<T> turn = pose;
            turn.translation = {0, 0, 0};
            for (auto& m : moved) m = {place(pose, m.start), place(turn, m.way)};
            const auto expected = sweeps_by_definition(placed, moved);
            check_sweep(on, posed(tree, pose), moved, expected);
        }
    }
}

/// Balls on their ways among triangles of a lattice, with ties.
struct sweep_scene {
    std::vector<triangle<float>> triangles;
    std::vector<swept<sphere<float>>> balls;

    sweep_scene(std::size_t faces, std::size_t movers) {
        uniform random(197);
        const auto place = [&](float far) { return on_sweep_lattice(random.point<float>(-far, far), true); };
        for (std::size_t i = 0; i < faces; ++i) {
            const vec3<float> p = place(4);
            triangles.push_back({p, p + place(1.5f), p + place(1.5f)});
        }
        for (std::size_t i = 0; i < movers; ++i) {
            const vec3<float> from = place(6);
            balls.push_back({{from, static_cast<float>(random.below(3)) / 2}, place(4) - from});
        }
    }
};

/// At the ends of the range, where squares overflow and are flushed.
template <class T, class Policy>
void check_sweep_scales(const Policy& on) {
    uniform random(193);
    const T largest = std::numeric_limits<T>::max(), smallest = std::numeric_limits<T>::min();
    for (const T scale : {largest / 16, smallest * 64, smallest / 64}) {
        CAPTURE(scale);
        const auto point = [&] { return scale * random.point<T>(-4, 4); };
        std::vector<triangle<T>> triangles;
        for (int i = 0; i < 12; ++i) {
            const vec3<T> a = point();
            triangles.push_back({a, T(0.5) * a + T(0.5) * point(), T(0.5) * a + T(0.5) * point()});
        }
        std::vector<swept<sphere<T>>> movers;
        for (std::size_t i = 0; i < 16; ++i) {
            const vec3<T> from = point();
            movers.push_back({{from, scale / 8}, T(0.5) * (triangles[random.below(triangles.size())].a - from)});
        }
        const triangle_soup<T> soup(triangles);
        const auto expected = sweeps_by_definition(soup.view(), movers);
        CHECK(std::count_if(expected.begin(), expected.end(), [](const auto& h) { return h.id != no_id; }) > 0);
        check_sweep(on, make_bvh(on, soup), movers, expected);
    }
}

/// Balls of a lattice that begin in contact, and others: contacts are those of `contacts` for what the sweep found at 0.
template <class Policy>
void check_start_contacts(const Policy& on) {
    const sweep_scene scene(60, 200);
    const auto soup = copy_to(on, triangle_soup<float>(scene.triangles));
    const auto tree = make_bvh(on, soup);
    const shapes<swept<sphere<float>>> movers(scene.balls);
    const auto found = sweep(on, tree, movers);
    const auto hits = to_host(found);
    const auto contacts_at_start = to_host(start_contacts(on, found, tree, movers));
    REQUIRE(contacts_at_start.size() == hits.size());
    std::size_t touching = 0;
    for (std::uint32_t i = 0; i < hits.size(); ++i) {
        contact<float> expected{i, no_id, {0, 0, 0}, {0, 0, 0}, 0};
        for (std::uint32_t k = 0; k < scene.triangles.size() && expected.b == no_id; ++k) {
            const auto c = contact_of<exact>(scene.balls[i].start, scene.triangles[k]);
            if (c) expected = {i, k, c->point, c->normal, c->depth};
        }
        touching += expected.b != no_id ? 1 : 0;
        CAPTURE(i, hits[i].id, hits[i].t);
        CHECK(contacts_at_start[i] == expected);
    }
    CHECK(touching > 10);
    CHECK(touching < hits.size());
    // What is touched so soon that the time is rounded to 0 is no contact at the start.
    const float tiny = std::numeric_limits<float>::denorm_min();
    const auto floor = copy_to(on, triangle_soup<float>{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}});
    const auto fast_one = moving(sphere<float>{{0, 0, tiny}, 0}, vec3<float>{0, 0, -16});
    const auto soon = sweep(on, floor, fast_one);
    CHECK((to_host(soon)[0].id == 0 && to_host(soon)[0].t == 0));
    CHECK(to_host(start_contacts(on, soon, floor, fast_one))[0].b == no_id);
    try {
        (void)start_contacts(on, found, floor, movers);
        FAIL_CHECK("hits of other shapes were taken");
    } catch (const error& e) {
        CHECK(std::string(e.what()).find("of none of the 1 shapes") != std::string::npos);
    }
}

}  // namespace abut::test
