// SPDX-License-Identifier: MIT

// A mesh against one box, plane, capsule or point, and sets of all shapes: complete and the same with each index, on each
// policy, in either order of arguments. The truth is a plain loop over `intersects<exact>`, whose own truth is
// tests/predicate.

#include <abut/abut.hpp>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include "collide/set_cases.hpp"
#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace {

using namespace abut;
using pair_list = std::vector<index_pair>;

template <class Triangles, class Shape>
pair_list faces_that_touch(const Triangles& triangles, const Shape& shape) {
    pair_list touching;
    const auto view = triangles.view();
    for (std::uint32_t i = 0; i < view.size(); ++i) {
        if (intersects<exact>(view[i], shape)) touching.push_back({i, 0});
    }
    return touching;
}

template <class Policy, class Triangles, class Shape>
void check_against(const Policy& on, const Triangles& triangles, const Shape& shape, std::size_t& hits,
                   std::size_t& misses) {
    const pair_list expected = faces_that_touch(triangles, shape);
    pair_list mirrored;
    for (const index_pair& p : expected) mirrored.push_back({p.b, p.a});
    hits += expected.size();
    misses += triangles.size() - expected.size();
    CHECK(to_host(pairs<exact>(on, triangles, shape)) == expected);
    CHECK(any(on, triangles, shape) == !expected.empty());
    CHECK(count(on, shape, triangles) == expected.size());
    const auto tree = make_bvh(on, triangles);
    CHECK(to_host(pairs(on, shape, tree)) == mirrored);
    CHECK(any(on, tree, shape) == !expected.empty());
    CHECK(to_host(pairs(on, make_grid(on, triangles), shape)) == expected);
    // An index over the one shape, whose box may be all of space.
    CHECK(count(on, triangles, make_bvh(on, shape)) == expected.size());
    CHECK(count(on, make_grid(on, shape), triangles) == expected.size());
}

struct totals {
    std::size_t hits = 0, misses = 0;
};

/// Shapes at random places of the mesh's box, small and large.
template <class T, class Policy>
void check_random_shapes(const Policy& on, std::uint64_t seed, int count) {
    test::uniform random(seed);
    const test::torus<T> shape(24, 12, 2, 1);
    const mesh<T> ring(shape.vertices, shape.faces);
    totals boxes, planes, capsules, segments_of_capsules;
    for (int i = 0; i < count; ++i) {
        const vec3<T> p = random.point<T>(-3.5, 3.5), q = random.point<T>(-3.5, 3.5);
        const T size = static_cast<T>(random(0, 1));
        const aabb<T> near_p{{p.x - size, p.y - size, p.z - size}, {p.x + size, p.y + size, p.z + size}};
        check_against(on, ring, i % 4 == 0 ? aabb<T>{detail::least(p, q), detail::greatest(p, q)} : near_p, boxes.hits,
                      boxes.misses);
        check_against(on, ring, plane<T>{q, dot(p, q)}, planes.hits, planes.misses);
        check_against(on, ring, capsule<T>{{p, q}, size / 4}, capsules.hits, capsules.misses);
        check_against(on, ring, capsule<T>{{p, i % 2 == 0 ? q : p}, T(0)}, segments_of_capsules.hits,
                      segments_of_capsules.misses);
    }
    for (const totals& t : {boxes, planes, capsules, segments_of_capsules}) {
        CHECK(t.hits >= 4);  // the least is of segments, which meet few faces
        CHECK(t.misses > t.hits);
    }
}

/// Shapes that touch the mesh exactly: all coordinates are small integers.
template <class T, class Policy>
void check_lattice(const Policy& on) {
    std::vector<triangle<T>> triangles;
    for (int x = 0; x < 5; ++x) {
        for (int y = 0; y < 5; ++y) {
            const T u = static_cast<T>(x), v = static_cast<T>(y);
            triangles.push_back({{u, v, 0}, {u + 1, v, 0}, {u, v + 1, 0}});
            triangles.push_back({{u, v, 0}, {u, v + 1, 1}, {u + 1, v, 2}});
            triangles.push_back({{u, v, 0}, {u, v, 0}, {u, v + 1, 0}});  // a segment
            triangles.push_back({{u, v, 0}, {u, v, 0}, {u, v, 0}});      // a point
        }
    }
    const triangle_soup<T> soup(triangles);
    totals all;
    const auto check = [&](const auto& shape) { check_against(on, soup, shape, all.hits, all.misses); };
    for (int i = 0; i < 4; ++i) {
        const T k = static_cast<T>(i);
        check(aabb<T>{{k, k, 0}, {k, k + 2, 3}});
        check(aabb<T>{{-k, -1, -2}, {k, k, 0}});
        check(aabb<T>{{k, k, k}, {k, k, k}});
        check(plane<T>{{0, 0, 1}, k});
        check(plane<T>{{1, 1, -1}, k});
        check(plane<T>{{0, 0, 0}, k});
        check(capsule<T>{{{k, 1, 2}, {3, k, 2}}, 2});
        check(capsule<T>{{{k, 1, 2}, {k, 1, -2}}, 0});
        check(capsule<T>{{{0, -2, k}, {4, -2, k}}, 2});
        check(vec3<T>{k, 1, 0});
        check(vec3<T>{1, k, 1});
    }
    CHECK(all.hits > 500);
    CHECK(all.misses > 500);
}

/// Exponents too far apart for integers in registers: the last stage decides, on the host.
template <class T, class Policy>
void check_wide_spans(const Policy& on) {
    constexpr T huge = std::numeric_limits<T>::max() / 4, tiny = std::numeric_limits<T>::denorm_min();
    std::vector<triangle<T>> triangles;
    for (int i = 0; i < 10; ++i) {
        const T lift = static_cast<T>(i - 5) * tiny;
        triangles.push_back({{huge, 0, lift}, {-huge, tiny, lift}, {0, huge, lift}});
    }
    const triangle_soup<T> soup(triangles);
    totals all;
    const auto check = [&](const auto& shape) { check_against(on, soup, shape, all.hits, all.misses); };
    check(aabb<T>{{1, 1, tiny}, {huge, 2, huge}});
    check(aabb<T>{{-huge, 1, -tiny}, {huge, 1, -tiny}});
    check(plane<T>{{0, 0, huge}, 0});
    check(plane<T>{{0, tiny, 1}, tiny});
    check(capsule<T>{{{0, 1, huge}, {1, 1, huge}}, huge});
    check(capsule<T>{{{0, 1, tiny}, {1, 1, huge}}, tiny});
    check(vec3<T>{0, 1, tiny});
    CHECK(all.hits > 10);
    CHECK(all.misses > 10);
}

}  // namespace

TEMPLATE_TEST_CASE("queries: a mesh against one box, plane or capsule", "", float, double) {
    constexpr std::uint64_t seed = 20260707;
    std::printf("a mesh against one shape: seed %llu\n", static_cast<unsigned long long>(seed));
    check_random_shapes<TestType>(serial{}, seed, 40);
    check_lattice<TestType>(serial{});
    check_wide_spans<TestType>(serial{});
}

TEST_CASE("queries: a mesh against one box, plane or capsule, openmp") {
    for (const int threads : {1, 2, 7}) {
        CAPTURE(threads);
        check_random_shapes<float>(openmp{.threads = threads}, 20260708, 10);
        check_lattice<float>(openmp{.threads = threads});
        check_wide_spans<float>(openmp{.threads = threads});
    }
}

TEST_CASE("queries: one shape that is none is refused, by name") {
    const triangle_soup<double> soup(std::vector<triangle<double>>{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}});
    const double inf = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(any(serial{}, soup, aabb<double>{{0, 2, 0}, {1, 1, 1}}),
                      "abut::any: shape 0: lower y is above upper y (2)");
    CHECK_THROWS_WITH(any(serial{}, soup, aabb<double>{{0, 0, 0}, {1, 1, inf}}),
                      "abut::any: shape 0: z is not finite (inf)");
    CHECK_THROWS_WITH(count(serial{}, capsule<double>{{{0, 0, 0}, {1, 1, 1}}, -2}, soup),
                      "abut::count: shape 0: radius is negative (-2)");
    CHECK_THROWS_WITH(count(serial{}, capsule<double>{{{0, 0, 0}, {1, -inf, 1}}, 1}, soup),
                      "abut::count: shape 0: y is not finite (-inf)");
    CHECK_THROWS_WITH(pairs(serial{}, plane<double>{{0, 0, 1}, inf}, soup),
                      "abut::pairs: shape 0: offset is not finite (inf)");
    CHECK_THROWS_WITH(make_bvh(serial{}, plane<double>{{inf, 0, 1}, 0}), "abut::make_bvh: shape 0: x is not finite (inf)");
    CHECK_THROWS_WITH(make_grid(serial{}, vec3<double>{0, inf, 1}), "abut::make_grid: shape 0: y is not finite (inf)");
}

TEST_CASE("queries: sets of every two shapes that have a predicate") {
    for (const int threads : {1, 2, 7}) {
        CAPTURE(threads);
        test::check_all_pairs_of_shapes<float>(openmp{.threads = threads});
    }
    test::check_pair_of_shapes<sphere<double>, sphere<double>>(serial{}, 71);
}

TEST_CASE("queries: views over the caller's own arrays, of each shape") {
    struct item {
        capsule<float> pill;
        aabb<float> box;
        segment<float> line;
        vec3<float> place;
        int id;
    };
    test::uniform random(73);
    const auto pills = test::shape_maker<capsule<float>>(random, false)(150);
    const auto some_boxes = test::shape_maker<aabb<float>>(random, false)(150);
    const auto lines = test::shape_maker<segment<float>>(random, false)(150);
    const auto places = test::shape_maker<vec3<float>>(random, true)(150);
    std::vector<item> items;
    for (std::size_t i = 0; i < 150; ++i) items.push_back({pills[i], some_boxes[i], lines[i], places[i], 9});
    const triangle_soup<float> soup(test::shape_maker<triangle<float>>(random, true)(200));
    const openmp on{.threads = 2};
    const auto check = [&](const auto& view) {
        const pair_list expected = test::all_that_touch(view, soup.view());
        CHECK(expected.size() > 5);
        CHECK(to_host(pairs(on, make_grid(on, view), soup)) == expected);
    };
    check(capsules_view<float>(&items[0].pill, items.size(), sizeof(item)));
    check(boxes_view<float>(&items[0].box, items.size(), sizeof(item)));
    check(segments_view<float>(&items[0].line, items.size(), sizeof(item)));
    check(points_view<float>(&items[0].place, items.size(), sizeof(item)));
    items[7].box.lower.x = 5;
    CHECK_THROWS_WITH(any(on, boxes_view<float>(&items[0].box, items.size(), sizeof(item)), soup),
                      "abut::any: box 7: lower x is above upper x (5)");
}

TEST_CASE("queries: posed sets of shapes, and posed shapes alone") {
    const openmp on{.threads = 2};
    test::uniform random(79);
    const triangle_soup<double> soup(test::shape_maker<triangle<double>>(random, false)(200));
    rigid<double> pose;
    pose.rotation[0] = pose.rotation[8] = 0.6;
    pose.rotation[2] = -0.8;
    pose.rotation[6] = 0.8;
    pose.translation = {0.25, 0, -0.5};
    const auto check = [&](const auto& set) {
        const pair_list expected = test::all_that_touch(
            posed_view<typename std::remove_cvref_t<decltype(set)>::view_type>{set.view(), pose}, soup.view());
        CHECK(expected.size() > 20);
        CHECK(to_host(pairs(on, posed(set, pose), soup)) == expected);
        CHECK(to_host(pairs(on, posed(make_bvh(on, set), pose), make_bvh(on, soup))) == expected);
    };
    check(capsules<double>(test::shape_maker<capsule<double>>(random, false)(150)));
    check(segments<double>(test::shape_maker<segment<double>>(random, false)(150)));
    const auto check_one = [&](const auto& shape) {
        pair_list expected;
        for (std::uint32_t j = 0; j < soup.size(); ++j) {
            if (intersects<exact>(place(pose, shape), soup.view()[j])) expected.push_back({0, j});
        }
        CHECK(expected.size() > 3);
        CHECK(to_host(pairs(on, posed(shape, pose), soup)) == expected);
        CHECK(to_host(pairs(on, posed(shape, pose), make_bvh(on, soup))) == expected);
        CHECK(any(on, soup, posed(shape, pose)));
    };
    check_one(triangle<double>{{-1, -1, 0}, {1, -1, 0.25}, {0, 1, 0}});
    check_one(sphere<double>{{0, 0, 0}, 0.5});
    auto stretched = pose;
    stretched.rotation[4] = 2;
    CHECK_THROWS_WITH(any(on, soup, posed(sphere<double>{{0, 0, 0}, 1}, stretched)),
                      "abut::any: rotation row 1: its squared length differs from 1 by more than 2^-10 (3)");
}

TEST_CASE("queries: contacts of two sets of spheres") {
    test::uniform random(83);
    const spheres<float> a(test::shape_maker<sphere<float>>(random, false)(150));
    const spheres<float> b(test::shape_maker<sphere<float>>(random, true)(150));
    const auto expected = test::all_that_touch(a.view(), b.view());
    const auto found = to_host(contacts(serial{}, make_bvh(serial{}, a), b));
    REQUIRE(found.size() == expected.size());
    CHECK(found.size() > 50);
    for (std::size_t i = 0; i < found.size(); ++i) CHECK(index_pair{found[i].a, found[i].b} == expected[i]);
}
