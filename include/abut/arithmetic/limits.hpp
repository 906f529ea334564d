// SPDX-License-Identifier: MIT
#pragma once

// Constants of the scalar types, as variables: the functions of std::numeric_limits are host functions, and code that also
// runs on a device may not call them.

#include <limits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/config.hpp>

namespace abut {

/// The largest finite number.
template <scalar T>
inline constexpr T largest_finite = std::numeric_limits<T>::max();
/// The smallest positive normal number; what is nearer to 0 is denormal.
template <scalar T>
inline constexpr T smallest_normal = std::numeric_limits<T>::min();
/// Positive infinity.
template <scalar T>
inline constexpr T infinity = std::numeric_limits<T>::infinity();
/// Half a unit in the last place of 1: the largest relative error of one rounded operation.
template <scalar T>
inline constexpr T unit_roundoff = std::numeric_limits<T>::epsilon() / 2;

namespace detail {

/// Neither infinite nor NaN.
template <scalar T>
ABUT_HD constexpr bool is_finite(T x) {
    return x >= -largest_finite<T> && x <= largest_finite<T>;
}

}  // namespace detail

}  // namespace abut
