// SPDX-License-Identifier: MIT
#pragma once

// Pairs of features: a vertex and a face, or two edges, of two meshes in motion or of one. All kinds of pairs are numbered
// together, so that one search finds them all, and what it finds is sorted at once.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include <abut/collide/keys.hpp>
#include <abut/collide/pair_rule.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/predicate/motion.hpp>
#include <abut/shape/features.hpp>
#include <abut/shape/motion.hpp>

namespace abut::detail {

/// A pair of features travels as one number: its kind, below that a's feature, below that b's. So their order is that of
/// results.
struct feature_key {
    static constexpr int kind_bits = 2;
    int id_bits;  ///< of a feature of either mesh

    [[nodiscard]] int bits() const { return kind_bits + 2 * id_bits; }
    [[nodiscard]] ABUT_HD std::uint64_t pack(feature_pair kind, std::uint32_t a, std::uint32_t b) const {
        return (static_cast<std::uint64_t>(kind) << id_bits | a) << id_bits | b;
    }
    [[nodiscard]] ABUT_HD feature_pair kind(std::uint64_t key) const {
        return static_cast<feature_pair>(key >> 2 * id_bits);
    }
    [[nodiscard]] ABUT_HD std::uint32_t a(std::uint64_t key) const {
        return static_cast<std::uint32_t>(key >> id_bits & mask());
    }
    [[nodiscard]] ABUT_HD std::uint32_t b(std::uint64_t key) const { return static_cast<std::uint32_t>(key & mask()); }

private:
    [[nodiscard]] ABUT_HD std::uint64_t mask() const { return (std::uint64_t{1} << id_bits) - 1; }
};

/// Whether vertex k of an impact is the first mesh's.
ABUT_HD constexpr bool is_of_first(feature_pair kind, int k) {
    return kind == feature_pair::vertex_face ? k == 0 : kind == feature_pair::face_vertex ? k != 0 : k < 2;
}

/// Whether a vertex and a face of one mesh, or two edges, have no vertex in common.
ABUT_HD inline bool share_no_vertex(std::uint32_t v, const std::uint32_t* corner) {
    return (v != corner[0]) & (v != corner[1]) & (v != corner[2]);
}
ABUT_HD inline bool share_no_vertex(const std::uint32_t* d, const std::uint32_t* e) {
    return (d[0] != e[0]) & (d[0] != e[1]) & (d[1] != e[0]) & (d[1] != e[1]);
}

/// A mesh in motion by its features.
template <scalar T, memory_space Space>
struct features_of_mesh {
    typename moving_set<points<T, Space>>::view_type vertices;
    typename moving_set<mesh<T, Space>>::view_type faces;
    typename moving_set<edge_mesh<T, Space>>::view_type edges;

    features_of_mesh(const moving_set<mesh<T, Space>>& of, const moving_set<edge_mesh<T, Space>>& edges_of)
        : vertices(abut::vertices(of).view()), faces(of.view()), edges(edges_of.view()) {}
    [[nodiscard]] std::size_t most() const { return std::max({vertices.size(), faces.size(), edges.size()}); }
    [[nodiscard]] std::size_t count() const { return vertices.size() + faces.size() + edges.size(); }
};

/// What a kernel sees of the pairs of features of two meshes; or `within` one, where those that share a vertex are not
/// wanted, and of two edges the lesser comes first.
template <scalar T, memory_space Space>
struct feature_pairs {
    using scalar_type = T;
    features_of_mesh<T, Space> a, b;
    feature_key key;
    bool within;

    /// Throws where their numbers are too long.
    feature_pairs(const features_of_mesh<T, Space>& of_a, const features_of_mesh<T, Space>& of_b, bool of_one,
                  const char* function)
        : a(of_a), b(of_b), key{id_bits(std::max(a.most(), b.most()))}, within(of_one) {
        if (key.bits() > 64) {
            throw capacity_error(std::string(function) + ": meshes of " + std::to_string(a.most()) + " and " +
                                 std::to_string(b.most()) + " features of a kind; expected 2^31 at most");
        }
    }

    /// f(vertex, face), or f(edge, edge).
    ABUT_CALLS_ANY
    template <class F>
    ABUT_INLINE ABUT_HD auto with_shapes(std::uint64_t k, const F& f) const {
        return key.kind(k) == feature_pair::edge_edge ? with_edges(k, f) : with_vertex(k, f);
    }
    /// The same of a pair of edges.
    ABUT_CALLS_ANY
    template <class F>
    ABUT_INLINE ABUT_HD auto with_edges(std::uint64_t k, const F& f) const {
        return f(a.edges[key.a(k)], b.edges[key.b(k)]);
    }
    /// And of a vertex and a face.
    ABUT_CALLS_ANY
    template <class F>
    ABUT_INLINE ABUT_HD auto with_vertex(std::uint64_t k, const F& f) const {
        const bool vertex_first = key.kind(k) == feature_pair::vertex_face;
        const std::uint32_t i = key.a(k), j = key.b(k);
        const auto& of_vertex = vertex_first ? a.vertices : b.vertices;
        const auto& of_face = vertex_first ? b.faces : a.faces;
        return f(of_vertex[vertex_first ? i : j], of_face[vertex_first ? j : i]);
    }
    [[nodiscard]] ABUT_HD bool wanted(feature_pair kind, std::uint32_t i, std::uint32_t j) const {
        if (!within) return true;
        return kind == feature_pair::edge_edge
                   ? share_no_vertex(corners_at(a.edges.t0.edges, i), corners_at(b.edges.t0.edges, j))
                   : share_no_vertex(i, corners_at(b.faces.t0.faces, j));
    }
    /// Its vertices, as those of an impact.
    ABUT_HD void write_vertices(std::uint64_t k, std::uint32_t* out) const {
        const std::uint32_t i = key.a(k), j = key.b(k);
        const feature_pair kind = key.kind(k);
        if (kind == feature_pair::edge_edge) {
            const std::uint32_t *const of_a = corners_at(a.edges.t0.edges, i), *const of_b = corners_at(b.edges.t0.edges, j);
            out[0] = of_a[0], out[1] = of_a[1], out[2] = of_b[0], out[3] = of_b[1];
        } else {
            const bool vertex_first = kind == feature_pair::vertex_face;
            const std::uint32_t* const corner =
                vertex_first ? corners_at(b.faces.t0.faces, j) : corners_at(a.faces.t0.faces, i);
            out[0] = vertex_first ? i : j, out[1] = corner[0], out[2] = corner[1], out[3] = corner[2];
        }
    }
    /// A hint that the pair will be looked at soon; see shape_view.
    ABUT_INLINE void prefetch(std::uint64_t k, int step) const {
        const std::uint32_t i = key.a(k), j = key.b(k);
        const feature_pair kind = key.kind(k);
        if (kind == feature_pair::vertex_face) prefetch_both(a.vertices, i, b.faces, j, step);
        if (kind == feature_pair::face_vertex) prefetch_both(a.faces, i, b.vertices, j, step);
        if (kind == feature_pair::edge_edge) prefetch_both(a.edges, i, b.edges, j, step);
    }

private:
    template <class V, class W>
    ABUT_INLINE static void prefetch_both(const V& v, std::uint32_t i, const W& w, std::uint32_t j, int step) {
        prefetch_shape(v, i, step);
        prefetch_shape(w, j, step);
    }
};

/// A vertex at both ends of the step, beside each other: what a device reads at once.
template <scalar T>
struct alignas(16) vertex_on_way {
    T at[8];

    [[nodiscard]] ABUT_HD vec3<T> t0() const { return {at[0], at[1], at[2]}; }
    [[nodiscard]] ABUT_HD vec3<T> t1() const { return {at[4], at[5], at[6]}; }
};
template <class Vertices>
struct put_on_way {
    using T = typename Vertices::scalar_type;
    Vertices from;
    vertex_on_way<T>* to;
    ABUT_HD void operator()(std::size_t i) const {
        const auto p = from[i];
        to[i] = {{p.t0.x, p.t0.y, p.t0.z, 0, p.t1.x, p.t1.y, p.t1.z, 0}};
    }
};
/// The same pairs of features of a view, from such vertices.
template <class View>
struct features_on_way {
    using T = typename View::scalar_type;
    View both;
    const vertex_on_way<T>*a, *b;

    ABUT_CALLS_ANY
    template <class F>
    ABUT_INLINE ABUT_HD auto with_shapes(std::uint64_t k, const F& f) const {
        return both.key.kind(k) == feature_pair::edge_edge ? with_edges(k, f) : with_vertex(k, f);
    }
    ABUT_CALLS_ANY
    template <class F>
    ABUT_INLINE ABUT_HD auto with_edges(std::uint64_t k, const F& f) const {
        return f(edge_at(a, corners_at(both.a.edges.t0.edges, both.key.a(k))),
                 edge_at(b, corners_at(both.b.edges.t0.edges, both.key.b(k))));
    }
    ABUT_CALLS_ANY
    template <class F>
    ABUT_INLINE ABUT_HD auto with_vertex(std::uint64_t k, const F& f) const {
        const bool vertex_first = both.key.kind(k) == feature_pair::vertex_face;
        const std::uint32_t i = both.key.a(k), j = both.key.b(k);
        const vertex_on_way<T> p = vertex_first ? a[i] : b[j];
        const std::uint32_t* const corner =
            vertex_first ? corners_at(both.b.faces.t0.faces, j) : corners_at(both.a.faces.t0.faces, i);
        const vertex_on_way<T>* const of = vertex_first ? b : a;
        const vertex_on_way<T> x = of[corner[0]], y = of[corner[1]], z = of[corner[2]];
        return f(motion<vec3<T>>{p.t0(), p.t1()}, motion<triangle<T>>{{x.t0(), y.t0(), z.t0()}, {x.t1(), y.t1(), z.t1()}});
    }

private:
    ABUT_INLINE ABUT_HD static motion<segment<T>> edge_at(const vertex_on_way<T>* of, const std::uint32_t* end) {
        const vertex_on_way<T> x = of[end[0]], y = of[end[1]];
        return {{x.t0(), y.t0()}, {x.t1(), y.t1()}};
    }
};
/// Keeps them. The two meshes of a view may be one.
template <class Policy, class View>
class vertices_on_way {
    using T = typename View::scalar_type;
    using buffer = execution::buffer_of<Policy, vertex_on_way<T>>;

public:
    vertices_on_way(const Policy& on, const View& both)
        : of_a_(on, both.a.vertices.size()),
          of_b_(both.within ? buffer() : buffer(on, both.b.vertices.size())) {
        using vertices = std::remove_cvref_t<decltype(both.a.vertices)>;
        for_each_index(on, of_a_.size(), put_on_way<vertices>{both.a.vertices, of_a_.data()});
        for_each_index(on, of_b_.size(), put_on_way<vertices>{both.b.vertices, of_b_.data()});
    }
    [[nodiscard]] features_on_way<View> view(const View& both) const {
        return {both, of_a_.data(), both.within ? of_a_.data() : of_b_.data()};
    }

private:
    buffer of_a_, of_b_;
};

}  // namespace abut::detail
