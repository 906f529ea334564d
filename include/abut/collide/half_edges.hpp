// SPDX-License-Identifier: MIT
#pragma once

// The edges of a mesh, found by sorting. Side k of face f, from corner k to the next, is the half-edge 3 f + k; a corner
// bears the number of the side that starts in it. Half-edges are sorted by their two vertices, the smaller first, and those
// of one edge then stand together, in the order of their faces. Everything that `validate` says of edges is read off that.

#include <cstddef>
#include <cstdint>

#include <abut/collide/mesh_report.hpp>
#include <abut/config.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

/// The vertices of a face. Not abut::face, whose operator[] is a host function.
struct corner_ids {
    std::uint32_t of[3];
};

ABUT_HD inline corner_ids corners_of(const strided<face>& faces, std::size_t f) {
    const auto* const corner = reinterpret_cast<const std::uint32_t*>(faces.data + f * faces.stride);
    return {{corner[0], corner[1], corner[2]}};
}

ABUT_HD inline bool is_in_range(const corner_ids& c, std::size_t vertex_count) {
    return c.of[0] < vertex_count && c.of[1] < vertex_count && c.of[2] < vertex_count;
}
ABUT_HD inline bool repeats_index(const corner_ids& c) {
    return c.of[0] == c.of[1] || c.of[1] == c.of[2] || c.of[2] == c.of[0];
}
/// Whether the face counts (mesh_report says which do).
ABUT_HD inline bool spans_triangle(const corner_ids& c, std::size_t vertex_count) {
    return is_in_range(c, vertex_count) && !repeats_index(c);
}

/// Where the run of equal elements begins that i is in. equal(j), for j <= i, says whether element j equals element i.
template <class Equal>
ABUT_HD std::size_t first_of_run(std::size_t i, const Equal& equal) {
    std::size_t begin = 0;
    while (begin < i) {
        const std::size_t middle = begin + (i - begin) / 2;
        if (equal(middle)) {
            i = middle;
        } else {
            begin = middle + 1;
        }
    }
    return i;
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
    [[nodiscard]] ABUT_HD std::uint32_t lower(std::size_t i) const {
        return static_cast<std::uint32_t>(edge(i) >> key.vertex_bits);
    }
    [[nodiscard]] ABUT_HD std::uint32_t upper(std::size_t i) const {
        return static_cast<std::uint32_t>(keys[i] & ((std::uint64_t{1} << key.vertex_bits) - 1));
    }
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

    /// The whole edge, where i is its first half-edge. Doubling steps, then halving: an edge of two faces is short work, and
    /// one of a million no long work.
    [[nodiscard]] ABUT_HD mesh_edge mesh_edge_at(std::size_t i) const {
        std::size_t step = 1;
        while (goes_on(i, step)) step *= 2;
        std::size_t low = step / 2, high = step;  // goes on so far; no longer so far
        while (high - low > 1) {
            const std::size_t middle = low + (high - low) / 2;
            (goes_on(i, middle) ? low : high) = middle;
        }
        return {lower(i), upper(i), static_cast<std::uint32_t>(high), face_of(i), face_of(i + low)};
    }
};

// What a list is made of: properties of half-edge i. Those of an edge hold for its first half-edge alone.

struct is_boundary {
    sorted_half_edges table;
    ABUT_HD bool operator()(std::size_t i) const { return table.is_edge(i) && table.is_first(i) && !table.goes_on(i, 1); }
};

struct is_nonmanifold {
    sorted_half_edges table;
    ABUT_HD bool operator()(std::size_t i) const { return table.is_edge(i) && table.is_first(i) && table.goes_on(i, 2); }
};

struct is_inconsistent {
    sorted_half_edges table;
    ABUT_HD bool operator()(std::size_t i) const {
        return table.is_edge(i) && table.is_first(i) && table.goes_on(i, 1) && !table.goes_on(i, 2) &&
               table.backward(i) == table.backward(i + 1);
    }
};

/// Whether another face may have the same three vertices. It would share all edges, so one of them tells: that of the two
/// smaller vertices. If the edge has two faces, they do if their third vertices are equal; of more faces each may.
struct may_be_duplicate {
    sorted_half_edges table;
    ABUT_HD bool operator()(std::size_t i) const {
        const bool goes_back = !table.is_first(i), goes_ahead = table.goes_on(i, 1);
        if (!table.is_edge(i) || (!goes_back && !goes_ahead)) return false;
        const bool is_second = goes_back && !goes_ahead && table.is_first(i - 1);
        if (is_second || (!goes_back && !table.goes_on(i, 2))) {
            const std::size_t other = is_second ? i - 1 : i + 1;
            // What the keys have of the third vertices saves nearly all reads of faces.
            const bool may = ((table.keys[i] ^ table.keys[other]) & ~half_edge_key::backward_bit) == 0;
            if (!may || table.opposite(i) != table.opposite(other)) return false;
        }
        return table.opposite(i) > table.upper(i);
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
    half_edge_table(const Policy& on, const mesh_view<T, Space>& mesh, int vertex_bits)
        : faces_(mesh.faces), key_{vertex_bits}, keys_(on, 3 * mesh.size()), half_edges_(on, 3 * mesh.size()) {
        const write_half_edges write{mesh.faces, mesh.vertices.count, key_, keys_.data(), half_edges_.data()};
        for_each_index(on, mesh.size(), write);
        sort_by_key(on, keys_, half_edges_, 2 * vertex_bits);
    }

    [[nodiscard]] sorted_half_edges view() const { return {faces_, keys_.data(), half_edges_.data(), keys_.size(), key_}; }

private:
    strided<face> faces_;
    half_edge_key key_;
    execution::buffer_of<Policy, std::uint64_t> keys_;
    execution::buffer_of<Policy, std::uint32_t> half_edges_;
};

}  // namespace abut::detail
