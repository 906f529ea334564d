// SPDX-License-Identifier: MIT
#pragma once

// Bytes as base64 (RFC 4648, section 4), there and back.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <abut/arithmetic/vec.hpp>
#include <abut/io/file.hpp>
#include <abut/io/property.hpp>

namespace abut::io::detail {

inline constexpr std::string_view base64_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Written without line breaks.
class base64_writer {
public:
    explicit base64_writer(output_file& to) : to_(to) {}

    template <class V>
    void put(V value) {
        std::array<char, sizeof(V)> bytes;
        put_little_endian(bytes.data(), value);
        for (const char c : bytes) {
            group_ = group_ << 8 | static_cast<unsigned char>(c);
            if (++used_ == 3) flush();
        }
    }
    template <scalar T>
    void put(const vec3<T>& v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }
    void write(const void* data, std::size_t size) {
        const char* const from = static_cast<const char*>(data);
        for (std::size_t i = 0; i < size; ++i) put(from[i]);
    }
    /// Has to be called after the last byte.
    void finish() {
        if (used_ == 0) return;
        const int bytes = used_;
        group_ <<= 8 * (3 - bytes);
        flush(bytes);
    }

private:
    void flush(int bytes = 3) {
        for (int i = 0; i < 4; ++i) to_.write(i > bytes ? '=' : base64_digits[group_ >> (18 - 6 * i) & 63]);
        group_ = 0;
        used_ = 0;
    }

    output_file& to_;
    std::uint32_t group_ = 0;
    int used_ = 0;
};

/// The bytes that a text stands for; nothing if it is malformed. Padding may be left out.
inline std::optional<std::vector<char>> base64_decoded(std::string_view text) {
    for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
    if (text.size() % 4 == 1) return {};
    std::vector<char> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t group = 0;
    int bits = 0;
    for (const char c : text) {
        const std::size_t digit = base64_digits.find(c);
        if (digit == base64_digits.npos) return {};
        group = group << 6 | static_cast<std::uint32_t>(digit);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<char>(group >> bits & 0xff));
    }
    return bytes;
}

}  // namespace abut::io::detail
