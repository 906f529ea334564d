// SPDX-License-Identifier: MIT
#pragma once

// Sums and products together with their rounding errors, and sums rounded in a stated direction. They hold whatever the
// compiler contracts: products use an explicit fma, and each operand of a sum passes a barrier first, because a compiler
// that inlines `two_sum(a * b, c)` may otherwise compute a * b + c in one rounding in one place and in two in another.
// They need round-to-nearest and gradual underflow at run time (arithmetic/self_test.hpp looks).

#include <cmath>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/config.hpp>

namespace abut {

namespace detail {

/// x, rounded and in a register, which the compiler cannot look behind. A device needs none: its sums and products below are
/// intrinsics that are never contracted.
template <scalar T>
ABUT_HD constexpr T rounded(T x) {
#if !ABUT_DEVICE_CODE
    if (!__builtin_is_constant_evaluated()) {
#if defined(__SSE2__)
        __asm__("" : "+x"(x));
#elif defined(__aarch64__)
        __asm__("" : "+w"(x));
#else
        __asm__("" : "+m"(x));
#endif
    }
#endif
    return x;
}

template <scalar T>
ABUT_HD constexpr T plain_sum(T a, T b) {
#if ABUT_DEVICE_CODE
    if (!__builtin_is_constant_evaluated()) {
        if constexpr (std::same_as<T, float>) {
            return __fadd_rn(a, b);
        } else {
            return __dadd_rn(a, b);
        }
    }
#endif
    return a + b;
}

template <scalar T>
ABUT_HD constexpr T plain_product(T a, T b) {
#if ABUT_DEVICE_CODE
    if (!__builtin_is_constant_evaluated()) {
        if constexpr (std::same_as<T, float>) {
            return __fmul_rn(a, b);
        } else {
            return __dmul_rn(a, b);
        }
    }
#endif
    return rounded(a * b);
}

/// The next representable number above a finite x; above the largest one, infinity.
template <scalar T>
ABUT_HD constexpr T next_up(T x) {
    using word = typename float_format<T>::word;
    const word w = __builtin_bit_cast(word, x);
    if (x == 0) return __builtin_bit_cast(T, word{1});
    return __builtin_bit_cast(T, x > 0 ? w + 1 : w - 1);
}

template <scalar T>
ABUT_HD constexpr bool is_finite(T x) {
    return x >= -float_format<T>::largest && x <= float_format<T>::largest;
}

}  // namespace detail

/// `value + error` is the exact result; `value` is it rounded to nearest.
template <scalar T>
struct error_free {
    T value, error;
};

/// Knuth's sum: exact unless `value` overflows.
template <scalar T>
ABUT_HD constexpr error_free<T> two_sum(T a, T b) {
    using detail::plain_sum;
    a = detail::rounded(a);
    b = detail::rounded(b);
    const T s = plain_sum(a, b), from_b = plain_sum(s, -a), from_a = plain_sum(s, -from_b);
    return {s, plain_sum(plain_sum(a, -from_a), plain_sum(b, -from_b))};
}

template <scalar T>
ABUT_HD constexpr error_free<T> two_diff(T a, T b) {
    return two_sum(a, -b);
}

/// Exact unless the product overflows, or its error falls below the smallest denormal. Not for constant expressions.
template <scalar T>
ABUT_HD inline error_free<T> two_prod(T a, T b) {
    const T p = detail::plain_product(a, b);
    return {p, std::fma(a, b, -p)};
}

/// The least representable number >= a + b, for finite a and b; infinity if there is none. Exactly a + b where that is
/// representable. NaN and infinities pass as in a + b. Overflow is no constant expression.
template <scalar T>
ABUT_HD constexpr T add_up(T a, T b) {
    a = detail::rounded(a);
    b = detail::rounded(b);
    const T s = detail::plain_sum(a, b);
    if (!detail::is_finite(s)) {
        const bool overflowed = detail::is_finite(a) && detail::is_finite(b);
        return overflowed && s < 0 ? -detail::float_format<T>::largest : s;
    }
    // Dekker's tail without its last subtraction: s - larger is exact, and a comparison cannot underflow.
    const bool a_larger = (a < 0 ? -a : a) > (b < 0 ? -b : b);
    const T larger = a_larger ? a : b, smaller = a_larger ? b : a;
    return smaller > detail::plain_sum(s, -larger) ? detail::next_up(s) : s;
}

/// The greatest representable number <= a + b.
template <scalar T>
ABUT_HD constexpr T add_down(T a, T b) {
    const T up = add_up(-a, -b);
    return up == 0 ? detail::plain_sum(a, b) : -up;  // so that an exact zero keeps the sign of a + b
}

/// The least representable number >= a - b.
template <scalar T>
ABUT_HD constexpr T sub_up(T a, T b) {
    return add_up(a, -b);
}

/// The greatest representable number <= a - b.
template <scalar T>
ABUT_HD constexpr T sub_down(T a, T b) {
    return add_down(a, -b);
}

}  // namespace abut
