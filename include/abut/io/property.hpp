// SPDX-License-Identifier: MIT
#pragma once

// What goes into a written file beside the positions: named values for each face, vertex or point; and what the writers of
// both formats check of it before they touch the file.

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/shape/view.hpp>

namespace abut::io {

/// @addtogroup files
///@{

/// A named value for each face, vertex or point. The values are the caller's, and have to live until the file is written.
/// Their type in a file is uchar, int, uint, float or double (VTP: UInt8, Int32, UInt32, Float32, Float64).
struct property {
    /// As programs that read the file show it: printable ASCII without blanks, and not one of the format's own.
    std::string name;
    /// One for each element, in its order.
    std::variant<std::span<const std::uint8_t>, std::span<const std::int32_t>, std::span<const std::uint32_t>,
                 std::span<const float>, std::span<const double>>
        values;
};
/// The name by which properties of faces went before there were others.
using face_property = property;

/// What goes into a file of a mesh besides the mesh; by default nothing.
struct mesh_options {
    /// For each face 0 or not: written as `hit` (0 or 1) of the face. PLY has it again as a colour of the face (`red`,
    /// `green`, `blue`: orange where it is set, light grey elsewhere), which is what viewers show without being told, and
    /// as `hit` of each vertex (1 if a face that uses it is set), for viewers that know no values of faces; in VTP it is
    /// the active scalar of the cells. Empty: nothing of this is written.
    std::span<const std::uint8_t> hit{};
    /// More values for each face, after those.
    std::vector<property> face_properties{};
    /// Values for each vertex.
    std::vector<property> vertex_properties{};
};
/// The name by which mesh_options went before there was VTP.
using ply_options = mesh_options;

/// What goes into a file of points besides their positions; by default nothing.
template <scalar T>
struct point_options {
    /// One for each point, as `nx`, `ny`, `nz` (PLY) or `normal` (VTP). Any vectors will do, unit or not. Empty: none.
    std::span<const vec3<T>> normals{};
    /// Values for each point.
    std::vector<property> properties{};
};

/// A pair of ids: `index_pair`, or any type with two integers `a` and `b`.
template <class P>
concept id_pair = requires(const P& pair) {
    requires std::integral<std::remove_cvref_t<decltype(pair.a)>>;
    requires std::integral<std::remove_cvref_t<decltype(pair.b)>>;
};

///@}

namespace detail {

/// In the byte order of the files that are written here.
template <class V>
void put_little_endian(char* to, V value) {
    std::memcpy(to, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(to, to + sizeof value);
}

inline std::size_t size_of(const property& p) {
    return std::visit([](const auto& values) { return values.size(); }, p.values);
}

/// Whether programs can read it as one word of a header.
inline bool is_word(std::string_view name) {
    for (const char c : name) {
        if (c <= ' ' || c > '~') return false;
    }
    return !name.empty();
}

inline void check_count(const std::string& file, std::string_view name, const char* what, std::size_t expected,
                        std::size_t found) {
    if (found == expected) return;
    throw io_error(file, "expected " + std::to_string(expected) + " values of '" + std::string(name) + "', one for each " +
                             what + ", found " + std::to_string(found));
}

/// One value for each of `count` elements, and names that neither format has given away.
inline void check_properties(const std::string& file, const char* what, std::size_t count,
                             const std::vector<property>& properties, std::vector<std::string_view> taken) {
    for (const property& p : properties) {
        check_count(file, p.name, what, count, size_of(p));
        if (!is_word(p.name)) {
            throw io_error(file, "expected the name of a property without blanks, found '" + p.name + "'");
        }
        if (std::ranges::find(taken, p.name) != taken.end()) {
            throw io_error(file, "expected properties of different names, found '" + p.name + "' again");
        }
        taken.push_back(p.name);
    }
}

inline constexpr std::size_t most_written = std::numeric_limits<std::int32_t>::max();  // ids are int there, for all to read

inline void check_mesh(const std::string& file, std::size_t vertices, std::size_t faces, const mesh_options& options) {
    if (vertices > most_written || faces > most_written) {
        throw io_error(file, "expected at most 2147483647 vertices and faces, found " + std::to_string(vertices) + " and " +
                                 std::to_string(faces));
    }
    std::vector<std::string_view> of_face{"vertex_indices"}, of_vertex{"x", "y", "z"};
    if (!options.hit.empty()) {
        check_count(file, "hit", "face", faces, options.hit.size());
        of_face.insert(of_face.end(), {"hit", "red", "green", "blue"});
        of_vertex.emplace_back("hit");
    }
    check_properties(file, "face", faces, options.face_properties, of_face);
    check_properties(file, "vertex", vertices, options.vertex_properties, of_vertex);
}

template <scalar T>
void check_points(const std::string& file, std::size_t points, const point_options<T>& options) {
    if (points > most_written) {
        throw io_error(file, "expected at most 2147483647 points, found " + std::to_string(points));
    }
    std::vector<std::string_view> taken{"x", "y", "z"};
    if (!options.normals.empty()) {
        check_count(file, "normal", "point", points, options.normals.size());
        taken.insert(taken.end(), {"nx", "ny", "nz", "normal"});
    }
    check_properties(file, "point", points, options.properties, taken);
}

}  // namespace detail

}  // namespace abut::io
