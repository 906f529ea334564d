// SPDX-License-Identifier: MIT
#pragma once

// JSON that is written: values as text, put together from the inside out. json.hpp reads.

#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <abut/config.hpp>

namespace abut::io::detail {

/// The shortest decimal that reads back as this number, which is finite; integers as they are.
template <class N>
    requires std::integral<N> || std::floating_point<N>
std::string json_number(N value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// A text in quotes. Bytes from 0x80 on are taken for UTF-8 as they are.
inline std::string json_string(std::string_view text) {
    constexpr std::string_view hex = "0123456789abcdef";
    std::string result = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            (result += '\\') += c;
        } else if (byte < 0x20) {
            ((result += "\\u00") += hex[byte >> 4]) += hex[byte & 15];
        } else {
            result += c;
        }
    }
    return result + '"';
}

/// Of members whose values are JSON already; those without a value are left out.
inline std::string json_object(std::initializer_list<std::pair<std::string_view, std::string>> members) {
    std::string result = "{";
    for (const auto& [name, value] : members) {
        if (value.empty()) continue;
        if (result.size() > 1) result += ',';
        ((result += json_string(name)) += ':') += value;
    }
    return result + '}';
}

/// Of values that are JSON already.
template <class Values>
std::string json_array(const Values& values) {
    std::string result = "[";
    for (const std::string& value : values) {
        if (result.size() > 1) result += ',';
        result += value;
    }
    return result + ']';
}
template <class... Values>
std::string json_list(const Values&... values) {
    return json_array(std::array<std::string, sizeof...(Values)>{values...});
}

}  // namespace abut::io::detail
