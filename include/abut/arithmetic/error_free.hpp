// SPDX-License-Identifier: MIT
#pragma once

// Sums and products together with their rounding errors, and sums rounded in a stated direction. They hold whatever the
// compiler contracts: products use an explicit fma, or Dekker's halves, and each operand of a sum passes a barrier first,
// because a compiler that inlines `two_sum(a * b, c)` may otherwise compute a * b + c in one rounding in one place and in
// two in another. Errors of sums and products need round-to-nearest and gradual underflow at run time
// (arithmetic/self_test.hpp looks). Directed sums need neither.

#include <cmath>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>

namespace abut {

namespace detail {

/// x, rounded and in a register, which the compiler cannot look behind. A device needs none: its sums and products below are
/// intrinsics that are never contracted.
template <scalar T>
ABUT_HD constexpr T rounded(T x) {
#if !ABUT_DEVICE_CODE
    if (!ABUT_CONSTANT_EVALUATED()) {
        ABUT_HIDE(x);
    }
#endif
    return x;
}

template <scalar T>
ABUT_HD constexpr T plain_sum(T a, T b) {
#if ABUT_DEVICE_CODE
    if (!ABUT_CONSTANT_EVALUATED()) {
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
    if (!ABUT_CONSTANT_EVALUATED()) {
        if constexpr (std::same_as<T, float>) {
            return __fmul_rn(a, b);
        } else {
            return __dmul_rn(a, b);
        }
    }
#endif
    return rounded(a * b);
}

/// 2^k, if that is a normal number.
template <scalar T>
ABUT_HD constexpr T power_of_two(int k) {
    using format = float_format<T>;
    return ABUT_BIT_CAST(T, static_cast<typename format::word>(k - format::min_exponent - format::digits + 2)
                                << (format::digits - 1));
}

/// Whether x is 0 or -0. By its bits: where denormals are read as zero, they equal 0 too.
template <scalar T>
ABUT_HD constexpr bool is_zero(T x) {
    using word = typename float_format<T>::word;
    return static_cast<word>(ABUT_BIT_CAST(word, x) << 1) == 0;
}

/// Whether the sign bit is set.
template <scalar T>
ABUT_HD constexpr bool has_sign(T x) {
    using word = typename float_format<T>::word;
    return ABUT_BIT_CAST(word, x) >> (8 * sizeof(T) - 1) != 0;
}

/// The next representable number above a finite x; above the largest one, infinity. By bits, in every mode.
template <scalar T>
ABUT_HD constexpr T next_up(T x) {
    using word = typename float_format<T>::word;
    const word w = ABUT_BIT_CAST(word, x);
    if (is_zero(x)) return ABUT_BIT_CAST(T, word{1});
    return ABUT_BIT_CAST(T, static_cast<word>(has_sign(x) ? w - 1 : w + 1));
}

}  // namespace detail

/// `value + error` is the exact result; `value` is it rounded to nearest.
template <scalar T>
struct error_free {
    T value;  ///< the rounded result
    T error;  ///< what rounding took off
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

/// The same for a - b.
template <scalar T>
ABUT_HD constexpr error_free<T> two_diff(T a, T b) {
    return two_sum(a, -b);
}

namespace detail {

/// a b - p by Dekker's halves, where p is a b rounded, or near it. Exact where nothing leaves the range of normal numbers.
ABUT_HD constexpr double dekker_error(double a, double b, double p) {
    constexpr double splitter = 0x1p27 + 1;
    const double x = plain_product(splitter, a), y = plain_product(splitter, b);
    const double a1 = plain_sum(x, -plain_sum(x, -a)), b1 = plain_sum(y, -plain_sum(y, -b));
    const double a2 = plain_sum(a, -a1), b2 = plain_sum(b, -b1);
    const double high = plain_sum(plain_product(a1, b1), -p), mixed = plain_sum(high, plain_product(a1, b2));
    return plain_sum(plain_sum(mixed, plain_product(a2, b1)), plain_product(a2, b2));
}

/// What std::fma(a, b, -p) is, to the bit, where p is a b rounded to nearest: without that function.
///@{
ABUT_HD constexpr float product_error_without_fma(float a, float b, float p) {
    return static_cast<float>(static_cast<double>(a) * static_cast<double>(b) - static_cast<double>(p));
}

ABUT_HD constexpr double product_error_without_fma(double a, double b, double p) {
    const double size = absolute(p);
    // Then the last digits of halves' products are no denormal numbers, and none of them overflows.
    if (size > 0x1p-960 && size < 0x1p990 && absolute(a) < 0x1p990 && absolute(b) < 0x1p990) return dekker_error(a, b, p);
    if (!is_finite(a) || !is_finite(b)) return a * b - p;
    if (is_zero(a) || is_zero(b)) return 0;
    if (!is_finite(p)) return -p;
    // The same of numbers in [1, 2), x 2^i = a and y 2^j = b.
    const auto in_unit = [](double x, int& exponent) {
        const binary_parts parts = take_apart(x);
        const auto magnitude = static_cast<double>(parts.mantissa < 0 ? -parts.mantissa : parts.mantissa);
        const int digits = static_cast<int>(ABUT_BIT_CAST(std::uint64_t, magnitude) >> 52) - 1023;
        exponent = parts.exponent + digits;
        return static_cast<double>(parts.mantissa) * power_of_two<double>(-digits);
    };
    int i = 0, j = 0;
    const double x = in_unit(a, i), y = in_unit(b, j), product = plain_product(x, y), error = dekker_error(x, y, product);
    // An error of a denormal product is at most half of the least number, and rounds to 0 of its sign.
    if (size <= smallest_normal<double>) {
        const int k = i + j + 1074;  // a b is product and error, times 2^k, in units of the least number
        const auto steps = static_cast<double>(ABUT_BIT_CAST(std::uint64_t, size));
        // Below a quarter of a unit it rounds to 0.
        const double units =
            k < -4 ? product : plain_sum(plain_product(product, power_of_two<double>(k)), p < 0 ? steps : -steps);
        const double rest = k < -4 ? error : plain_product(error, power_of_two<double>(k));
        return plain_sum(units, rest) < 0 ? -0.0 : 0.0;
    }
    // 2^(i + j) itself may be no normal number. Only the last product rounds.
    const int half = (i + j) / 2;
    return plain_product(plain_product(error, power_of_two<double>(half)), power_of_two<double>(i + j - half));
}
///@}

/// The error of the rounded product p = a b.
template <scalar T>
ABUT_HD constexpr T error_of_product(T a, T b, T p) {
#if ABUT_FMA_IS_RIGHT
    if (!ABUT_CONSTANT_EVALUATED()) return std::fma(a, b, -p);
#endif
    return product_error_without_fma(a, b, p);
}

}  // namespace detail

/// Exact unless the product overflows, or its error falls below the smallest denormal. The same with an fma and without.
template <scalar T>
ABUT_HD constexpr error_free<T> two_prod(T a, T b) {
    const T p = detail::plain_product(a, b);
    return {p, detail::error_of_product(a, b, p)};
}

namespace detail {

/// The least representable number >= a + b, given s = a + b as it is rounded. None of the three is denormal.
template <scalar T>
ABUT_HD constexpr T add_up_normal(T a, T b, T s) {
    if (!is_finite(s)) return is_finite(a) && is_finite(b) && s < 0 ? -largest_finite<T> : s;
    // Dekker's tail without its last subtraction: s - larger is exact in each rounding mode. Where it is flushed to zero, it
    // was nearer to zero than `smaller`, and compares as it did.
    const bool a_larger = absolute(a) > absolute(b);
    const T larger = a_larger ? a : b, smaller = a_larger ? b : a;
    return smaller > plain_sum(s, -larger) ? next_up(s) : s;
}

/// What numbers near 0 are multiplied by, so that no sum or difference of theirs is denormal.
template <scalar T>
inline constexpr T up_scale = power_of_two<T>(2 * float_format<T>::digits);
template <scalar T>
inline constexpr T scaled_denormal = power_of_two<T>(2 * float_format<T>::digits + float_format<T>::min_exponent);

/// x * up_scale, exactly, for an x that is not large. Not by arithmetic on a denormal number, which may be read as 0: such
/// a number is as many steps as its bits say.
template <scalar T>
ABUT_HD constexpr T scaled_up(T x) {
    using word = typename float_format<T>::word;
    if (!is_subnormal(x)) return plain_product(x, up_scale<T>);
    const word steps = ABUT_BIT_CAST(word, x) & (static_cast<word>(-1) >> 1);
    const T magnitude = plain_product(static_cast<T>(steps), scaled_denormal<T>);
    return has_sign(x) ? -magnitude : magnitude;
}

/// x / up_scale, which is representable.
template <scalar T>
ABUT_HD constexpr T scaled_down(T x) {
    using word = typename float_format<T>::word;
    if (absolute(x) >= up_scale<T> * smallest_normal<T>) return plain_product(x, 1 / up_scale<T>);
    const auto steps = static_cast<word>(plain_product(absolute(x), 1 / scaled_denormal<T>));
    const word sign = ABUT_BIT_CAST(word, x) & ~(static_cast<word>(-1) >> 1);
    return ABUT_BIT_CAST(T, static_cast<word>(sign | steps));
}

/// add_up where a, b or the sum may be denormal.
template <scalar T>
ABUT_HD constexpr T add_up_denormal(T a, T b) {
    using word = typename float_format<T>::word;
    // By bits: given a sum here, clang takes it for `b` below as well, which a processor may flush.
    if (is_zero(a) && is_zero(b)) {
        return ABUT_BIT_CAST(T, static_cast<word>(ABUT_BIT_CAST(word, a) & ABUT_BIT_CAST(word, b)));
    }
    if (is_zero(a)) return b;
    if (is_zero(b)) return a;
    if (absolute(a) < 1 && absolute(b) < 1) {
        const T x = scaled_up(a), y = scaled_up(b);
        return scaled_down(add_up_normal(x, y, plain_sum(x, y)));
    }
    // A denormal number is far below half a step of the other one: any other such number gives the same.
    const auto normal = [](T x) { return !is_subnormal(x) ? x : has_sign(x) ? -smallest_normal<T> : smallest_normal<T>; };
    // Known to be one of two numbers, g++ 13 takes the sum for finite, which it is in round-to-nearest alone.
    a = rounded(normal(a));
    b = rounded(normal(b));
    return add_up_normal(a, b, plain_sum(a, b));
}

}  // namespace detail

/// The least representable number >= a + b, for finite a and b; infinity if there is none. Exactly a + b where that is
/// representable. NaN and infinities pass as in a + b. The same in each rounding mode, with denormals flushed to zero or
/// read as zero. Overflow is no constant expression.
template <scalar T>
ABUT_HD constexpr T add_up(T a, T b) {
    using detail::absolute;
    a = detail::rounded(a);
    b = detail::rounded(b);
    const T s = detail::plain_sum(a, b);
    constexpr T normal = smallest_normal<T>;
    if (absolute(a) < normal || absolute(b) < normal || absolute(s) < normal) return detail::add_up_denormal(a, b);
    return detail::add_up_normal(a, b, s);
}

/// The greatest representable number <= a + b.
template <scalar T>
ABUT_HD constexpr T add_down(T a, T b) {
    const T up = add_up(-a, -b);
    return detail::is_zero(up) ? detail::plain_sum(a, b) : -up;  // so that an exact zero keeps the sign of a + b
}

namespace detail {

/// A sum of many numbers, as if it had twice as many digits.
struct long_sum {
    double high = 0, low = 0;
    ABUT_HD void add(double x) {
        const error_free<double> s = two_sum(high, x);
        high = s.value;
        low = plain_sum(low, s.error);
    }
    [[nodiscard]] ABUT_HD double total() const { return plain_sum(high, low); }
};

// Vectors in doubles, each operation rounded.

ABUT_INLINE ABUT_HD constexpr double plain_dot(const vec3<double>& a, const vec3<double>& b) {
    return plain_sum(plain_sum(plain_product(a.x, b.x), plain_product(a.y, b.y)), plain_product(a.z, b.z));
}
ABUT_INLINE ABUT_HD constexpr vec3<double> plain_cross(const vec3<double>& a, const vec3<double>& b) {
    const auto minor = [](double s, double t, double x, double y) {
        return plain_sum(plain_product(s, t), -plain_product(x, y));
    };
    return {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
}
/// p + t v
ABUT_INLINE ABUT_HD constexpr vec3<double> plain_step(const vec3<double>& p, double t, const vec3<double>& v) {
    return {plain_sum(p.x, plain_product(t, v.x)), plain_sum(p.y, plain_product(t, v.y)),
            plain_sum(p.z, plain_product(t, v.z))};
}

}  // namespace detail

}  // namespace abut
