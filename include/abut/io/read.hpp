// SPDX-License-Identifier: MIT
#pragma once

// Files into sets: a mesh from OBJ, PLY, STL, OFF or glTF, spheres from CSV. Formats and exact rules:
// docs/reference/formats.md. The parsers beneath work on text and bytes in memory (obj.hpp, ply.hpp, stl.hpp, off.hpp,
// gltf.hpp, csv.hpp).

#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <abut/io/csv.hpp>
#include <abut/io/error.hpp>
#include <abut/io/file.hpp>
#include <abut/io/gltf.hpp>
#include <abut/io/mesh_data.hpp>
#include <abut/io/obj.hpp>
#include <abut/io/off.hpp>
#include <abut/io/ply.hpp>
#include <abut/io/stl.hpp>
#include <abut/shape/set.hpp>

/// Readers and writers of files; see @ref files.
namespace abut::io {

/// @defgroup files Files
///
/// Readers of meshes from OBJ, PLY, STL, OFF and glTF and of spheres from CSV; writers of sets as PLY or VTP, of pairs as
/// CSV, and of whole scenes as glTF or as a page for a browser. They are the CMake target `abut::io`, and are included one
/// by one: `<abut/io/read.hpp>`, `<abut/io/write.hpp>`,
/// `<abut/io/write_gltf.hpp>`, `<abut/io/write_html.hpp>`.
/// docs/reference/formats.md has the exact rules. The parsers beneath take text and bytes in memory.
///
/// @par Memory
/// Everything lies in host memory: `copy_to` brings a set to a device. A file is read as a whole before it is parsed, and a
/// reader allocates no more than its content can fill. Writers take the caller's arrays as they are, through a buffer.
///
/// @par Errors
/// - `io_error`: a file cannot be opened, read or written in full; its extension is none of these; or its content is
///   malformed or truncated. The message names the file, the line or the byte, what was expected and what was found.
/// - `capacity_error`: a reader that returns a set found 2^31 elements or more.
/// - `std::bad_alloc`.
///
/// @par Synchronisation
/// All run on the calling thread and return when they are done; a writer has closed its file then. Threads may read and
/// write different files at a time.
///
/// @par Example
/// @snippet files.cpp files
///@{

/// Vertices and faces of the file, by its extension (.obj, .ply, .stl, .off, .glb or .gltf, in any case), as plain vectors:
/// for those who want to change them before they make a set, or who have a cloud of points, which has no faces. Throws
/// io_error for another extension, for a file that cannot be read, and for one that is malformed or truncated;
/// std::bad_alloc.
template <scalar T>
mesh_data<T> read_mesh_data(const std::filesystem::path& path, const read_options& options = {}) {
    const std::string extension = detail::plain_name(path.extension().string()), name = path.string();
    const bool is_gltf = extension == ".glb" || extension == ".gltf";
    if (!is_gltf && extension != ".obj" && extension != ".ply" && extension != ".stl" && extension != ".off") {
        throw io_error(name, "expected a file name that ends with .obj, .ply, .stl, .off, .glb or .gltf");
    }
    const std::vector<char> bytes = detail::read_file(path);
    const std::string_view data(bytes.data(), bytes.size());
    if (is_gltf) {
        return parse_gltf<T>(data, name,
                             [&](const std::string& other) { return detail::read_file(path.parent_path() / other); });
    }
    if (extension == ".obj") return parse_obj<T>(data, name, options);
    if (extension == ".ply") return parse_ply<T>(data, name, options);
    return extension == ".stl" ? parse_stl<T>(data, name, options) : parse_off<T>(data, name, options);
}

/// The mesh in a file: OBJ, PLY, STL, OFF or glTF, by its extension. Polygons become triangles; vertices and triangles are
/// in the file's order, vertices that no triangle uses included. A cloud of points becomes a mesh without faces. Throws as
/// `read_mesh_data` does, and what the constructor of `mesh` throws (capacity_error for 2^31 elements or more).
///
///     const auto mesh = abut::io::read_mesh<float>("part.obj");
template <scalar T>
mesh<T> read_mesh(const std::filesystem::path& path, const read_options& options = {}) {
    const mesh_data<T> data = read_mesh_data<T>(path, options);
    return mesh<T>{data.vertices, data.faces};
}

/// The spheres in a CSV file with the columns x,y,z,r, with or without a header line. Throws io_error for a file that
/// cannot be read and for one that is malformed (three columns included: see `read_equal_spheres`), and what the
/// constructor of `spheres` throws.
///
///     const auto grains = abut::io::read_spheres<float>("grains.csv");
template <scalar T>
spheres<T> read_spheres(const std::filesystem::path& path) {
    const std::vector<char> text = detail::read_file(path);
    return spheres<T>{parse_spheres<T>({text.data(), text.size()}, path.string())};
}

/// Spheres of one radius whose centers are in a CSV file with the columns x,y,z, with or without a header line. Throws
/// io_error as `read_spheres` does (four columns included), and what the constructor of `equal_spheres` throws
/// (invalid_geometry for a radius that is negative or not finite).
///
///     const auto drops = abut::io::read_equal_spheres<double>("centers.csv", 3.0);
template <scalar T>
equal_spheres<T> read_equal_spheres(const std::filesystem::path& path, std::type_identity_t<T> radius) {
    const std::vector<char> text = detail::read_file(path);
    return equal_spheres<T>{parse_centers<T>({text.data(), text.size()}, path.string()), radius};
}

///@}

}  // namespace abut::io
