// SPDX-License-Identifier: MIT
#pragma once

// What `validate` (collide/validate.hpp) says of a mesh.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <abut/arithmetic/vec.hpp>
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

/// Faces that are joined by edges of two faces.
struct mesh_sheet {
    std::uint32_t first_face;  ///< the lowest of them
    std::uint32_t faces;       ///< how many they are
    bool closed;               ///< each edge of each of them has two faces
    bool oriented;             ///< no two of them run along an edge in the same direction
    /// The sign of the volume that a closed, oriented sheet encloses, exactly: 1 where it faces outwards, -1 inwards. 0 of others.
    int volume_sign;

    friend bool operator==(const mesh_sheet&, const mesh_sheet&) = default;
};

/// What a mesh measures, and which way it faces. Faces that name a vertex twice, or one that does not exist, are of no sheet
/// and measure nothing; nor do corners that are not finite.
///
/// Numbers are sums in double, the same bits on each policy. Let V be the sum over all faces of the products of three
/// distances from the first corner of the first face to the corners, a distance being the sum of the coordinates'
/// differences, and r the greatest such distance. The volume is off by less than 2^-50 V and a rounding, the center by less
/// than 2^-46 r V / volume and roundings where that is below r / 4, the area by less than 2^-48 of the sum of products of two
/// sides of each face. What is too large for a double is infinite.
struct mesh_measures {
    double area = 0;                ///< of all faces, each once
    double volume = 0;              ///< below 0 of what faces inwards; 0 unless all sheets have a volume_sign
    vec3<double> center_of_mass{};  ///< of what is enclosed; at 0 unless there is a volume
    std::vector<mesh_sheet> sheets;   ///< by their first faces

    /// Whether all sheets are closed and face outwards. A hollow of a solid should not.
    [[nodiscard]] bool outward() const {
        return !sheets.empty() && std::all_of(sheets.begin(), sheets.end(), [](const mesh_sheet& s) { return s.volume_sign > 0; });
    }
    friend bool operator==(const mesh_measures&, const mesh_measures&) = default;
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

    std::optional<mesh_measures> measures;  ///< where `validate_options` ask for it

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
