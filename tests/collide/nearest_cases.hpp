// SPDX-License-Identifier: MIT
#pragma once

// What `nearest` promises on every policy: of each point the shape with the least squared distance, as it is computed for
// one pair, and of equal ones the least id; the same bits whatever the index, its layout, its builder, the pose, the number
// of points and their order. The truth is a plain loop over all shapes; that one pair is right is tests/narrow's matter.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/leafless.hpp>

#include "collide/set_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// By definition, with the unit that the call takes.
template <shape_view Shapes, class T>
std::vector<neighbor<T>> nearest_by_definition(const Shapes& shapes, const std::vector<vec3<T>>& points,
                                               const detail::length_unit<T>& unit) {
    std::vector<neighbor<T>> all;
    for (const vec3<T>& p : points) {
        neighbor<T> best{no_id, p, std::numeric_limits<T>::infinity()};
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            const auto shape = shapes[i];
            const vec3<double> way = detail::way_from(p, shape, unit);
            const double square = detail::plain_dot(way, way);
            if (!(square < least)) continue;
            least = square;
            best = {static_cast<std::uint32_t>(i), detail::end_of_way(shape, p, way, unit),
                    static_cast<T>(unit.length(std::sqrt(square)))};
        }
        all.push_back(best);
    }
    return all;
}

/// The few nearest by definition, in their order.
template <shape_view Shapes, class T>
std::vector<neighbor<T>> nearest_few_by_definition(const Shapes& shapes, const std::vector<vec3<T>>& points,
                                                   const detail::length_unit<T>& unit, std::size_t count) {
    std::vector<neighbor<T>> all;
    for (const vec3<T>& p : points) {
        std::vector<std::pair<double, std::uint32_t>> squares;
        for (std::uint32_t i = 0; i < shapes.size(); ++i) squares.emplace_back(detail::squared_distance(p, shapes[i], unit), i);
        std::sort(squares.begin(), squares.end());
        for (std::size_t k = 0; k < count; ++k) {
            all.push_back({no_id, p, std::numeric_limits<T>::infinity()});
            if (k >= squares.size()) continue;
            const auto [square, id] = squares[k];
            const vec3<double> way = detail::way_from(p, shapes[id], unit);
            all.back() = {id, detail::end_of_way(shapes[id], p, way, unit), static_cast<T>(unit.length(std::sqrt(square)))};
        }
    }
    return all;
}

/// A unit for all of it. (Bits do not depend on which, as long as nothing underflows.)
template <shape_view Shapes, class T>
detail::length_unit<T> unit_of_all(const Shapes& shapes, const std::vector<vec3<T>>& points) {
    aabb<T> box = empty_box<T>();
    for (std::size_t i = 0; i < shapes.size(); ++i) box = merge(box, bounds(shapes[i]));
    for (const vec3<T>& p : points) box = merge(box, bounds(p));
    return detail::unit_for(box, box.lower);
}

template <class Policy, class X, class Points, class T>
void check_answers(const Policy& on, const X& index, const Points& points, const std::vector<neighbor<T>>& expected) {
    const auto found = to_host(nearest(on, index, points));
    REQUIRE(found.size() == expected.size());
    const auto wrong = std::mismatch(found.begin(), found.end(), expected.begin());
    if (wrong.first == found.end()) {
        SUCCEED();
        return;
    }
    const auto &f = *wrong.first, &e = *wrong.second;
    CAPTURE(wrong.first - found.begin(), f.id, e.id, f.distance, e.distance, f.point.x, e.point.x, f.point.y, e.point.y);
    FAIL_CHECK("another answer than by definition");
}

/// A set by brute force and by each index.
template <class Policy, class Set, class T>
void check_nearest(const Policy& on, const Set& set, const std::vector<vec3<T>>& points) {
    CAPTURE(set.size(), points.size());
    const auto there = copy_to(on, set);
    const auto expected = nearest_by_definition(set.view(), points, unit_of_all(set.view(), points));
    check_answers(on, there, points, expected);
    check_answers(on, make_bvh(on, there), points, expected);
    check_answers(on, make_grid(on, there), points, expected);
}

/// By trees of all layouts and builders.
template <class Policy, class Set, class T>
void check_nearest_by_trees(const Policy& on, const Set& set, const std::vector<vec3<T>>& points) {
    const auto there = copy_to(on, set);
    const auto expected = nearest_by_definition(set.view(), points, unit_of_all(set.view(), points));
    const auto tree = make_bvh(on, there);
    check_answers(on, quantised(on, tree), points, expected);
    check_answers(on, leafless(on, tree), points, expected);
    check_answers(on, oriented(on, tree), points, expected);
    check_answers(on, make_bvh(on, there, {.builder = bvh_builder::ploc}), points, expected);
    if constexpr (host_policy<Policy>) {
        check_answers(on, wide(on, tree), points, expected);
        check_answers(on, make_bvh(on, there, {.builder = bvh_builder::sah}), points, expected);
        check_answers(on, make_bvh(on, there, {.builder = bvh_builder::mean_split}), points, expected);
    }
}

template <class Policy, class Set, class T>
void check_nearest_posed(const Policy& on, const Set& set, const std::vector<vec3<T>>& points, const rigid<T>& pose) {
    const auto there = copy_to(on, set);
    const posed_view<typename Set::view_type> placed{set.view(), pose};
    const auto expected = nearest_by_definition(placed, points, unit_of_all(placed, points));
    check_answers(on, posed(there, pose), points, expected);
    check_answers(on, posed(make_bvh(on, there), pose), points, expected);
    check_answers(on, posed(make_grid(on, there), pose), points, expected);
    if constexpr (std::same_as<typename Set::shape_type, triangle<T>>)
        check_answers(on, posed(oriented(on, make_bvh(on, there)), pose), points, expected);
}

/// Points in and around a box of side 2, and on what is there.
template <class T>
std::vector<vec3<T>> points_around(std::size_t n, uniform& random, const std::vector<vec3<T>>& corners) {
    std::vector<vec3<T>> points;
    for (std::size_t i = 0; i < n; ++i) {
        if (i % 4 == 0 && !corners.empty()) {
            points.push_back(corners[random.below(corners.size())]);
        } else {
            const double half = i % 4 == 1 ? 1.2 : i % 4 == 2 ? 3 : 100;
            points.push_back(random.point<T>(-half, half));
        }
    }
    return points;
}

template <class Shape, class Policy>
void check_nearest_of(const Policy& on, std::uint64_t seed) {
    using T = scalar_type_of<Shape>;
    CAPTURE(seed);
    uniform random(seed);
    for (const bool on_lattice : {false, true}) {
        CAPTURE(on_lattice);
        const shape_maker<Shape> make(random, on_lattice);
        for (const std::size_t n : {1u, 2u, 300u}) {
            const shapes<Shape> set(make(n));
            std::vector<vec3<T>> points = points_around<T>(100, random, {});
            // On the lattice, where many shapes are as near as each other.
            for (vec3<T>& p : points) {
                if (on_lattice) p = {std::round(4 * p.x) / 4, std::round(4 * p.y) / 4, std::round(4 * p.z) / 4};
            }
            check_nearest(on, set, points);
        }
        if constexpr (placeable<Shape>) {
            const shapes<Shape> set(make(200));
            const auto points = points_around<T>(100, random, {});
            const double c = 0.6, s = 0.8;
            const rigid<T> turned{{T(c), T(-s), 0, T(s), T(c), 0, 0, 0, 1}, {T(0.3), T(-7), T(1.5)}};
            rigid<T> stretched = turned;
            stretched.rotation[0] *= T(1 + 0x1p-12);
            stretched.rotation[4] *= T(1 - 0x1p-12);
            stretched.rotation[8] *= T(1 - 0x1p-12);
            rigid<T> far = turned;
            far.translation = {T(1e5), T(1e5), T(-1e5)};
            for (const rigid<T>& pose : {rigid<T>{}, turned, stretched, far}) check_nearest_posed(on, set, points, pose);
        }
    }
}

/// Enough points to be taken along a curve, around a mesh; and the order of shapes changes ids alone.
template <class T, class Policy>
void check_nearest_to_mesh(const Policy& on) {
    uniform random(71);
    const torus<T> shape(24, 12, 2, 1);
    const mesh<T> surface(shape.vertices, shape.faces);
    const auto points = points_around<T>(6000, random, shape.vertices);
    const auto expected = nearest_by_definition(surface.view(), points, unit_of_all(surface.view(), points));
    const auto there = copy_to(on, surface);
    const auto tree = make_bvh(on, there);
    check_answers(on, tree, points, expected);
    check_answers(on, make_grid(on, there), points, expected);
    check_answers(on, there, points, expected);
    // Points as a set, and one alone.
    check_answers(on, tree, shapes<vec3<T>>(points), expected);
    check_answers(on, tree, points[0], std::vector<neighbor<T>>{expected[0]});
    check_answers(on, there, points[0], std::vector<neighbor<T>>{expected[0]});
    // Points that lie close to faces look alone on a device; from farther away than some edges they look together.
    std::vector<vec3<T>> close, far;
    for (std::size_t i = 0; i < 1000; ++i) {
        const triangle<T> t = surface.view()[static_cast<std::uint32_t>(random.below(shape.faces.size()))];
        close.push_back(T(0.25) * t.a + T(0.25) * t.b + T(0.5) * t.c + random.point<T>(-0.01, 0.01));
        far.push_back(T(i % 2 == 0 ? 40 : 12) * points[i]);
    }
    for (const auto& some : {close, far}) {
        check_answers(on, tree, some, nearest_by_definition(surface.view(), some, unit_of_all(surface.view(), some)));
    }
    const rigid<T> pose{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {1, 2, 3}};
    const posed_view<mesh_view<T>> placed{surface.view(), pose};
    check_answers(on, posed(tree, pose), points, nearest_by_definition(placed, points, unit_of_all(placed, points)));

    // A vertex is on some six triangles: the least id of them.
    const auto at_vertices = to_host(nearest(on, tree, shape.vertices));
    for (std::uint32_t v = 0; v < shape.vertices.size(); ++v) {
        std::uint32_t first = 0;
        while (std::count(shape.faces[first].begin(), shape.faces[first].end(), v) == 0) ++first;
        CHECK(at_vertices[v] == neighbor<T>{first, shape.vertices[v], 0});
    }

    std::vector<std::uint32_t> order(shape.faces.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    order = shuffled(order, random);
    std::vector<face> moved;
    for (const std::uint32_t i : order) moved.push_back(shape.faces[i]);
    const auto after = to_host(nearest(on, make_bvh(on, mesh<T>(shape.vertices, moved)), points));
    std::size_t ties = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        CAPTURE(i, after[i].id, order[after[i].id], expected[i].id, after[i].distance, expected[i].distance);
        ties += order[after[i].id] != expected[i].id;
        CHECK(after[i].distance == expected[i].distance);
    }
    // Only where an edge or a corner is nearest, which several triangles have.
    CHECK(ties > 0);
    CHECK(ties < points.size() * 3 / 4);
}

/// Many small balls around a hole. From inside the hole a grid has to look farther and farther.
template <class T, class Policy>
void check_nearest_in_hole(const Policy& on) {
    uniform random(80);
    std::vector<sphere<T>> balls;
    while (balls.size() < 20'000) {
        const vec3<T> at = random.point<T>(-1, 1);
        if (dot(at, at) > T(0.25)) balls.push_back({at, T(0.001)});
    }
    const auto points = points_around<T>(60, random, {{0, 0, 0}, {T(0.1), T(0.1), 0}, {T(0.3), 0, 0}});
    const spheres<T> set(balls);
    const auto expected = nearest_by_definition(set.view(), points, unit_of_all(set.view(), points));
    const auto there = copy_to(on, set);
    for (const double width : {0.0, 0.01, 0.3}) {
        CAPTURE(width);
        check_answers(on, make_grid(on, there, width), points, expected);
    }
}

/// Points in the middle of a tube, which many triangles are as near to as the nearest, and far from where coordinates are
/// exact.
template <class T, class Policy>
void check_nearest_in_tube(const Policy& on) {
    uniform random(81);
    for (const double away : {0.0, 1000.0}) {
        CAPTURE(away);
        torus<T> shape(96, 64, 8, 1);
        const auto moved = [&](vec3<T> p) { return vec3<T>{T(p.x + T(away)), p.y, T(p.z - T(2 * away))}; };
        for (vec3<T>& v : shape.vertices) v = moved(v);
        std::vector<vec3<T>> points;
        for (int i = 0; i < 700; ++i) {
            const double turn = random(0, 6.3), near = random(0, i % 3 == 0 ? 0.001 : 0.2);
            const vec3<T> off = random.point<T>(-near, near);
            points.push_back(moved({T(8 * std::cos(turn)) + off.x, T(8 * std::sin(turn)) + off.y, off.z}));
            points.push_back(moved({off.x, off.y, T(20 * near) * off.z}));
        }
        check_nearest(on, mesh<T>(shape.vertices, shape.faces), points);
    }
}

/// From the least numbers to the largest; all in one scene too.
template <class T, class Policy>
void check_nearest_scales(const Policy& on) {
    uniform random(72);
    const auto triangles = random_triangles<T>(60, random);
    const auto corners = points_around<T>(60, random, {});
    const int most = std::numeric_limits<T>::max_exponent - 9, least = std::numeric_limits<T>::min_exponent - 8;
    std::vector<triangle<T>> mixed;
    std::vector<vec3<T>> mixed_points;
    // Near most / 4 the squares of squares overflow, which bounds of distances are made of.
    for (const int e : {most, least, most / 2, least / 2, most / 4, most / 4 + 2, most / 4 + 4, 40, -40}) {
        CAPTURE(e);
        const T s = std::ldexp(T(1), e);
        std::vector<triangle<T>> scaled;
        std::vector<vec3<T>> points;
        for (const triangle<T>& t : triangles) scaled.push_back({s * t.a, s * t.b, s * t.c});
        for (const vec3<T>& p : corners) points.push_back(s * p);
        check_nearest(on, triangle_soup<T>(scaled), points);
        check_nearest_by_trees(on, triangle_soup<T>(scaled), points);
        mixed.insert(mixed.end(), scaled.begin(), scaled.end());
        mixed_points.insert(mixed_points.end(), points.begin(), points.end());
    }
    check_nearest(on, triangle_soup<T>(mixed), mixed_points);
    check_nearest_by_trees(on, triangle_soup<T>(mixed), mixed_points);
}

template <class T, class Policy>
void check_nearest_by_hand(const Policy& on) {
    using limits = std::numeric_limits<T>;
    const vec3<T> p{1, 2, 3};
    const std::vector<neighbor<T>> none{{no_id, p, limits::infinity()}};
    CHECK(to_host(nearest(on, triangle_soup<T>(), p)) == none);
    CHECK(to_host(nearest(on, make_bvh(on, triangle_soup<T>()), p)) == none);
    CHECK(to_host(nearest(on, make_grid(on, spheres<T>()), std::vector{p})) == none);
    CHECK(nearest(on, make_bvh(on, triangle_soup<T>()), std::vector<vec3<T>>{}).empty());

    // In two balls, on a third, and at one distance from two others.
    const spheres<T> balls({{{10, 0, 0}, 1}, {{0, 0, 0}, 2}, {{1, 0, 0}, 2}, {{0, 5, 0}, 3}, {{-10, 0, 0}, 1}});
    const std::vector<vec3<T>> points{{T(0.5), 0, 0}, {0, 2, 0}, {0, -100, 0}, {20, 0, 0}};
    const std::vector<neighbor<T>> expected{
        {1, {T(0.5), 0, 0}, 0}, {1, {0, 2, 0}, 0}, {1, {0, -2, 0}, 98}, {0, {11, 0, 0}, 9}};
    CHECK(to_host(nearest(on, balls, points)) == expected);
    CHECK(to_host(nearest(on, make_bvh(on, balls), points)) == expected);
    CHECK(to_host(nearest(on, make_grid(on, balls), points)) == expected);

    const triangle<T> t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    CHECK(to_host(nearest(on, t, vec3<T>{1, 1, 5})) == std::vector<neighbor<T>>{{0, {1, 1, 0}, 5}});
    const rigid<T> up{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 3}};
    CHECK(to_host(nearest(on, posed(t, up), vec3<T>{1, 1, 5})) == std::vector<neighbor<T>>{{0, {1, 1, 3}, 2}});

    // Copies of one shape: the first.
    const triangle_soup<T> copies(std::vector<triangle<T>>(1000, t));
    const std::vector<vec3<T>> many(5000, vec3<T>{1, 1, 5});
    const std::vector<neighbor<T>> first(5000, neighbor<T>{0, {1, 1, 0}, 5});
    CHECK(to_host(nearest(on, make_bvh(on, copies), many)) == first);

    const vec3<T> bad{0, limits::quiet_NaN(), 0};
    CHECK_THROWS_AS(nearest(on, t, std::vector{p, bad}), invalid_geometry);
    CHECK_THROWS_AS(nearest(on, t, bad), invalid_geometry);
}

/// The few nearest: of a mesh, where triangles at a corner are as near, and of points among points.
template <class T, class Policy>
void check_nearest_few(const Policy& on) {
    uniform random(82);
    const torus<T> shape(24, 12, 2, 1);
    const mesh<T> surface(shape.vertices, shape.faces);
    const auto unit = unit_of_all(surface.view(), shape.vertices);
    const auto points = points_around<T>(300, random, shape.vertices);
    const auto there = copy_to(on, surface);
    const auto tree = make_bvh(on, there);
    const rigid<T> pose{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {1, 2, 3}};
    const posed_view<mesh_view<T>> placed{surface.view(), pose};
    for (const std::size_t count : {1u, 2u, 7u, 40u}) {
        CAPTURE(count);
        const auto expected = nearest_few_by_definition(surface.view(), points, unit, count);
        CHECK(to_host(nearest(on, tree, points, count)) == expected);
        CHECK(to_host(nearest(on, make_grid(on, there), points, count)) == expected);
        CHECK(to_host(nearest(on, there, points[1], count)) ==
              nearest_few_by_definition(surface.view(), {points[1]}, unit, count));
        CHECK(to_host(nearest(on, posed(tree, pose), points, count)) ==
              nearest_few_by_definition(placed, points, unit_of_all(placed, points), count));
    }
    CHECK(to_host(nearest(on, tree, points, 1)) == to_host(nearest(on, tree, points)));

    // More than there are, and points among themselves, of which each is the nearest to itself.
    std::vector<vec3<T>> cloud;
    for (int i = 0; i < 20; ++i) cloud.push_back(random.point<T>(-1, 1));
    cloud.push_back(cloud[3]);
    const shapes<vec3<T>> set(cloud);
    const auto neighbors = to_host(nearest(on, make_bvh(on, set), cloud, 25));
    CHECK(neighbors == nearest_few_by_definition(set.view(), cloud, unit_of_all(set.view(), cloud), 25));
    CHECK(neighbors[25 * 20].id == 3);
    CHECK(neighbors[25 * 20 + 1].id == 20);
    CHECK(neighbors[24] == neighbor<T>{no_id, cloud[0], std::numeric_limits<T>::infinity()});
    CHECK(to_host(nearest(on, triangle_soup<T>(), cloud[0], 2)) == std::vector<neighbor<T>>(2, neighbors[24]));
    CHECK_THROWS_WITH(nearest(on, set, cloud, 0), "abut::nearest: count is 0, expected 1 or more");
    CHECK_THROWS_AS(nearest(on, set, cloud, std::size_t{1} << 60), capacity_error);
}

template <class T, class Policy>
void check_all_nearest(const Policy& on) {
    std::printf("nearest: seeds 71 to 74\n");
    check_nearest_by_hand<T>(on);
    check_nearest_to_mesh<T>(on);
    check_nearest_in_hole<T>(on);
    check_nearest_scales<T>(on);
    check_nearest_few<T>(on);
    check_nearest_of<triangle<T>>(on, 73);
    check_nearest_of<sphere<T>>(on, 74);
}

}  // namespace abut::test
