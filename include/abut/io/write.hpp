// SPDX-License-Identifier: MIT
#pragma once

// Results into files that other programs open: a mesh with values for its faces as PLY, pairs of ids as CSV. Layout and
// who shows what: docs/files.md.

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/file.hpp>
#include <abut/shape/set.hpp>

namespace abut::io {

/// A named value for each face. The values are the caller's, and have to live until the file is written. In the file the
/// type is uchar, int, uint, float or double.
struct face_property {
    std::string name;
    std::variant<std::span<const std::uint8_t>, std::span<const std::int32_t>, std::span<const std::uint32_t>,
                 std::span<const float>, std::span<const double>>
        values;
};

/// What goes into a PLY file besides the mesh; by default nothing.
struct ply_options {
    /// For each face 0 or not: written as `uchar hit` (0 or 1) of the face, and again as a colour of the face (`red`,
    /// `green`, `blue`: orange where it is set, light grey elsewhere), which is what viewers show without being told, and
    /// as `uchar hit` of each vertex (1 if a face that uses it is set), for viewers that know no values of faces. Empty:
    /// nothing of this is written.
    std::span<const std::uint8_t> hit{};
    /// More values for each face, after those.
    std::vector<face_property> face_properties{};
};

/// A pair of ids: `index_pair`, or any type with two integers `a` and `b`.
template <class P>
concept id_pair = requires(const P& pair) {
    requires std::integral<std::remove_cvref_t<decltype(pair.a)>>;
    requires std::integral<std::remove_cvref_t<decltype(pair.b)>>;
};

namespace detail {

/// In the byte order of the files that are written here.
template <class V>
void put_little_endian(char* to, V value) {
    std::memcpy(to, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(to, to + sizeof value);
}

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

/// Whether programs can read it as one word of a header.
inline bool is_ply_word(std::string_view name) {
    for (const char c : name) {
        if (c <= ' ' || c > '~') return false;
    }
    return !name.empty();
}

inline void check_sizes(const std::string& file, std::size_t vertices, std::size_t faces, const ply_options& options) {
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();  // indices are written as int, for all to read
    if (vertices > most || faces > most) {
        throw io_error(file, "expected at most 2147483647 vertices and faces, found " + std::to_string(vertices) + " and " +
                                 std::to_string(faces));
    }
    const auto check = [&](const std::string& name, std::size_t count) {
        if (count == faces) return;
        throw io_error(file, "expected " + std::to_string(faces) + " values of '" + name + "', one for each face, found " +
                                 std::to_string(count));
    };
    if (!options.hit.empty()) check("hit", options.hit.size());
    std::vector<std::string_view> taken{"vertex_indices"};
    if (!options.hit.empty()) taken.insert(taken.end(), {"hit", "red", "green", "blue"});
    for (const face_property& property : options.face_properties) {
        check(property.name, std::visit([](const auto& values) { return values.size(); }, property.values));
        if (!is_ply_word(property.name)) {
            throw io_error(file, "expected the name of a property without blanks, found '" + property.name + "'");
        }
        if (std::ranges::find(taken, property.name) != taken.end()) {
            throw io_error(file, "expected properties of different names, found '" + property.name + "' again");
        }
        taken.push_back(property.name);
    }
}

template <scalar T>
void write_ply_header(output_file& to, std::size_t vertices, std::size_t faces, const ply_options& options) {
    const std::string real = ply_name<T>();
    std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) + "\n";
    for (const char* axis : {"x", "y", "z"}) text += "property " + real + " " + axis + "\n";
    if (!options.hit.empty()) text += "property uchar hit\n";
    text += "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\n";
    if (!options.hit.empty()) {
        for (const char* name : {"hit", "red", "green", "blue"}) text += std::string("property uchar ") + name + "\n";
    }
    for (const face_property& property : options.face_properties) {
        const auto type = [](const auto& values) { return ply_name<typename std::decay_t<decltype(values)>::value_type>(); };
        text += std::string("property ") + std::visit(type, property.values) + " " + property.name + "\n";
    }
    to.write(text + "end_header\n");
}

}  // namespace detail

/// Writes a mesh as binary little-endian PLY: positions in T, all vertices and triangles in order, and what the options
/// add. An existing file is replaced. Throws io_error if the file cannot be written in full (what is there of it then is
/// not removed), if a property has not one value for each face or no usable name, and for 2^31 vertices or faces or more.
///
///     abut::io::write_ply("hits.ply", mesh, {.hit = hit});
template <scalar T>
void write_ply(const std::filesystem::path& path, const mesh_view<T>& mesh, const ply_options& options = {}) {
    const std::string name = path.string();
    const std::size_t vertices = mesh.vertices.count, faces = mesh.faces.count;
    detail::check_sizes(name, vertices, faces, options);
    std::vector<std::uint8_t> vertex_hit(options.hit.empty() ? 0 : vertices);
    for (std::size_t f = 0; f < options.hit.size(); ++f) {
        if (options.hit[f] == 0) continue;
        for (const std::uint32_t v : mesh.faces[f]) vertex_hit.at(v) = 1;
    }

    detail::output_file file(path);
    detail::write_ply_header<T>(file, vertices, faces, options);
    std::array<char, 3 * sizeof(T) + 1> vertex_row{};
    for (std::size_t v = 0; v < vertices; ++v) {
        const vec3<T>& position = mesh.vertices[v];
        detail::put_little_endian(&vertex_row[0], position.x);
        detail::put_little_endian(&vertex_row[sizeof(T)], position.y);
        detail::put_little_endian(&vertex_row[2 * sizeof(T)], position.z);
        if (!vertex_hit.empty()) vertex_row[3 * sizeof(T)] = static_cast<char>(vertex_hit[v]);
        file.write(vertex_row.data(), vertex_row.size() - (vertex_hit.empty() ? 1 : 0));
    }
    std::vector<char> face_row;
    const auto append = [&face_row](auto value) {
        face_row.resize(face_row.size() + sizeof value);
        detail::put_little_endian(face_row.data() + face_row.size() - sizeof value, value);
    };
    constexpr std::array<std::uint8_t, 3> marked{230, 85, 13}, plain{217, 217, 217};
    for (std::size_t f = 0; f < faces; ++f) {
        face_row.clear();
        append(std::uint8_t{3});
        for (const std::uint32_t v : mesh.faces[f]) append(v);
        if (!options.hit.empty()) {
            const bool hit = options.hit[f] != 0;
            append(static_cast<std::uint8_t>(hit));
            for (const std::uint8_t channel : hit ? marked : plain) append(channel);
        }
        for (const face_property& property : options.face_properties) {
            std::visit([&](const auto& values) { append(values[f]); }, property.values);
        }
        file.write(face_row.data(), face_row.size());
    }
    file.close();
}

/// The same for a mesh that owns its arrays.
template <scalar T>
void write_ply(const std::filesystem::path& path, const mesh<T>& mesh, const ply_options& options = {}) {
    write_ply(path, mesh.view(), options);
}

/// The same for vectors, as the parsers return them.
template <scalar T>
void write_ply(const std::filesystem::path& path, const std::vector<vec3<T>>& vertices, const std::vector<face>& faces,
               const ply_options& options = {}) {
    write_ply(path, mesh_view<T>(vertices.data(), vertices.size(), faces.data(), faces.size()), options);
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

}  // namespace abut::io
