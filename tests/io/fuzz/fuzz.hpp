// SPDX-License-Identifier: MIT
#pragma once

// What holds for every result of a parser, and for every refusal.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <abut/arithmetic/vec.hpp>
#include <abut/io/error.hpp>

namespace fuzz {

inline void require(bool holds) {
    if (!holds) std::abort();
}

template <class T>
bool is_finite(const abut::vec3<T>& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Parse>
void check_rows(const Parse& parse) {
    try {
        parse();
    } catch (const abut::io_error& refusal) {
        const std::string_view message = refusal.what();
        require(message.starts_with("fuzz:") && message.find("expected") != message.npos && refusal.file() == "fuzz");
        for (const char c : message) require(c >= 0x20 && c < 0x7f);
    }
}

template <class T, class Parse>
void check_mesh(const Parse& parse) {
    check_rows([&] {
        const auto mesh = parse();
        for (const auto& vertex : mesh.vertices) require(is_finite(vertex));
        for (const auto& face : mesh.faces) {
            for (const std::uint32_t index : face) require(index < mesh.vertices.size());
        }
    });
}

}  // namespace fuzz
