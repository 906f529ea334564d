// SPDX-License-Identifier: MIT
#pragma once

// JSON (RFC 8259) that is read: a tree of values that knows where each stands in the file, so that whoever uses it can say
// what is wrong where. Not for documents that do not fit into memory: a value takes 56 bytes. json_text.hpp writes.

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <abut/io/error.hpp>
#include <abut/io/text.hpp>

namespace abut::io::detail {

enum class json_kind : unsigned char { null, boolean, number, string, array, object };

/// A value. Of numbers and strings it keeps the text, a string's without its quotes.
struct json_value {
    json_kind kind = json_kind::null;
    std::size_t at = 0;               ///< the byte where it begins
    std::string_view text{};          ///< of a number, a string or a boolean
    std::vector<json_value> items{};  ///< of an array; of an object names and values in turn
};

/// What reads values of a document, and says where they are wrong: the file's name, and the byte where its JSON begins.
class json_reader {
public:
    json_reader(std::string_view text, const std::string& file, std::size_t begin = 0)
        : text_(text), file_(file), begin_(begin) {}

    /// The document's one value.
    json_value parse() {
        json_value root = value(0);
        skip_blanks();
        if (at_ != text_.size()) fail("the end of the JSON");
        return root;
    }

    /// The member of this name, or null.
    [[nodiscard]] static const json_value* find(const json_value& object, std::string_view name) {
        if (object.kind != json_kind::object) return nullptr;
        for (std::size_t i = 0; i < object.items.size(); i += 2) {
            if (object.items[i].text == name) return &object.items[i + 1];
        }
        return nullptr;
    }
    /// Likewise, but of this kind if it is there.
    [[nodiscard]] const json_value* find(const json_value& object, std::string_view name, json_kind kind) const {
        const json_value* const found = find(object, name);
        if (found != nullptr && found->kind != kind) {
            constexpr const char* kinds[] = {"null", "a boolean", "a number", "a string", "an array", "an object"};
            refuse(*found, std::string(kinds[static_cast<std::size_t>(kind)]) + " as '" + std::string(name) + "'");
        }
        return found;
    }
    /// Likewise, but it has to be there.
    [[nodiscard]] const json_value& get(const json_value& object, std::string_view name, json_kind kind) const {
        if (object.kind != json_kind::object) refuse(object, "an object with '" + std::string(name) + "'");
        const json_value* const found = find(object, name, kind);
        if (found == nullptr)
            throw io_error::at_byte(file_, object.at, "expected '" + std::string(name) + "' in this object");
        return *found;
    }
    /// A whole number from 0 to `most`.
    [[nodiscard]] std::uint64_t whole(const json_value& value, const char* what, std::uint64_t most) const {
        double found = 0;
        const bool is_number = value.kind == json_kind::number && to_number(value.text, found) == number::ok;
        if (!is_number || !(found >= 0 && found <= static_cast<double>(most)) || found != std::floor(found)) {
            refuse(value, std::string(what) + " from 0 to " + std::to_string(most));
        }
        return static_cast<std::uint64_t>(found);
    }
    /// The member of this name as such a number; `otherwise` if there is none.
    [[nodiscard]] std::uint64_t whole(const json_value& object, std::string_view name, std::uint64_t otherwise,
                                      std::uint64_t most) const {
        const json_value* const found = find(object, name);
        return found == nullptr ? otherwise : whole(*found, in_quotes(name).c_str(), most);
    }
    /// A finite number.
    [[nodiscard]] double real(const json_value& value) const {
        double found = 0;
        if (value.kind != json_kind::number || to_number(value.text, found) != number::ok) refuse(value, "a finite number");
        return found;
    }
    /// Throws io_error at a value.
    [[noreturn]] void refuse(const json_value& value, const std::string& expected) const {
        const std::string found = value.kind == json_kind::array    ? "an array"
                                  : value.kind == json_kind::object ? "an object"
                                  : value.kind == json_kind::null   ? "null"
                                                                    : in_quotes(value.text);
        throw io_error::at_byte(file_, value.at, "expected " + expected + ", found " + found);
    }

private:
    static constexpr int deepest = 100;  // documents of meshes take a dozen; the stack has room for thousands

    [[noreturn]] void fail(const std::string& expected) const {
        throw io_error::at_byte(
            file_, begin_ + at_,
            "expected " + expected + ", found " +
                (at_ < text_.size() ? in_quotes(text_.substr(at_, 1)) : std::string("the end of the JSON")));
    }
    void skip_blanks() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || is_line_end(text_[at_]))) ++at_;
    }
    bool take(char c) {
        if (at_ == text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    json_value value(int depth) {
        skip_blanks();
        json_value made{.at = begin_ + at_};
        if (depth > deepest) fail("at most 100 arrays and objects within each other");
        if (take('{')) {
            made.kind = json_kind::object;
            list('}', [&] {
                skip_blanks();
                json_value name{.kind = json_kind::string, .at = begin_ + at_};
                if (!take('"')) fail("the name of a member in quotes");
                name.text = string();
                made.items.push_back(std::move(name));
                skip_blanks();
                if (!take(':')) fail("':'");
                made.items.push_back(value(depth + 1));
            });
        } else if (take('[')) {
            made.kind = json_kind::array;
            list(']', [&] { made.items.push_back(value(depth + 1)); });
        } else if (take('"')) {
            made.kind = json_kind::string;
            made.text = string();
        } else {
            word(made);
        }
        return made;
    }
    template <class Item>
    void list(char end, const Item& item) {
        skip_blanks();
        if (take(end)) return;
        for (;;) {
            item();
            skip_blanks();
            if (take(end)) return;
            if (!take(',')) fail(std::string("',' or '") + end + "'");
        }
    }
    /// After the quote; escapes are checked no further than that a quote after a backslash does not end the string.
    std::string_view string() {
        const std::size_t first = at_;
        for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
            if (static_cast<unsigned char>(text_[at_]) < 0x20) fail("a character of a string");
            if (text_[at_] == '\\') ++at_;
        }
        if (at_ >= text_.size()) {
            at_ = text_.size();
            fail("'\"'");
        }
        return text_.substr(first, at_++ - first);
    }
    void word(json_value& made) {
        const std::size_t first = at_;
        while (at_ < text_.size() && std::string_view(" \t\r\n,]}:[{\"").find(text_[at_]) == std::string_view::npos) ++at_;
        made.text = text_.substr(first, at_ - first);
        double ignored = 0;
        if (made.text == "true" || made.text == "false") {
            made.kind = json_kind::boolean;
        } else if (made.text != "null") {
            made.kind = json_kind::number;
            if (made.text.empty() || (made.text[0] != '-' && !is_digit(made.text[0])) ||
                to_number(made.text, ignored) == number::malformed) {
                at_ = first;
                fail("a value");
            }
        }
    }

    std::string_view text_;
    const std::string& file_;
    std::size_t begin_;
    std::size_t at_ = 0;
};

/// The text that a string stands for, in UTF-8; what is no escape stays as it is.
inline std::string json_unescaped(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            result += text[i];
            continue;
        }
        constexpr std::string_view marks = "bfnrt", stands = "\b\f\n\r\t";
        const char c = text[++i];
        std::uint32_t code = 0;
        if (c == 'u' && i + 4 < text.size() &&
            std::from_chars(text.data() + i + 1, text.data() + i + 5, code, 16).ptr == text.data() + i + 5) {
            i += 4;
            if (code < 0x80) {
                result += static_cast<char>(code);
            } else if (code < 0x800) {
                result += static_cast<char>(0xc0 | code >> 6);
                result += static_cast<char>(0x80 | (code & 63));
            } else {
                result += static_cast<char>(0xe0 | code >> 12);
                result += static_cast<char>(0x80 | (code >> 6 & 63));
                result += static_cast<char>(0x80 | (code & 63));
            }
        } else if (const std::size_t at = marks.find(c); at != marks.npos) {
            result += stands[at];
        } else {
            result += c;
        }
    }
    return result;
}

}  // namespace abut::io::detail
