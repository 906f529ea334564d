// SPDX-License-Identifier: MIT
//
// any_each and any_within_each of rows: one answer of each shape of a set. Spheres and points on a lattice are compared with whole
// numbers; other shapes with a plain loop over `intersects`, which other tests prove right.
#include <abut/collide/row_each.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include <abut/collide/query.hpp>
#include <abut/index/wide.hpp>

#include "support/catch.hpp"

using namespace abut;

namespace {

struct draws {
    std::uint64_t state = 5;
    std::uint32_t operator()(std::uint32_t below) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint32_t>((state >> 33) % below);
    }
};

using answers = std::vector<std::uint8_t>;

/// Of an index in all layouts, of a plain set, on one thread and on several.
template <class Set, class S>
void check_all(const Set& set, const std::vector<S>& all, const answers& expected) {
    const shapes<S> rows(all);
    const auto tree = make_bvh(serial{}, set);
    CHECK(to_host(any_each(serial{}, set, rows)) == expected);
    CHECK(to_host(any_each(serial{}, tree, rows)) == expected);
    CHECK(to_host(any_each<exact>(openmp{3}, wide(serial{}, tree), rows)) == expected);
    CHECK(to_host(any_each(openmp{3}, make_grid(serial{}, set), rows)) == expected);
    const auto kept = make_grid(serial{}, set, {.clearances = true});
    CHECK(to_host(any_each(serial{}, kept, rows)) == expected);
    CHECK(to_host(any_each<exact>(openmp{3}, kept, rows)) == expected);
    // In groups: as many as a few spheres, more than a thread takes at a time, and all.
    for (const std::size_t group : {std::size_t{2}, std::size_t{5}, std::size_t{100}, all.size()}) {
        if (all.size() % group != 0) continue;
        answers of_groups(all.size() / group);
        for (std::size_t i = 0; i < all.size(); ++i) of_groups[i / group] |= expected[i];
        const each_options<> options{.group = group};
        CHECK(to_host(any_each(serial{}, set, rows, options)) == of_groups);
        CHECK(to_host(any_each(openmp{2}, tree, rows, options)) == of_groups);
        CHECK(to_host(any_each(openmp{3}, kept, rows, options)) == of_groups);
    }
    // A few at a time look in the tree, and many in cells.
    for (std::size_t first = 0; first < all.size(); first += 97) {
        const std::vector some(all.begin() + static_cast<std::ptrdiff_t>(first),
                               all.begin() + static_cast<std::ptrdiff_t>(std::min(first + 5, all.size())));
        const answers of_some = to_host(any_each(serial{}, tree, shapes<S>(some)));
        CHECK(std::equal(of_some.begin(), of_some.end(), expected.begin() + static_cast<std::ptrdiff_t>(first)));
    }
}

}  // namespace

TEMPLATE_TEST_CASE("spheres and points of a lattice, by whole numbers", "", float, double) {
    using T = TestType;
    // Side by side, in a plane, on a line, all in one place; as they are, and as small and as large as numbers go. Many touch.
    const int shapes_of[][3] = {{40, 40, 40}, {300, 300, 1}, {1, 2000, 1}, {1, 1, 1}};
    const T units[] = {1, std::is_same_v<T, float> ? T(0x1p-140) : T(0x1p-1060), std::is_same_v<T, float> ? T(0x1p110) : T(0x1p1000)};
    for (const auto& size : shapes_of) {
        for (const std::uint32_t n : {1u, 300u, 4000u}) {
            draws d;
            std::vector<vec3<int>> at, from;
            std::vector<int> radii;
            for (std::uint32_t i = 0; i < n; ++i) {
                const auto next = [&d](int below) { return static_cast<int>(d(static_cast<std::uint32_t>(below))); };
                at.push_back({next(size[0]), next(size[1]), next(size[2])});
            }
            for (int i = 0; i < 1500; ++i) {
                const auto next = [&d](int below) { return static_cast<int>(d(static_cast<std::uint32_t>(below + 6))) - 3; };
                from.push_back({next(size[0]), next(size[1]), next(size[2])});
                radii.push_back(static_cast<int>(d(i % 10 == 0 ? 30 : 5)));
            }
            answers expected;
            std::size_t hits = 0, touching = 0;
            for (std::size_t i = 0; i < from.size(); ++i) {
                bool met = false, touches = false;
                for (const auto& p : at) {
                    const int x = p.x - from[i].x, y = p.y - from[i].y, z = p.z - from[i].z;
                    const int over = x * x + y * y + z * z - radii[i] * radii[i];
                    met |= over <= 0;
                    touches |= over == 0;
                }
                expected.push_back(met);
                hits += met;
                touching += touches;
            }
            CHECK((n == 1 || (hits > 15 && touching > 3)));
            for (const T unit : units) {
                std::vector<vec3<T>> points_at;
                std::vector<sphere<T>> balls;
                for (const auto& p : at) points_at.push_back({unit * static_cast<T>(p.x), unit * static_cast<T>(p.y), unit * static_cast<T>(p.z)});
                for (std::size_t i = 0; i < from.size(); ++i) {
                    const auto& p = from[i];
                    balls.push_back({{unit * static_cast<T>(p.x), unit * static_cast<T>(p.y), unit * static_cast<T>(p.z)},
                                     unit * static_cast<T>(radii[i])});
                }
                if (unit != 1 && n == 4000) continue;
                check_all(points<T>(points_at), balls, expected);
            }
        }
    }
}

TEMPLATE_TEST_CASE("spheres that all but touch points", "", float, double) {
    using T = TestType;
    // The centre is beside a point, by a radius along an axis, or a unit in the last place more or less, far from the origin too.
    draws d;
    std::vector<vec3<T>> at;
    std::vector<sphere<T>> balls;
    answers expected;
    for (int i = 0; i < 600; ++i) {
        const T x = static_cast<T>(1000 * i) + static_cast<T>(d(1u << 20)) * T(0x1p-15);
        const T radius = static_cast<T>(1 + d(1u << 10)) * T(0x1p-6);
        T center = x + radius;
        center = i % 3 == 0 ? center : std::nextafter(center, i % 3 == 1 ? T(0) : std::numeric_limits<T>::max());
        at.push_back({x, 1, 2});
        balls.push_back({{center, 1, 2}, radius});
        expected.push_back(static_cast<long double>(center) - x <= radius);
    }
    CHECK(std::count(expected.begin(), expected.end(), 1) > 200);
    CHECK(std::count(expected.begin(), expected.end(), 0) > 100);
    check_all(points<T>(at), balls, expected);
}

TEMPLATE_TEST_CASE("rows of any shape are what pairs say of them", "", float, double) {
    using T = TestType;
    draws d;
    const auto number = [&d](double low, double high) { return static_cast<T>(low + (high - low) * d(1u << 20) * 0x1p-20); };
    const auto place = [&] { return vec3<T>{number(-1, 1), number(-1, 1), number(-1, 1)}; };
    std::vector<triangle<T>> faces;
    std::vector<vec3<T>> cloud;
    std::vector<capsule<T>> links;
    std::vector<aabb<T>> boxes;
    for (int i = 0; i < 400; ++i) {
        const vec3<T> p = place(), q = place();
        faces.push_back({p, p + T(0.1) * place(), p + T(0.1) * place()});
        cloud.push_back(place());
        links.push_back({{q, q + T(0.2) * place()}, number(0, 0.1)});
        const vec3<T> half{number(0, 0.1), number(0, 0.1), number(0, 0.1)};
        boxes.push_back({q - half, q + half});
    }
    const auto check = [&]<class S, class U>(const std::vector<S>& all, const std::vector<U>& looking) {
        const shapes<S> set(all);
        const shapes<U> rows(looking);
        answers expected, even, near;
        for (const U& row : looking) {
            expected.push_back(0), even.push_back(0), near.push_back(0);
            for (std::uint32_t id = 0; id < all.size(); ++id) {
                const bool met = intersects<exact>(all[id], row);
                expected.back() |= met;
                even.back() |= met && (id + expected.size()) % 2 == 1;  // of row 0 the even ones
                near.back() |= detail::come_within<exact>{0.03}.resolve(all[id], row);
            }
        }
        CHECK(std::count(expected.begin(), expected.end(), 1) > 10);
        CHECK(std::count(expected.begin(), expected.end(), 0) > 10);
        CHECK((even != expected && near != expected));
        check_all(set, looking, expected);
        const auto is_even = [](std::uint32_t row, std::uint32_t id) { return (row + id) % 2 == 0; };
        const auto tree = make_bvh(serial{}, set);
        CHECK(to_host(any_each(openmp{2}, tree, rows, each_options<std::remove_const_t<decltype(is_even)>>{is_even})) == even);
        CHECK(to_host(any_each(serial{}, set, rows, each_options<std::remove_const_t<decltype(is_even)>>{is_even})) == even);
        CHECK(to_host(any_within_each(openmp{2}, tree, rows, 0.03)) == near);
        CHECK(to_host(any_within_each(serial{}, set, rows, 0.03)) == near);
        const auto kept = make_grid(serial{}, set, {.clearances = true});
        CHECK(to_host(any_each(serial{}, kept, rows, each_options<std::remove_const_t<decltype(is_even)>>{is_even})) == even);
        CHECK(to_host(any_within_each(openmp{2}, kept, rows, 0.03)) == near);
        // Under a pose, as a list of placed shapes would be.
        const rigid<T> pose{.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1}, .translation = {T(0.1), T(-0.2), T(0.05)}};
        answers placed;
        for (const U& row : looking) {
            placed.push_back(0);
            for (const auto& one : all) placed.back() |= intersects<exact>(abut::place(pose, one), row);
        }
        CHECK(placed != expected);
        CHECK(to_host(any_each(serial{}, posed(tree, pose), rows)) == placed);
        CHECK(to_host(any_each(serial{}, posed(set, pose), rows)) == placed);
        CHECK(to_host(any_each(serial{}, posed(kept, pose), rows)) == placed);
    };
    check(faces, links);
    check(faces, boxes);
    check(cloud, links);
    check(cloud, boxes);
    std::vector<sphere<T>> balls;
    for (const auto& link : links) balls.push_back({link.axis.a, link.radius});
    check(cloud, balls);
}

TEMPLATE_TEST_CASE("balls of all sizes among points at all distances, on a surface and far away", "", float, double) {
    using T = TestType;
    // Most of the points are on a sphere, a few in one place, and in another test some are far away from the rest, so that the
    // rest is in one cell. Centres on and beside points, and far out; radii from the least number to beyond the extent, and those
    // that all but reach a point.
    for (const T far : {T(1), T(0x1p18), T(0x1p60)}) {
        draws d;
        const auto number = [&d](double low, double high) { return static_cast<T>(low + (high - low) * d(1u << 24) * 0x1p-24); };
        std::vector<vec3<T>> cloud;
        while (cloud.size() < 700) {
            const vec3<T> p{number(-1, 1), number(-1, 1), number(-1, 1)};
            if (const T square = dot(p, p); square > T(0.1)) cloud.push_back(1 / std::sqrt(square) * p);
        }
        for (int i = 0; i < 50; ++i) cloud.push_back({T(0.5), T(0.25), T(-0.125)});
        cloud.push_back({far, 0, far});
        std::vector<sphere<T>> balls;
        for (int i = 0; i < 2000; ++i) {
            const vec3<T> p = cloud[d(751)], q{number(-1.5, 1.5), number(-1.5, 1.5), number(-1.5, 1.5)};
            const vec3<T> center = i % 3 == 0 ? q : i % 3 == 1 ? p + std::ldexp(T(1), -static_cast<int>(d(40))) * q : far * q;
            const vec3<T> way = center - p;
            const T exactly = std::sqrt(dot(way, way));
            const T radii[] = {exactly, std::nextafter(exactly, T(0)), std::nextafter(exactly, 4 * far),
                               std::ldexp(number(0, 1), -static_cast<int>(d(60))), 0, std::numeric_limits<T>::denorm_min(), std::numeric_limits<T>::max(), far * number(0, 2)};
            balls.push_back({center, radii[d(8)]});
        }
        answers expected;
        for (const auto& ball : balls) {
            bool met = false;
            for (const auto& p : cloud) met |= intersects<exact>(p, ball);
            expected.push_back(met);
        }
        CHECK(std::count(expected.begin(), expected.end(), 1) > 500);
        CHECK(std::count(expected.begin(), expected.end(), 0) > 500);
        check_all(points<T>(cloud), balls, expected);
    }
}

TEST_CASE("distances that a grid keeps take the memory that is promised") {
    draws d;
    std::vector<vec3<float>> cloud;
    const auto number = [&d] { return static_cast<float>(d(1u << 24)) * 0x1p-24f; };
    for (int i = 0; i < 20000; ++i) cloud.push_back({number(), number(), i % 2 == 0 ? 0.0f : number()});
    const points<float> set(cloud);
    const std::size_t plain = make_grid(serial{}, set).bytes(), kept = make_grid(serial{}, set, {.clearances = true}).bytes();
    CHECK(kept > plain + 16 * cloud.size());
    CHECK(kept <= plain + 25 * cloud.size() + 1000);
    // Of what are no points, and of points in one place, there are none.
    const spheres<float> balls(std::vector<sphere<float>>{{{0, 0, 0}, 1}});
    CHECK(make_grid(serial{}, balls, {.clearances = true}).bytes() == make_grid(serial{}, balls).bytes());
    const points<float> same(std::vector<vec3<float>>(300, {1, 2, 3}));
    CHECK(make_grid(serial{}, same, {.clearances = true}).bytes() < make_grid(serial{}, same).bytes() + 200);
}

TEST_CASE("no rows, no shapes, and numbers that are none") {
    const spheres<float> none(std::vector<sphere<float>>{}), two({{{0, 0, 0}, 1}, {{5, 0, 0}, 1}});
    const points<float> some(std::vector<vec3<float>>{{0, 1, 0}}), empty(std::vector<vec3<float>>{});
    CHECK(to_host(any_each(serial{}, some, none)).empty());
    CHECK(to_host(any_each(serial{}, empty, two)) == answers{0, 0});
    CHECK(to_host(any_each(serial{}, some, two)) == answers{1, 0});
    CHECK(to_host(any_each(serial{}, some, sphere<float>{{0, 0, 0}, 1})) == answers{1});
    CHECK(to_host(any_within_each(serial{}, make_bvh(serial{}, some), two, 4.1)) == answers{1, 1});
    CHECK_THROWS_AS(any_within_each(serial{}, some, two, -1), error);
    CHECK(to_host(any_each(serial{}, some, two, {.group = 2})) == answers{1});
    CHECK(to_host(any_within_each(serial{}, make_bvh(serial{}, some), two, 4.1, {.group = 2})) == answers{1});
    CHECK(to_host(any_each(serial{}, empty, two, {.group = 2})) == answers{0});
    CHECK(to_host(any_each(serial{}, some, none, {.group = 2})).empty());
    CHECK_THROWS_WITH(any_each(serial{}, some, two, {.group = 3}),
                      "abut::any_each: group is 3; expected a divisor of the number of rows, 2");
    CHECK_THROWS_AS(any_each(serial{}, some, two, {.group = 0}), error);
    CHECK_THROWS_AS(any_each(serial{}, some, sphere<float>{{0, 0, 0}, -1}), invalid_geometry);
}
