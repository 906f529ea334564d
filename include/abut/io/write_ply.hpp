// SPDX-License-Identifier: MIT
#pragma once

// Meshes and points as binary PLY, the form that most programs read. Layout and who shows what: docs/reference/formats.md.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <abut/io/file.hpp>
#include <abut/io/property.hpp>
#include <abut/shape/set.hpp>

namespace abut::io {

namespace detail {

template <class V>
constexpr const char* ply_name() {
    if constexpr (std::same_as<V, std::uint8_t>)
        return "uchar";
    else if constexpr (std::same_as<V, std::int32_t>)
        return "int";
    else if constexpr (std::same_as<V, std::uint32_t>)
        return "uint";
    else if constexpr (std::same_as<V, float>)
        return "float";
    else
        return "double";
}

/// Lines of a header.
class ply_header_text {
public:
    void element(const char* name, std::size_t count) {
        text_ += std::string("element ") + name + " " + std::to_string(count) + "\n";
    }
    void property_line(const std::string& type, const std::string& name) { text_ += "property " + type + " " + name + "\n"; }
    template <scalar T>
    void axes(const char* prefix) {
        for (const char* axis : {"x", "y", "z"}) property_line(ply_name<T>(), std::string(prefix) + axis);
    }
    void properties(const std::vector<property>& all) {
        const auto type = [](const auto& values) { return ply_name<typename std::decay_t<decltype(values)>::value_type>(); };
        for (const property& p : all) property_line(std::visit(type, p.values), p.name);
    }
    void write(output_file& to) const { to.write("ply\nformat binary_little_endian 1.0\n" + text_ + "end_header\n"); }

private:
    std::string text_;
};

/// The bytes of one element.
class ply_row {
public:
    template <class V>
    void append(V value) {
        row_.resize(row_.size() + sizeof value);
        put_little_endian(row_.data() + row_.size() - sizeof value, value);
    }
    template <scalar T>
    void append(const vec3<T>& v) {
        append(v.x);
        append(v.y);
        append(v.z);
    }
    void append(const std::vector<property>& all, std::size_t i) {
        for (const property& p : all) {
            std::visit([&](const auto& values) { append(values[i]); }, p.values);
        }
    }
    void write(output_file& to) {
        to.write(row_.data(), row_.size());
        row_.clear();
    }

private:
    std::vector<char> row_;
};

template <scalar T>
void write_ply_header(output_file& to, std::size_t vertices, std::size_t faces, const mesh_options& options) {
    ply_header_text header;
    header.element("vertex", vertices);
    header.axes<T>("");
    if (!options.hit.empty()) header.property_line("uchar", "hit");
    header.properties(options.vertex_properties);
    header.element("face", faces);
    header.property_line("list uchar int", "vertex_indices");
    if (!options.hit.empty()) {
        for (const char* name : {"hit", "red", "green", "blue"}) header.property_line("uchar", name);
    }
    header.properties(options.face_properties);
    header.write(to);
}

}  // namespace detail

/// @addtogroup files
///@{

/// Writes a mesh as binary little-endian PLY: positions in T, all vertices and triangles in order, and what the options
/// add. An existing file is replaced. Throws io_error if the file cannot be written in full (what is there of it then is
/// not removed), if a property has not one value for each face or vertex or no usable name, and for 2^31 vertices or faces
/// or more.
///
///     abut::io::write_ply("hits.ply", mesh, {.hit = hit});
template <scalar T>
void write_ply(const std::filesystem::path& path, const mesh_view<T>& mesh, const mesh_options& options = {}) {
    const std::size_t vertices = mesh.vertices.count, faces = mesh.faces.count;
    detail::check_mesh(path.string(), vertices, faces, options);
    std::vector<std::uint8_t> vertex_hit(options.hit.empty() ? 0 : vertices);
    for (std::size_t f = 0; f < options.hit.size(); ++f) {
        if (options.hit[f] == 0) continue;
        for (const std::uint32_t v : mesh.faces[f]) vertex_hit.at(v) = 1;
    }

    detail::output_file file(path);
    detail::write_ply_header<T>(file, vertices, faces, options);
    detail::ply_row row;
    for (std::size_t v = 0; v < vertices; ++v) {
        row.append(mesh.vertices[v]);
        if (!vertex_hit.empty()) row.append(vertex_hit[v]);
        row.append(options.vertex_properties, v);
        row.write(file);
    }
    constexpr std::array<std::uint8_t, 3> marked{230, 85, 13}, plain{217, 217, 217};
    for (std::size_t f = 0; f < faces; ++f) {
        row.append(std::uint8_t{3});
        for (const std::uint32_t v : mesh.faces[f]) row.append(v);
        if (!options.hit.empty()) {
            const bool hit = options.hit[f] != 0;
            row.append(static_cast<std::uint8_t>(hit));
            for (const std::uint8_t channel : hit ? marked : plain) row.append(channel);
        }
        row.append(options.face_properties, f);
        row.write(file);
    }
    file.close();
}

/// The same for a mesh that owns its arrays.
template <scalar T>
void write_ply(const std::filesystem::path& path, const mesh<T>& mesh, const mesh_options& options = {}) {
    write_ply(path, mesh.view(), options);
}

/// The same for vectors, as the parsers return them.
template <scalar T>
void write_ply(const std::filesystem::path& path, const std::vector<vec3<T>>& vertices, const std::vector<face>& faces,
               const mesh_options& options = {}) {
    write_ply(path, mesh_view<T>(vertices.data(), vertices.size(), faces.data(), faces.size()), options);
}

/// Writes points as binary little-endian PLY: an element `vertex` with positions in T, and what the options add; no faces.
/// The readers here give back such a file as a mesh without faces. Replaces and throws as `write_ply` does.
///
///     abut::io::write_points_ply("contacts.ply", points, {.normals = normals, .properties = {{"depth", depths}}});
template <scalar T>
void write_points_ply(const std::filesystem::path& path, const std::vector<vec3<T>>& points,
                      const point_options<T>& options = {}) {
    detail::check_points(path.string(), points.size(), options);
    detail::output_file file(path);
    detail::ply_header_text header;
    header.element("vertex", points.size());
    header.axes<T>("");
    if (!options.normals.empty()) header.axes<T>("n");
    header.properties(options.properties);
    header.write(file);
    detail::ply_row row;
    for (std::size_t i = 0; i < points.size(); ++i) {
        row.append(points[i]);
        if (!options.normals.empty()) row.append(options.normals[i]);
        row.append(options.properties, i);
        row.write(file);
    }
    file.close();
}

///@}

}  // namespace abut::io
