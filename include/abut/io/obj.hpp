// SPDX-License-Identifier: MIT
#pragma once

// Wavefront OBJ: the polygons of a file. docs/files.md has the exact rules.
//
// tinyobjloader alone would not do: it takes a word that is no number for 0, drops polygons whose indices are out of range
// with at most a warning, names no line, and its decimal conversion is not rounded to nearest (the last digits of a double
// differ). So a first pass reads the statements strictly, takes the positions itself, and copies the `f` statements that
// have passed; tinyobjloader then takes those apart. Only its callback with integers is used: which of its two builds
// (float or double) is linked makes no difference.

#include <array>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <limits>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_obj_loader.h>

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

/// The first pass: reads the statements, checks all that is used of them, and keeps positions and `f` statements.
template <scalar T>
class obj_scanner {
public:
    obj_scanner(std::string_view text, const std::string& file, const read_options& options, mesh_data<T>& mesh)
        : file_(file), text_(text, file), options_(options), vertices_(mesh.vertices), skipped_(mesh.skipped) {
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
    }

    /// The faces, as `f` statements of one line each without comments.
    [[nodiscard]] const std::string& faces() const { return faces_; }
    /// For each face the number of vertices before it, which its negative indices count back from.
    [[nodiscard]] const std::vector<std::uint32_t>& vertices_before() const { return before_; }
    /// The lines of the faces of more than most_corners_clipped corners, in order.
    [[nodiscard]] const std::vector<std::size_t>& lines_of_large() const { return lines_of_large_; }

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
        const std::size_t begin = faces_.size(), line = text_.line();
        faces_ += 'f';
        std::size_t corners = 0;
        for (std::string_view word = next(); !word.empty(); word = next(), ++corners) {
            corner(word);
            faces_ += ' ';
            faces_ += word;
        }
        if (corners < 3) {
            if (!options_.lenient) text_.fail("a face of at least 3 corners", {});
            faces_.resize(begin);
            ++skipped_.faces;
            return;
        }
        faces_ += '\n';
        if (corners > most_corners_clipped) lines_of_large_.push_back(line);
        before_.push_back(static_cast<std::uint32_t>(vertices_.size()));
    }

    /// Checks v, v/vt, v//vn or v/vt/vn. Only v is used; the others need to be integers, or nothing.
    void corner(std::string_view word) {
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
    std::string faces_;
    std::vector<std::uint32_t> before_;
    std::vector<std::size_t> lines_of_large_;
    std::vector<forward_reference> ahead_;
};

/// A stream buffer over text that is there already.
class text_streambuf : public std::streambuf {
public:
    explicit text_streambuf(const std::string& text) {
        char* const first = const_cast<char*>(text.data());  // a get area is never written
        setg(first, first, first + text.size());
    }
};

/// The second pass: tinyobjloader takes the checked `f` statements apart.
template <scalar T>
struct obj_faces {
    face_collector<T>& faces;
    const std::vector<std::uint32_t>& vertices_before;
    const std::vector<std::size_t>& lines_of_large;
    std::size_t count = 0, large = 0;

    static void add(void* self, tinyobj::index_t* corners, int size) {
        auto& to = *static_cast<obj_faces*>(self);
        const std::uint32_t before = to.vertices_before.at(to.count++);
        const auto n = static_cast<std::size_t>(size);
        const std::size_t line = n > most_corners_clipped ? to.lines_of_large.at(to.large++) : 0;
        const auto corner = [&](std::size_t i) {
            const int index = corners[i].vertex_index;
            return index > 0 ? static_cast<std::uint32_t>(index) - 1 : before - static_cast<std::uint32_t>(-index);
        };
        to.faces.add(n, corner, {line, true});
    }
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
    detail::obj_scanner<T> scanner(text, file, options, mesh);
    scanner.run();

    detail::face_collector<T> collector(mesh, file);
    detail::obj_faces<T> sink{collector, scanner.vertices_before(), scanner.lines_of_large()};
    mesh.faces.reserve(scanner.vertices_before().size());
    detail::text_streambuf buffer(scanner.faces());
    std::istream stream(&buffer);
    tinyobj::callback_t callbacks;
    callbacks.index_cb = detail::obj_faces<T>::add;
    tinyobj::LoadObjWithCallback(stream, callbacks, &sink);
    if (sink.count != scanner.vertices_before().size()) {
        throw io_error(file, "expected " + std::to_string(scanner.vertices_before().size()) +
                                 " faces from tinyobjloader, found " + std::to_string(sink.count));
    }
    collector.finish();
    return mesh;
}

///@}

}  // namespace abut::io
