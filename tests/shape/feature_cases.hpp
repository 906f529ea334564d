// SPDX-License-Identifier: MIT
#pragma once

// vertices(mesh) and edges(mesh) on every policy, against a naive oracle: a set of pairs, filled face by face.

#include <cstdint>
#include <cstdio>
#include <set>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

inline std::vector<edge> naive_edges(const std::vector<face>& faces) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const face& f : faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t p = f[k], q = f[(k + 1) % 3];
            if (p != q) found.insert(std::minmax(p, q));
        }
    }
    std::vector<edge> edges;
    for (const auto& [p, q] : found) edges.push_back({p, q});
    return edges;
}

/// The ids of a set of edges, on the host.
template <scalar T, memory_space Space>
std::vector<edge> ids_of(const edge_mesh<T, Space>& edges) {
    const auto here = copy_to(serial{}, edges);
    const auto view = here.view();
    return std::vector<edge>(view.edges.first(), view.edges.first() + view.size());
}

/// A mesh in the policy's memory, and a view of the caller's own arrays there, with strides: points, edges, and their
/// shapes. Returns the number of edges.
template <class Policy, scalar T>
std::size_t check_features(const Policy& on, const std::vector<vec3<T>>& corners, const std::vector<face>& faces) {
    const std::vector<edge> expected = naive_edges(faces);
    const mesh<T> host(corners, faces);
    const auto there = copy_to(on, host);

    const auto rim = edges(on, there);
    CHECK(ids_of(rim) == expected);
    CHECK(rim.view().vertices.data == there.view().vertices.data);  // shared
    CHECK(ids_of(edges(on, host)) == expected);                     // brought over, if need be
    CHECK(ids_of(edges(host)) == expected);
    const auto here = copy_to(serial{}, rim);
    bool same = here.size() == expected.size();
    for (std::size_t i = 0; i < here.size() && same; ++i) {
        const segment<T> s = here.view()[i];
        same = s.a == corners[expected[i][0]] && s.b == corners[expected[i][1]];
    }
    CHECK(same);

    const auto all = vertices(there);
    CHECK(all.size() == corners.size());
    CHECK(all.view().shapes.data == there.view().vertices.data);
    const auto points_here = copy_to(serial{}, all);
    for (std::size_t i = 0; i < corners.size() && same; ++i) same = points_here.view()[i] == corners[i];
    CHECK(same);

    struct vertex {
        T weight;
        vec3<T> position;
    };
    struct tagged_face {
        face ids;
        std::uint32_t tag;
    };
    std::vector<vertex> own_vertices;
    std::vector<tagged_face> own_faces;
    for (const vec3<T>& p : corners) own_vertices.push_back({T(1), p});
    for (const face& f : faces) own_faces.push_back({f, 7});
    execution::buffer_of<Policy, vertex> vertex_memory(on, own_vertices.size() + 1);
    execution::buffer_of<Policy, tagged_face> face_memory(on, own_faces.size() + 1);
    upload(on, own_vertices.data(), own_vertices.size(), vertex_memory.data());
    upload(on, own_faces.data(), own_faces.size(), face_memory.data());
    synchronize(on);
    const mesh_view<T, space_of<Policy>> view(&vertex_memory.data()->position, corners.size(), &face_memory.data()->ids,
                                              faces.size(), sizeof(vertex), sizeof(tagged_face));
    const auto of_view = edges(on, view);
    CHECK(ids_of(of_view) == expected);
    const auto of_view_here = copy_to(serial{}, of_view);
    for (std::size_t i = 0; i < expected.size() && same; ++i) {
        const segment<T> s = of_view_here.view()[i];
        same = s.a == corners[expected[i][0]] && s.b == corners[expected[i][1]];
    }
    CHECK(same);
    CHECK(vertices(view).size() == corners.size());
    CHECK(vertices(view).shapes.stride == sizeof(vertex));
    return expected.size();
}

template <class T>
std::vector<face> random_faces(std::size_t n, std::uint32_t vertex_count, uniform& random) {
    std::vector<face> faces;
    const auto any = [&] { return static_cast<std::uint32_t>(random.below(vertex_count)); };
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t a = any(), b = any(), c = any();
        faces.push_back({a, b, c});
    }
    return faces;
}

template <class T, class Policy>
void check_all_features(const Policy& on, int rounds) {
    constexpr std::uint64_t seed = 20261001;
    std::printf("features of random meshes: seed %llu\n", static_cast<unsigned long long>(seed));
    const auto points_of = [](std::size_t n) {
        std::vector<vec3<T>> points;
        for (std::size_t i = 0; i < n; ++i) points.push_back({static_cast<T>(i), static_cast<T>(i * i % 7), T(-1)});
        return points;
    };
    const auto edges_in = [&](std::size_t vertex_count, const std::vector<face>& faces) {
        return check_features(on, points_of(vertex_count), faces);
    };
    CHECK(edges_in(0, {}) == 0);
    CHECK(edges_in(5, {}) == 0);                                 // vertices of no face
    CHECK(edges_in(1, {{0, 0, 0}}) == 0);                        // a point
    CHECK(edges_in(2, {{0, 1, 1}, {1, 1, 1}}) == 1);             // a segment
    CHECK(edges_in(3, {{0, 1, 2}}) == 3);                        // open
    CHECK(edges_in(4, {{0, 1, 2}, {2, 1, 3}}) == 5);             // one shared
    CHECK(edges_in(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}) == 7);  // three faces at an edge
    CHECK(edges_in(4, {{3, 1, 0}, {0, 1, 3}, {1, 3, 0}}) == 3);  // one face three times
    CHECK(edges_in(4, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) == 6);
    const torus<T> ring(40, 25, 2, 1);
    CHECK(check_features(on, ring.vertices, ring.faces) == ring.faces.size() * 3 / 2);  // closed
    uniform random(seed);
    for (int i = 0; i < rounds; ++i) {
        const auto n = static_cast<std::uint32_t>(1 + random.below(i % 3 == 0 ? 5 : 600));
        check_features(on, points_of(n), random_faces<T>(random.below(2000), n, random));
    }
}

/// Features are sets like any other: points and edges of one torus against another's faces, by index and without.
template <class T, class Policy>
void check_features_in_queries(const Policy& on) {
    const torus<T> ring(24, 12, 2, 1);
    std::vector<vec3<T>> moved;
    for (const vec3<T>& p : ring.vertices) moved.push_back({p.x + T(1.9), p.z, p.y + T(0.07)});
    const mesh<T> a(ring.vertices, ring.faces), b(moved, ring.faces);
    const auto there_a = copy_to(on, a), there_b = copy_to(on, b);
    const auto rim = edges(on, there_a);
    const auto host_rim = edges(a);
    std::vector<index_pair> expected;
    for (std::uint32_t i = 0; i < host_rim.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            if (intersects<exact>(host_rim.view()[i], b.view()[j])) expected.push_back({i, j});
        }
    }
    CHECK(expected.size() > 30);
    CHECK(to_host(pairs(on, rim, there_b)) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, rim), make_bvh(on, there_b))) == expected);
    CHECK(to_host(pairs(on, make_grid(on, rim), there_b)) == expected);
    // Each vertex meets the faces that name it, and no others, since no two vertices are in one place.
    std::vector<index_pair> corners;
    for (std::uint32_t v = 0; v < a.view().vertices.count; ++v) {
        for (std::uint32_t f = 0; f < a.size(); ++f) {
            const face& ids = ring.faces[f];
            if (ids[0] == v || ids[1] == v || ids[2] == v) corners.push_back({v, f});
        }
    }
    CHECK(to_host(pairs(on, vertices(there_a), make_bvh(on, there_a))) == corners);
    CHECK(to_host(pairs(on, make_bvh(on, vertices(there_a)), there_a)) == corners);
}

}  // namespace abut::test
