// SPDX-License-Identifier: MIT
#pragma once

// The edges of a mesh, found by sorting. Side k of face f, from corner k to the next, is the half-edge 3 f + k; a corner
// bears the number of the side that starts in it. Half-edges are sorted by their two vertices, the smaller first, and those
// of one edge then stand together, in the order of their faces. Everything that `validate` (collide/validate.hpp) says of
// edges is read off that; `edges` (shape/features.hpp) sorts the same keys alone.

#include <cstddef>
#include <cstdint>
#include <string>

#include <abut/config.hpp>
#include <abut/error.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/disjoint_sets.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

ABUT_HD inline corner_ids corners_of(const strided<face>& faces, std::size_t f) {
    const std::uint32_t* const corner = corners_at(faces, f);
    return {{corner[0], corner[1], corner[2]}};
}

ABUT_HD inline bool is_in_range(const corner_ids& c, std::size_t vertex_count) {
    return c.of[0] < vertex_count && c.of[1] < vertex_count && c.of[2] < vertex_count;
}
ABUT_HD inline bool repeats_index(const corner_ids& c) {
    return c.of[0] == c.of[1] || c.of[1] == c.of[2] || c.of[2] == c.of[0];
}
/// Whether the face counts: whether it names three vertices.
ABUT_HD inline bool spans_triangle(const corner_ids& c, std::size_t vertex_count) {
    return is_in_range(c, vertex_count) && !repeats_index(c);
}

/// Sides of faces are numbered in 32 bits.
inline void check_sides(std::size_t face_count, const char* function) {
    if (face_count > 0xffffffff / 3) {
        throw capacity_error(std::string(function) + ": " + std::to_string(face_count) +
                             " faces; their sides are numbered in 32 bits, which is enough for 1431655765");
    }
}

/// How half-edges are packed, from the lowest bit: the greater vertex, the smaller one, as many bits of the face's third
/// vertex as there is room for, and whether the half-edge runs from the greater vertex to the smaller. The two vertices are
/// the edge; the rest takes no part in the order and is carried along.
struct half_edge_key {
    static constexpr std::uint64_t backward_bit = std::uint64_t{1} << 63;

    int vertex_bits;  // below 32

    [[nodiscard]] ABUT_HD std::uint64_t edge_mask() const { return (std::uint64_t{1} << 2 * vertex_bits) - 1; }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint64_t from, std::uint64_t to, std::uint64_t third) const {
        const std::uint64_t rest = third << 2 * vertex_bits & ~backward_bit;
        return rest | (from < to ? from << vertex_bits | to : to << vertex_bits | from | backward_bit);
    }
    /// The edge's vertices: the smaller and the greater.
    [[nodiscard]] ABUT_HD std::uint32_t lower(std::uint64_t packed) const {
        return static_cast<std::uint32_t>((packed & edge_mask()) >> vertex_bits);
    }
    [[nodiscard]] ABUT_HD std::uint32_t upper(std::uint64_t packed) const {
        return static_cast<std::uint32_t>(packed & ((std::uint64_t{1} << vertex_bits) - 1));
    }
    /// What sorts behind all edges: two equal vertices, the last that there may be.
    [[nodiscard]] ABUT_HD std::uint64_t no_edge() const { return edge_mask(); }
};

/// Half-edges in order. Those of faces that do not count come last.
struct sorted_half_edges {
    strided<face> faces;
    const std::uint64_t* keys;
    const std::uint32_t* half_edges;
    std::size_t count;
    half_edge_key key;

    [[nodiscard]] ABUT_HD std::uint64_t edge(std::size_t i) const { return keys[i] & key.edge_mask(); }
    [[nodiscard]] ABUT_HD bool backward(std::size_t i) const { return (keys[i] & half_edge_key::backward_bit) != 0; }
    [[nodiscard]] ABUT_HD std::uint32_t lower(std::size_t i) const { return key.lower(keys[i]); }
    [[nodiscard]] ABUT_HD std::uint32_t upper(std::size_t i) const { return key.upper(keys[i]); }
    [[nodiscard]] ABUT_HD bool is_edge(std::size_t i) const { return lower(i) != upper(i); }
    [[nodiscard]] ABUT_HD bool is_first(std::size_t i) const { return i == 0 || edge(i - 1) != edge(i); }
    /// Whether the next `more` half-edges are of the same edge.
    [[nodiscard]] ABUT_HD bool goes_on(std::size_t i, std::size_t more) const {
        return count - i > more && edge(i + more) == edge(i);
    }

    [[nodiscard]] ABUT_HD std::uint32_t face_of(std::size_t i) const { return half_edges[i] / 3; }
    [[nodiscard]] ABUT_HD static std::uint32_t next(std::uint32_t half_edge) {
        return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
    }
    [[nodiscard]] ABUT_HD std::uint32_t lower_corner(std::size_t i) const {
        return backward(i) ? next(half_edges[i]) : half_edges[i];
    }
    [[nodiscard]] ABUT_HD std::uint32_t upper_corner(std::size_t i) const {
        return backward(i) ? half_edges[i] : next(half_edges[i]);
    }
    /// The face's third vertex.
    [[nodiscard]] ABUT_HD std::uint32_t opposite(std::size_t i) const {
        return corners_of(faces, face_of(i)).of[next(next(half_edges[i])) % 3];
    }
};

/// Writes the half-edges of face f.
struct write_half_edges {
    strided<face> faces;
    std::size_t vertex_count;
    half_edge_key key;
    std::uint64_t* keys;
    std::uint32_t* half_edges;

    ABUT_HD void operator()(std::size_t f) const {
        const corner_ids c = corners_of(faces, f);
        const bool counts = spans_triangle(c, vertex_count);
        const std::uint64_t of_face[3] = {key.pack(c.of[0], c.of[1], c.of[2]), key.pack(c.of[1], c.of[2], c.of[0]),
                                          key.pack(c.of[2], c.of[0], c.of[1])};
        for (std::size_t k = 0; k < 3; ++k) {
            keys[3 * f + k] = counts ? of_face[k] : key.no_edge();
            half_edges[3 * f + k] = static_cast<std::uint32_t>(3 * f + k);
        }
    }
};

/// Half-edges in the policy's memory, sorted when made. The work may still be under way when the constructor returns.
template <execution_policy Policy>
class half_edge_table {
public:
    template <scalar T, memory_space Space>
    half_edge_table(const Policy& policy, const mesh_view<T, Space>& mesh, int vertex_bits)
        : faces_(mesh.faces), key_{vertex_bits}, keys_(policy, 3 * mesh.size()), half_edges_(policy, 3 * mesh.size()) {
        const write_half_edges write{mesh.faces, mesh.vertices.count, key_, keys_.data(), half_edges_.data()};
        for_each_index(policy, mesh.size(), write);
        sort_by_key(policy, keys_, half_edges_, 2 * vertex_bits);
    }

    [[nodiscard]] sorted_half_edges view() const { return {faces_, keys_.data(), half_edges_.data(), keys_.size(), key_}; }

private:
    strided<face> faces_;
    half_edge_key key_;
    execution::buffer_of<Policy, std::uint64_t> keys_;
    execution::buffer_of<Policy, std::uint32_t> half_edges_;
};

/// Joins neighbours: the vertices of an edge are of one component, and the corners of its faces at either of its ends are of
/// one fan.
struct connect {
    sorted_half_edges table;
    execution::disjoint_sets fans, components;
    ABUT_HD void operator()(std::size_t i) const {
        if (!table.is_edge(i)) return;
        if (table.is_first(i)) {
            components.unite(table.lower(i), table.upper(i));
        } else {
            fans.unite(table.lower_corner(i - 1), table.lower_corner(i));
            fans.unite(table.upper_corner(i - 1), table.upper_corner(i));
        }
    }
};

/// Each fan has one corner that stands for it.
struct count_fans {
    strided<face> faces;
    std::size_t vertex_count;
    execution::disjoint_sets fans;
    std::uint32_t* fans_of_vertex;
    ABUT_HD void operator()(std::size_t corner) const {
        if (!fans.is_root(corner)) return;
        const corner_ids c = corners_of(faces, corner / 3);
        if (spans_triangle(c, vertex_count)) execution::atomic_add(fans_of_vertex + c.of[corner % 3], 1u);
    }
};

}  // namespace abut::detail
