// SPDX-License-Identifier: MIT
//
// On hosts, neighbouring rays at a wide tree that go nearly the same way begin at common entries (traverse/from_each.hpp).
// They meet what each of them meets by itself, to the bit.
#include <abut/collide/inside.hpp>
#include <abut/collide/raycast_all.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <abut/index/wide.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"

using namespace abut;

namespace {

/// Rows of a camera, 640 rays each, which looks from a point at a square around the origin.
template <class T>
std::vector<ray<T>> camera(std::size_t rows, const vec3<T>& from, double wide, T length = 1) {
    constexpr std::size_t columns = 640;
    std::vector<ray<T>> rays;
    for (std::size_t i = 0; i < rows * columns; ++i) {
        const auto at = [&](std::size_t k, std::size_t of) {
            return static_cast<T>(wide * ((static_cast<double>(k) + 0.5) / static_cast<double>(of) - 0.5));
        };
        rays.push_back({from, length * (vec3<T>{at(i % columns, columns), at(i / columns, rows), 0} - from)});
    }
    return rays;
}
/// The same in parallel, along an axis.
template <class T>
std::vector<ray<T>> beam(std::size_t rows, double wide) {
    auto rays = camera<T>(rows, {0, 0, 0}, wide);
    for (auto& r : rays) r = {r.direction + vec3<T>{0, 0, 3}, {0, 0, -1}};
    return rays;
}

/// What share of bundles of 32 lines go together.
template <class Index, class Line>
double share_together(const Index& index, const std::vector<Line>& lines) {
    const shapes<Line> set(lines);
    const auto both = detail::bring_lines_and_shapes(serial{}, index, set, "test");
    execution::best_of_each<host_space> best(serial{}, lines.size());
    auto sink = best.make_sink(0);
    const detail::from_each walk{both.template walk<detail::walk_along_lines, filtered>(true)};
    auto bundles = walk.in_bundles();
    std::size_t together = 0, all = 0;
    for (std::size_t i = 0; i + 32 <= lines.size(); i += 32, ++all) together += bundles(i, i + 32, sink);
    return static_cast<double>(together) / static_cast<double>(all);
}

/// What lines meet in a wide tree, together and some of them alone, is what they meet in a binary one, where each walks by
/// itself. How many meet anything.
template <class Policy, class Wide, class Binary, class Line>
std::size_t check_bundles(const Policy& on, const Wide& wide, const Binary& binary, const std::vector<Line>& lines) {
    const shapes<Line> set(lines);
    const auto first = raycast(serial{}, binary, set).to_host();
    CHECK((raycast(on, wide, set).to_host() == first));
    CHECK((raycast_any(on, wide, set).to_host() == raycast_any(serial{}, binary, set).to_host()));
    CHECK((raycast_all(on, wide, set).to_host() == raycast_all(serial{}, binary, set).to_host()));
    std::size_t wrong = 0, met = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        met += first[i].id != no_id;
        if (i % 16 == 0) wrong += raycast(serial{}, wide, lines[i]).to_host()[0] != first[i];
    }
    CHECK(wrong == 0);
    return met;
}

template <class T>
std::vector<segment<T>> cut(const std::vector<ray<T>>& rays, double most) {
    std::vector<segment<T>> lines;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const T share = static_cast<T>(i % 3 == 0 ? 1 / most : i % 3 == 1 ? 1 : most);
        lines.push_back({rays[i].origin, rays[i].origin + share * rays[i].direction});
    }
    return lines;
}

}  // namespace

TEMPLATE_TEST_CASE("bundles of rays: as each ray by itself", "", float, double) {
    using T = TestType;
    test::uniform random(511);
    const test::torus<T> around(40, 24, 1, 0.4);
    // Each face three times: hits are at one time, and the least id is first.
    auto faces = around.faces;
    for (int times = 0; times < 2; ++times) faces.insert(faces.end(), around.faces.begin(), around.faces.end());
    std::swap(faces[7], faces[1999]);
    const mesh<T> m(around.vertices, faces);
    const auto binary = make_bvh(serial{}, m, {.builder = bvh_builder::sah});
    const auto tree = wide(serial{}, binary);
    rigid<T> pose{};
    test::construction::set_rotation(pose, 0.8L, 0.3L, -0.2L, 0.4L);
    pose.translation = {T(0.25), T(-0.5), T(0.125)};

    std::vector<ray<T>> apart;
    for (int i = 0; i < 300; ++i) {
        const vec3<T> o = random.point<T>(-2, 2);
        apart.push_back({o, random.point<T>(-1, 1) - o});
    }
    CHECK(share_together(tree, apart) < 0.2);
    const auto seen = camera<T>(3, {T(0.3), T(0.2), 3}, 3.2);
    CHECK(share_together(tree, seen) > 0.5);
    CHECK(share_together(posed(tree, pose), seen) > 0.5);
    CHECK(share_together(tree, cut(seen, 1)) > 0.5);
    CHECK(share_together(tree, cut(seen, 4)) < 0.2);
    CHECK(share_together(tree, beam<T>(3, 3.2)) > 0.5);

    std::vector<std::vector<ray<T>>> cases{seen,
                                           beam<T>(3, 3.2),
                                           camera<T>(3, {0, 0, 3}, 3.2, T(0.01)),
                                           camera<T>(3, {T(0.9), T(0.1), T(0.2)}, 0.6),   // from within the tube
                                           camera<T>(3, {1, 0, 0}, 20, T(1000)),
                                           camera<T>(3, {T(-3), T(0.01), T(0.02)}, 0.2),  // along the plane of the ring
                                           camera<T>(3, {T(0.3), T(0.2), T(-3)}, 1e-5)};
    {  // By turns in one bundle and in the next, with some that go nowhere, and all of one.
        auto mixed = seen;
        for (std::size_t i = 0; i < mixed.size(); ++i) {
            if (i / 16 % 3 == 0 || i % 97 == 0) mixed[i] = apart[i % apart.size()];
            if (i % 101 == 0) mixed[i].direction = {0, 0, 0};
            if (i % 53 == 0) mixed[i].direction.x = std::numeric_limits<T>::denorm_min();
        }
        cases.push_back(mixed);
        cases.push_back(std::vector<ray<T>>(70, seen[960]));
    }
    {  // At corners and sides of triangles, from one point.
        std::vector<ray<T>> aimed;
        for (std::size_t i = 0; i < around.faces.size(); i += 4) {
            const face& f = around.faces[i];
            const vec3<T>&a = around.vertices[f[0]], &b = around.vertices[f[1]], o{T(0.25), T(0.5), 4};
            aimed.push_back({o, a - o});
            aimed.push_back({o, T(0.5) * (a + b) - o});
        }
        cases.push_back(aimed);
    }
    std::size_t met = 0, asked = 0;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        CAPTURE(k);
        met += check_bundles(serial{}, tree, binary, cases[k]);
        check_bundles(serial{}, tree, binary, cut(cases[k], k % 2 == 0 ? 1 : 2));
        check_bundles(openmp{.threads = 3}, tree, binary, cases[k]);
        asked += cases[k].size();
        if (k < 2) check_bundles(serial{}, posed(tree, pose), posed(binary, pose), cases[k]);
    }
    CHECK(met > asked / 4);
    CHECK(met < asked);
    for (const std::size_t n : {0u, 1u, 7u, 8u, 9u, 31u, 32u, 33u, 40u, 64u, 69u}) {
        CAPTURE(n);
        const auto begin = seen.begin() + 930;
        check_bundles(serial{}, tree, binary, std::vector<ray<T>>(begin, begin + static_cast<std::ptrdiff_t>(n)));
    }

    // Points in rows look upward in bundles.
    std::vector<vec3<T>> points;
    for (const auto& r : beam<T>(3, 3)) points.push_back({r.origin.x, r.origin.y, T(0.05)});
    const auto where = inside(serial{}, tree, points, {.known_closed = true}).to_host();
    CHECK((where == inside(serial{}, binary, points, {.known_closed = true}).to_host()));
    const auto within = std::count(where.begin(), where.end(), containment::inside);
    CHECK(within > 50);
    CHECK(within < 1500);
}

TEMPLATE_TEST_CASE("bundles of rays: tiny and huge", "", float, double) {
    using T = TestType;
    const T smallest = std::numeric_limits<T>::min(), largest = std::numeric_limits<T>::max();
    const test::torus<T> around(24, 12, 1, 0.4);
    for (const T scale : {T(1e-20), T(1e20), smallest * 1024, smallest, smallest / 64, largest / 16}) {
        CAPTURE(scale);
        auto vertices = around.vertices;
        for (auto& v : vertices) v = scale * v;
        const mesh<T> m(vertices, around.faces);
        const auto binary = make_bvh(serial{}, m);
        const auto tree = wide(serial{}, binary);
        auto lines = camera<T>(1, {T(0.3), T(0.2), 3}, 3.2);
        lines = {lines.begin() + 100, lines.begin() + 140};
        std::size_t met = 0;
        for (const bool is_scaled : {false, true}) {
            for (auto& r : lines) (is_scaled ? r.direction : r.origin) = scale * (is_scaled ? r.direction : r.origin);
            met += check_bundles(serial{}, tree, binary, lines);
            if (is_scaled) check_bundles(serial{}, tree, binary, cut(lines, 1));
        }
        CHECK(met > 15);
    }
}

TEMPLATE_TEST_CASE("bundles of rays: in turns with others, in a large mesh", "", float, double) {
    using T = TestType;
    test::uniform random(512);
    const test::torus<T> around(256, 129, 1, 0.4);
    const mesh<T> m(around.vertices, around.faces);
    REQUIRE(m.size() > std::size_t{1} << 16);
    const auto tree = make_bvh(serial{}, m);
    const auto fine = wide(serial{}, tree);
    auto lines = camera<T>(5, {T(0.3), T(0.2), 3}, 3.2);
    CHECK(share_together(fine, lines) > 0.5);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (i / 50 % 4 == 0) lines[i].direction = random.point<T>(-1, 1) - lines[i].origin;
        if (i / 50 % 4 == 1 && i % 2 == 0) lines[i] = {random.point<T>(-2, 2), random.point<T>(-1, 1)};
    }
    const shapes<ray<T>> rays(lines);
    const auto first = raycast(serial{}, tree, rays).to_host();
    const auto any = raycast_any(serial{}, tree, rays).to_host();
    const auto all = raycast_all(serial{}, tree, rays).to_host();
    const auto met = std::count_if(first.begin(), first.end(), [](const auto& hit) { return hit.id != no_id; });
    CHECK(met > 500);
    const auto check = [&](const auto& on) {
        CHECK((raycast(on, fine, rays).to_host() == first));
        CHECK((raycast_any(on, fine, rays).to_host() == any));
        CHECK((raycast_all(on, fine, rays).to_host() == all));
    };
    check(serial{});
    check(openmp{.threads = 3});
}
