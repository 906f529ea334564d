// SPDX-License-Identifier: MIT
#pragma once

// |x|, the least and the greatest of numbers, and sizes of vectors, without a branch, on hosts, on devices and in constant
// expressions. `x < 0 ? -x : x` will not do: it keeps the sign of -0.0, so compilers may not make it a mask, and g++ jumps.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

ABUT_HD constexpr float absolute(float x) { return __builtin_fabsf(x); }
ABUT_HD constexpr double absolute(double x) { return __builtin_fabs(x); }

template <scalar F>
ABUT_HD constexpr vec3<F> absolute(const vec3<F>& v) {
    return {absolute(v.x), absolute(v.y), absolute(v.z)};
}

/// The sum of the coordinates' magnitudes: not less than any of them, nor than the length. NaN and infinity pass through,
/// which a maximum of comparisons does not promise.
template <scalar F>
ABUT_HD constexpr F magnitudes(const vec3<F>& v) {
    return absolute(v.x) + absolute(v.y) + absolute(v.z);
}

/// The least of the arguments. NaN is passed over where it stands first, and is the answer where it stands last.
template <scalar F>
ABUT_HD constexpr F least(F a) {
    return a;
}
template <scalar F, class... Rest>
ABUT_HD constexpr F least(F a, F b, Rest... rest) {
    return least(a < b ? a : b, rest...);
}

/// The greatest of the arguments; NaN as for `least`.
template <scalar F>
ABUT_HD constexpr F greatest(F a) {
    return a;
}
template <scalar F, class... Rest>
ABUT_HD constexpr F greatest(F a, F b, Rest... rest) {
    return greatest(a > b ? a : b, rest...);
}

template <scalar T>
ABUT_HD constexpr vec3<double> widened(const vec3<T>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

}  // namespace abut::detail
