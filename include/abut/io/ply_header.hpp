// SPDX-License-Identifier: MIT
#pragma once

// The header of a PLY file: which elements follow, of which properties, in which form.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/text.hpp>

namespace abut::io::detail {

enum class ply_type : unsigned char { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t size_of(ply_type type) {
    constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}
constexpr bool is_integer(ply_type type) { return type < ply_type::float32; }

struct ply_field {
    std::string name;
    ply_type type;
    std::optional<ply_type> count_type{};  // of lists only
};

struct ply_element {
    std::string name;
    std::uint64_t count;
    std::vector<ply_field> fields{};

    /// Index of a field, or the number of fields.
    [[nodiscard]] std::size_t find(std::string_view field) const {
        std::size_t i = 0;
        while (i < fields.size() && fields[i].name != field) ++i;
        return i;
    }
    /// Whether its rows are faces or strips of triangles.
    [[nodiscard]] bool has_corners() const { return name == "face" || name == "tristrips"; }
    /// Index of the list of its corners, or the number of fields.
    [[nodiscard]] std::size_t corners() const { return std::min(find("vertex_indices"), find("vertex_index")); }
    /// How many values, or bytes of values, a row has at least, where a face has at least so many corners.
    [[nodiscard]] std::size_t least_row(std::size_t corners_of_a_face, bool in_bytes) const {
        std::size_t least = 0;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const ply_field& field = fields[i];
            least += in_bytes ? size_of(field.count_type.value_or(field.type)) : 1;
            if (name == "face" && i == corners()) least += corners_of_a_face * (in_bytes ? size_of(field.type) : 1);
        }
        return least;
    }
};

enum class ply_form { ascii, little_endian, big_endian };

struct ply_header {
    ply_form form;
    std::vector<ply_element> elements;
    std::size_t body;       // where it starts, in bytes
    std::size_t body_line;  // and the number of that line

    [[nodiscard]] const ply_element* find(std::string_view element) const {
        for (const auto& candidate : elements) {
            if (candidate.name == element) return &candidate;
        }
        return nullptr;
    }
};

/// Reads a header line by line. Lines end as the first one does: with LF (a CR before it is dropped), or with CR.
class ply_header_parser {
public:
    ply_header_parser(std::string_view data, const std::string& file) : data_(data), file_(file) {
        const std::size_t end = data.find_first_of("\r\n");
        if (end != data.npos && data[end] == '\r' && (end + 1 == data.size() || data[end + 1] != '\n')) line_end_ = '\r';
    }

    ply_header parse() {
        if (!next_line() || line_ != "ply") fail("'ply' in the first line of a PLY file", found_);
        for (;;) {
            if (!next_line()) fail("'end_header'", {});
            const std::string_view keyword = word();
            if (keyword.empty()) continue;
            if (keyword == "comment" || keyword == "obj_info") {
                in_comment_ = true;
                continue;
            }
            const bool may_be_comment = in_comment_ || elements_.empty();
            in_comment_ = false;
            if (keyword == "format")
                format();
            else if (keyword == "element")
                element();
            else if (keyword == "property")
                property();
            else if (keyword == "end_header")
                break;
            else if (may_be_comment && form_) {
                // A comment that lacks its keyword, or goes on without it. Among elements and their properties it might be
                // one that is misspelt.
                in_comment_ = true;
                continue;
            } else
                fail("a line of a PLY header (format, element, property, comment, end_header)", keyword);
            if (const auto more = word(); !more.empty()) fail("the end of the line", more);
        }
        if (!form_) fail("a format line before 'end_header'", "end_header");
        check();
        return {*form_, std::move(elements_), at_, line_number_ + 1};
    }

private:
    bool next_line() {
        found_ = {};
        ++line_number_;
        if (at_ == data_.size()) return false;
        const std::size_t end = data_.find(line_end_, at_);
        line_ = data_.substr(at_, end == data_.npos ? end : end - at_);
        found_ = line_.empty() ? std::string_view("an empty line") : line_;
        at_ = end == data_.npos ? data_.size() : end + 1;
        while (!line_.empty() && (is_blank(line_.back()) || line_.back() == '\r')) line_.remove_suffix(1);
        return true;
    }

    std::string_view word() {
        while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
        std::size_t size = 0;
        while (size < line_.size() && !is_blank(line_[size])) ++size;
        const std::string_view result = line_.substr(0, size);
        line_.remove_prefix(size);
        return result;
    }

    void format() {
        if (form_) fail("one format line", "format");
        const std::string_view name = word();
        if (name == "ascii")
            form_ = ply_form::ascii;
        else if (name == "binary_little_endian")
            form_ = ply_form::little_endian;
        else if (name == "binary_big_endian")
            form_ = ply_form::big_endian;
        else
            fail("format ascii, binary_little_endian or binary_big_endian", name);
        if (const auto version = word(); version != "1.0") fail("version 1.0", version);
    }

    void element() {
        const std::string_view name = word();
        if (name.empty()) fail("the name of an element", name);
        if (!names_of_elements_.emplace(name).second) fail("elements of different names", name);
        names_of_fields_.clear();
        const std::string_view text = word();
        std::uint64_t count = 0;
        if (to_number(text, count) != number::ok) fail("the number of elements", text);
        elements_.push_back({std::string(name), count});
    }

    void property() {
        if (elements_.empty()) fail("an element before its properties", "property");
        ply_field field{};
        std::string_view first = word();
        if (first == "list") {
            const std::string_view count = word();
            field.count_type = type(count);
            if (!is_integer(*field.count_type)) fail("an integer type for the length of a list", count);
            first = word();
        }
        field.type = type(first);
        field.name = word();
        if (field.name.empty()) fail("the name of a property", {});
        if (!names_of_fields_.insert(field.name).second) fail("properties of different names", field.name);
        elements_.back().fields.push_back(std::move(field));
    }

    ply_type type(std::string_view name) const {
        constexpr std::array<std::array<std::string_view, 2>, 8> names{{{"char", "int8"},
                                                                        {"uchar", "uint8"},
                                                                        {"short", "int16"},
                                                                        {"ushort", "uint16"},
                                                                        {"int", "int32"},
                                                                        {"uint", "uint32"},
                                                                        {"float", "float32"},
                                                                        {"double", "float64"}}};
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (name == names[i][0] || name == names[i][1]) return static_cast<ply_type>(i);
        }
        fail("a type (char, uchar, short, ushort, int, uint, float, double)", name);
    }

    /// That the elements make a mesh.
    void check() const {
        const auto missing = [&](const std::string& what) { fail(what + " in the header of a mesh", "end_header"); };
        const ply_element* vertex = nullptr;
        for (const auto& element : elements_) {
            if (element.name == "vertex") vertex = &element;
        }
        if (!vertex) missing("an element 'vertex'");
        for (const std::string name : {"x", "y", "z"}) {
            const std::size_t i = vertex->find(name);
            if (i == vertex->fields.size() || vertex->fields[i].count_type)
                missing("a scalar property '" + name + "' of 'vertex'");
        }
        constexpr std::uint64_t most = 0xffffffff;
        if (vertex->count > most) fail_with("expected at most 4294967295 vertices, found " + std::to_string(vertex->count));
        for (const auto& element : elements_) {
            if (!element.has_corners()) continue;
            const std::size_t both = element.fields.size(), i = element.corners();
            if (element.find("vertex_indices") != both && element.find("vertex_index") != both) {
                missing("one of 'vertex_indices' and 'vertex_index', not both,");
            }
            if (i == both || !element.fields[i].count_type || !is_integer(element.fields[i].type)) {
                missing("a list of integers 'vertex_indices' of '" + element.name + "'");
            }
        }
    }

    [[noreturn]] void fail(const std::string& expected, std::string_view found) const {
        fail_with("expected " + expected + ", found " +
                  (!found.empty()        ? in_quotes(found)
                   : at_ == data_.size() ? "the end of the file"
                                         : "the end of the line"));
    }
    [[noreturn]] void fail_with(const std::string& what) const { throw io_error::at_line(file_, line_number_, what); }

    std::string_view data_;
    const std::string& file_;
    char line_end_ = '\n';
    std::size_t at_ = 0;
    std::size_t line_number_ = 0;
    bool in_comment_ = false;  // whether the last line was a comment
    std::string_view line_;    // what is left of the line
    std::string_view found_;   // all of it, for messages
    std::optional<ply_form> form_;
    std::vector<ply_element> elements_;
    std::set<std::string, std::less<>> names_of_elements_, names_of_fields_;  // the latter of the last element
};

}  // namespace abut::io::detail
