// SPDX-License-Identifier: MIT
#pragma once

// What `validate` (collide/validate.hpp) says of a mesh.

#include <cstdint>
#include <vector>

#include <abut/config.hpp>

namespace abut {

/// @addtogroup mesh_checks
///@{

/// An edge and the faces that have it.
struct mesh_edge {
    std::uint32_t a;           ///< its lower vertex
    std::uint32_t b;           ///< its higher one
    std::uint32_t faces;       ///< how many faces have it
    std::uint32_t first_face;  ///< the lowest of them
    std::uint32_t last_face;   ///< the highest: of two, the other one

    friend bool operator==(const mesh_edge&, const mesh_edge&) = default;
    friend auto operator<=>(const mesh_edge&, const mesh_edge&) = default;
};

/// A face with the vertices of an earlier one.
struct duplicate_face {
    std::uint32_t face;  ///< the later one
    std::uint32_t of;    ///< the lowest face with these vertices
    bool reversed;       ///< it has its sides the other way round than `of`

    friend bool operator==(const duplicate_face&, const duplicate_face&) = default;
    friend auto operator<=>(const duplicate_face&, const duplicate_face&) = default;
};

/// A vertex in the place of an earlier one.
struct coincident_vertex {
    std::uint32_t vertex;  ///< the later one
    std::uint32_t of;      ///< the lowest vertex in this place

    friend bool operator==(const coincident_vertex&, const coincident_vertex&) = default;
    friend auto operator<=>(const coincident_vertex&, const coincident_vertex&) = default;
};

/// What there is of a mesh and what is wrong with it, in host memory. Every list is complete and ascending.
///
/// A face that names a vertex twice, or one that does not exist, spans no triangle. It is listed as such and then passed
/// over: it has no edges, connects nothing and uses no vertex. All other faces count, those without area and duplicates too.
/// Vertices are told apart by their index, not by their place: coincident ones are listed and otherwise have nothing in
/// common.
struct mesh_report {
    std::uint64_t vertices = 0;  ///< all, unused ones too
    std::uint64_t faces = 0;     ///< all, those passed over too
    std::uint64_t edges = 0;     ///< pairs of vertices that are neighbours in a face
    /// Pieces of the surface: two faces belong to one piece if a chain of faces leads from one to the other, each sharing
    /// a vertex with the next.
    std::uint64_t components = 0;
    /// V - E + F of what the faces make up: used vertices, edges, faces not passed over. 2 for each sphere, 0 for each
    /// torus.
    std::int64_t euler_characteristic = 0;

    std::vector<mesh_edge> boundary_edges;      ///< edges of one face ("open")
    std::vector<mesh_edge> nonmanifold_edges;   ///< edges of more than two faces
    std::vector<mesh_edge> inconsistent_edges;  ///< edges of two faces that both run along it from a to b, or from b to a

    std::vector<std::uint32_t> faces_out_of_range;         ///< with an index that is no vertex; a view's only
    std::vector<std::uint32_t> faces_with_repeated_index;  ///< with all indices in range, two or three of them equal
    /// Corners on one line or in one point, decided exactly. Faces with a repeated index are among them; faces out of range,
    /// or with a corner that is not finite, are not.
    std::vector<std::uint32_t> zero_area_faces;
    std::vector<duplicate_face> duplicate_faces;  ///< all but the first of faces with the same three vertices

    std::vector<std::uint32_t> nonfinite_vertices;  ///< with a coordinate that is infinite or NaN; a view's only
    std::vector<std::uint32_t> unused_vertices;     ///< of no face, those passed over not counted
    /// Vertices whose faces form more than one fan: two faces are in one fan if a chain of faces at the vertex leads from
    /// one to the other, each sharing an edge at the vertex with the next.
    std::vector<std::uint32_t> nonmanifold_vertices;
    /// All but the first of vertices in one place, unused ones too. -0.0 and 0.0 are one place; what is not finite is none.
    std::vector<coincident_vertex> coincident_vertices;

    /// Every face is three edges and every edge two faces, so that E = 3F/2. A mesh without faces is not closed.
    [[nodiscard]] bool closed() const {
        return faces > 0 && every_face_counts() && boundary_edges.empty() && nonmanifold_edges.empty();
    }
    /// A surface, with or without a boundary: no edge has more than two faces and no vertex more than one fan. Whether it
    /// passes through itself or lies on itself in places is another question: coincident, duplicate or flat faces do not
    /// count against it.
    [[nodiscard]] bool manifold() const {
        return every_face_counts() && nonmanifold_edges.empty() && nonmanifold_vertices.empty();
    }
    /// No two faces run along an edge in the same direction. Three faces at an edge cannot but do so.
    [[nodiscard]] bool oriented() const { return nonmanifold_edges.empty() && inconsistent_edges.empty(); }

    friend bool operator==(const mesh_report&, const mesh_report&) = default;

private:
    [[nodiscard]] bool every_face_counts() const { return faces_out_of_range.empty() && faces_with_repeated_index.empty(); }
};

///@}

}  // namespace abut
