// SPDX-License-Identifier: MIT
#pragma once

// Wavefront OBJ: the polygons of a file. docs/reference/formats.md has the exact rules.
//
// Statements are read strictly, in one pass: a word that is no number is an error of its line, and so is an index out of
// range. Positions are rounded once, to nearest.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/mesh_data.hpp>
#include <abut/io/text.hpp>

namespace abut::io {
namespace detail {

/// Statements that say nothing about polygons. The rest of the line is skipped.
constexpr bool is_obj_aside(std::string_view word) {
    constexpr std::string_view words[] = {
        "t",          "group",     "vt",     "vn",     "vp",     "vw",     "l",    "p",     "g",        "o",
        "s",          "mg",        "usemtl", "mtllib", "usemap", "maplib", "lod",  "bevel", "c_interp", "d_interp",
        "shadow_obj", "trace_obj", "ctech",  "stech",  "cstype", "deg",    "bmat", "step",  "curv",     "curv2",
        "parm",       "trim",      "hole",   "scrv",   "sp",     "end",    "con"};
    for (const std::string_view known : words) {
        if (word == known) return true;
    }
    return false;
}

/// Those of them that hold names and not numbers: a backslash at the end may belong to a path.
constexpr bool is_obj_naming(std::string_view word) {
    return word == "g" || word == "group" || word == "o" || word == "usemtl" || word == "mtllib" || word == "usemap" ||
           word == "maplib" || word == "shadow_obj" || word == "trace_obj";
}

/// Reads the statements, and keeps positions and faces.
template <scalar T>
class obj_scanner {
public:
    obj_scanner(std::string_view text, const std::string& file, const read_options& options, mesh_data<T>& mesh)
        : file_(file),
          text_(text, file),
          options_(options),
          vertices_(mesh.vertices),
          skipped_(mesh.skipped),
          faces_(mesh, file) {
        refuse_utf16(text, file);
    }

    void run() {
        while (!text_.at_end()) {
            const std::string_view word = next();
            if (word == "v")
                vertex();
            else if (word == "f" || word == "fo")
                face();
            else if (is_obj_aside(word))
                aside(word);
            else if (!word.empty())
                stray(word);
            if (!text_.at_line_end()) text_.rest();  // a comment
            text_.next_line();
        }
        if (vertices_.empty()) text_.fail("vertices ('v x y z') in an OBJ file", {});
        for (const forward_reference& corner : ahead_) {
            if (corner.index <= vertices_.size()) continue;
            throw io_error::at_line(
                file_, corner.line,
                "expected " + index_range(vertices_.size()) + ", found '" + std::to_string(corner.index) + "'");
        }
        faces_.finish();
    }

private:
    /// The next word of the statement, on the next line too if this one ends with a backslash; empty at the end of the
    /// statement or at a comment.
    std::string_view next() {
        for (;;) {
            text_.skip_blanks();
            if (text_.peek() == '#') return {};
            std::string_view word = text_.token();
            if (!word.ends_with('\\') || !text_.at_line_end()) return word;
            word.remove_suffix(1);
            text_.next_line();
            if (!word.empty()) return word;
        }
    }

    void vertex() {
        constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max();
        if (vertices_.size() == limit) text_.fail_with("more than 2147483647 vertices");
        const T x = text_.template finite<T>(next(), "the x coordinate of a vertex");
        const T y = text_.template finite<T>(next(), "the y coordinate of a vertex");
        const T z = text_.template finite<T>(next(), "the z coordinate of a vertex");
        vertices_.push_back({x, y, z});
        // What may follow, a weight (for curves only) or a colour, is no part of the shape.
        std::size_t more = 0;
        for (std::string_view word = next(); !word.empty(); word = next(), ++more) {
            float ignored = 0;
            if ((more == 4 && !options_.lenient) || to_number(word, ignored) == number::malformed) {
                text_.fail("the end of the vertex, a weight or a colour", word);
            }
        }
        if (more == 2 && !options_.lenient) text_.fail("x, y, z, and then a weight, a colour of three numbers or both", {});
        if (more == 2 || more > 4) ++skipped_.rows;
    }

    void face() {
        const std::size_t line = text_.line();
        corners_.clear();
        for (std::string_view word = next(); !word.empty(); word = next()) corners_.push_back(corner(word));
        if (corners_.size() < 3) {
            if (!options_.lenient) text_.fail("a face of at least 3 corners", {});
            ++skipped_.faces;
            return;
        }
        faces_.add(corners_.size(), [&](std::size_t i) { return corners_[i]; }, {line, true});
    }

    /// The vertex, from 0, of v, v/vt, v//vn or v/vt/vn. Only v is used; the others need to be integers, or nothing.
    std::uint32_t corner(std::string_view word) {
        constexpr const char* expected = "a corner as v, v/vt, v//vn or v/vt/vn";
        const std::size_t slash = word.find('/');
        std::int32_t index = 0;
        const number how = to_number(word.substr(0, slash), index);
        if (how == number::malformed) text_.fail(expected, word);
        const bool backwards = index < 0;
        const auto distance = static_cast<std::size_t>(backwards ? -static_cast<std::int64_t>(index) : index);
        if (how != number::ok || index == 0 || (backwards && distance > vertices_.size())) {
            text_.fail(index_range(vertices_.size()), word);
        }
        // A vertex may come after the face that uses it. Of such corners only the first to exceed all before it can be the
        // first that turns out to be wrong.
        if (!backwards && distance > vertices_.size() && (ahead_.empty() || distance > ahead_.back().index)) {
            ahead_.push_back({distance, text_.line()});
        }
        std::size_t parts = 1;
        for (std::size_t from = slash; from != std::string_view::npos; ++parts) {
            const std::size_t to = word.find('/', from + 1);
            const std::string_view part = word.substr(from + 1, to == std::string_view::npos ? to : to - from - 1);
            std::int32_t ignored = 0;
            if (parts == 3 || (!part.empty() && to_number(part, ignored) != number::ok)) text_.fail(expected, word);
            from = to;
        }
        return static_cast<std::uint32_t>(backwards ? vertices_.size() - distance : distance - 1);
    }

    static std::string index_range(std::size_t vertices) {
        return "a vertex index from 1 to " + std::to_string(vertices) + " (or from -1 to -" + std::to_string(vertices) + ")";
    }

    void aside(std::string_view word) {
        const bool continues = !is_obj_naming(word);
        while (text_.rest().ends_with('\\') && continues && !text_.at_end()) text_.next_line();
    }

    /// Lines of numbers before the first vertex are counts that some programs write; all else is refused.
    void stray(std::string_view word) {
        if (word == "surf") text_.fail("polygons (free-form surfaces are not supported)", word);
        if (word == "call" || word == "csh") text_.fail("one file (other files and commands are not called)", word);
        const std::string_view first = word;
        double ignored = 0;
        for (; !word.empty() && vertices_.empty(); word = next()) {
            if (to_number(word, ignored) == number::malformed) break;
        }
        if (!word.empty()) text_.fail("an OBJ statement (v, f, vt, vn, g, ...)", first);
    }

    struct forward_reference {
        std::size_t index;
        std::size_t line;
    };

    const std::string& file_;
    text_cursor text_;
    const read_options options_;
    std::vector<vec3<T>>& vertices_;
    skipped_parts& skipped_;
    face_collector<T> faces_;
    std::vector<std::uint32_t> corners_;  // of the face that is being read
    std::vector<forward_reference> ahead_;
};

}  // namespace detail

/// @addtogroup files
///@{

/// Reads the text of an OBJ file; `file` is its name in messages. Polygons are cut into triangles as docs/files.md says.
/// Positions are the decimal text rounded once to T. Throws io_error with the line for text that is malformed. A text
/// without faces is a cloud of points.
///
///     const auto mesh = abut::io::parse_obj<double>("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "inline");
template <scalar T>
mesh_data<T> parse_obj(std::string_view text, const std::string& file, const read_options& options = {}) {
    while (text.ends_with('\0')) text.remove_suffix(1);  // with which some programs fill the file up
    mesh_data<T> mesh;
    detail::obj_scanner<T>(text, file, options, mesh).run();
    return mesh;
}

///@}

}  // namespace abut::io
