// SPDX-License-Identifier: MIT
#pragma once

// What `crossings` promises on every policy: one crossing for each of `pairs`, bit for bit what is known of the two triangles
// on the host, whatever the indices, the poses and the form of the arguments. What a crossing has to be is tests/predicate's.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <abut/abut.hpp>
#include <abut/collide/curves.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/poses.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

template <scalar T>
mesh<T> mesh_of(const surface_data<T>& s) {
    return {s.vertices, s.faces};
}

/// A mesh that is turned and moved, its vertices rounded.
inline mesh<float> turned_and_moved(const mesh<float>& of, draws& d, double reach) {
    const double turn = d.uniform(0, 3), c = std::cos(turn), s = std::sin(turn);
    const double x = d.uniform(-reach, reach), y = d.uniform(-reach, reach), z = d.uniform(-reach, reach);
    std::vector<vec3<float>> vertices;
    for (std::size_t i = 0; i < of.view().vertices.count; ++i) {
        const auto v = detail::widened(of.view().vertices[i]);
        const double p = c * v.x - s * v.y, q = s * v.x + c * v.y;
        vertices.push_back({static_cast<float>(p + x), static_cast<float>(c * q - s * v.z + y), static_cast<float>(s * q + c * v.z + z)});
    }
    std::vector<face> faces;
    for (std::size_t i = 0; i < of.size(); ++i) faces.push_back(of.view().faces[i]);
    return {vertices, faces};
}

/// By a plain loop.
template <class A, class B>
auto true_crossings(const A& a, const B& b) {
    using T = typename A::scalar_type;
    std::vector<crossing<T>> all;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            const triangle<T> s = a[i], t = b[j];
            const detail::shared_corners found = detail::corners_at_any_span(s, t);
            if (found.count() == 0) continue;
            crossing<T> c{};
            c.a = i;
            c.b = j;
            const auto of_a = detail::vertices_of_shape(a, i), of_b = detail::vertices_of_shape(b, j);
            std::copy_n(of_a.of, 3, c.vertices_a);
            std::copy_n(of_b.of, 3, c.vertices_b);
            c.count = static_cast<unsigned char>(found.count());
            c.coplanar = found.is_flat() ? 1 : 0;
            for (int k = 0; k < found.count(); ++k) {
                c.in_a[k] = static_cast<unsigned char>(found.in_first(k));
                c.in_b[k] = static_cast<unsigned char>(found.in_second(k));
                c.points[k] = detail::point_of_corner(found, k, s, t);
            }
            all.push_back(c);
        }
    }
    return all;
}

/// Triangles of a small grid, and of all exponents.
template <scalar T>
triangle_soup<T> few_triangles(draws& d, std::size_t n, bool of_all_exponents) {
    std::vector<triangle<T>> all;
    const auto place = [&] {
        const auto coordinate = [&] {
            const T unit = of_all_exponents && d.below(2) == 0 ? std::numeric_limits<T>::min() * 4 : T{1};
            return static_cast<T>(d.below(5) - 2) * unit;
        };
        return vec3<T>{coordinate(), coordinate(), coordinate()};
    };
    for (std::size_t i = 0; i < n; ++i) {
        const vec3<T> a = place(), b = place(), c = place();
        all.push_back({a, b, c});
    }
    return triangle_soup<T>(std::move(all));
}

template <scalar T, class Policy>
void check_crossings(const Policy& on) {
    using found_list = std::vector<crossing<T>>;
    draws d(20270515, 1, 1);
    const mesh<T> ball = mesh_of(ball_surface<T>(2, 1)), other = mesh_of(ball_surface<T>(1, 1));
    for (int k = 0; k < 3; ++k) {
        // The same, coplanar in part and in general position.
        rigid<T> pose{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {T(0.25) * static_cast<T>(k), 0, 0}};
        if (k == 2) pose = make_loose_pose<T>(d, 0.3);
        const posed_view<typename mesh<T>::view_type> there{ball.view(), pose};
        const found_list expected = true_crossings(other.view(), there);
        CHECK(!expected.empty());
        const auto a = copy_to(on, other), b = copy_to(on, ball);
        const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
        CHECK(to_host(crossings(on, a, posed(b, pose))) == expected);
        CHECK(to_host(crossings<exact>(on, tree_a, posed(tree_b, pose))) == expected);
        CHECK(to_host(crossings(on, a, posed(tree_b, pose))) == expected);
        const auto ids = to_host(pairs(on, tree_a, posed(tree_b, pose)));
        CHECK(ids.size() == expected.size());
        found_list unsorted = to_host(crossings(on, tree_a, posed(tree_b, pose), {.sorted = false}));
        std::sort(unsorted.begin(), unsorted.end(), [](const auto& x, const auto& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
        CHECK(unsorted == expected);
        // Lists and bodies.
        using tree = std::remove_const_t<decltype(tree_a)>;
        const rigid<T> home{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
        const std::vector<posed_pair<tree>> list{{posed(tree_b, home), posed(tree_b, home)}, {posed(tree_a, home), posed(tree_b, pose)}};
        std::size_t next = 0;
        for (const auto& c : to_host(crossings(on, list))) {
            if (c.pair == 0) continue;
            REQUIRE(next < expected.size());
            crossing<T> one = c.common;
            one.a = c.a;
            one.b = c.b;
            CHECK(one == expected[next]);
            ++next;
        }
        CHECK(next == expected.size());
        const std::vector<posed_object<tree>> scene{posed(tree_a, home), posed(tree_b, pose)};
        const auto of_bodies = to_host(crossings(on, make_bodies(on, scene)));
        CHECK(of_bodies.size() == expected.size());
        for (std::size_t i = 0; i < of_bodies.size() && i < expected.size(); ++i) {
            CHECK((of_bodies[i].body_a == 0 && of_bodies[i].body_b == 1 && of_bodies[i].a == expected[i].a));
            CHECK(of_bodies[i].common.points[0] == expected[i].points[0]);
        }
    }
    for (const bool of_all_exponents : {false, true}) {
        const auto x = few_triangles<T>(d, 60, of_all_exponents), y = few_triangles<T>(d, 70, of_all_exponents);
        const found_list expected = true_crossings(x.view(), y.view());
        CHECK(expected.size() > 300);
        CHECK(to_host(crossings(on, copy_to(on, x), make_bvh(on, copy_to(on, y)))) == expected);
    }
    {  // In one plane, and of no lattice: polygons with sides of both, which compilers for devices got in the wrong order.
        std::vector<triangle<T>> flat;
        for (int i = 0; i < 60; ++i) {
            const auto corner = [&] {
                const T u = static_cast<T>(d.uniform(-1, 1));
                return vec3<T>{u, static_cast<T>(d.uniform(-1, 1)), 0};
            };
            const vec3<T> p = corner(), q = corner();
            flat.push_back({p, q, corner()});
        }
        const triangle_soup<T> soup(flat);
        const found_list expected = true_crossings(soup.view(), soup.view());
        std::size_t polygons = 0;
        for (const auto& c : expected) polygons += c.count > 3;
        CHECK(polygons > 500);
        CHECK(to_host(crossings(on, copy_to(on, soup), make_bvh(on, copy_to(on, soup)))) == expected);
    }
    CHECK(crossings(on, copy_to(on, mesh<T>()), copy_to(on, ball)).size() == 0);
}

/// Two balls in one mesh: all crossings are of a face of the one with a face of the other, and those are `crossings` of them.
template <scalar T, class Policy>
void check_self_crossings(const Policy& on) {
    const auto ball = ball_surface<T>(2, 1);
    auto two = ball;
    const auto vertices = static_cast<std::uint32_t>(ball.vertices.size()), faces = static_cast<std::uint32_t>(ball.faces.size());
    std::vector<vec3<T>> moved;
    for (const auto& v : ball.vertices) moved.push_back({v.x + T(0.3), v.y + T(0.21), v.z - T(0.17)});
    two.vertices.insert(two.vertices.end(), moved.begin(), moved.end());
    for (auto f : ball.faces) {
        for (auto& v : f) v += vertices;
        two.faces.push_back(f);
    }
    const mesh<T> whole = mesh_of(two), first = mesh_of(ball), second(moved, ball.faces);
    auto expected = true_crossings(first.view(), second.view());
    for (auto& c : expected) {
        c.b += faces;
        for (auto& v : c.vertices_b) v += vertices;
        c.of_one_mesh = 1;
    }
    CHECK(!expected.empty());
    CHECK(to_host(self_crossings(on, make_bvh(on, copy_to(on, whole)))) == expected);
    CHECK(to_host(self_crossings(on, copy_to(on, whole))) == expected);
    // Two faces with an edge in common that fold onto each other.
    const mesh<T> fold({{0, 0, 0}, {4, 0, 0}, {1, 2, 0}, {2, 4, 0}}, {{0, 1, 2}, {1, 0, 3}});
    const auto folded = to_host(self_crossings(on, copy_to(on, fold)));
    REQUIRE(folded.size() == 1);
    CHECK(folded[0].count == 3);
    CHECK(folded[0].coplanar == 1);
    CHECK(folded[0].feature_a(0) == mesh_feature{mesh_part::at_vertex, 0, 0});
    CHECK(folded[0].feature_b(0) == mesh_feature{mesh_part::at_vertex, 0, 0});
}

}  // namespace abut::test
