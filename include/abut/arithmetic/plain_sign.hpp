// SPDX-License-Identifier: MIT
#pragma once

// Where a predicate ends, for numbers that are taken as they come: integers that cannot overflow, and floating point without
// a promise. wide_int.hpp and sparse_sum.hpp answer the same questions exactly.

#include <type_traits>

#include <abut/arithmetic/vec.hpp>

namespace abut {

/// -1, 0 or 1.
template <class N>
    requires std::is_arithmetic_v<N>
ABUT_HD constexpr int sign(N a) {
    return (a > 0) - (a < 0);
}

/// The sign of a . b
template <class N>
    requires std::is_arithmetic_v<N>
ABUT_HD constexpr int sign_of_dot(const vec3<N>& a, const vec3<N>& b) {
    return sign(dot(a, b));
}

}  // namespace abut
