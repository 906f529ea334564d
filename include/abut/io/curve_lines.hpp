// SPDX-License-Identifier: MIT
#pragma once

// Curves as segments one after another, as files and scenes have them.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/io/property.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::io {

/// A curve: `abut::curve`, or any type with its members.
/// @ingroup files
template <class C>
concept curve_like = requires(const C& c, std::size_t i) {
    { c.points.size() } -> std::convertible_to<std::size_t>;
    requires scalar<std::remove_cvref_t<decltype(c.points[i].x)>>;
    { c.segments() } -> std::convertible_to<std::size_t>;
    requires id_pair<std::remove_cvref_t<decltype(c.pairs_of(i)[0])>>;
};

namespace detail {

template <scalar T>
struct curve_lines {
    std::vector<segment<T>> segments;
    std::vector<std::uint32_t> curve, face_a, face_b;  ///< of each segment: its curve, and the first pair of faces it lies in
};

/// The segments of all curves, in order.
template <std::ranges::input_range Curves>
auto lines_of(const Curves& curves) {
    using T = std::remove_cvref_t<decltype((*std::ranges::begin(curves)).points[0].x)>;
    curve_lines<T> lines;
    std::uint32_t number = 0;
    for (const auto& c : curves) {
        for (std::size_t i = 0; i < c.segments(); ++i) {
            lines.segments.push_back({c.points[i], c.points[i + 1 == c.points.size() ? 0 : i + 1]});
            lines.curve.push_back(number);
            const auto faces = c.pairs_of(i)[0];
            lines.face_a.push_back(static_cast<std::uint32_t>(faces.a));
            lines.face_b.push_back(static_cast<std::uint32_t>(faces.b));
        }
        ++number;
    }
    return lines;
}

}  // namespace detail

}  // namespace abut::io
