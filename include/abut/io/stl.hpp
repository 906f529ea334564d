// SPDX-License-Identifier: MIT
#pragma once

// STL: the triangles of a file, binary or ASCII. docs/reference/formats.md has the exact rules.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include <abut/io/error.hpp>
#include <abut/io/mesh_data.hpp>
#include <abut/io/text.hpp>

namespace abut::io {
namespace detail {

/// A value in the byte order of all binary files that are read here but PLY.
template <class V>
V get_little_endian(const char* from) {
    std::array<char, sizeof(V)> bytes;
    std::memcpy(bytes.data(), from, sizeof(V));
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<V>(bytes);
}

inline constexpr std::size_t stl_head = 84, stl_row = 50;  // 80 bytes of anything and the number of triangles; a triangle

/// Whether the size is that of a binary file. Its first 80 bytes may be anything, so also "solid" as in ASCII.
inline bool is_binary_stl(std::string_view data) {
    if (data.size() < stl_head) return false;
    return (data.size() - stl_head) / stl_row == get_little_endian<std::uint32_t>(data.data() + 80) &&
           (data.size() - stl_head) % stl_row == 0;
}

template <scalar T>
mesh_data<T> parse_binary_stl(std::string_view data, const std::string& file, const read_options& options) {
    const auto fail = [&](std::size_t byte, const std::string& what) { throw io_error::at_byte(file, byte, what); };
    if (data.size() < stl_head) {
        fail(data.size(), "expected the 84 bytes that a binary STL file begins with, or 'solid', found the end of the file");
    }
    const std::uint64_t count = get_little_endian<std::uint32_t>(data.data() + 80);
    const std::size_t left = data.size() - stl_head;
    if (count > left / stl_row) {
        fail(80, "expected " + std::to_string(count) + " triangles of 50 bytes, found " + std::to_string(left) + " bytes");
    }
    mesh_data<T> mesh;
    mesh.skipped.bytes = left - static_cast<std::size_t>(count) * stl_row;
    if (mesh.skipped.bytes > 0 && !options.lenient) {
        fail(data.size() - mesh.skipped.bytes, "expected the end of the file after the last triangle, found " +
                                                   std::to_string(mesh.skipped.bytes) +
                                                   (mesh.skipped.bytes == 1 ? " more byte" : " more bytes"));
    }
    mesh.vertices.reserve(3 * static_cast<std::size_t>(count));
    mesh.faces.reserve(static_cast<std::size_t>(count));
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::size_t row = stl_head + stl_row * i;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            std::array<T, 3> point;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t at = row + 12 * (corner + 1) + 4 * k;  // after the normal
                const auto value = get_little_endian<float>(data.data() + at);
                if (!std::isfinite(value)) {
                    fail(at, std::string("expected a finite ") + "xyz"[k] + " coordinate of a vertex, found " +
                                 abut::detail::shortest(static_cast<double>(value)));
                }
                point[k] = static_cast<T>(value);
            }
            mesh.vertices.push_back({point[0], point[1], point[2]});
        }
        mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// Whether a word is a keyword, in any case.
inline bool is_keyword(std::string_view word, std::string_view keyword) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::ranges::equal(word, keyword, {}, lower);
}

/// Words of ASCII STL, in any case, across lines.
template <scalar T>
class stl_text {
public:
    stl_text(std::string_view text, const std::string& file, const read_options& options)
        : text_(text, file), options_(options) {}

    mesh_data<T> parse() {
        while (is_keyword(next(), "solid")) {
            text_.rest();  // its name
            std::string_view word = next();
            for (; is_keyword(word, "facet"); word = next()) facet();
            // Some programs forget the blank before the name that it ends with.
            if (!is_keyword(word.substr(0, 8), "endsolid")) text_.fail("'facet' or 'endsolid'", word);
            text_.rest();
        }
        if (!word_.empty()) {
            if (!options_.lenient) text_.fail("'solid' or the end of the file", word_);
            mesh_.skipped.bytes = text_.bytes_left() + word_.size();
        }
        return std::move(mesh_);
    }

private:
    std::string_view next() {
        for (text_.skip_blanks(); text_.at_line_end() && !text_.at_end(); text_.skip_blanks()) text_.next_line();
        return word_ = text_.token();
    }
    void expect(std::string_view keyword) {
        if (!is_keyword(next(), keyword)) text_.fail(in_quotes(keyword), word_);
    }
    void facet() {
        constexpr std::size_t limit = 0x7fffffff / 3;
        if (mesh_.faces.size() == limit) text_.fail_with("expected at most 715827882 triangles, found more");
        expect("normal");
        for (int k = 0; k < 3; ++k) {
            float ignored = 0;
            if (to_number(next(), ignored) == number::malformed) text_.fail("a number of a normal", word_);
        }
        expect("outer");
        expect("loop");
        const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            const T x = text_.template finite<T>(next(), "the x coordinate of a vertex");
            const T y = text_.template finite<T>(next(), "the y coordinate of a vertex");
            const T z = text_.template finite<T>(next(), "the z coordinate of a vertex");
            mesh_.vertices.push_back({x, y, z});
        }
        expect("endloop");
        expect("endfacet");
        mesh_.faces.push_back({first, first + 1, first + 2});
    }

    text_cursor text_;
    const read_options options_;
    std::string_view word_;
    mesh_data<T> mesh_;
};

}  // namespace detail

/// @addtogroup files
///@{

/// Reads the bytes of an STL file; `file` is its name in messages. Each triangle has three vertices of its own: `welded`
/// joins those in one place. Normals and attributes are not used. In ASCII, positions are the decimal text rounded once to
/// T. Throws io_error with the line (ASCII) or byte (binary) of what is malformed or missing.
///
///     const auto mesh = abut::io::parse_stl<float>({bytes.data(), bytes.size()}, "part.stl");
template <scalar T>
mesh_data<T> parse_stl(std::string_view data, const std::string& file, const read_options& options = {}) {
    if (detail::is_binary_stl(data)) return detail::parse_binary_stl<T>(data, file, options);
    detail::refuse_utf16(data, file);
    std::string_view start = data.substr(0, std::min<std::size_t>(data.size(), 256));
    if (start.starts_with("\xef\xbb\xbf")) start.remove_prefix(3);
    const std::size_t first = start.find_first_not_of(" \t\r\n");
    // A binary file that is cut off may begin with "solid" too; then it holds bytes that no text does.
    const bool is_text =
        first != start.npos && detail::is_keyword(start.substr(first, 5), "solid") && start.find('\0') == start.npos;
    if (!is_text) return detail::parse_binary_stl<T>(data, file, options);
    return detail::stl_text<T>(data, file, options).parse();
}

///@}

}  // namespace abut::io
