// SPDX-License-Identifier: MIT
#pragma once

// `vec3` and the few operations that geometry needs of it, for any number type: float and double, and the integers and
// bounded numbers in which predicates are decided.

#include <abut/config.hpp>

namespace abut {

/// A point or a vector. An aggregate of three numbers without padding, so arrays of it are arrays of coordinates.
template <class T>
struct vec3 {
    T x;  ///< first coordinate
    T y;  ///< second
    T z;  ///< third

    friend constexpr bool operator==(const vec3&, const vec3&) = default;
};

/// Sum and difference, coordinate by coordinate.
///@{
template <class T>
ABUT_HD constexpr auto operator+(const vec3<T>& a, const vec3<T>& b) {
    return vec3<decltype(a.x + b.x)>{a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class T>
ABUT_HD constexpr auto operator-(const vec3<T>& a, const vec3<T>& b) {
    return vec3<decltype(a.x - b.x)>{a.x - b.x, a.y - b.y, a.z - b.z};
}
///@}

/// s v, for a number of the vector's own type.
template <class T>
ABUT_HD constexpr vec3<T> operator*(const T& s, const vec3<T>& v) {
    return {s * v.x, s * v.y, s * v.z};
}

// The operands of these may be numbers of different widths (exact integers grow with the degree); the result is as wide as
// needed.

/// s v
template <class S, class T>
ABUT_HD constexpr auto scale(const S& s, const vec3<T>& v) {
    auto x = s * v.x;
    return vec3<decltype(x)>{x, s * v.y, s * v.z};
}

/// a . b
template <class A, class B>
ABUT_HD constexpr auto dot(const vec3<A>& a, const vec3<B>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// a x b
template <class A, class B>
ABUT_HD constexpr auto cross(const vec3<A>& a, const vec3<B>& b) {
    auto x = a.y * b.z - a.z * b.y;
    return vec3<decltype(x)>{x, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

namespace detail {

/// b, c, a.
template <class V>
ABUT_HD constexpr void rotate(V& a, V& b, V& c) {
    const V first = a;
    a = b;
    b = c;
    c = first;
}

}  // namespace detail

}  // namespace abut
