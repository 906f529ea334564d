// SPDX-License-Identifier: MIT
#pragma once

// Bytes as base64 (RFC 4648, section 4), there and back.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <abut/arithmetic/vec.hpp>
#include <abut/io/file.hpp>
#include <abut/io/property.hpp>

namespace abut::io::detail {

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
        constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (int i = 0; i < 4; ++i) to_.write(i > bytes ? '=' : digits[group_ >> (18 - 6 * i) & 63]);
        group_ = 0;
        used_ = 0;
    }

    output_file& to_;
    std::uint32_t group_ = 0;
    int used_ = 0;
};

}  // namespace abut::io::detail
