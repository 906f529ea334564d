// SPDX-License-Identifier: MIT
#pragma once

// What two faces that meet have in common: what `crossings` gives. How that is found is in predicate/shared_corners.hpp and
// narrow/crossing_points.hpp.

#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>

namespace abut {

/// What part of a mesh a point lies in: the least one, so on an edge it is in no vertex.
enum class mesh_part : unsigned char {
    at_vertex,  ///< in a vertex
    on_edge,    ///< on an edge, and in no vertex
    in_face     ///< in the inside of a face
};

/// A vertex, an edge or a face of a mesh, by which a point of a crossing is known. Two points of one name are one point.
struct mesh_feature {
    mesh_part part;       ///< which
    std::uint32_t first;  ///< the vertex, the lesser vertex of the edge, or the face
    std::uint32_t second; ///< the greater vertex of the edge, or the same number again

    friend constexpr bool operator==(const mesh_feature&, const mesh_feature&) = default;
    friend constexpr auto operator<=>(const mesh_feature&, const mesh_feature&) = default;
};

/// What a face of one mesh and a face of another have in common: a point, a segment or a convex polygon, by its corners. Each
/// corner is told by what it lies in of either mesh, exactly, and by its coordinates, which are rounded
/// (`crossings` says how).
///
/// Where the planes of both faces cross, a segment runs from `points[0]` to `points[1]` along the cross product of a's normal
/// and b's. A polygon turns as the corners of a's face do.
template <scalar T>
struct crossing {
    std::uint32_t a;              ///< id of the first face; in `self_crossings` the lower one
    std::uint32_t b;              ///< id of the second one
    std::uint32_t vertices_a[3];  ///< vertices of the first face; of a soup those of triangle i are 3 i, 3 i + 1, 3 i + 2
    std::uint32_t vertices_b[3];  ///< of the second one
    unsigned char count;          ///< of corners: 1 for a point, 2 for a segment, 3 to 6 for a polygon
    unsigned char coplanar;       ///< 1 if both faces lie in one plane, else 0
    unsigned char of_one_mesh;    ///< 1 of `self_crossings`, where both numbers are of one mesh; else 0
    /// What each corner lies in of the first face: k < 3 is its corner k, 3 + k the edge from there to the next, 6 its inside.
    unsigned char in_a[6];
    unsigned char in_b[6];  ///< of the second face
    vec3<T> points[6];      ///< the corners, in the world; those from `count` on are 0

    /// What corner i lies in of the first mesh.
    [[nodiscard]] ABUT_HD constexpr mesh_feature feature_a(int i) const { return feature(a, vertices_a, in_a[i]); }
    /// And of the second one.
    [[nodiscard]] ABUT_HD constexpr mesh_feature feature_b(int i) const { return feature(b, vertices_b, in_b[i]); }

    friend constexpr bool operator==(const crossing&, const crossing&) = default;

private:
    ABUT_HD static constexpr mesh_feature feature(std::uint32_t id, const std::uint32_t (&vertices)[3], unsigned in) {
        if (in > 5) return {mesh_part::in_face, id, id};
        const std::uint32_t from = vertices[in % 3], to = vertices[(in + 1) % 3];
        if (in < 3) return {mesh_part::at_vertex, from, from};
        return from < to ? mesh_feature{mesh_part::on_edge, from, to} : mesh_feature{mesh_part::on_edge, to, from};
    }
};

/// A crossing of an entry of a list.
template <scalar T>
struct tagged_crossing {
    std::uint32_t pair;  ///< position in the list
    std::uint32_t a;     ///< id in the entry's first set
    std::uint32_t b;     ///< id in its second one
    crossing<T> common;  ///< what they have in common

    friend constexpr bool operator==(const tagged_crossing&, const tagged_crossing&) = default;
};

/// A crossing of two bodies: the first four are as in body_pair.
template <scalar T>
struct body_crossing {
    std::uint32_t body_a;  ///< position of the first body
    std::uint32_t body_b;  ///< position of the second one, which is higher
    std::uint32_t a;       ///< id in the first body's set
    std::uint32_t b;       ///< id in the second one's
    crossing<T> common;    ///< what they have in common

    friend constexpr bool operator==(const body_crossing&, const body_crossing&) = default;
};

}  // namespace abut
