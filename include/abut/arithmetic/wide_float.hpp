// SPDX-License-Identifier: MIT
#pragma once

// Numbers of 256 binary digits and an exponent of their own: a floating-point number in integers, the same bits on each
// compiler and device. For searches that converge, where double leaves them open and no polynomial decides. Not for exact
// results: each operation cuts off what is below its digits, and so is off by less than 2^-252 of its larger operand, or of
// its result where it multiplies.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>

namespace abut::detail {

/// sense * limb * 2^exponent, with the first digit of the last limb 1; or 0, for a sense of 0.
struct wide_float {
    static constexpr int limbs = 4;

    std::uint64_t limb[std::size_t{limbs}]{};
    int exponent = 0, sense = 0;

    wide_float() = default;
    template <scalar T>
    ABUT_HD constexpr explicit wide_float(T x) {
        const binary_parts p = take_apart(x);
        if (p.mantissa == 0) return;
        sense = p.mantissa < 0 ? -1 : 1;
        limb[0] = static_cast<std::uint64_t>(p.mantissa < 0 ? -p.mantissa : p.mantissa);
        const int up = 64 * limbs - bits_of_limbs(limb, limbs);
        move_up(limb, limbs, up);
        exponent = p.exponent - up;
    }
    /// Times 2^n
    [[nodiscard]] ABUT_HD constexpr wide_float scaled(int n) const {
        wide_float r = *this;
        if (sense != 0) r.exponent += n;
        return r;
    }
    ABUT_HD friend constexpr wide_float operator-(wide_float a) {
        a.sense = -a.sense;
        return a;
    }
};

ABUT_HD constexpr int sign(const wide_float& a) { return a.sense; }

/// n limbs as a number: the first `wide_float::limbs` of them from the first digit that is 1.
ABUT_NOINLINE ABUT_HD constexpr wide_float leading_part(std::uint64_t* a, int n, int exponent, int sense) {
    wide_float r;
    const int bits = bits_of_limbs(a, n);
    if (bits == 0) return r;
    move_up(a, n, 64 * n - bits);
    ABUT_ROLLED
    for (int i = 0; i < wide_float::limbs; ++i) r.limb[i] = a[n - wide_float::limbs + i];
    r.exponent = exponent - (64 * n - bits) + 64 * (n - wide_float::limbs);
    r.sense = sense;
    return r;
}

ABUT_NOINLINE ABUT_HD constexpr wide_float operator*(const wide_float& a, const wide_float& b) {
    constexpr int n = 2 * wide_float::limbs;
    if (a.sense == 0 || b.sense == 0) return {};
    std::uint64_t product[std::size_t{n}]{};
    ABUT_ROLLED
    for (int i = 0; i < wide_float::limbs; ++i) {
        std::uint64_t carry = 0;
        ABUT_ROLLED
        for (int j = 0; j < wide_float::limbs; ++j) {
            const uint128 t = static_cast<uint128>(a.limb[i]) * b.limb[j] + product[i + j] + carry;
            product[i + j] = lower_limb(t);
            carry = upper_limb(t);
        }
        product[i + wide_float::limbs] = carry;
    }
    return leading_part(product, n, a.exponent + b.exponent, a.sense * b.sense);
}

ABUT_NOINLINE ABUT_HD constexpr wide_float operator+(const wide_float& a, const wide_float& b) {
    constexpr int n = wide_float::limbs + 1;
    if (a.sense == 0) return b;
    if (b.sense == 0) return a;
    if (a.exponent < b.exponent) return b + a;
    const int down = a.exponent - b.exponent, whole = down / 64, part = down % 64;
    if (whole >= n) return a;
    // With a limb more below.
    std::uint64_t sum[std::size_t{n}]{}, other[std::size_t{n} + 1]{};
    ABUT_ROLLED
    for (int i = 0; i < n; ++i) {
        const int k = i + whole;
        const auto of_b = [&](int j) { return j >= 1 && j < n ? b.limb[j - 1] : 0; };
        sum[i] = i > 0 ? a.limb[i - 1] : 0;
        other[i] = part == 0 ? of_b(k) : of_b(k) >> part | of_b(k + 1) << (64 - part);
    }
    int sense = a.sense;
    if (a.sense != b.sense && limbs_less(sum, other, n)) {
        subtract(sum, other, sum, n);
        sense = -sense;
    } else if (a.sense != b.sense) {
        subtract(sum, sum, other, n);
    } else {
        std::uint64_t carry = 0;
        ABUT_ROLLED
        for (int i = 0; i < n; ++i) {
            const uint128 t = static_cast<uint128>(sum[i]) + other[i] + carry;
            other[i] = lower_limb(t);
            carry = upper_limb(t);
        }
        other[n] = carry;
        return leading_part(other, n + 1, a.exponent - 64, sense);
    }
    return leading_part(sum, n, a.exponent - 64, sense);
}
ABUT_HD constexpr wide_float operator-(const wide_float& a, const wide_float& b) { return a + -b; }

/// The sign of a . b
ABUT_HD constexpr int sign_of_dot(const vec3<wide_float>& a, const vec3<wide_float>& b) { return sign(dot(a, b)); }

/// 1 / x^(1/2) of a number above 0, off by less than 2^-248 of it. Newton's steps, from 1 for a number between 1/4 and 1: in
/// nine the half that 1 may be off becomes less than 2^-300. Without double, in which modes of rounding may differ.
ABUT_NOINLINE ABUT_HD constexpr wide_float inverse_root(const wide_float& x) {
    const int top = x.exponent + 64 * wide_float::limbs, half = (top + ((top & 1) != 0 ? 1 : 0)) / 2;
    const wide_float part = x.scaled(-2 * half), three(3.0);
    wide_float y(1.0);
    ABUT_ROLLED
    for (int i = 0; i < 9; ++i) y = (y * (three - part * (y * y))).scaled(-1);
    return y.scaled(-half);
}

}  // namespace abut::detail
