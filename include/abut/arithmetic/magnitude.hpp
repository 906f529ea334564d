// SPDX-License-Identifier: MIT
#pragma once

// |x|, the least and the greatest of numbers, and sizes of vectors, without a branch, on hosts, on devices and in constant
// expressions. `x < 0 ? -x : x` will not do for |x|: it keeps the sign of -0.0, so compilers may not make it a mask, and g++
// jumps. These are the library's only minimum and maximum of numbers: std::fmin is a call, and std::min says the opposite of
// NaN.

#include <concepts>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

ABUT_HD constexpr float absolute(float x) { return ABUT_FABSF(x); }
ABUT_HD constexpr double absolute(double x) { return ABUT_FABS(x); }

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

/// The least of the arguments: the second of two that do not compare. So NaN is passed over where it stands first, and is
/// the answer where it stands last. Of two it is one instruction of processors, MINSS and its like.
template <class F>
ABUT_HD constexpr F least(F a) {
    return a;
}
template <class F, class... Rest>
ABUT_HD constexpr F least(F a, F b, Rest... rest) {
    return least(a < b ? a : b, rest...);
}

/// The greatest of the arguments; NaN as for `least`.
template <class F>
ABUT_HD constexpr F greatest(F a) {
    return a;
}
template <class F, class... Rest>
ABUT_HD constexpr F greatest(F a, F b, Rest... rest) {
    return greatest(a > b ? a : b, rest...);
}

/// The lesser and the greater of two numbers where it does not matter what is made of NaN, or of zeros of two signs: one
/// instruction of devices too, which need two for `least`.
template <scalar F>
ABUT_HD F lesser(F a, F b) {
#if ABUT_DEVICE_CODE
    if constexpr (std::same_as<F, float>) return ::fminf(a, b);
#endif
    return a < b ? a : b;
}
template <scalar F>
ABUT_HD F greater(F a, F b) {
#if ABUT_DEVICE_CODE
    if constexpr (std::same_as<F, float>) return ::fmaxf(a, b);
#endif
    return a > b ? a : b;
}

/// Coordinate by coordinate.
template <class T>
ABUT_HD constexpr vec3<T> least(const vec3<T>& a, const vec3<T>& b) {
    return {least(a.x, b.x), least(a.y, b.y), least(a.z, b.z)};
}
template <class T>
ABUT_HD constexpr vec3<T> greatest(const vec3<T>& a, const vec3<T>& b) {
    return {greatest(a.x, b.x), greatest(a.y, b.y), greatest(a.z, b.z)};
}
template <class T>
ABUT_HD vec3<T> lesser(const vec3<T>& a, const vec3<T>& b) {
    return {lesser(a.x, b.x), lesser(a.y, b.y), lesser(a.z, b.z)};
}
template <class T>
ABUT_HD vec3<T> greater(const vec3<T>& a, const vec3<T>& b) {
    return {greater(a.x, b.x), greater(a.y, b.y), greater(a.z, b.z)};
}

template <scalar T>
ABUT_HD constexpr vec3<double> widened(const vec3<T>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

}  // namespace abut::detail
