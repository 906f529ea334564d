// SPDX-License-Identifier: MIT
#pragma once

// PLY: the vertices and faces of a file, ASCII or binary. docs/reference/formats.md has the exact rules. One routine reads
// the rows; where the values come from, text or bytes, is its parameter.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/mesh_data.hpp>
#include <abut/io/ply_header.hpp>
#include <abut/io/text.hpp>

namespace abut::io {
namespace detail {

/// `rows` rows that take at least `least` bytes each do not fit into `left` bytes. Asked before anything is allocated.
constexpr bool too_many(std::uint64_t rows, std::size_t least, std::size_t left) { return least > 0 && rows > left / least; }

inline std::string rows_expected(const ply_element& element, std::size_t least, std::size_t left) {
    return "expected " + std::to_string(element.count) + " rows of element " + in_quotes(element.name) + ", at least " +
           std::to_string(least) + (least == 1 ? " byte each" : " bytes each") + ", found " + std::to_string(left) +
           (left == 1 ? " byte" : " bytes");
}

/// Values written as text: one element a line, values apart by blanks, empty lines skipped.
class ply_text {
public:
    ply_text(std::string_view data, const ply_header& header, const std::string& file, const read_options& options)
        : text_(data.substr(header.body), file, header.body_line), options_(options) {}

    void check_rows(const ply_element& element) const {
        // Each value takes a character and a blank or line end; the last line may lack its end.
        const std::size_t least = 2 * element.least_row(0, false), left = text_.bytes_left();
        if (too_many(element.count, least, left + 1)) text_.fail_with(rows_expected(element, least, left));
    }
    /// How many of a file's faces there can be at most, for all that is left of it.
    [[nodiscard]] std::size_t most_faces(const ply_element& element) const {
        return (text_.bytes_left() + 1) / (2 * element.least_row(3, false));
    }
    void begin_row() {
        for (text_.skip_blanks(); text_.at_line_end() && !text_.at_end(); text_.skip_blanks()) text_.next_line();
    }
    void end_row() {
        text_.skip_blanks();
        if (!text_.at_line_end()) {
            if (!options_.lenient) text_.fail("the end of the line", text_.token());
            text_.rest();
            ++skipped.rows;
        }
        text_.next_line();
    }
    void check_list(std::uint64_t, ply_type) const {}  // its items are read one by one, and counted where they are kept

    template <scalar T>
    T coordinate(ply_type type, const char* name) {
        const std::string_view word = next();
        const std::string expected = std::string("the ") + name + " coordinate of a vertex";
        if (!is_integer(type)) return text_.finite<T>(word, expected.c_str());
        return static_cast<T>(integer_in(word, type, expected));
    }
    std::int64_t integer(ply_type type, const char* what) { return integer_in(next(), type, what); }
    void skip(ply_type, std::uint64_t count, const std::string& name) {
        for (; count > 0; --count) {
            const std::string_view word = next();
            double ignored = 0;
            if (to_number(word, ignored) == number::malformed)
                text_.fail("a number for the property " + in_quotes(name), word);
        }
    }
    [[noreturn]] void fail(const std::string& expected, std::int64_t found) const {
        text_.fail(expected, std::to_string(found));
    }
    /// Of the last value.
    [[nodiscard]] file_place place() const { return {text_.line(), true}; }
    void check_end() {
        begin_row();
        if (text_.at_end()) return;
        if (!options_.lenient) text_.fail("the end of the file after the last row", text_.token());
        skipped.bytes = text_.bytes_left();
    }

    skipped_parts skipped;

private:
    std::string_view next() {
        text_.skip_blanks();
        return text_.token();
    }
    std::int64_t integer_in(std::string_view word, ply_type type, const std::string& expected) const {
        std::int64_t value = 0;
        const number how = to_number(word, value);
        if (how == number::malformed) text_.fail(expected, word);
        const auto bits = static_cast<int>(8 * size_of(type));
        const bool is_signed = type == ply_type::int8 || type == ply_type::int16 || type == ply_type::int32;
        const std::int64_t lowest = is_signed ? -(std::int64_t{1} << (bits - 1)) : 0;
        const std::int64_t highest = (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
        if (how != number::ok || value < lowest || value > highest) {
            text_.fail(expected + " from " + std::to_string(lowest) + " to " + std::to_string(highest), word);
        }
        return value;
    }

    text_cursor text_;
    const read_options options_;
};

/// Values written as bytes, in either order.
class ply_bytes {
public:
    ply_bytes(std::string_view data, const ply_header& header, const std::string& file, const read_options& options)
        : data_(data),
          file_(file),
          options_(options),
          at_(header.body),
          swap_((header.form == ply_form::big_endian) == (std::endian::native == std::endian::little)) {}

    void check_rows(const ply_element& element) const {
        const std::size_t least = element.least_row(0, true);
        if (too_many(element.count, least, left())) fail_at(at_, rows_expected(element, least, left()));
    }
    [[nodiscard]] std::size_t most_faces(const ply_element& element) const { return left() / element.least_row(3, true); }
    void begin_row() const {}
    void end_row() const {}
    void check_list(std::uint64_t count, ply_type type) const {
        if (too_many(count, size_of(type), left())) {
            fail_at(at_, "expected a list of " + std::to_string(count) + " values of " + std::to_string(size_of(type)) +
                             " bytes, found " + std::to_string(left()) + " bytes");
        }
    }

    template <scalar T>
    T coordinate(ply_type type, const char* name) {
        const double value = is_integer(type)            ? static_cast<double>(load_integer(type))
                             : type == ply_type::float32 ? static_cast<double>(load<float>())
                                                         : load<double>();
        // Doubles from here on round to an infinite float.
        constexpr double bound = std::is_same_v<T, float> ? 0x1.ffffffp+127 : std::numeric_limits<double>::infinity();
        if (!(std::fabs(value) < bound)) {
            fail_at(last_, std::string("expected a finite ") + name + " coordinate of a vertex, found " +
                               abut::detail::shortest(value));
        }
        return static_cast<T>(value);
    }
    std::int64_t integer(ply_type type, const char*) { return load_integer(type); }
    void skip(ply_type type, std::uint64_t count, const std::string&) {
        check_list(count, type);
        at_ += std::size_t{count} * size_of(type);
    }
    [[noreturn]] void fail(const std::string& expected, std::int64_t found) const {
        fail_at(last_, "expected " + expected + ", found " + std::to_string(found));
    }
    [[nodiscard]] file_place place() const { return {last_, false}; }
    void check_end() {
        if (left() == 0) return;
        if (options_.lenient) {
            skipped.bytes = left();
            return;
        }
        fail_at(at_, "expected the end of the file after the last row, found " + std::to_string(left()) +
                         (left() == 1 ? " more byte" : " more bytes"));
    }

    skipped_parts skipped;

private:
    [[nodiscard]] std::size_t left() const { return data_.size() - at_; }
    [[noreturn]] void fail_at(std::size_t byte, const std::string& what) const {
        throw io_error::at_byte(file_, byte, what);
    }

    template <class V>
    V load() {
        if (left() < sizeof(V)) {
            fail_at(at_, "expected a value of " + std::to_string(sizeof(V)) + (sizeof(V) == 1 ? " byte" : " bytes") +
                             ", found the end of the file");
        }
        unsigned char bytes[sizeof(V)];
        std::memcpy(bytes, data_.data() + at_, sizeof(V));
        last_ = at_;
        at_ += sizeof(V);
        if (swap_) std::reverse(bytes, bytes + sizeof(V));
        V value;
        std::memcpy(&value, bytes, sizeof(V));
        return value;
    }
    std::int64_t load_integer(ply_type type) {
        switch (type) {
            case ply_type::int8:
                return load<std::int8_t>();
            case ply_type::uint8:
                return load<std::uint8_t>();
            case ply_type::int16:
                return load<std::int16_t>();
            case ply_type::uint16:
                return load<std::uint16_t>();
            case ply_type::int32:
                return load<std::int32_t>();
            default:
                return load<std::uint32_t>();
        }
    }

    std::string_view data_;
    const std::string& file_;
    const read_options options_;
    std::size_t at_;
    std::size_t last_ = 0;  // where the last value began
    bool swap_;
};

template <class Source>
void skip_field(Source& from, const ply_field& field) {
    std::uint64_t count = 1;
    if (field.count_type) {
        const std::int64_t length = from.integer(*field.count_type, "the length of a list");
        if (length < 0) from.fail("the length of a list", length);
        count = static_cast<std::uint64_t>(length);
    }
    from.skip(field.type, count, field.name);
}

template <scalar T, class Source>
void read_vertices(Source& from, const ply_element& element, std::vector<vec3<T>>& vertices) {
    const std::size_t x = element.find("x"), y = element.find("y"), z = element.find("z");
    vertices.reserve(static_cast<std::size_t>(element.count));
    for (std::uint64_t row = 0; row < element.count; ++row) {
        vec3<T> vertex{};
        from.begin_row();
        for (std::size_t i = 0; i < element.fields.size(); ++i) {
            const ply_field& field = element.fields[i];
            if (i == x)
                vertex.x = from.template coordinate<T>(field.type, "x");
            else if (i == y)
                vertex.y = from.template coordinate<T>(field.type, "y");
            else if (i == z)
                vertex.z = from.template coordinate<T>(field.type, "z");
            else
                skip_field(from, field);
        }
        from.end_row();
        vertices.push_back(vertex);
    }
}

/// The indices of a row's list; of a strip also -1, where it ends and another one begins.
template <class Source>
void read_corners(Source& from, const ply_field& field, std::int64_t count, std::int64_t least, std::uint64_t vertices,
                  std::vector<std::int64_t>& corners) {
    from.check_list(static_cast<std::uint64_t>(count), field.type);
    corners.clear();
    for (std::int64_t corner = 0; corner < count; ++corner) {
        const std::int64_t index = from.integer(field.type, "a vertex index");
        if (index < least || (index >= 0 && static_cast<std::uint64_t>(index) >= vertices)) {
            from.fail("a vertex index below " + std::to_string(vertices), index);
        }
        corners.push_back(index);
    }
}

template <scalar T, class Source>
void read_faces(Source& from, const ply_element& element, std::uint64_t vertices, const read_options& options,
                mesh_data<T>& mesh, face_collector<T>& faces) {
    const std::size_t list = element.corners();
    const bool is_strip = element.name == "tristrips";
    std::vector<std::int64_t> corners;
    if (!is_strip) {
        mesh.faces.reserve(std::min(static_cast<std::size_t>(element.count), from.most_faces(element)));
    }
    for (std::uint64_t row = 0; row < element.count; ++row) {
        from.begin_row();
        for (std::size_t i = 0; i < element.fields.size(); ++i) {
            const ply_field& field = element.fields[i];
            if (i != list) {
                skip_field(from, field);
                continue;
            }
            const std::int64_t count = from.integer(*field.count_type, "the number of corners of a face");
            if (count < 0 || (count < 3 && !is_strip && !options.lenient)) from.fail("a face of at least 3 corners", count);
            const file_place place = from.place();
            read_corners(from, field, count, is_strip ? -1 : 0, vertices, corners);
            const auto at = [&](std::size_t first) {
                return [&, first](std::size_t corner) { return static_cast<std::uint32_t>(corners[first + corner]); };
            };
            if (is_strip) {
                for (std::size_t first = 0, end = 0; first < corners.size(); first = end + 1) {
                    for (end = first; end < corners.size() && corners[end] >= 0;) ++end;
                    faces.add_strip(end - first, at(first));
                }
            } else if (count < 3) {
                ++from.skipped.faces;
            } else {
                faces.add(corners.size(), at(0), place);
            }
        }
        from.end_row();
    }
}

template <scalar T, class Source>
mesh_data<T> read_body(Source from, const ply_header& header, const std::string& file, const read_options& options) {
    mesh_data<T> mesh;
    face_collector<T> faces(mesh, file);
    for (const ply_element& element : header.elements) {
        if (element.fields.empty()) continue;  // rows of nothing, however many
        from.check_rows(element);
        if (element.name == "vertex") {
            read_vertices(from, element, mesh.vertices);
        } else if (element.has_corners()) {
            read_faces(from, element, header.find("vertex")->count, options, mesh, faces);
        } else {
            for (std::uint64_t row = 0; row < element.count; ++row) {
                from.begin_row();
                for (const ply_field& field : element.fields) skip_field(from, field);
                from.end_row();
            }
        }
    }
    from.check_end();
    mesh.skipped = from.skipped;
    faces.finish();
    return mesh;
}

}  // namespace detail

/// @addtogroup files
///@{

/// Reads the bytes of a PLY file; `file` is its name in messages. Polygons are cut into triangles as docs/files.md says.
/// A file without faces is a cloud of points. In ASCII, positions are the decimal text rounded once to T; in binary, the
/// value rounded to T. Memory is allocated only for what the bytes can hold. Throws io_error with the line (header and
/// ASCII) or byte (binary) of what is malformed or missing.
///
///     const auto mesh = abut::io::parse_ply<float>({bytes.data(), bytes.size()}, "part.ply");
template <scalar T>
mesh_data<T> parse_ply(std::string_view data, const std::string& file, const read_options& options = {}) {
    detail::refuse_utf16(data, file);
    const detail::ply_header header = detail::ply_header_parser(data, file).parse();
    if (header.form == detail::ply_form::ascii) {
        return detail::read_body<T>(detail::ply_text(data, header, file, options), header, file, options);
    }
    return detail::read_body<T>(detail::ply_bytes(data, header, file, options), header, file, options);
}

///@}

}  // namespace abut::io
