// SPDX-License-Identifier: MIT
#pragma once

// Text, as the readers of this folder see it: a cursor that knows its line, and numbers that are read strictly. Nothing
// here depends on the locale. std::from_chars rounds the decimal text once, to nearest, to the type that is asked for.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/io/error.hpp>

namespace abut::io::detail {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
constexpr bool is_line_end(char c) { return c == '\n' || c == '\r'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// For messages: at most 24 characters in quotes, with bytes that are not printable shown as \xNN.
inline std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 24;
    constexpr std::string_view hex = "0123456789abcdef";
    std::string result = "'";
    for (const char c : text.substr(0, longest)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f) {
            result += c;
        } else {
            result += "\\x";
            result += hex[byte >> 4];
            result += hex[byte & 15];
        }
    }
    return result + (text.size() > longest ? "...'" : "'");
}

/// Throws io_error if a text is UTF-16, as some editors save it: its bytes would be taken for a text that is malformed.
inline void refuse_utf16(std::string_view text, const std::string& file) {
    const bool is_marked = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
    const bool is_plain = text.size() > 3 && ((text[0] == 0 && text[1] > 0 && text[2] == 0 && text[3] > 0) ||
                                              (text[0] > 0 && text[1] == 0 && text[2] > 0 && text[3] == 0));
    if (is_marked || is_plain) throw io_error(file, "expected text in ASCII or UTF-8, found UTF-16");
}

/// How a number's text was taken.
enum class number { ok, malformed, not_finite, out_of_range };

/// Whether the decimal number in `text` (valid, not zero) is below 1 in magnitude: tells underflow from overflow.
inline bool is_small(std::string_view text) {
    constexpr std::int64_t bound = 1'000'000'000'000;  // no text is so long that its digits outweigh such an exponent
    std::int64_t exponent = 0;
    const std::size_t mark = text.find_first_of("eE");
    if (mark != std::string_view::npos) {
        std::size_t i = mark + 1;
        const bool negative = i < text.size() && text[i] == '-';
        if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
        for (; i < text.size() && exponent < bound; ++i) exponent = 10 * exponent + (text[i] - '0');
        if (negative) exponent = -exponent;
    }
    const std::string_view digits = text.substr(0, mark);
    const std::size_t first = digits.find_first_of("123456789");
    if (first == std::string_view::npos) return true;
    const std::size_t point = std::min(digits.find('.'), digits.size());
    return (first < point ? static_cast<std::int64_t>(point - first) : -static_cast<std::int64_t>(first - point)) +
               exponent <=
           0;
}

/// Reads the whole of `token` as a decimal number, rounded to nearest once: digits with an optional sign, point and
/// exponent. A magnitude that is nearest to zero becomes a signed zero; one that rounds to infinity is `not_finite`, and
/// so are the words nan, inf and infinity. The value is left alone unless the result is `ok`.
template <scalar T>
number to_number(std::string_view token, T& value) {
    const char* first = token.data();
    const char* const last = first + token.size();
    if (first != last && *first == '+') {
        ++first;
        if (first != last && *first == '-') return number::malformed;
    }
    T read{};
    const auto [end, failure] = std::from_chars(first, last, read);
    if (end != last || first == last || failure == std::errc::invalid_argument) return number::malformed;
    if (failure == std::errc::result_out_of_range) {
        // The standard library reports both ends of the range alike, and not every version tells what it rounded to.
        if (!is_small({first, last})) return number::not_finite;
        read = *first == '-' ? -T{0} : T{0};
    }
    if (!std::isfinite(read)) return number::not_finite;
    value = read;
    return number::ok;
}

/// Reads the whole of `token` as a decimal integer; `out_of_range` if the type cannot hold it.
template <std::integral I>
number to_number(std::string_view token, I& value) {
    const char* first = token.data();
    const char* const last = first + token.size();
    if (first != last && *first == '+') {
        ++first;
        if (first != last && *first == '-') return number::malformed;
    }
    I read{};
    const auto [end, failure] = std::from_chars(first, last, read);
    if (end != last || first == last || failure == std::errc::invalid_argument) return number::malformed;
    if (failure == std::errc::result_out_of_range) return number::out_of_range;
    value = read;
    return number::ok;
}

/// Walks through a text, token by token within a line and line by line. Lines end with LF, CR LF or CR.
class text_cursor {
public:
    text_cursor(std::string_view text, const std::string& file, std::size_t line = 1)
        : at_(text.data()), end_(at_ + text.size()), line_(line), file_(file) {
        if (line == 1 && text.starts_with("\xef\xbb\xbf")) at_ += 3;  // the byte order mark that some editors put first
    }

    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] bool at_end() const { return at_ == end_; }
    [[nodiscard]] bool at_line_end() const { return at_ == end_ || is_line_end(*at_); }
    [[nodiscard]] char peek() const { return at_line_end() ? '\n' : *at_; }
    [[nodiscard]] std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
    void advance() { ++at_; }

    void skip_blanks() {
        while (at_ != end_ && is_blank(*at_)) ++at_;
    }
    /// The characters up to the next blank or line end, or up to `stop`; empty if there are none.
    std::string_view token(char stop = ' ') {
        const char* const first = at_;
        while (at_ != end_ && !is_blank(*at_) && !is_line_end(*at_) && *at_ != stop) ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }
    /// The characters up to the next `stop` or line end, blanks included.
    std::string_view up_to(char stop) {
        const char* const first = at_;
        while (at_ != end_ && !is_line_end(*at_) && *at_ != stop) ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }
    /// The rest of the line, without its end.
    std::string_view rest() {
        const char* const first = at_;
        while (at_ != end_ && !is_line_end(*at_)) ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }
    /// Goes to the start of the next line (from the end of this one only).
    void next_line() {
        if (at_ == end_) return;
        if (*at_++ == '\r' && at_ != end_ && *at_ == '\n') ++at_;
        ++line_;
    }

    /// To the next line that is neither empty nor a comment, which '#' begins. Whether there is one.
    bool to_next_row() {
        for (;; next_line()) {
            skip_blanks();
            if (peek() == '#') rest();
            if (!at_line_end()) return true;
            if (at_end()) return false;
        }
    }

    /// Throws io_error of this line: `expected ..., found ...`. What was found is the token given or, if that is empty, what
    /// the cursor stands at.
    [[noreturn]] void fail(const std::string& expected, std::string_view found) const {
        const std::string what = !found.empty()  ? in_quotes(found)
                                 : at_end()      ? "the end of the file"
                                 : at_line_end() ? "the end of the line"
                                                 : in_quotes({at_, 1});
        fail_with("expected " + expected + ", found " + what);
    }
    [[noreturn]] void fail_with(const std::string& what) const { throw io_error::at_line(file_, line_, what); }

    /// Reads a coordinate or the like, `expected` in messages.
    template <scalar T>
    T finite(std::string_view token, const char* expected) const {
        T value{};
        const number how = to_number(token, value);
        if (how == number::ok) return value;
        fail(how == number::not_finite ? std::string("a finite number (") + expected + ")" : expected, token);
    }

private:
    const char* at_;
    const char* end_;
    std::size_t line_;
    const std::string& file_;
};

}  // namespace abut::io::detail
