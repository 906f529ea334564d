// SPDX-License-Identifier: MIT
#pragma once

// What self_pairs promises on every policy: the pairs of a plain loop over all faces and the oracle of
// support/shared_faces.hpp, from sets and all indices, posed or not, with vertices taken as they are and as one in each
// place. And `welded`, against a plain loop.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/leafless.hpp>

#include "query_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/shared_faces.hpp"

namespace abut::test {

/// A mesh before it is one.
template <class T>
struct raw_mesh {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
};

/// Faces over vertices that are drawn as tests/support/shared_faces.hpp draws them: full of neighbours that fold, cross and
/// coincide.
template <class T>
raw_mesh<T> tangled(places kind, std::uint64_t index, std::size_t vertices, std::size_t faces) {
    draws d(20270116, 160 + static_cast<std::uint64_t>(kind), index);
    raw_mesh<T> m{draw_places<T>(d, kind, vertices), {}};
    for (std::size_t f = 0; f < faces; ++f) {
        const auto v = [&] { return static_cast<std::uint32_t>(d.below(static_cast<int>(vertices))); };
        const std::uint32_t a = v(), b = v(), c = v();
        m.faces.push_back({a, b, c});
    }
    return m;
}

/// A torus, of which some vertices are pushed to the middle or onto others, so that parts pass through each other.
template <class T>
raw_mesh<T> crumpled_torus(std::uint32_t around, std::uint32_t across, int pushed) {
    torus<T> t(around, across, 3, 1);
    draws d(20270117, 180, around);
    for (int k = 0; k < pushed; ++k) {
        const auto v = static_cast<std::size_t>(d.below(static_cast<int>(t.vertices.size())));
        const auto w = static_cast<std::size_t>(d.below(static_cast<int>(t.vertices.size())));
        t.vertices[v] = k % 2 == 0 ? vec3<T>{0, 0, 0} : t.vertices[w];
    }
    return {t.vertices, t.faces};
}

/// A flat sheet of voxel corners, folded over along the middle onto itself.
template <class T>
raw_mesh<T> folded_sheet(std::uint32_t n) {
    raw_mesh<T> m;
    for (std::uint32_t i = 0; i <= n; ++i) {
        for (std::uint32_t j = 0; j <= n; ++j) {
            const auto x = static_cast<T>(i), y = static_cast<T>(j);
            m.vertices.push_back({2 * i <= n ? x : static_cast<T>(n) - x, y, 0});
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            m.faces.push_back({a, b, b + 1});
            m.faces.push_back({a, b + 1, a + 1});
        }
    }
    return m;
}

template <class T>
pair_list self_truth(const raw_mesh<T>& m, const rigid<T>& pose, bool merged, bool soup) {
    std::vector<detail::mesh_face<T>> faces;
    std::vector<aabb<T>> boxes;
    for (std::uint32_t f = 0; f < m.faces.size(); ++f) {
        const face& v = m.faces[f];
        detail::mesh_face<T> one{{m.vertices[v[0]], m.vertices[v[1]], m.vertices[v[2]]}, {v[0], v[1], v[2]}};
        if (pose != rigid<T>{}) one.corners = place(pose, one.corners);
        for (std::uint32_t& x : one.vertex) x = merged ? detail::mesh_face<T>::by_place : soup ? f : x;
        faces.push_back(one);
        boxes.push_back(bounds(one.corners));
    }
    pair_list touching;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        for (std::uint32_t j = i + 1; j < faces.size(); ++j) {
            if (overlaps(boxes[i], boxes[j]) && oracle::meet_beyond_shared(faces[i], faces[j])) touching.push_back({i, j});
        }
    }
    return touching;
}

/// Keeps pairs by the sum of their ids, and none with a > b.
struct odd_sum {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return a < b && (a + b) % 2 == 1; }
};

/// Every way to ask `x`.
template <class Policy, class X>
void check_self(const Policy& on, const X& x, const pair_list& expected, coincident_vertices coincident) {
    const self_options<> as_usual{.coincident = coincident};
    CHECK(to_host(self_pairs(on, x, as_usual)) == expected);
    CHECK(to_host(self_pairs<exact>(on, x, as_usual)) == expected);
    CHECK(count_self_pairs(on, x, as_usual) == expected.size());
    auto unsorted = to_host(self_pairs(on, x, {.sorted = false, .coincident = coincident}));
    std::sort(unsorted.begin(), unsorted.end());
    CHECK(unsorted == expected);
    pair_list odd;
    for (const index_pair& p : expected) {
        if ((p.a + p.b) % 2 == 1) odd.push_back(p);
    }
    CHECK(to_host(self_pairs(on, x, self_options<odd_sum>{.filter = {}, .coincident = coincident})) == odd);
}

/// The policy's indices over a set that lies in its memory, under a pose unless that is none.
template <class Policy, class Set, class T>
void check_self_indices(const Policy& on, const Set& set, const rigid<T>& pose, const pair_list& expected,
                        coincident_vertices coincident) {
    const self_options<> as_usual{.coincident = coincident};
    const auto tree = make_bvh(on, set);
    const auto grid = make_grid(on, set);
    const auto check_posed = [&](const auto& x) { CHECK(to_host(self_pairs(on, posed(x, pose), as_usual)) == expected); };
    if (pose == rigid<T>{}) {
        check_self(on, set, expected, coincident);
        check_self(on, tree, expected, coincident);
        check_self(on, grid, expected, coincident);
        CHECK(to_host(self_pairs(on, quantised(on, tree), as_usual)) == expected);
        CHECK(to_host(self_pairs(on, leafless(on, tree), as_usual)) == expected);
        for (const int depth : {0, 3, most_start_depth}) {
            const self_options<keep_all, traversal::breadth_first> by_levels{.start_depth = depth, .coincident = coincident};
            CHECK(to_host(self_pairs(on, tree, by_levels)) == expected);
        }
        if constexpr (host_policy<Policy>) {
            CHECK(to_host(self_pairs(on, wide(on, tree), as_usual)) == expected);
            CHECK(to_host(self_pairs(on, make_bvh(on, set, {.builder = bvh_builder::sah}), as_usual)) == expected);
        }
    }
    check_posed(set);
    check_posed(tree);
    check_posed(grid);
    if constexpr (host_policy<Policy>) check_posed(wide(on, tree));
}

/// What is true of a mesh under a pose.
template <class T>
struct self_case {
    raw_mesh<T> m;
    rigid<T> pose;
    pair_list distinct, merged, of_soup;

    explicit self_case(raw_mesh<T> of, const rigid<T>& at = {})
        : m(std::move(of)),
          pose(at),
          distinct(self_truth(m, at, false, false)),
          merged(self_truth(m, at, true, false)),
          of_soup(self_truth(m, at, false, true)) {}
};

/// A mesh, and its triangles as a soup.
template <class Policy, class T>
void check_self_mesh(const Policy& on, const self_case<T>& c) {
    const auto& m = c.m;
    const auto& pose = c.pose;
    const auto here = copy_to(on, mesh<T>(m.vertices, m.faces));
    std::vector<triangle<T>> triangles;
    for (const face& v : m.faces) triangles.push_back({m.vertices[v[0]], m.vertices[v[1]], m.vertices[v[2]]});
    const auto soup = copy_to(on, triangle_soup<T>(triangles));
    for (const bool merged : {false, true}) {
        const auto coincident = merged ? coincident_vertices::merged : coincident_vertices::distinct;
        CAPTURE(m.faces.size(), merged);
        check_self_indices(on, here, pose, merged ? c.merged : c.distinct, coincident);
        const pair_list& of_soup = merged ? c.merged : c.of_soup;
        CHECK(to_host(self_pairs(on, posed(make_bvh(on, soup), pose), {.coincident = coincident})) == of_soup);
        CHECK(to_host(self_pairs(on, posed(soup, pose), {.coincident = coincident})) == of_soup);
    }
}

/// Made once, for all policies.
template <class T>
const std::vector<self_case<T>>& self_meshes() {
    static const std::vector<self_case<T>> all = [] {
        std::vector<self_case<T>> made;
        for (const places kind : {places::lattice_2, places::lattice_4, places::flat_lattice, places::tilted_plane,
                                  places::tenths, places::random, places::any_span}) {
            made.emplace_back(tangled<T>(kind, 0, 12, 40));
        }
        for (const places kind : {places::lattice_4, places::tenths}) {
            draws d(20270118, 190, made.size());
            made.emplace_back(tangled<T>(kind, 1, 12, 40), make_pose<T>(d, 1));
        }
        for (const std::size_t n : {0u, 1u, 2u, 3u}) made.emplace_back(tangled<T>(places::lattice_1, 2, 4, n));
        made.emplace_back(crumpled_torus<T>(10, 6, 5));
        made.emplace_back(crumpled_torus<T>(10, 6, 0));
        made.emplace_back(folded_sheet<T>(7));
        return made;
    }();
    return all;
}

template <class T, class Policy>
void check_all_self(const Policy& on) {
    std::size_t distinct = 0, merged = 0, of_soup = 0;
    for (const self_case<T>& c : self_meshes<T>()) {
        CAPTURE(&c - self_meshes<T>().data());
        check_self_mesh(on, c);
        distinct += c.distinct.size(), merged += c.merged.size(), of_soup += c.of_soup.size();
    }
    std::printf("self_pairs: %zu pairs, %zu with vertices merged, %zu of soups\n", distinct, merged, of_soup);
    CHECK(distinct > 1000);
    CHECK(merged > 1000);
    CHECK(of_soup > 2 * distinct);
    const auto& last = self_meshes<T>().rbegin();
    CHECK(last[0].distinct.size() > 50);  // folded
    CHECK(last[1].distinct.empty());      // a torus as it should be
    CHECK(last[2].distinct.size() > 50);  // crumpled
}

/// Other shapes are paired as they are.
template <class T, class Policy>
void check_self_shapes(const Policy& on) {
    uniform random(20270119);
    const auto check = [&](const auto& set_here) {
        const auto v = set_here.view();
        pair_list expected;
        for (std::uint32_t i = 0; i < v.size(); ++i) {
            for (std::uint32_t j = i + 1; j < v.size(); ++j) {
                if (intersects<exact>(v[i], v[j])) expected.push_back({i, j});
            }
        }
        CHECK(expected.size() > 50);
        check_self_indices(on, copy_to(on, set_here), rigid<T>{}, expected, coincident_vertices::distinct);
    };
    std::vector<sphere<T>> balls;
    for (int k = 0; k < 300; ++k) balls.push_back({random.point<T>(-1, 1), static_cast<T>(random(0, 0.2))});
    check(spheres<T>(balls));
    std::vector<vec3<T>> centers;
    for (const auto& s : balls) centers.push_back(s.center);
    check(equal_spheres<T>(centers, T(0.125)));
}

/// `welded` against a plain loop.
template <class T, class Policy>
void check_welded(const Policy& on, const raw_mesh<T>& m) {
    const auto key = [](const vec3<T>& p) { return std::array<T, 3>{p.x + T(0), p.y + T(0), p.z + T(0)}; };
    raw_mesh<T> expected;
    std::map<std::array<T, 3>, std::uint32_t> seen;
    std::vector<std::uint32_t> number;
    for (const vec3<T>& p : m.vertices) {
        const auto [at, is_new] = seen.try_emplace(key(p), static_cast<std::uint32_t>(expected.vertices.size()));
        if (is_new) expected.vertices.push_back(p);
        number.push_back(at->second);
    }
    for (const face& f : m.faces) expected.faces.push_back({number[f[0]], number[f[1]], number[f[2]]});
    const auto check = [&](const auto& made) {
        const auto here = copy_to(serial{}, made);
        const auto v = here.view();
        CHECK(std::vector<vec3<T>>(v.vertices.first(), v.vertices.first() + v.vertices.count) == expected.vertices);
        CHECK(std::vector<face>(v.faces.first(), v.faces.first() + v.faces.count) == expected.faces);
    };
    const auto here = copy_to(on, mesh<T>(m.vertices, m.faces));
    check(welded(on, here));
    check(welded(on, here.view()));
    check(welded(on, mesh<T>(m.vertices, m.faces)));
    CHECK(to_host(self_pairs(on, welded(on, here))) ==
          to_host(self_pairs(on, here, {.coincident = coincident_vertices::merged})));
}

template <class T, class Policy>
void check_all_welded(const Policy& on) {
    for (const places kind : {places::lattice_2, places::signed_zeros, places::random, places::denormal}) {
        check_welded(on, tangled<T>(kind, 3, 60, 50));
    }
    check_welded(on, tangled<T>(places::lattice_2, 4, 1, 0));
    check_welded(on, raw_mesh<T>{});
    check_welded(on, folded_sheet<T>(20));
}

}  // namespace abut::test
