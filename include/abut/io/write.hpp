// SPDX-License-Identifier: MIT
#pragma once

// Results into files that other programs open: meshes with values for their faces, and points with normals, as PLY or VTP;
// meshes alone as STL, OBJ or OFF; pairs of ids as CSV. Layout and who shows what: docs/reference/formats.md.

#include <array>
#include <concepts>
#include <filesystem>
#include <ranges>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/file.hpp>
#include <abut/io/property.hpp>
#include <abut/io/write_plain.hpp>
#include <abut/io/write_ply.hpp>
#include <abut/io/write_vtp.hpp>

namespace abut::io {

/// @addtogroup files
///@{

namespace detail {

/// In lower case.
inline std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return extension;
}

/// Whether the file is to be VTP; PLY if not. Throws io_error for other extensions.
inline bool is_vtp(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    if (extension != ".ply" && extension != ".vtp") {
        throw io_error(path.string(), "expected a file name that ends with .ply or .vtp");
    }
    return extension == ".vtp";
}

}  // namespace detail

/// Writes a mesh as the extension says, in any case: .ply (`write_ply`), .vtp (`write_vtp`), .stl (`write_stl`), .obj
/// (`write_obj`) or .off (`write_off`). `mesh` is a mesh or a mesh_view in host memory. Throws io_error for another
/// extension, for options with one of the last three, which hold a mesh alone, and as those do.
///
///     abut::io::write_mesh("hits.vtp", mesh, {.hit = hit});
template <class Mesh>
    requires requires(const std::filesystem::path& path, const Mesh& mesh) { write_ply(path, mesh); }
void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const mesh_options& options = {}) {
    const std::string extension = detail::extension_of(path);
    const bool is_plain = extension == ".stl" || extension == ".obj" || extension == ".off";
    if (is_plain && !(options.hit.empty() && options.face_properties.empty() && options.vertex_properties.empty())) {
        throw io_error(path.string(), "expected .ply or .vtp for a mesh with values, which " + extension + " cannot hold");
    }
    if (extension == ".ply") return write_ply(path, mesh, options);
    if (extension == ".vtp") return write_vtp(path, mesh, options);
    if (extension == ".stl") return write_stl(path, mesh);
    if (extension == ".obj") return write_obj(path, mesh);
    if (extension == ".off") return write_off(path, mesh);
    throw io_error(path.string(), "expected a file name that ends with .ply, .vtp, .stl, .obj or .off");
}

/// The same for vectors, as the parsers return them.
template <scalar T>
void write_mesh(const std::filesystem::path& path, const std::vector<vec3<T>>& vertices, const std::vector<face>& faces,
                const mesh_options& options = {}) {
    write_mesh(path, mesh_view<T>(vertices.data(), vertices.size(), faces.data(), faces.size()), options);
}

/// Writes points, with normals and values or without, as the extension says: .ply (`write_points_ply`) or .vtp
/// (`write_points_vtp`), in any case. Throws io_error for another extension, and as those do.
///
///     abut::io::write_points("contacts.vtp", points, {.normals = normals, .properties = {{"depth", depths}}});
template <scalar T>
void write_points(const std::filesystem::path& path, const std::vector<vec3<T>>& points,
                  const point_options<T>& options = {}) {
    detail::is_vtp(path) ? write_points_vtp(path, points, options) : write_points_ply(path, points, options);
}

/// Writes pairs as CSV: a line of column names (`a,b`, or those given), then a line `a,b` of decimal integers for each
/// pair, in order; lines end with LF. An existing file is replaced. Throws io_error if the file cannot be written in full.
///
///     abut::io::write_pairs("pairs.csv", abut::to_host(pairs), {"triangle", "sphere"});
template <std::ranges::input_range Pairs>
    requires id_pair<std::ranges::range_value_t<Pairs>>
void write_pairs(const std::filesystem::path& path, const Pairs& pairs,
                 const std::array<std::string_view, 2>& columns = {"a", "b"}) {
    detail::output_file file(path);
    file.write(columns[0]);
    file.write(',');
    file.write(columns[1]);
    file.write('\n');
    for (const auto& pair : pairs) {
        file.write_decimal(pair.a);
        file.write(',');
        file.write_decimal(pair.b);
        file.write('\n');
    }
    file.close();
}

///@}

}  // namespace abut::io
