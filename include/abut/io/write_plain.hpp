// SPDX-License-Identifier: MIT
#pragma once

// Meshes alone, without values for their faces: binary STL, and OBJ and OFF as text. Layout: docs/reference/formats.md.

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/file.hpp>
#include <abut/io/gltf_drawing.hpp>
#include <abut/io/property.hpp>
#include <abut/shape/set.hpp>

namespace abut::io {

namespace detail {

/// Refuses faces that name no vertex.
template <scalar T>
void check_corners(const std::string& file, const mesh_view<T>& mesh) {
    check_mesh(file, mesh.vertices.count, mesh.faces.count, {});
    for (std::size_t f = 0; f < mesh.faces.count; ++f) {
        for (const std::uint32_t v : mesh.faces[f]) {
            if (v < mesh.vertices.count) continue;
            throw io_error(file, "expected vertex indices below " + std::to_string(mesh.vertices.count) + ", found " +
                                     std::to_string(v) + " in face " + std::to_string(f));
        }
    }
}

/// The three coordinates with a blank before each, in the fewest digits that give them back.
template <scalar T>
void write_position(output_file& file, const vec3<T>& p, bool blank_first) {
    const T all[] = {p.x, p.y, p.z};
    for (const T x : all) {
        std::array<char, 32> text;
        if (blank_first) file.write(' ');
        blank_first = true;
        const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
        file.write(std::string_view(text.data(), static_cast<std::size_t>(end - text.data())));
    }
    file.write('\n');
}

}  // namespace detail

/// @addtogroup files
///@{

/// Writes the triangles of a mesh as binary STL. The form has floats alone: positions of a mesh of doubles are rounded to
/// nearest. Normals are computed, and (0, 0, 1) where there is
/// no area. Which triangles share a vertex is not in it; `welded` joins those whose corners have the
/// same coordinates. An existing file is replaced. Throws io_error if the file cannot be written in full, for a coordinate
/// that float does not hold, a vertex index out of range, and 2^31 vertices or faces or more.
///
///     abut::io::write_stl("part.stl", mesh);
template <scalar T>
void write_stl(const std::filesystem::path& path, const mesh_view<T>& mesh) {
    const std::string name = path.string();
    detail::check_corners(name, mesh);
    for (std::size_t v = 0; v < mesh.vertices.count; ++v) {
        const vec3<T> p = mesh.vertices[v];
        const T all[] = {p.x, p.y, p.z};
        for (const T x : all) {
            if (std::isfinite(static_cast<float>(x))) continue;
            throw io_error(name, "expected coordinates that float can hold, found " +
                                     abut::detail::shortest(static_cast<double>(x)) + " in vertex " + std::to_string(v));
        }
    }
    detail::output_file file(path);
    std::array<char, 84> head{};
    constexpr std::string_view made = "binary STL, written by abut";  // not 'solid', by which some readers tell ASCII
    made.copy(head.data(), made.size());
    detail::put_little_endian(head.data() + 80, static_cast<std::uint32_t>(mesh.faces.count));
    file.write(head.data(), head.size());
    for (std::size_t f = 0; f < mesh.faces.count; ++f) {
        const auto& corner = mesh.faces[f];
        std::array<vec3<double>, 3> points;  // as they are in the file
        for (std::size_t k = 0; k < 3; ++k) {
            const vec3<T> p = mesh.vertices[corner[k]];
            points[k] = detail::in_double(vec3<float>{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        }
        std::array<char, 50> row{};
        char* to = row.data();
        const auto put = [&](float x) { detail::put_little_endian(to, x), to += sizeof x; };
        for (const float n : detail::flat_normal(points[0], points[1], points[2])) put(n);
        for (const vec3<double>& p : points) {
            for (const double x : {p.x, p.y, p.z}) put(static_cast<float>(x));
        }
        file.write(row.data(), row.size());
    }
    file.close();
}

/// Writes a mesh as Wavefront OBJ: `v` and `f` lines, in order. A coordinate has the fewest digits that give it back, bit
/// for bit, to who reads it in T. Replaces and throws as `write_stl` does; any finite coordinate can be written.
///
///     abut::io::write_obj("part.obj", mesh);
template <scalar T>
void write_obj(const std::filesystem::path& path, const mesh_view<T>& mesh) {
    detail::check_corners(path.string(), mesh);
    detail::output_file file(path);
    for (std::size_t v = 0; v < mesh.vertices.count; ++v) {
        file.write('v');
        detail::write_position(file, mesh.vertices[v], true);
    }
    for (std::size_t f = 0; f < mesh.faces.count; ++f) {
        file.write('f');
        for (const std::uint32_t v : mesh.faces[f]) {
            file.write(' ');
            file.write_decimal(v + 1);
        }
        file.write('\n');
    }
    file.close();
}

/// Writes a mesh as OFF, in order; of the number of edges, which no reader uses, it says 0. Replaces and throws as
/// `write_obj` does.
///
///     abut::io::write_off("part.off", mesh);
template <scalar T>
void write_off(const std::filesystem::path& path, const mesh_view<T>& mesh) {
    detail::check_corners(path.string(), mesh);
    detail::output_file file(path);
    file.write("OFF\n" + std::to_string(mesh.vertices.count) + ' ' + std::to_string(mesh.faces.count) + " 0\n");
    for (std::size_t v = 0; v < mesh.vertices.count; ++v) detail::write_position(file, mesh.vertices[v], false);
    for (std::size_t f = 0; f < mesh.faces.count; ++f) {
        file.write('3');
        for (const std::uint32_t v : mesh.faces[f]) {
            file.write(' ');
            file.write_decimal(v);
        }
        file.write('\n');
    }
    file.close();
}

/// The same for a mesh that owns its arrays.
///@{
template <scalar T>
void write_stl(const std::filesystem::path& path, const mesh<T>& mesh) {
    write_stl(path, mesh.view());
}
template <scalar T>
void write_obj(const std::filesystem::path& path, const mesh<T>& mesh) {
    write_obj(path, mesh.view());
}
template <scalar T>
void write_off(const std::filesystem::path& path, const mesh<T>& mesh) {
    write_off(path, mesh.view());
}
///@}

///@}

}  // namespace abut::io
