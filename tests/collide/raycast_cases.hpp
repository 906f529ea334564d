// SPDX-License-Identifier: MIT
#pragma once

// What `raycast` promises on every policy: of each ray or segment the triangle that it meets first, as times are computed
// for one pair, and of equal times the least id; the same bits whatever the index, its layout and the pose. And
// `raycast_all` and `raycast_any` of all of them. The truth is a plain loop over all triangles; that one pair is right is
// tests/narrow's matter. And that nothing slips through a closed mesh.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

/// By definition.
template <shape_view Shapes, class Line>
auto hits_by_definition(const Shapes& shapes, const std::vector<Line>& lines) {
    using T = scalar_type_of<Line>;
    std::vector<ray_hit<T>> all;
    for (const Line& line : lines) {
        double least = std::numeric_limits<double>::infinity();
        ray_hit<T> first{no_id, std::numeric_limits<T>::infinity()};
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            const double time = detail::hit_time<exact>(line, shapes[i]);
            if (!(time >= 0 && time < least)) continue;
            least = time;
            const double most = static_cast<double>(std::numeric_limits<T>::max());
            first = {static_cast<std::uint32_t>(i), static_cast<T>(std::min(time, most))};
        }
        all.push_back(first);
    }
    return all;
}

template <arithmetic A = filtered, class Policy, class X, class Line, class T>
void check_hits(const Policy& on, const X& index, const std::vector<Line>& lines, const std::vector<ray_hit<T>>& expected) {
    const auto found = to_host(raycast<A>(on, index, shapes<Line>(lines)));
    REQUIRE(found.size() == expected.size());
    const auto wrong = std::mismatch(found.begin(), found.end(), expected.begin());
    if (wrong.first == found.end()) {
        SUCCEED();
        return;
    }
    CAPTURE(wrong.first - found.begin(), wrong.first->id, wrong.second->id, wrong.first->t, wrong.second->t);
    FAIL_CHECK("another answer than by definition");
}

template <shape_view Shapes, class Line>
auto all_hits_by_definition(const Shapes& shapes, const std::vector<Line>& lines) {
    using T = scalar_type_of<Line>;
    std::vector<hit_of_ray<T>> all;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        std::vector<std::pair<double, std::uint32_t>> mine;
        for (std::uint32_t i = 0; i < shapes.size(); ++i) {
            const double time = detail::hit_time<exact>(lines[k], shapes[i]);
            if (time >= 0) mine.emplace_back(time, i);
        }
        std::sort(mine.begin(), mine.end());
        const double most = static_cast<double>(std::numeric_limits<T>::max());
        for (const auto& [time, id] : mine) {
            all.push_back({static_cast<std::uint32_t>(k), id, static_cast<T>(std::min(time, most))});
        }
    }
    return all;
}
/// What rays meet of all that there is, in order, and whether they meet anything.
template <arithmetic A = filtered, class Policy, class X, shape_view Shapes, class Line>
void check_all_hits(const Policy& on, const X& index, const Shapes& shapes_there, const std::vector<Line>& lines) {
    const auto expected = all_hits_by_definition(shapes_there, lines);
    const shapes<Line> made(lines);
    const auto found = to_host(raycast_all<A>(on, index, made));
    REQUIRE(found.size() == expected.size());
    const auto wrong = std::mismatch(found.begin(), found.end(), expected.begin());
    if (wrong.first != found.end()) {
        CAPTURE(wrong.first->ray, wrong.first->id, wrong.second->ray, wrong.second->id, wrong.first->t, wrong.second->t);
        FAIL_CHECK("another order than by definition");
    }
    std::vector<std::uint8_t> met(lines.size(), 0);
    for (const auto& hit : expected) met[hit.ray] = 1;
    CHECK(to_host(raycast_any<A>(on, index, made)) == met);
    CHECK(expected.size() * 2 > lines.size());
}

/// Lines that are aimed at corners, sides and the insides of triangles, and at nothing.
template <class T, shape_view Shapes>
std::vector<ray<T>> rays_at(const Shapes& shapes, std::size_t n, uniform& random, double half) {
    std::vector<ray<T>> lines;
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> origin = random.point<T>(-half, half);
        const triangle<T> t = shapes[random.below(shapes.size())];
        const vec3<T> target = i % 5 == 0 ? t.a : i % 5 == 1 ? T(0.5) * (t.a + t.b) : i % 5 == 2 ? T(0.25) * (t.a + t.b + t.c + t.c)
                                                                              : random.point<T>(-half, half);
        lines.push_back({origin, target - origin});
        if (i % 11 == 0) lines.back().direction.x = 0;
        if (i % 13 == 0) lines.back().direction.y = lines.back().direction.z = 0;
    }
    lines.push_back({shapes[0].a, {0, 0, 0}});
    lines.push_back({random.point<T>(-half, half), {0, 0, 0}});
    return lines;
}
template <class T>
std::vector<segment<T>> as_segments(const std::vector<ray<T>>& rays) {
    std::vector<segment<T>> lines;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const T share = i % 3 == 0 ? T(0.5) : i % 3 == 1 ? T(1) : T(2);
        lines.push_back({rays[i].origin, rays[i].origin + share * rays[i].direction});
    }
    return lines;
}
template <class T>
double share_of_hits(const std::vector<ray_hit<T>>& hits) {
    return static_cast<double>(std::count_if(hits.begin(), hits.end(), [](const auto& h) { return h.id != no_id; })) /
           static_cast<double>(hits.size());
}

template <class Line, class Policy, class Set>
void check_indices(const Policy& on, const Set& set, const std::vector<Line>& lines) {
    const auto expected = hits_by_definition(set.view(), lines);
    CHECK(share_of_hits(expected) > 0.1);
    CHECK(share_of_hits(expected) < 0.99);
    const auto there = copy_to(on, set);
    const auto tree = make_bvh(on, there);
    check_hits(on, there, lines, expected);
    check_hits(on, tree, lines, expected);
    check_hits<exact>(on, tree, lines, expected);
    check_all_hits(on, tree, set.view(), lines);
    check_hits(on, quantised(on, tree), lines, expected);
    if constexpr (host_policy<Policy>) check_hits(on, wide(on, tree), lines, expected);
}

template <class T, class Policy>
void check_raycast(const Policy& on) {
    uniform random(91);
    for (const bool on_lattice : {false, true}) {
        CAPTURE(on_lattice);
        std::vector<triangle<T>> triangles;
        for (int i = 0; i < 150; ++i) {
            const vec3<T> at = random.point<T>(-2, 2);
            triangle<T> t{at, at + random.point<T>(-0.7, 0.7), at + random.point<T>(-0.7, 0.7)};
            const auto snapped = [](const vec3<T>& p) { return vec3<T>{std::round(p.x), std::round(p.y), std::round(p.z)}; };
            if (on_lattice) t = {snapped(t.a), snapped(t.b), snapped(t.c)};
            triangles.push_back(t);
        }
        const triangle_soup<T> soup(triangles);
        auto rays = rays_at<T>(soup.view(), 300, random, 3);
        if (on_lattice) {
            for (auto& r : rays) {
                r.origin = {std::round(r.origin.x), std::round(r.origin.y), std::round(r.origin.z)};
                r.direction = {std::round(r.direction.x), std::round(r.direction.y), std::round(r.direction.z)};
            }
        }
        check_indices(on, soup, rays);
        check_indices(on, soup, as_segments(rays));
        const auto tree = make_bvh(on, soup);
        for (std::uint64_t k = 0; k < 12; ++k) {
            draws d(sample_seed, 95, k);
            const rigid<T> pose = k % 2 == 0 ? make_pose<T>(d, 10) : make_loose_pose<T>(d, 1000);
            CAPTURE(k);
            const posed_view<typename triangle_soup<T>::view_type> placed{soup.view(), pose};
            auto moved = rays;
            rigid<T> turn = pose;
            turn.translation = {0, 0, 0};
            for (auto& r : moved) r = {place(pose, r.origin), place(turn, r.direction)};
            const auto expected = hits_by_definition(placed, moved);
            check_hits(on, posed(tree, pose), moved, expected);
            check_hits(on, posed(soup, pose), moved, expected);
            if (k < 4) check_all_hits(on, posed(tree, pose), placed, moved);
        }
    }
}

/// Many triangles that a line meets at nearly one time, or at one: planes a few units of the last place apart, each in several
/// orders of its corners. In doubles times are told apart, or not, by the last bit.
template <class T, class Policy>
void check_near_times(const Policy& on) {
    uniform random(96);
    std::vector<triangle<T>> triangles;
    const T step = std::numeric_limits<T>::epsilon() / 2;
    for (int i = 0; i < 60; ++i) {
        const T z = 1 - step * static_cast<T>(random.below(4));
        const triangle<T> t{{T(-3), random.below(2) == 0 ? T(-1) : T(-2), z}, {T(3), T(-1), z + step}, {T(0), T(4), z}};
        triangles.push_back(i % 3 == 0 ? triangle<T>{t.b, t.c, t.a} : i % 3 == 1 ? triangle<T>{t.c, t.b, t.a} : t);
    }
    const triangle_soup<T> soup(triangles);
    std::vector<ray<T>> rays;
    for (int i = 0; i < 200; ++i) rays.push_back({random.point<T>(-0.3, 0.3), random.point<T>(-0.3, 0.3) + vec3<T>{0, 0, 1}});
    rays.push_back({{0, 0, 0}, {0, 0, -1}});
    const auto expected = hits_by_definition(soup.view(), rays);
    const auto tree = make_bvh(on, copy_to(on, soup));
    check_hits(on, tree, rays, expected);
    check_hits<exact>(on, tree, rays, expected);
    check_hits(on, copy_to(on, soup), as_segments(rays), hits_by_definition(soup.view(), as_segments(rays)));
    if constexpr (host_policy<Policy>) {
        check_hits(on, wide(on, tree), rays, expected);
        // Who compares them with times of other parts needs them as doubles.
        const shapes<ray<T>> lines(rays);
        const auto both = detail::bring_lines_and_shapes(on, tree, lines, "test");
        detail::look_for_first_hits<filtered>(on, both, false, [&](const execution::least_value* found) {
            std::size_t wrong = 0;
            for (std::size_t i = 0; i + 1 < rays.size(); ++i) {
                REQUIRE(expected[i].id != no_id);
                wrong += found[i].key != expected[i].id ||
                         found[i].value != detail::hit_time<exact>(rays[i], triangles[expected[i].id]);
            }
            CHECK(wrong == 0);
        });
    }
}

/// A closed mesh, from within to its corners and to the middles of its sides, which need not be representable, and along
/// axes.
template <class T, class Policy>
void check_watertight(const Policy& on) {
    const auto data = ball_surface<T>(3, 1);
    const mesh<T> ball(data.vertices, data.faces);
    const auto tree = make_bvh(on, ball);
    uniform random(92);
    std::vector<ray<T>> rays;
    for (const face& f : data.faces) {
        const vec3<T> o = random.point<T>(-0.3, 0.3);
        const auto &a = data.vertices[f[0]], &b = data.vertices[f[1]];
        rays.push_back({o, a - o});
        rays.push_back({o, T(1.0 / 3) * (a - o) + T(0.5) * (b - o)});
        rays.push_back({{0, 0, 0}, a + b});
    }
    const auto hits = to_host(raycast(on, tree, shapes<ray<T>>(rays)));
    CHECK(share_of_hits(hits) == 1);
    const auto seen = hits_by_definition(ball.view(), std::vector<ray<T>>(rays.begin(), rays.begin() + 60));
    CHECK(std::equal(seen.begin(), seen.end(), hits.begin()));
    // From a corner outwards nothing but what lies at the corner is met, at time 0.
    std::vector<ray<T>> outwards;
    for (const vec3<T>& p : data.vertices) outwards.push_back({p, p});
    for (const auto& hit : to_host(raycast(on, tree, shapes<ray<T>>(outwards)))) CHECK((hit.id != no_id && hit.t == 0));
}

/// At the ends of the range, where products and differences overflow and are flushed.
template <class T, class Policy>
void check_raycast_scales(const Policy& on) {
    uniform random(93);
    const T largest = std::numeric_limits<T>::max(), smallest = std::numeric_limits<T>::min();
    for (const T scale : {largest / 8, smallest * 64, smallest, smallest / 1024, T(1e-20), T(1e20)}) {
        CAPTURE(scale);
        std::vector<triangle<T>> triangles;
        const auto point = [&] { return scale * random.point<T>(-4, 4); };
        for (int i = 0; i < 60; ++i) {
            const vec3<T> a = point();
            triangles.push_back({a, T(0.75) * a + T(0.25) * point(), T(0.75) * a + T(0.25) * point()});
        }
        const triangle_soup<T> soup(triangles);
        std::vector<ray<T>> rays;
        for (std::size_t i = 0; i < 60; ++i) {
            const triangle<T>& t = triangles[random.below(triangles.size())];
            const vec3<T> o = point(), target = T(0.5) * t.a + T(0.25) * (t.b + t.c);
            const T length = i % 3 == 0 ? T(1) : T(0.25) / scale;
            const vec3<T> way = T(0.5) * target - T(0.5) * o;
            rays.push_back({o, std::isfinite(length) && std::isfinite(length * way.x) ? length * way : way});
        }
        const auto expected = hits_by_definition(soup.view(), rays);
        CHECK(share_of_hits(expected) > 0.3);
        check_hits(on, make_bvh(on, soup), rays, expected);
        check_all_hits(on, make_bvh(on, soup), soup.view(), rays);
        check_hits(on, quantised(on, make_bvh(on, soup)), rays, expected);
    }
}

}  // namespace abut::test
