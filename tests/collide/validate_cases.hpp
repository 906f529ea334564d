// SPDX-License-Identifier: MIT
#pragma once

// What `validate` says on every policy, against answers that are known and against a naive oracle: maps and sets over faces
// one by one, written from the definitions in shape/mesh_report.hpp and from nothing else.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/flat_triangles.hpp"
#include "support/scenes.hpp"

namespace abut::test {

inline constexpr std::uint64_t mesh_seed = 1968;

template <class T>
struct plain_mesh {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;
};

/// Corners of small integers, so that the cross product is exact in 64 bits; other corners by has_zero_area, whose own truth
/// is tests/predicate.
template <class T>
bool is_flat(const triangle<T>& t) {
    const T coordinates[9] = {t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    for (const T x : coordinates) {
        if (!(std::abs(x) < 1000) || x != std::floor(x)) return has_zero_area<exact>(t);
    }
    const auto minus = [](T x, T y) { return static_cast<std::int64_t>(x) - static_cast<std::int64_t>(y); };
    const std::int64_t fx = minus(t.b.x, t.a.x), fy = minus(t.b.y, t.a.y), fz = minus(t.b.z, t.a.z);
    const std::int64_t gx = minus(t.c.x, t.a.x), gy = minus(t.c.y, t.a.y), gz = minus(t.c.z, t.a.z);
    return fy * gz == fz * gy && fz * gx == fx * gz && fx * gy == fy * gx;
}

/// Number of pieces that sets make up, where two are of one piece if a chain of sets leads from one to the other, each
/// sharing an element with the next. By flooding.
inline std::size_t pieces_of(const std::vector<std::set<std::uint32_t>>& sets) {
    std::map<std::uint32_t, std::vector<std::size_t>> having;
    for (std::size_t i = 0; i < sets.size(); ++i) {
        for (const std::uint32_t x : sets[i]) having[x].push_back(i);
    }
    std::size_t pieces = 0;
    std::vector<bool> wet(sets.size());
    for (std::size_t start = 0; start < sets.size(); ++start) {
        if (wet[start]) continue;
        ++pieces;
        std::vector<std::size_t> open{start};
        wet[start] = true;
        while (!open.empty()) {
            const std::size_t i = open.back();
            open.pop_back();
            for (const std::uint32_t x : sets[i]) {
                for (const std::size_t j : std::exchange(having[x], {})) {
                    if (!wet[j]) open.push_back(j);
                    wet[j] = true;
                }
            }
        }
    }
    return pieces;
}

template <class T>
mesh_report naive_report(const plain_mesh<T>& m) {
    mesh_report r;
    r.vertices = m.vertices.size();
    r.faces = m.faces.size();
    const auto finite = [&](std::uint32_t v) {
        const vec3<T>& p = m.vertices[v];
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };

    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::uint32_t, bool>>> edges;
    std::map<std::uint32_t, std::vector<std::set<std::uint32_t>>> links;  // of a vertex: the other two of each face
    std::map<std::set<std::uint32_t>, std::uint32_t> seen;
    std::vector<std::set<std::uint32_t>> triangles;
    for (std::uint32_t f = 0; f < m.faces.size(); ++f) {
        const face& c = m.faces[f];
        if (*std::max_element(c.begin(), c.end()) >= m.vertices.size()) {
            r.faces_out_of_range.push_back(f);
            continue;
        }
        const triangle<T> t{m.vertices[c[0]], m.vertices[c[1]], m.vertices[c[2]]};
        if (finite(c[0]) && finite(c[1]) && finite(c[2]) && is_flat(t)) r.zero_area_faces.push_back(f);
        const std::set<std::uint32_t> three(c.begin(), c.end());
        if (three.size() < 3) {
            r.faces_with_repeated_index.push_back(f);
            continue;
        }
        triangles.push_back(three);
        const auto [first, fresh] = seen.try_emplace(three, f);
        if (!fresh) {
            face here = c, there = m.faces[first->second];
            std::rotate(here.begin(), std::min_element(here.begin(), here.end()), here.end());
            std::rotate(there.begin(), std::min_element(there.begin(), there.end()), there.end());
            r.duplicate_faces.push_back({f, first->second, here != there});
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = c[k], to = c[(k + 1) % 3], third = c[(k + 2) % 3];
            edges[std::minmax(from, to)].push_back({f, from < to});
            links[third].push_back({from, to});
        }
    }

    r.edges = edges.size();
    for (const auto& [ends, uses] : edges) {
        const mesh_edge e{ends.first, ends.second, static_cast<std::uint32_t>(uses.size()), uses.front().first,
                          uses.back().first};
        if (uses.size() == 1) r.boundary_edges.push_back(e);
        if (uses.size() > 2) r.nonmanifold_edges.push_back(e);
        if (uses.size() == 2 && uses[0].second == uses[1].second) r.inconsistent_edges.push_back(e);
    }
    std::map<std::tuple<T, T, T>, std::uint32_t> places;  // 0.0 and -0.0 are one key
    for (std::uint32_t v = 0; v < m.vertices.size(); ++v) {
        const auto link = links.find(v);
        if (link == links.end()) {
            r.unused_vertices.push_back(v);
        } else if (pieces_of(link->second) > 1) {
            r.nonmanifold_vertices.push_back(v);
        }
        if (!finite(v)) {
            r.nonfinite_vertices.push_back(v);
            continue;
        }
        const vec3<T>& p = m.vertices[v];
        const auto [first, fresh] = places.try_emplace({p.x, p.y, p.z}, v);
        if (!fresh) r.coincident_vertices.push_back({v, first->second});
    }
    r.components = pieces_of(triangles);
    r.euler_characteristic = static_cast<std::int64_t>(links.size()) - static_cast<std::int64_t>(edges.size()) +
                             static_cast<std::int64_t>(triangles.size());
    return r;
}

inline void check_same(const mesh_report& is, const mesh_report& should) {
    CHECK(is.vertices == should.vertices);
    CHECK(is.faces == should.faces);
    CHECK(is.edges == should.edges);
    CHECK(is.components == should.components);
    CHECK(is.euler_characteristic == should.euler_characteristic);
    CHECK(is.boundary_edges == should.boundary_edges);
    CHECK(is.nonmanifold_edges == should.nonmanifold_edges);
    CHECK(is.inconsistent_edges == should.inconsistent_edges);
    CHECK(is.faces_out_of_range == should.faces_out_of_range);
    CHECK(is.faces_with_repeated_index == should.faces_with_repeated_index);
    CHECK(is.zero_area_faces == should.zero_area_faces);
    CHECK(is.duplicate_faces == should.duplicate_faces);
    CHECK(is.nonfinite_vertices == should.nonfinite_vertices);
    CHECK(is.unused_vertices == should.unused_vertices);
    CHECK(is.nonmanifold_vertices == should.nonmanifold_vertices);
    CHECK(is.coincident_vertices == should.coincident_vertices);
    CHECK(is == should);
}

/// Through a view over the policy's memory, with strides, which is not checked before.
template <class Policy, class T>
mesh_report validate_as_view(const Policy& on, const plain_mesh<T>& m) {
    struct vertex {
        T weight;
        vec3<T> position;
    };
    struct tagged_face {
        face vertices;
        std::uint32_t tag;
    };
    std::vector<vertex> vertices;
    std::vector<tagged_face> faces;
    for (const vec3<T>& p : m.vertices) vertices.push_back({T(1), p});
    for (const face& f : m.faces) faces.push_back({f, 7});
    execution::buffer_of<Policy, vertex> vertex_memory(on, vertices.size() + 1);
    execution::buffer_of<Policy, tagged_face> face_memory(on, faces.size() + 1);
    upload(on, vertices.data(), vertices.size(), vertex_memory.data());
    upload(on, faces.data(), faces.size(), face_memory.data());
    synchronize(on);
    const mesh_view<T, space_of<Policy>> view(&vertex_memory.data()->position, vertices.size(),
                                              &face_memory.data()->vertices, faces.size(), sizeof(vertex),
                                              sizeof(tagged_face));
    return validate(on, view);
}

// --- meshes with known answers --------------------------------------------------------------------------------------------

/// What a case is sure of; the rest is the oracle's.
struct known_facts {
    const char* name;
    std::uint64_t edges, components;
    std::int64_t euler_characteristic;
    bool closed, manifold, oriented;
    std::size_t boundary, nonmanifold_edges, inconsistent;
    std::vector<std::uint32_t> repeated, zero_area;
    std::vector<duplicate_face> duplicates;
    std::vector<std::uint32_t> unused, nonmanifold_vertices;
    std::vector<coincident_vertex> coincident;
};

template <class Policy, class T>
void check_known(const Policy& on, const plain_mesh<T>& m, const known_facts& known) {
    CAPTURE(known.name);
    const mesh_report r = validate(on, mesh<T>(m.vertices, m.faces));
    CHECK(r.edges == known.edges);
    CHECK(r.components == known.components);
    CHECK(r.euler_characteristic == known.euler_characteristic);
    CHECK(r.closed() == known.closed);
    CHECK(r.manifold() == known.manifold);
    CHECK(r.oriented() == known.oriented);
    CHECK(r.boundary_edges.size() == known.boundary);
    CHECK(r.nonmanifold_edges.size() == known.nonmanifold_edges);
    CHECK(r.inconsistent_edges.size() == known.inconsistent);
    CHECK(r.faces_with_repeated_index == known.repeated);
    CHECK(r.zero_area_faces == known.zero_area);
    CHECK(r.duplicate_faces == known.duplicates);
    CHECK(r.unused_vertices == known.unused);
    CHECK(r.nonmanifold_vertices == known.nonmanifold_vertices);
    CHECK(r.coincident_vertices == known.coincident);
    if (r.closed()) CHECK(2 * r.edges == 3 * r.faces);
    check_same(r, naive_report(m));
    check_same(validate_as_view(on, m), r);
    CHECK(validate(on, copy_to(on, mesh<T>(m.vertices, m.faces))) == r);
}

template <class Policy, class T>
void check_known_meshes(const Policy& on) {
    const std::vector<vec3<T>> corners{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
    const std::vector<face> tetrahedron{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const auto check = [&](const plain_mesh<T>& m, const known_facts& known) { check_known(on, m, known); };

    check({}, {"nothing", 0, 0, 0, false, true, true, 0, 0, 0, {}, {}, {}, {}, {}, {}});
    check({corners, {}}, {"vertices only", 0, 0, 0, false, true, true, 0, 0, 0, {}, {}, {}, {0, 1, 2, 3}, {}, {}});
    check({{{1, 2, 3}}, {{0, 0, 0}}}, {"one point", 0, 0, 0, false, false, true, 0, 0, 0, {0}, {0}, {}, {0}, {}, {}});
    check({corners, {{1, 2, 3}}}, {"one triangle", 3, 1, 1, false, true, true, 3, 0, 0, {}, {}, {}, {0}, {}, {}});
    check({corners, tetrahedron}, {"tetrahedron", 6, 1, 2, true, true, true, 0, 0, 0, {}, {}, {}, {}, {}, {}});
    check({corners, {tetrahedron[0], tetrahedron[1], tetrahedron[2], {1, 3, 2}}},
          {"tetrahedron, one face turned", 6, 1, 2, true, true, false, 0, 0, 3, {}, {}, {}, {}, {}, {}});
    check({corners, {tetrahedron[0], tetrahedron[1], tetrahedron[2]}},
          {"tetrahedron, open", 6, 1, 1, false, true, true, 3, 0, 0, {}, {}, {}, {}, {}, {}});

    plain_mesh<T> cube;
    for (int i = 0; i < 8; ++i) cube.vertices.push_back({T(i & 1), T(i >> 1 & 1), T(i >> 2 & 1)});
    cube.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    check(cube, {"cube", 18, 1, 2, true, true, true, 0, 0, 0, {}, {}, {}, {}, {}, {}});

    // Five triangles in a strip whose ends meet with a twist: each vertex is on the one boundary; no turning of faces makes
    // all of them agree.
    check({{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {1, 2, 1}, {0, 1, 2}}, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}}},
          {"Moebius strip", 10, 1, 0, false, true, false, 5, 0, 1, {}, {}, {}, {}, {}, {}});
    check({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}},
          {"bow tie", 6, 1, 1, false, false, true, 6, 0, 0, {}, {}, {}, {}, {0}, {}});
    check({{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}},
          {"book of three pages", 7, 1, 1, false, false, false, 6, 1, 0, {}, {}, {}, {}, {}, {}});
    check({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {-4, 0, 0}, {0, -4, 0}, {0, 0, -4}},
           {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 5, 4}, {0, 4, 6}, {0, 6, 5}, {4, 5, 6}}},
          {"two tetrahedra with a vertex in common", 12, 1, 3, true, false, true, 0, 0, 0, {}, {}, {}, {}, {0}, {}});
    check({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {T(-0.0), 0, 0}, {0, -4, 0}, {0, 0, -4}, {-4, 0, 0}},
           {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {4, 5, 7}, {4, 7, 6}, {4, 6, 5}, {7, 5, 6}}},
          {"two tetrahedra in one place, but not in one vertex",
           12,
           2,
           4,
           true,
           true,
           true,
           0,
           0,
           0,
           {},
           {},
           {},
           {},
           {},
           {{4, 0}}});

    check({corners, {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}}, {"one face three times",
                                                         3,
                                                         1,
                                                         3,
                                                         false,
                                                         false,
                                                         false,
                                                         0,
                                                         3,
                                                         0,
                                                         {},
                                                         {},
                                                         {{1, 0, false}, {2, 0, false}},
                                                         {3},
                                                         {},
                                                         {}});
    check({corners, {{0, 1, 2}, {0, 2, 1}}},
          {"a face and its back", 3, 1, 2, true, true, true, 0, 0, 0, {}, {}, {{1, 0, true}}, {3}, {}, {}});
    check({corners, {{3, 1, 2}, {1, 2, 3}}},
          {"a face twice", 3, 1, 2, true, true, false, 0, 0, 3, {}, {}, {{1, 0, false}}, {0}, {}, {}});
    check({corners, {{0, 0, 3}, {0, 2, 1}, {0, 1, 3}, {2, 2, 2}, {0, 3, 2}, {1, 2, 3}, {3, 1, 3}}},
          {"repeated indices beside a tetrahedron",
           6,
           1,
           2,
           false,
           false,
           true,
           0,
           0,
           0,
           {0, 3, 6},
           {0, 3, 6},
           {},
           {},
           {},
           {}});
    check({{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {0, 0, 0}, {5, 6, 7}}, {{0, 1, 2}, {0, 3, 4}, {0, 1, 4}}},
          {"flat faces count", 7, 1, 1, false, true, false, 5, 0, 2, {}, {0, 1}, {}, {}, {}, {{3, 0}}});
}

// --- random meshes with every defect
// ----------------------------------------------------------------------------------------

/// Vertices in a small lattice of integers, so that they coincide and lie in line; faces drawn from few vertices, repeated,
/// turned and broken. `broken` adds what no set may hold.
template <class T>
plain_mesh<T> random_mesh(uniform& random, bool broken) {
    plain_mesh<T> m;
    const std::size_t vertices = 3 + random.below(30), faces = random.below(60), side = 1 + random.below(5);
    const auto coordinate = [&] {
        const auto x = static_cast<T>(random.below(side + 1));
        return x == 0 && random() < 0.5 ? T(-0.0) : x;
    };
    for (std::size_t v = 0; v < vertices; ++v) {
        const T x = coordinate(), y = coordinate(), z = coordinate();
        m.vertices.push_back({x, y, z});
    }
    if (broken) {
        m.vertices[random.below(vertices)].y = std::numeric_limits<T>::quiet_NaN();
        m.vertices[random.below(vertices)].x = std::numeric_limits<T>::infinity();
        m.vertices[random.below(vertices)].x = std::numeric_limits<T>::infinity();
    }
    const auto any_vertex = [&] { return static_cast<std::uint32_t>(random.below(vertices)); };
    for (std::size_t f = 0; f < faces; ++f) {
        face c{any_vertex(), any_vertex(), any_vertex()};
        if (f > 0 && random() < 0.5) {  // a neighbour of a face, or the face itself
            c = m.faces[random.below(f)];
            if (random() < 0.8) c[random.below(3)] = any_vertex();
            std::rotate(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(random.below(3)), c.end());
            if (random() < 0.6) std::swap(c[0], c[1]);
        }
        if (random() < 0.05) c[random.below(3)] = c[random.below(3)];
        if (broken && random() < 0.1)
            c[random.below(3)] = random() < 0.5 ? static_cast<std::uint32_t>(vertices) : 0xffffffffu;
        m.faces.push_back(c);
    }
    return m;
}

/// How many reports have something in each list: a test in which nothing is ever wrong proves nothing.
struct hit_rates {
    std::size_t of[12]{};

    void add(const mesh_report& r) {
        const bool hits[12] = {
            !r.boundary_edges.empty(),       !r.nonmanifold_edges.empty(),   !r.inconsistent_edges.empty(),
            !r.faces_out_of_range.empty(),   !r.nonfinite_vertices.empty(),  !r.faces_with_repeated_index.empty(),
            !r.zero_area_faces.empty(),      !r.duplicate_faces.empty(),     !r.unused_vertices.empty(),
            !r.nonmanifold_vertices.empty(), !r.coincident_vertices.empty(), r.components > 1};
        for (std::size_t k = 0; k < 12; ++k) of[k] += hits[k];
    }
};

template <class Policy, class T>
void check_random_meshes(const Policy& on, int rounds) {
    uniform random(mesh_seed);
    hit_rates rates;
    for (int round = 0; round < rounds; ++round) {
        CAPTURE(mesh_seed, round);
        const bool broken = round % 2 == 1;
        const plain_mesh<T> m = random_mesh<T>(random, broken);
        const mesh_report expected = naive_report(m);
        rates.add(expected);
        check_same(validate_as_view(on, m), expected);
        if (expected.nonfinite_vertices.empty() && expected.faces_out_of_range.empty()) {
            check_same(validate(on, mesh<T>(m.vertices, m.faces)), expected);
        }
    }
    for (std::size_t k = 0; k < 12; ++k) {
        CAPTURE(k);
        CHECK(rates.of[k] > static_cast<std::size_t>(rounds) / 20);
    }
}

/// Tori in random order, large enough for threads and blocks, with all that faces and vertices can be done to.
template <class Policy, class T>
void check_large_mesh(const Policy& on) {
    uniform random(mesh_seed + 1);
    plain_mesh<T> m;
    for (int k = 0; k < 3; ++k) {
        const torus<T> part(120, 40, 2 + k, 0.3);
        const auto first = static_cast<std::uint32_t>(m.vertices.size());
        m.vertices.insert(m.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (face c : part.faces) {
            for (std::uint32_t& v : c) v += first;
            m.faces.push_back(c);
        }
    }
    const std::size_t whole = m.faces.size();
    for (std::size_t k = 0; k < whole / 50; ++k) {
        face c = m.faces[random.below(whole)];
        std::swap(c[0], c[1]);
        m.faces.push_back(c);
        m.faces.push_back({c[1], c[2], c[0]});
        c[random.below(3)] = static_cast<std::uint32_t>(random.below(m.vertices.size()));
        m.faces.push_back(c);
        m.faces[random.below(whole)][0] = m.faces[random.below(whole)][0];
        m.faces[random.below(whole)] = m.faces.back();
        m.vertices[random.below(m.vertices.size())] = m.vertices[random.below(m.vertices.size())];
        m.vertices.push_back(m.vertices[random.below(m.vertices.size())]);
    }
    // An edge of many faces, and a vertex of many fans.
    for (std::uint32_t k = 2; k < 5000; ++k) {
        m.faces.push_back({0, 1, k});
        m.faces.push_back({6000, k, k + 5000});
    }
    m.faces = shuffled(m.faces, random);
    check_same(validate(on, mesh<T>(m.vertices, m.faces)), naive_report(m));
}

/// Faces without area, or nearly, of all kinds; each a component of its own, with vertices in places of others.
template <class Policy, class T>
void check_flat_faces(const Policy& on) {
    plain_mesh<T> m;
    for (std::uint64_t i = 0; i < 400; ++i) {
        for (int family = 0; family < flat_family_count; ++family) {
            const auto t = make_flat_triangle<T>(mesh_seed, static_cast<flat_family>(family), i);
            const auto first = static_cast<std::uint32_t>(m.vertices.size());
            m.vertices.insert(m.vertices.end(), {t.a, t.b, t.c});
            m.faces.push_back({first, first + 1, first + 2});
        }
    }
    const mesh_report r = validate(on, mesh<T>(m.vertices, m.faces));
    std::vector<std::uint32_t> flat;
    for (std::uint32_t f = 0; f < m.faces.size(); ++f) {
        const triangle<T> t{m.vertices[3 * f], m.vertices[3 * f + 1], m.vertices[3 * f + 2]};
        if (has_zero_area<exact>(t)) flat.push_back(f);
    }
    CHECK(flat.size() > m.faces.size() / 5);
    CHECK(flat.size() < m.faces.size() / 2);
    CHECK(r.zero_area_faces == flat);
    CHECK(r.components == m.faces.size());
    CHECK(r.boundary_edges.size() == 3 * m.faces.size());
    std::map<std::tuple<T, T, T>, std::uint32_t> places;
    std::vector<coincident_vertex> coincident;
    for (std::uint32_t v = 0; v < m.vertices.size(); ++v) {
        const auto [first, fresh] = places.try_emplace({m.vertices[v].x, m.vertices[v].y, m.vertices[v].z}, v);
        if (!fresh) coincident.push_back({v, first->second});
    }
    CHECK(coincident.size() > 100);
    CHECK(r.coincident_vertices == coincident);
}

template <class T, class Policy>
void check_validate(const Policy& on, int rounds = 400) {
    check_known_meshes<Policy, T>(on);
    check_random_meshes<Policy, T>(on, rounds);
    check_large_mesh<Policy, T>(on);
    check_flat_faces<Policy, T>(on);
}

}  // namespace abut::test
