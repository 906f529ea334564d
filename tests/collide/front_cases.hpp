// SPDX-License-Identifier: MIT
#pragma once

// Queries that begin at a front find what the same queries find without, on every policy, whatever moves from frame to
// frame: little, much, trees that are built anew, other trees, poses, fronts with too little room.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/front.hpp>
#include <abut/experimental/impact_fronts.hpp>

#include "collide/query_cases.hpp"
#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

template <class Filter = keep_all, schedule Schedule = schedule::shared_list>
using begun_at = query_options<Filter, traversal::from_front, Schedule>;
using self_begun_at = self_options<keep_all, traversal::from_front>;

/// Triangles that move.
template <class T>
struct crowd {
    std::vector<triangle<T>> triangles;

    /// Each corner by up to `step`, or all far away.
    void move(double step, bool jump, uniform& random) {
        const vec3<T> far = jump ? random.point<T>(-2, 2) : vec3<T>{};
        for (triangle<T>& t : triangles) {
            const vec3<T> by = random.point<T>(-step, step) + far;
            t = {t.a + by, t.b + by, t.c + by};
        }
    }
    [[nodiscard]] triangle_soup<T> soup() const { return triangle_soup<T>(triangles); }
};

template <class T>
crowd<T> small_crowd(std::size_t n, uniform& random) {
    crowd<T> made;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> at = random.point<T>(-1, 1);
        const auto corner = [&] { return at + random.point<T>(-0.2, 0.2); };
        const vec3<T> a = corner(), b = corner(), c = corner();
        made.triangles.push_back({a, b, c});
    }
    return made;
}

/// What was seen in all frames, so that a test can say that it tested something.
struct front_tally {
    std::uint64_t pairs = 0, opened = 0, kept = 0, rebuilds = 0, queries = 0, overflows = 0, moved_on = 0;

    void add(const front_report& now, std::uint64_t found) {
        pairs += found;
        moved_on += now.queries > queries && now.rebuilds == rebuilds ? 1 : 0;
        opened += now.opened;
        kept += now.kept;
        rebuilds = now.rebuilds;
        queries = now.queries;
        overflows = now.overflows;
    }
};

/// Counts pairs where a device may.
template <class Policy, class X, class Y>
std::uint64_t visited_from(const Policy& on, const X& x, const Y& y, front& ends, std::size_t n, std::size_t m,
                           const pair_list& expected) {
    check_each_visited(on, x, y, n, m, expected, begun_at<>{.front = &ends});
    return expected.size();
}

/// Frames of two crowds, of which the first moves. In some all is far away, in some its tree is built anew. The kind of
/// query changes with the frame; the front stays.
template <class T, class Policy>
front_tally check_two_crowds(const Policy& on, std::size_t n, std::size_t m, int frames, const front_options& options) {
    uniform random(20270401 + n + m);
    crowd<T> a = small_crowd<T>(n, random);
    const crowd<T> b = small_crowd<T>(m, random);
    const auto still = make_bvh(on, copy_to(on, b.soup()));
    auto tree = make_bvh(on, copy_to(on, a.soup()));
    front ends(options);
    front_tally seen;
    for (int frame = 0; frame < frames; ++frame) {
        CAPTURE(n, m, frame);
        const double step = frame % 3 == 0 ? 0.0 : frame % 7 == 0 ? 0.3 : 0.01;
        a.move(step, frame % 50 == 49, random);
        if (frame % 50 == 0) a = small_crowd<T>(n, random);
        const auto moved = copy_to(on, a.soup());
        tree = frame % 97 == 96 ? make_bvh(on, moved) : refit(on, tree, moved);
        const auto expected = to_host(pairs(on, tree, still));
        const begun_at<> from{.front = &ends};
        switch (frame % 6) {
            case 1: CHECK(count(on, tree, still, from) == expected.size()); break;
            case 2: CHECK(any(on, tree, still, from) == !expected.empty()); break;
            case 3: {
                pair_list kept;
                for (const index_pair& p : expected) {
                    if (id_filter{}(p.a, p.b)) kept.push_back(p);
                }
                CHECK(to_host(pairs(on, tree, still, begun_at<id_filter>{.front = &ends})) == kept);
                break;
            }
            case 4: visited_from(on, tree, still, ends, n, m, expected); break;
            default: CHECK(to_host(pairs(on, tree, still, from)) == expected);
        }
        seen.add(ends.report(), expected.size());
    }
    return seen;
}

template <class Policy>
void check_fronts_of_two(const Policy& on, int frames) {
    for (const auto& [n, m] : {std::pair(0u, 0u), std::pair(0u, 5u), std::pair(1u, 7u), std::pair(9u, 1u)}) {
        const front_tally seen = check_two_crowds<float>(on, n, m, 10, {});
        CHECK(seen.queries == 0);
    }
    for (const auto& [n, m] : {std::pair(2, 2), std::pair(2, 40), std::pair(33, 3), std::pair(120, 80)}) {
        const front_tally seen =
            check_two_crowds<float>(on, static_cast<std::size_t>(n), static_cast<std::size_t>(m), frames, {});
        CHECK(seen.queries == static_cast<std::uint64_t>(frames));
        CHECK(seen.moved_on > static_cast<std::uint64_t>(frames) / 2);
        CHECK(seen.rebuilds > 1);
        if (n * m > 100) {
            CHECK(seen.pairs > 0);
            CHECK(seen.opened > 0);
            CHECK(seen.kept > seen.opened);
        }
    }
    // Never back to the roots but for another tree.
    const front_tally deep = check_two_crowds<float>(on, 90, 60, frames, {.reference_frames = 0, .most_growth = 1e9});
    CHECK(deep.rebuilds == static_cast<std::uint64_t>(1 + frames / 97));
    CHECK(deep.opened > 0);
    // Too little room, now and then or always.
    for (const std::size_t most : {0u, 1u}) {
        const front_tally none = check_two_crowds<float>(on, 90, 60, frames / 4, {.most_items = most});
        CHECK(none.overflows > 0);
    }
    const front_tally some = check_two_crowds<float>(on, 90, 60, frames, {.most_items = 800, .reference_frames = 3});
    INFO(some.overflows << " of " << frames << ", " << some.moved_on);
    CHECK(some.overflows > 0);
    CHECK(some.moved_on > 0);
}

/// A torus that is bent and twisted, and of which parts pass through each other.
template <class T>
mesh<T> bent_torus(std::uint32_t around, std::uint32_t across, double time) {
    torus<T> t(around, across, 1, 0.4);
    for (vec3<T>& p : t.vertices) {
        const double x = p.x, y = p.y, z = p.z, s = std::sin(time), turn = 2 * s * y;
        p = {static_cast<T>(std::cos(turn) * x * (1 - 0.9 * std::abs(s)) - std::sin(turn) * z),
             static_cast<T>(y + 0.3 * s * x * x), static_cast<T>(std::sin(turn) * x + std::cos(turn) * z)};
    }
    return {t.vertices, t.faces};
}

template <class Policy>
void check_fronts_of_one(const Policy& on, int frames) {
    using T = float;
    constexpr std::uint32_t around = 24, across = 10;
    const auto at = [&](double time) { return copy_to(on, bent_torus<T>(around, across, time)); };
    auto tree = make_bvh(on, at(0));
    front ends, of_two;
    front_tally seen;
    double time = 0;
    for (int frame = 0; frame < frames; ++frame) {
        CAPTURE(frame, time);
        time += frame % 40 == 39 ? 1.3 : 0.01;
        tree = frame % 131 == 130 ? make_bvh(on, at(time)) : refit(on, tree, at(time));
        const auto expected = to_host(self_pairs(on, tree));
        if (frame % 3 == 1) {
            CHECK(count_self_pairs(on, tree, self_begun_at{.front = &ends}) == expected.size());
        } else {
            CHECK(to_host(self_pairs(on, tree, self_begun_at{.front = &ends})) == expected);
        }
        seen.add(ends.report(), expected.size());
        // The same tree twice is another pair than the tree with itself.
        if (frame % 20 == 0) {
            CHECK(count(on, tree, tree, begun_at<>{.front = &of_two}) == count(on, tree, tree));
            const std::uint64_t before = of_two.report().rebuilds;
            CHECK(to_host(self_pairs(on, tree, self_begun_at{.front = &of_two})) == expected);
            CHECK(of_two.report().rebuilds == before + 1);
        }
    }
    CHECK(seen.pairs > 0);
    CHECK(seen.opened > 0);
    CHECK(seen.rebuilds > 1);
    CHECK(seen.moved_on > static_cast<std::uint64_t>(frames) / 2);
}

/// Poses may change with a front, and so may which tree comes first, which is another front.
template <class Policy>
void check_fronts_posed(const Policy& on) {
    const auto tree = make_bvh(on, copy_to(on, bent_torus<float>(20, 8, 0.2)));
    const auto other = make_bvh(on, copy_to(on, bent_torus<float>(16, 8, 0)));
    front ends;
    std::uint64_t found = 0;
    for (int frame = 0; frame < 60; ++frame) {
        CAPTURE(frame);
        rigid<float> pose;
        pose.translation = {0.03f * static_cast<float>(frame), 0.1f, frame == 30 ? 9.0f : 0.0f};
        const auto expected = to_host(pairs(on, tree, posed(other, pose)));
        CHECK(to_host(pairs(on, tree, posed(other, pose), begun_at<>{.front = &ends})) == expected);
        found += expected.size();
    }
    CHECK(found > 100);
    const front_report before = ends.report();
    CHECK(before.rebuilds < 20);
    CHECK(to_host(pairs(on, other, tree, begun_at<>{.front = &ends})) == to_host(pairs(on, other, tree)));
    CHECK(ends.report().rebuilds == before.rebuilds + 1);
    CHECK(ends.report().kept == 0);
    CHECK(ends.report().items > 0);
    CHECK(ends.report().added == ends.report().items);
    CHECK(count(on, other, tree, begun_at<>{.front = &ends}) == count(on, other, tree));
    CHECK(ends.report().kept == ends.report().items);
    CHECK(ends.report().opened == 0);
    CHECK(ends.report().added == 0);
    ends.clear();
    CHECK(ends.report().items == 0);
    CHECK(count(on, other, tree, begun_at<>{.front = &ends}) == count(on, other, tree));
    CHECK(ends.report().rebuilds == before.rebuilds + 2);
}

/// What has no front does without: sets, grids, one shape.
template <class Policy>
void check_fronts_elsewhere(const Policy& on) {
    uniform random(20270402);
    const auto a = copy_to(on, small_crowd<float>(60, random).soup());
    const auto b = copy_to(on, small_crowd<float>(50, random).soup());
    const auto tree = make_bvh(on, a), expected = make_bvh(on, b);
    const auto truth = to_host(pairs(on, tree, expected));
    CHECK(truth.size() > 3);
    front ends;
    const begun_at<> from{.front = &ends};
    CHECK(to_host(pairs(on, tree, b, from)) == truth);
    CHECK(to_host(pairs(on, a, b, from)) == truth);
    CHECK(to_host(pairs(on, make_grid(on, a), b, from)) == truth);
    CHECK(ends.report().queries == 0);
    CHECK_THROWS_AS(pairs(on, tree, expected, begun_at<>{}), error);
    CHECK_THROWS_AS(self_pairs(on, tree, self_begun_at{}), error);
}

template <class Policy>
void check_fronts_of_impacts(const Policy& on, int frames) {
    constexpr std::uint32_t around = 12, across = 6;
    const auto at = [&](double time) { return copy_to(on, bent_torus<float>(around, across, time)); };
    const auto step_at = [&](double time, double step) { return moving(at(time), at(time + step)); };
    torus<float> ball(8, 6, 0.2, 0.15);
    const auto ground = make_impact_index(on, copy_to(on, mesh<float>(ball.vertices, ball.faces)));
    auto index = make_impact_index(on, step_at(0, 0.01));
    impact_fronts within, between;
    std::size_t found = 0;
    double time = 0;
    for (int frame = 0; frame < frames; ++frame) {
        CAPTURE(frame, time);
        const double step = frame % 17 == 16 ? 0.8 : 0.02;
        index = refit(on, index, step_at(time, step));
        const auto self = to_host(self_impacts(on, index));
        CHECK(to_host(self_impacts(on, index, {}, within)) == self);
        const auto both = to_host(impacts(on, index, ground));
        CHECK(to_host(impacts(on, index, ground, {}, between)) == both);
        CHECK(first_impact(on, index, ground, {}, between) == first_impact(on, index, ground));
        if (frame % 5 == 0) {
            const impact_options near{.bounds = {.separation = 0.05}};
            CHECK(to_host(impacts<conservative>(on, index, ground, near, between)) ==
                  to_host(impacts<conservative>(on, index, ground, near)));
        }
        found += self.size() + both.size();
        time += step;
    }
    CHECK(found > 0);
    CHECK(within.face_vertex.report().queries == 0);
    for (const front* ends : {&within.vertex_face, &within.edge_edge, &between.vertex_face, &between.face_vertex,
                              &between.edge_edge}) {
        CHECK(ends->report().queries >= static_cast<std::uint64_t>(frames));
        CHECK(ends->report().rebuilds < ends->report().queries / 2);
    }
}

/// Schedules of the walk down.
template <class Policy>
void check_fronts_by_schedule(const Policy& on) {
    uniform random(20270403);
    crowd<float> a = small_crowd<float>(400, random);
    const auto still = make_bvh(on, copy_to(on, small_crowd<float>(300, random).soup()));
    auto tree = make_bvh(on, copy_to(on, a.soup()));
    front ends;
    for (int frame = 0; frame < 12; ++frame) {
        a.move(0.05, false, random);
        tree = refit(on, tree, copy_to(on, a.soup()));
        const begun_at<keep_all, schedule::work_stealing> from{.front = &ends};
        CHECK(to_host(pairs(on, tree, still, from)) == to_host(pairs(on, tree, still)));
    }
    CHECK(ends.report().rebuilds < 12);
}

/// More pairs than a device's queue has room for at first: it is enlarged, and the loops run again.
template <class Policy>
void check_fronts_of_many_pairs(const Policy& on) {
    const auto balls = [&](double x) {
        std::vector<vec3<float>> centers;
        for (int i = 0; i < 500; ++i) centers.push_back({static_cast<float>(x + 0.001 * i), 0, 0});
        return make_bvh(on, equal_spheres<float, space_of<Policy>>(on, std::span<const vec3<float>>(centers), 1));
    };
    const auto a = balls(0), b = balls(0.25);
    constexpr std::size_t all = 500 * 500;
    front between, within;
    for (int time = 0; time < 2; ++time) {
        CAPTURE(time);
        CHECK(pairs(on, a, b, begun_at<>{.front = &between}).size() == all);
        CHECK(self_pairs(on, a, self_begun_at{.front = &within}).size() == 500 * 499 / 2);
    }
    CHECK(between.report().rebuilds == 1);
    CHECK(within.report().rebuilds == 1);
}

template <class Policy>
void check_fronts(const Policy& on, int frames) {
    check_fronts_of_many_pairs(on);
    check_fronts_of_two(on, frames);
    check_fronts_of_one(on, frames / 2);
    check_fronts_posed(on);
    check_fronts_elsewhere(on);
    check_fronts_of_impacts(on, frames / 8);
    check_fronts_by_schedule(on);
}

}  // namespace abut::test
