// SPDX-License-Identifier: MIT
#pragma once

// Where a predicate ends, for numbers that are taken as they come: integers that cannot overflow, and floating point without
// a promise. wide_int.hpp and sparse_sum.hpp answer the same questions for longer numbers.

#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut {

/// -1, 0 or 1.
template <class N>
    requires std::is_arithmetic_v<N>
ABUT_HD constexpr int sign(N a) { return (a > 0) - (a < 0); }
namespace detail {
using abut::sign;  // which that of a number of its own would hide there
}

/// The sign of a . b
template <class N>
    requires std::is_arithmetic_v<N>
ABUT_HD constexpr int sign_of_dot(const vec3<N>& a, const vec3<N>& b) {
    return sign(dot(a, b));
}

// Words whose products need two: differences of coordinates and what is computed of them.

/// The product of two words, exactly.
ABUT_HD constexpr int128 product(std::int64_t a, std::int64_t b) { return static_cast<int128>(a) * b; }

/// The sign of a . b
ABUT_HD constexpr int sign_of_dot(const vec3<std::int64_t>& a, const vec3<std::int64_t>& b) {
    const int128 sum = product(a.x, b.x) + product(a.y, b.y) + product(a.z, b.z);
    return (sum > 0) - (sum < 0);
}

/// a^2 or |a|^2 of words. Components below 2^62 in magnitude leave room for the sum.
///@{
ABUT_HD constexpr int128 square(std::int64_t a) { return product(a, a); }
ABUT_HD constexpr int128 square(const vec3<std::int64_t>& a) { return square(a.x) + square(a.y) + square(a.z); }
///@}

/// a^2 or |a|^2 in floating point, rounded.
///@{
template <class N>
    requires std::is_floating_point_v<N>
ABUT_HD constexpr N square(N a) {
    return a * a;
}
template <class N>
    requires std::is_floating_point_v<N>
ABUT_HD constexpr N square(const vec3<N>& a) {
    return dot(a, a);
}
///@}

/// |a|^2 <= |b|^2, where a and b are numbers or vectors.
template <class A, class B>
ABUT_HD constexpr auto squares_at_most(const A& a, const B& b) -> decltype(square(a) <= square(b)) {
    return square(a) <= square(b);
}

}  // namespace abut
