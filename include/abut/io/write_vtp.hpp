// SPDX-License-Identifier: MIT
#pragma once

// Meshes and points as VTP, the XML form of VTK's PolyData, which ParaView and all that is made with VTK read. Arrays are
// in the XML as base64 of their bytes: any XML parser takes the file, every number comes back bit for bit, and nothing
// depends on how a reader takes decimals apart. Layout: docs/reference/formats.md.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <abut/io/base64.hpp>
#include <abut/io/file.hpp>
#include <abut/io/property.hpp>
#include <abut/shape/set.hpp>

namespace abut::io {

namespace detail {

template <class V>
struct vtk_array {
    static constexpr const char* name() {
        if constexpr (std::same_as<V, std::uint8_t>)
            return "UInt8";
        else if constexpr (std::same_as<V, std::int32_t>)
            return "Int32";
        else if constexpr (std::same_as<V, std::uint32_t>)
            return "UInt32";
        else if constexpr (std::same_as<V, std::int64_t>)
            return "Int64";
        else if constexpr (std::same_as<V, float>)
            return "Float32";
        else
            return "Float64";
    }
    static constexpr std::size_t components = 1, bytes = sizeof(V);
};
template <scalar T>
struct vtk_array<vec3<T>> {
    static constexpr const char* name() { return vtk_array<T>::name(); }
    static constexpr std::size_t components = 3, bytes = 3 * sizeof(T);
};

/// A text in quotes in XML.
inline std::string in_attribute(std::string_view text) {
    std::string r;
    for (const char c : text) {
        switch (c) {
            case '&':
                r += "&amp;";
                break;
            case '<':
                r += "&lt;";
                break;
            case '>':
                r += "&gt;";
                break;
            case '"':
                r += "&quot;";
                break;
            default:
                r += c;
        }
    }
    return '"' + r + '"';
}

/// The elements of the file, in order. An array of bytes is preceded by their number in 64 bits, in the same base64.
class vtp_file {
public:
    explicit vtp_file(const std::filesystem::path& path) : file_(path) {
        file_.write(
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
            "<PolyData>\n");
    }
    void piece(std::size_t points, std::size_t single_points, std::size_t polygons, std::size_t lines = 0) {
        file_.write("<Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfVerts=\"" +
                    std::to_string(single_points) + "\" NumberOfLines=\"" + std::to_string(lines) +
                    "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(polygons) + "\">\n");
    }
    void open(std::string_view element, std::string_view attributes = "") {
        file_.write('<');
        file_.write(element);
        file_.write(attributes);
        file_.write(">\n");
    }
    void close(std::string_view element) {
        file_.write("</");
        file_.write(element);
        file_.write(">\n");
    }
    /// An array of `count` elements, at(i) of type V each.
    template <class V, class At>
    void array(std::string_view name, std::size_t count, const At& at) {
        using form = vtk_array<V>;
        file_.write(std::string("<DataArray type=\"") + form::name() + "\" Name=" + in_attribute(name) +
                    " NumberOfComponents=\"" + std::to_string(form::components) + "\" format=\"binary\">");
        base64_writer out(file_);
        out.put(std::uint64_t{count * form::bytes});
        for (std::size_t i = 0; i < count; ++i) out.put(static_cast<V>(at(i)));
        out.finish();
        file_.write("</DataArray>\n");
    }
    void properties(const std::vector<property>& all) {
        for (const property& p : all) {
            std::visit(
                [&](const auto& values) {
                    using V = typename std::decay_t<decltype(values)>::value_type;
                    array<V>(p.name, values.size(), [&](std::size_t i) { return values[i]; });
                },
                p.values);
        }
    }
    template <class At>
    void points(std::size_t count, const At& at) {
        using V = std::remove_cvref_t<decltype(at(0))>;
        open("Points");
        array<V>("Points", count, at);
        close("Points");
    }
    /// `count` cells of `corners` points each, corner(i) of all their corners in a row.
    template <class Corner>
    void cells(std::string_view element, std::size_t count, std::size_t corners, const Corner& corner) {
        open(element);
        // Readers convert where the two arrays differ in type, and most store what is there: 32 bits where they do.
        if (count <= most_written / corners) {
            cell_arrays<std::int32_t>(count, corners, corner);
        } else {
            cell_arrays<std::int64_t>(count, corners, corner);
        }
        close(element);
    }
    void finish() {
        file_.write("</Piece>\n</PolyData>\n</VTKFile>\n");
        file_.close();
    }

private:
    template <class Id, class Corner>
    void cell_arrays(std::size_t count, std::size_t corners, const Corner& corner) {
        array<Id>("connectivity", count * corners, corner);
        array<Id>("offsets", count, [&](std::size_t i) { return corners * (i + 1); });
    }

    output_file file_;
};

}  // namespace detail

/// @addtogroup files
///@{

/// Writes a mesh as VTP: positions in T, all vertices and triangles in order, and what the options add, as arrays of points
/// and cells of the same names as in PLY (but no colours, and `hit` for cells alone: programs that read VTP show values of
/// cells). An existing file is replaced. Throws as `write_ply` does.
///
///     abut::io::write_vtp("hits.vtp", mesh, {.hit = hit});
template <scalar T>
void write_vtp(const std::filesystem::path& path, const mesh_view<T>& mesh, const mesh_options& options = {}) {
    const std::size_t vertices = mesh.vertices.count, faces = mesh.faces.count;
    detail::check_mesh(path.string(), vertices, faces, options);
    detail::vtp_file file(path);
    file.piece(vertices, 0, faces);
    file.open("PointData");
    file.properties(options.vertex_properties);
    file.close("PointData");
    file.open("CellData", options.hit.empty() ? "" : " Scalars=\"hit\"");
    if (!options.hit.empty()) {
        file.array<std::uint8_t>("hit", faces, [&](std::size_t f) { return options.hit[f] != 0; });
    }
    file.properties(options.face_properties);
    file.close("CellData");
    file.points(vertices, [&](std::size_t v) { return mesh.vertices[v]; });
    file.cells("Polys", faces, 3, [&](std::size_t i) { return mesh.faces[i / 3][i % 3]; });
    file.finish();
}

/// The same for a mesh that owns its arrays.
template <scalar T>
void write_vtp(const std::filesystem::path& path, const mesh<T>& mesh, const mesh_options& options = {}) {
    write_vtp(path, mesh.view(), options);
}

/// The same for vectors, as the parsers return them.
template <scalar T>
void write_vtp(const std::filesystem::path& path, const std::vector<vec3<T>>& vertices, const std::vector<face>& faces,
               const mesh_options& options = {}) {
    write_vtp(path, mesh_view<T>(vertices.data(), vertices.size(), faces.data(), faces.size()), options);
}

/// Writes points as VTP, each a cell of its own (a vertex, in VTK's words), so that viewers draw it; normals are the array
/// `normal`. Replaces and throws as `write_ply` does.
///
///     abut::io::write_points_vtp("contacts.vtp", points, {.normals = normals, .properties = {{"depth", depths}}});
template <scalar T>
void write_points_vtp(const std::filesystem::path& path, const std::vector<vec3<T>>& points,
                      const point_options<T>& options = {}) {
    detail::check_points(path.string(), points.size(), options);
    detail::vtp_file file(path);
    file.piece(points.size(), points.size(), 0);
    file.open("PointData", options.normals.empty() ? "" : " Normals=\"normal\"");
    if (!options.normals.empty()) {
        file.array<vec3<T>>("normal", points.size(), [&](std::size_t i) { return options.normals[i]; });
    }
    file.properties(options.properties);
    file.close("PointData");
    file.open("CellData");
    file.close("CellData");
    file.points(points.size(), [&](std::size_t i) { return points[i]; });
    file.cells("Verts", points.size(), 1, [](std::size_t i) { return i; });
    file.finish();
}

///@}

}  // namespace abut::io
