// SPDX-License-Identifier: MIT
#pragma once

// OFF, the form of Geomview: the polygons of a file. docs/reference/formats.md has the exact rules.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/mesh_data.hpp>
#include <abut/io/text.hpp>

namespace abut::io {
namespace detail {

template <scalar T>
class off_reader {
public:
    /// With `across_lines` a vertex or a face may go on in the next line, as the form allows: a vertex has three numbers
    /// then, and no others.
    off_reader(std::string_view text, const std::string& file, const read_options& options, bool across_lines)
        : file_(file), text_(text, file), options_(options), across_lines_(across_lines) {
        refuse_utf16(text, file);
    }

    mesh_data<T> parse() {
        const auto [vertices, faces] = counts();
        check_rows(vertices, 6, "vertices");  // three numbers, three blanks or ends of lines
        mesh_.vertices.reserve(static_cast<std::size_t>(vertices));
        for (std::uint64_t v = 0; v < vertices; ++v) vertex();
        check_rows(faces, options_.lenient ? 2 : 8, "faces");
        mesh_.faces.reserve(static_cast<std::size_t>(faces));
        face_collector<T> collector(mesh_, file_);
        for (std::uint64_t f = 0; f < faces; ++f) face(collector);
        text_.to_next_row();
        if (!text_.at_end()) {
            if (!options_.lenient) text_.fail("the end of the file after the last face", text_.token());
            mesh_.skipped.bytes = text_.bytes_left();
        }
        collector.finish();
        return std::move(mesh_);
    }

private:
    std::string_view next() {
        text_.skip_blanks();
        return text_.peek() == '#' ? std::string_view() : text_.token();
    }
    /// A value that the row must have.
    std::string_view value() {
        std::string_view word = next();
        if (word.empty() && across_lines_) text_.to_next_row(), word = next();
        return word;
    }
    /// What is left of a row are numbers, which are colours, normals or the like.
    void end_row() {
        for (std::string_view word = next(); !word.empty(); word = next()) {
            float ignored = 0;
            if (to_number(word, ignored) == number::malformed) text_.fail("a number or the end of the line", word);
        }
        text_.rest();  // a comment
        text_.next_line();
    }
    std::uint64_t count(std::string_view word, const char* what) {
        std::uint32_t value = 0;
        if (to_number(word, value) != number::ok || value > 0x7fffffff) text_.fail(what, word);
        return value;
    }

    /// The keyword, and the numbers of vertices, faces and edges, on its line or on the next one. Many programs leave out
    /// the edges, and some the blank after the keyword.
    std::pair<std::uint64_t, std::uint64_t> counts() {
        text_.to_next_row();
        std::string_view word = next();
        std::string_view kind = word.substr(0, word.find_first_of("0123456789"));
        if (!kind.ends_with("OFF") || (kind.size() < word.size() && kind != "OFF")) {
            text_.fail("'OFF' at the start of an OFF file", word);
        }
        word.remove_prefix(kind.size());
        kind.remove_suffix(3);
        if (across_lines_ && !kind.empty()) text_.fail("vertices of three numbers (OFF)", kind);
        for (const std::string_view with : {"ST", "C", "N"}) {
            if (kind.starts_with(with)) kind.remove_prefix(with.size());
        }
        if (!kind.empty()) text_.fail("vertices of three coordinates (OFF, COFF, NOFF, STOFF)", kind);
        if (word.empty()) word = next();
        if (word == "BINARY") text_.fail("OFF as text", word);
        if (word.empty()) {
            text_.rest();  // a comment
            text_.next_line();
            text_.to_next_row();
            word = next();
        }
        const std::uint64_t vertices = count(word, "the number of vertices, up to 2147483647");
        const std::uint64_t faces = count(value(), "the number of faces, up to 2147483647");
        const std::string_view edges = next();
        if (!edges.empty()) count(edges, "the number of edges, which is not used");
        if (!across_lines_) end_row();
        return {vertices, faces};
    }
    void check_rows(std::uint64_t rows, std::size_t least, const char* what) const {
        const std::size_t left = text_.bytes_left();
        if (rows <= (left + 1) / least) return;
        text_.fail_with("expected " + std::to_string(rows) + ' ' + what + ", at least " + std::to_string(least) +
                        " bytes each, found " + std::to_string(left) + (left == 1 ? " byte" : " bytes"));
    }

    void vertex() {
        text_.to_next_row();
        const T x = text_.template finite<T>(value(), "the x coordinate of a vertex");
        const T y = text_.template finite<T>(value(), "the y coordinate of a vertex");
        const T z = text_.template finite<T>(value(), "the z coordinate of a vertex");
        mesh_.vertices.push_back({x, y, z});
        if (!across_lines_) end_row();
    }
    void face(face_collector<T>& collector) {
        text_.to_next_row();
        const std::string_view word = next();
        const std::uint64_t corners = count(word, "the number of corners of a face");
        if (corners < 3 && !options_.lenient) text_.fail("a face of at least 3 corners", word);
        corners_.clear();
        for (std::uint64_t i = 0; i < corners; ++i) {
            const std::string_view corner = value();
            std::uint32_t index = 0;
            const number how = to_number(corner, index);
            if (how == number::malformed) text_.fail("a vertex index", corner);
            if (how != number::ok || index >= mesh_.vertices.size()) {
                text_.fail("a vertex index below " + std::to_string(mesh_.vertices.size()), corner);
            }
            corners_.push_back(index);
        }
        const file_place place{text_.line(), true};
        end_row();
        if (corners < 3) {
            ++mesh_.skipped.faces;
        } else {
            collector.add(corners_.size(), [&](std::size_t i) { return corners_[i]; }, place);
        }
    }

    const std::string& file_;
    text_cursor text_;
    const read_options options_;
    const bool across_lines_;
    mesh_data<T> mesh_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace detail

/// @addtogroup files
///@{

/// Reads the text of an OFF file; `file` is its name in messages. Polygons are cut into triangles as docs/files.md says.
/// Positions are the decimal text rounded once to T; colours, normals and the like are not used. Rows are lines, or all
/// rows go on across lines. Throws io_error with the line for text that is malformed.
///
///     const auto mesh = abut::io::parse_off<double>("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "inline");
template <scalar T>
mesh_data<T> parse_off(std::string_view text, const std::string& file, const read_options& options = {}) {
    try {
        return detail::off_reader<T>(text, file, options, false).parse();
    } catch (const io_error&) {
        // Rows that go on in the next line are rare, and a number that is missing is not. So the text is taken for such rows
        // only if all of it fits them.
        try {
            return detail::off_reader<T>(text, file, {}, true).parse();
        } catch (const io_error&) {
        }
        throw;
    }
}

///@}

}  // namespace abut::io
