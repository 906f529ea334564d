// SPDX-License-Identifier: MIT
#pragma once

// Numbers that are known but for an error, and the running error analysis that bounds it (J. H. Wilkinson, Error analysis
// revisited, 1986): each operation adds to the errors of its operands what its own rounding may add. So a polynomial that is
// written once for integers is a filter as well, without a bound derived by hand. It costs several times what plain numbers
// do.
//
// The bound. Let u = 2^-52, at least the relative error of an operation in any rounding mode, and as well of a product and a
// sum that are contracted into one. A sum v of two numbers is off by their errors and u|v|, a product by |a| e_b + |b| e_a +
// e_a e_b and u|v|. The errors are rounded themselves, at each of fewer than 2^10 operations by a factor of no less than
// 1 - 3u: a sign is told if the value exceeds its error by 2^-30 of it.
//
// Nothing overflows or underflows. Values are scaled, exactly, to the largest that a polynomial of the predicate's degree n
// leaves room for: below 2^(900 / n + 1). Values that are not 0 and far below that are left undecided: for if s is the
// least, a difference of two that are not equal is at least s 2^-53, with an error of at least s 2^-105; so by induction an
// error that is not 0 of a number of degree k is at least (s 2^-105)^k, as it is not less than that of each term, or than
// the product of both errors, or of an error and a value; and that is above 2^-960. What a flush to zero takes from a value,
// less than 2^-1022, is nothing beside it. And where the error is 0, the value is a number as it was given, or an exact 0: a
// difference of equal numbers, or a product or sum of such zeros. Those are frequent where shapes lie along the axes.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

/// A number within `error` of `value`.
struct estimate {
    double value, error;

    static constexpr double roundoff = 0x1p-52;

    ABUT_HD friend constexpr estimate operator+(const estimate& a, const estimate& b) {
        const double v = a.value + b.value;
        return {v, (a.error + b.error) + roundoff * absolute(v)};
    }
    ABUT_HD friend constexpr estimate operator-(const estimate& a, const estimate& b) {
        const double v = a.value - b.value;
        return {v, (a.error + b.error) + roundoff * absolute(v)};
    }
    ABUT_HD friend constexpr estimate operator*(const estimate& a, const estimate& b) {
        const double v = a.value * b.value, size = absolute(a.value);
        return {v, (size * b.error + a.error * (absolute(b.value) + b.error)) + roundoff * absolute(v)};
    }
    ABUT_HD friend constexpr estimate operator-(const estimate& a) { return {-a.value, a.error}; }
    /// The quotient of polynomials. Nothing is known of it where b may be 0 or it leaves the middle of the range.
    ABUT_HD friend constexpr estimate operator/(const estimate& a, const estimate& b) {
        const double divisor = absolute(b.value) - (1 + 0x1p-30) * b.error, v = a.value / b.value, size = absolute(v);
        if (a.value == 0 && a.error == 0 && divisor > 0) return {0, 0};
        if (!(divisor > 0 && size > 0x1p-900 && size < 0x1p900)) return {0, infinity<double>};
        return {v, (a.error + size * b.error) / divisor + roundoff * size};
    }
};

/// What is known of a number, and how far off it may be.
///@{
ABUT_HD constexpr double value_of(double x) { return x; }
ABUT_HD constexpr double value_of(const estimate& x) { return x.value; }
ABUT_HD constexpr double error_of(double) { return 0; }
ABUT_HD constexpr double error_of(const estimate& x) { return x.error; }
///@}

/// a^2 or |a|^2
///@{
ABUT_HD constexpr estimate square(const estimate& a) { return a * a; }
ABUT_HD constexpr estimate square(const vec3<estimate>& a) { return dot(a, a); }
///@}

/// What `sign_or_unknown` says besides -1, 0 and 1.
inline constexpr int unknown_sign = 2;

/// The sign of a number; of an estimate, where its error leaves one.
///@{
template <class N>
ABUT_HD constexpr int sign_or_unknown(const N& a) {
    using abut::sign;
    return sign(a);
}
ABUT_HD constexpr int sign_or_unknown(const estimate& a) {
    const double error = (1 + 0x1p-30) * a.error;
    return a.value > error ? 1 : a.value < -error ? -1 : a.error == 0 ? 0 : unknown_sign;
}
///@}

// Questions in three-valued logic, of exact numbers and of estimates.

template <class N>
ABUT_HD constexpr verdict is_positive(const N& a) {
    const int s = sign_or_unknown(a);
    return s == unknown_sign ? verdict::unknown : to_verdict(s > 0);
}
template <class N>
ABUT_HD constexpr verdict is_negative(const N& a) {
    const int s = sign_or_unknown(a);
    return s == unknown_sign ? verdict::unknown : to_verdict(s < 0);
}
template <class N>
ABUT_HD constexpr verdict is_not_negative(const N& a) {
    const int s = sign_or_unknown(a);
    return s == unknown_sign ? verdict::unknown : to_verdict(s >= 0);
}

template <class N>
ABUT_HD constexpr verdict is_not_positive(const N& a) {
    const int s = sign_or_unknown(a);
    return s == unknown_sign ? verdict::unknown : to_verdict(s <= 0);
}

/// |a|^2 <= |b|^2, of numbers or vectors of one degree.
template <class A, class B>
ABUT_HD constexpr verdict is_no_longer(const A& a, const B& b) {
    using abut::square;  // of plain numbers, which the names of this namespace hide
    return is_not_negative(square(b) - square(a));
}

/// |a|^2 > |b|^2, alike.
template <class A, class B>
ABUT_HD constexpr verdict is_longer(const A& a, const B& b) {
    using abut::square;
    return is_positive(square(a) - square(b));
}

/// a && b(), which is not asked where a is no.
template <class Question>
ABUT_HD constexpr verdict and_then(verdict a, const Question& b) {
    return a == verdict::no ? verdict::no : a && b();
}
/// a || b(), which is not asked where a is yes.
template <class Question>
ABUT_HD constexpr verdict or_else(verdict a, const Question& b) {
    return a == verdict::yes ? verdict::yes : a || b();
}

/// The power of two that values are multiplied by for polynomials of a degree, or 0 where these might underflow or denormal
/// numbers might be read as 0. `digits`: what is left of a rounded number's error, 2^-digits of it.
template <int Degree, int Digits, scalar T, std::size_t V>
ABUT_HD constexpr double unit_of_estimates(const T (&value)[V]) {
    using format = float_format<T>;
    using word = typename format::word;
    constexpr int top = 900 / Degree, span = 960 / Degree + top - 54 - Digits;
    constexpr int bias = 2 - format::digits - format::min_exponent, far = 600;
    // By their bits, without a sign; less 1, which makes 0 the greatest of all.
    word most = 0, least_of_all = static_cast<word>(-1);
    for (int i = 0; i < int{V}; ++i) {
        const word size = static_cast<word>(ABUT_BIT_CAST(word, value[i]) << 1), less = static_cast<word>(size - 1);
        most = size > most ? size : most;
        least_of_all = less < least_of_all ? less : least_of_all;
    }
    const int high = static_cast<int>(most >> format::digits), low = static_cast<int>(least_of_all >> format::digits);
    const int exponent = high - bias;
    if (low < 1 || high - low >= span || exponent > far || exponent < -far) return 0;
    return power_of_two<double>(top - exponent);
}

/// Question::ask of the values, where doubles can tell. In double also of floats.
template <class Question, scalar T, std::size_t V>
ABUT_HD constexpr verdict ask_estimates(const T (&value)[V]) {
    const double unit = unit_of_estimates<Question::degree, 52>(value);
    if (unit == 0) return verdict::unknown;
    estimate number[V]{};
    for (int i = 0; i < int{V}; ++i) number[i] = {static_cast<double>(value[i]) * unit, 0};
    return Question::ask(number);
}

/// A question as a predicate of the exact stages, without its `degree`: in words these ask only polynomials of degree 6 or
/// less.
template <class Question>
struct asked_exactly {
    template <class N, std::size_t V>
    ABUT_HD static constexpr bool holds(const N (&value)[V]) {
        return Question::ask(value) == verdict::yes;
    }
};

}  // namespace abut::detail
