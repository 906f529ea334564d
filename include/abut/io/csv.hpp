// SPDX-License-Identifier: MIT
#pragma once

// Spheres as comma-separated values: x,y,z,r, or x,y,z where all have one radius. docs/reference/formats.md has the exact
// rules.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/text.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::io {
namespace detail {

inline constexpr std::array<const char*, 4> csv_columns{"the x coordinate of a center", "the y coordinate of a center",
                                                        "the z coordinate of a center", "the radius of a sphere"};

/// Without blanks and quotes around it, in lower case.
inline std::string plain_name(std::string_view name) {
    const auto around = [](char c) { return is_blank(c) || c == '"' || c == '\''; };
    while (!name.empty() && around(name.front())) name.remove_prefix(1);
    while (!name.empty() && around(name.back())) name.remove_suffix(1);
    std::string result(name);
    for (char& c : result) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return result;
}

/// Rows of `Columns` numbers each, as arrays that `add` gets.
template <scalar T, std::size_t Columns>
class csv_reader {
public:
    csv_reader(std::string_view text, const std::string& file) : text_(text, file) { refuse_utf16(text, file); }

    template <class Add>
    void run(const Add& add) {
        for (bool first = true; text_.to_next_row(); first = false) {
            if (first && is_header()) {
                header();
            } else {
                add(row());
            }
            text_.next_line();
        }
    }

private:
    /// Whether the first line, where the cursor is, starts with something that is no number.
    [[nodiscard]] bool is_header() const {
        text_cursor ahead = text_;
        double ignored = 0;
        const std::string_view word = ahead.token(',');
        return !word.empty() && !is_digit(word.front()) && to_number(word, ignored) == number::malformed &&
               word.find_first_of("+-.") != 0;
    }

    /// Names of columns are free, but not in another order than the one that is read.
    void header() {
        constexpr std::array<std::string_view, 5> names{"x", "y", "z", "r", "radius"};
        std::string_view line = text_.rest();
        std::size_t column = 0;
        for (bool more = true; more; ++column) {
            const std::size_t comma = line.find(',');
            const std::string name = plain_name(line.substr(0, comma));
            double ignored = 0;
            if (to_number(name, ignored) != number::malformed) {
                text_.fail_with("expected either names of columns or numbers, found " + in_quotes(name) + " among names");
            }
            for (std::size_t i = 0; i < names.size(); ++i) {
                if (name == names[i] && std::min<std::size_t>(i, 3) != column) {
                    text_.fail_with(std::string("expected the columns ") + layout() + ", found " + in_quotes(name) +
                                    " as column " + std::to_string(column + 1));
                }
            }
            more = comma != std::string_view::npos;
            if (more) line.remove_prefix(comma + 1);
        }
        if (column < Columns) fail_short(column);
        if (column > Columns) fail_long(column);
    }

    std::array<T, Columns> row() {
        std::array<T, Columns> values;
        for (std::size_t i = 0; i < Columns; ++i) {
            text_.skip_blanks();
            values[i] = text_.template finite<T>(text_.token(','), csv_columns[i]);
            text_.skip_blanks();
            if (i + 1 == Columns) break;
            if (text_.at_line_end()) fail_short(i + 1);
            if (text_.peek() != ',') text_.fail(std::string("',' after ") + csv_columns[i], text_.token());
            text_.advance();
        }
        if constexpr (Columns == 4) {
            if (values[3] < 0) text_.fail_with("expected a radius of 0 or more, found " + abut::detail::shortest(values[3]));
        }
        if (text_.peek() == ',') fail_long(Columns + 1);
        if (!text_.at_line_end()) text_.fail("the end of the line", text_.token());
        return values;
    }

    static constexpr const char* layout() { return Columns == 4 ? "x,y,z,r" : "x,y,z"; }
    [[noreturn]] void fail_short(std::size_t found) const {
        text_.fail_with(std::string("expected ") + std::to_string(Columns) + " columns " + layout() + ", found " +
                        std::to_string(found) +
                        (Columns == 4 && found == 3 ? " (spheres of one radius: read_equal_spheres(path, radius))" : ""));
    }
    [[noreturn]] void fail_long(std::size_t found) const {
        text_.fail_with(std::string("expected ") + std::to_string(Columns) + " columns " + layout() + ", found " +
                        (Columns == 3 && found == 4 ? "4 (spheres with radii of their own: read_spheres(path))" : "more"));
    }

    text_cursor text_;
};

}  // namespace detail

/// @addtogroup files
///@{

/// Reads the text of a CSV file of spheres, x,y,z,r in each line; `file` is its name in messages. Numbers are the decimal
/// text rounded once to T. Throws io_error with the line for text that is malformed, a number that is not finite, or a
/// negative radius. No rows give no spheres.
///
///     const auto spheres = abut::io::parse_spheres<float>("x,y,z,r\n0,0,0,1\n", "inline");
template <scalar T>
std::vector<sphere<T>> parse_spheres(std::string_view text, const std::string& file) {
    std::vector<sphere<T>> spheres;
    detail::csv_reader<T, 4>(text, file).run([&](const auto& v) { spheres.push_back({{v[0], v[1], v[2]}, v[3]}); });
    return spheres;
}

/// Reads the text of a CSV file of points, x,y,z in each line: the centers of spheres of one radius. Otherwise as
/// `parse_spheres`.
template <scalar T>
std::vector<vec3<T>> parse_centers(std::string_view text, const std::string& file) {
    std::vector<vec3<T>> centers;
    detail::csv_reader<T, 3>(text, file).run([&](const auto& v) { centers.push_back({v[0], v[1], v[2]}); });
    return centers;
}

///@}

}  // namespace abut::io
