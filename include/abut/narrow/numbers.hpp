// SPDX-License-Identifier: MIT
#pragma once

// The numbers that contacts are computed in: doubles whose operations are rounded one by one, and sums of two doubles for
// what is ill-conditioned. Both give the same bits under every compiler, flag and device that rounds to nearest and keeps
// subnormals; nothing in them is contracted. Not for decisions: those are exact, and are made elsewhere.

#include <cmath>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut::detail::contact_math {

/// A double; each operation is rounded.
struct one_double {
    double high;

    ABUT_HD static constexpr one_double of(double x) { return {x}; }
    /// a - b
    ABUT_HD static constexpr one_double difference(double a, double b) { return {plain_sum(a, -b)}; }

    friend ABUT_HD constexpr one_double operator+(one_double a, one_double b) { return {plain_sum(a.high, b.high)}; }
    friend ABUT_HD constexpr one_double operator-(one_double a, one_double b) { return {plain_sum(a.high, -b.high)}; }
    friend ABUT_HD constexpr one_double operator*(one_double a, one_double b) { return {plain_product(a.high, b.high)}; }
    friend ABUT_HD constexpr one_double operator/(one_double a, one_double b) { return {a.high / b.high}; }
    friend ABUT_HD constexpr one_double operator-(one_double a) { return {-a.high}; }
    friend ABUT_HD constexpr bool operator<(one_double a, one_double b) { return a.high < b.high; }
};

/// high + low, where |low| is at most half a unit in the last place of high: 106 bits or more. Sums and products have
/// relative errors of a few 2^-105 (Joldes, Muller, Popescu: Tight and rigorous error bounds for basic building blocks of
/// double-word arithmetic, 2017, algorithms 6 and 10), also where a sum cancels.
struct two_doubles {
    double high, low;

    ABUT_HD static constexpr two_doubles of(double x) { return {x, 0}; }
    /// a - b, exactly.
    ABUT_HD static constexpr two_doubles difference(double a, double b) {
        const error_free<double> d = two_diff(a, b);
        return {d.value, d.error};
    }
    /// Of a sum whose first part is the larger.
    ABUT_HD static constexpr two_doubles normal(double a, double b) {
        const double s = plain_sum(a, b);
        return {s, plain_sum(b, -plain_sum(s, -a))};
    }

    friend ABUT_HD constexpr two_doubles operator+(const two_doubles& a, const two_doubles& b) {
        const error_free<double> s = two_sum(a.high, b.high), t = two_sum(a.low, b.low);
        const two_doubles v = normal(s.value, plain_sum(s.error, t.value));
        return normal(v.high, plain_sum(t.error, v.low));
    }
    friend ABUT_HD constexpr two_doubles operator-(const two_doubles& a) { return {-a.high, -a.low}; }
    friend ABUT_HD constexpr two_doubles operator-(const two_doubles& a, const two_doubles& b) { return a + -b; }
    friend ABUT_HD constexpr two_doubles operator*(const two_doubles& a, const two_doubles& b) {
        const double p = plain_product(a.high, b.high), e = error_of_product(a.high, b.high, p);
        const double mixed = plain_sum(plain_product(a.high, b.low), plain_product(a.low, b.high));
        return normal(p, plain_sum(e, mixed));
    }
    friend ABUT_HD constexpr two_doubles operator/(const two_doubles& a, const two_doubles& b) {
        const double q = a.high / b.high;
        const two_doubles rest = a - of(q) * b;
        return normal(q, rest.high / b.high);
    }
    friend ABUT_HD constexpr bool operator<(const two_doubles& a, const two_doubles& b) {
        return a.high < b.high || (a.high == b.high && a.low < b.low);
    }
};

/// The square root of a positive double with an exponent of moderate size, rounded to nearest, in integers: for constant
/// expressions, where std::sqrt is none.
ABUT_HD constexpr double constant_root(double x) {
    int exponent = 0;
    while (x >= 4) x /= 4, ++exponent;
    while (x < 1) x *= 4, --exponent;
    uint128 rest = static_cast<uint128>(static_cast<std::uint64_t>(x * 0x1p52)) << 54, root = 0;  // x 2^106
    for (uint128 bit = uint128{1} << 106; bit != 0; bit >>= 2) {
        if (rest >= root + bit) {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    // 54 bits of the root, and whether more follow: a root is never halfway between two doubles.
    double r = static_cast<double>(lower_limb((root >> 1) + (root & 1))) * 0x1p-52;
    for (; exponent > 0; --exponent) r *= 2;
    for (; exponent < 0; ++exponent) r /= 2;
    return r;
}

/// Square roots of what is not negative.
ABUT_INLINE ABUT_HD constexpr one_double root(one_double x) {
    if (x.high == 0) return x;
    if (ABUT_CONSTANT_EVALUATED()) return {constant_root(x.high)};
    return {std::sqrt(x.high)};
}
ABUT_HD constexpr two_doubles root(const two_doubles& x) {
    if (x.high == 0) return {0, 0};
    const two_doubles r = two_doubles::of(root(one_double{x.high}).high);
    return two_doubles::normal(r.high, (x - r * r).high / (2 * r.high));
}

// --- vectors of them ------------------------------------------------------------------------------------------------------

using point = vec3<double>;  ///< as it was given, or as rounded numbers

template <class N>
ABUT_HD constexpr vec3<N> as(const point& p) {
    return {N::of(p.x), N::of(p.y), N::of(p.z)};
}
template <class N>
ABUT_HD constexpr vec3<N> between(const point& from, const point& to) {
    return {N::difference(to.x, from.x), N::difference(to.y, from.y), N::difference(to.z, from.z)};
}
template <class N>
ABUT_HD constexpr point rounded_off(const vec3<N>& v) {
    return {v.x.high, v.y.high, v.z.high};
}
ABUT_HD constexpr point negated(const point& p) { return {-p.x, -p.y, -p.z}; }

ABUT_HD constexpr double largest_of(const point& p) { return greatest(absolute(p.x), absolute(p.y), absolute(p.z)); }

using detail::plain_dot;
/// In doubles, rounded one by one.
ABUT_INLINE ABUT_HD constexpr point plain_difference(const point& a, const point& b) {
    return {plain_sum(a.x, -b.x), plain_sum(a.y, -b.y), plain_sum(a.z, -b.z)};
}

/// 2^e, for -1022 <= e <= 1023
ABUT_HD constexpr double power_of_two(int e) {
    return ABUT_BIT_CAST(double, static_cast<std::uint64_t>(e + 1023) << 52);
}
/// The exponent of a finite double x > 0: 2^e <= x < 2^(e+1).
ABUT_HD constexpr int exponent_of(double x) {
    const auto biased = static_cast<int>(ABUT_BIT_CAST(std::uint64_t, x) >> 52 & 0x7ff);
    if (biased != 0) return biased - 1023;
    return static_cast<int>(ABUT_BIT_CAST(std::uint64_t, x * 0x1p54) >> 52 & 0x7ff) - 1023 - 54;
}
/// x 2^e, for -2044 <= e <= 2046; in two steps, since 2^e itself may be out of range.
ABUT_HD constexpr double scaled(double x, int e) {
    const int half = e / 2;
    return plain_product(plain_product(x, power_of_two(half)), power_of_two(e - half));
}
ABUT_HD constexpr point scaled(const point& p, int e) { return {scaled(p.x, e), scaled(p.y, e), scaled(p.z, e)}; }
ABUT_HD constexpr one_double scaled(one_double x, int e) { return {scaled(x.high, e)}; }
ABUT_HD constexpr two_doubles scaled(const two_doubles& x, int e) { return {scaled(x.high, e), scaled(x.low, e)}; }
template <class N>
ABUT_HD constexpr vec3<N> scaled_vector(const vec3<N>& v, int e) {
    return {scaled(v.x, e), scaled(v.y, e), scaled(v.z, e)};
}

/// The vector with its largest coordinate brought to [1, 2); zero stays.
template <class N>
ABUT_HD constexpr vec3<N> brought_to_one(const vec3<N>& v) {
    const double largest = largest_of(rounded_off(v));
    return largest > 0 ? scaled_vector(v, -exponent_of(largest)) : v;
}

ABUT_HD constexpr bool is_zero(const point& p) { return p.x == 0 && p.y == 0 && p.z == 0; }
template <class N>
ABUT_HD constexpr bool is_zero(const vec3<N>& v) {
    return is_zero(rounded_off(v));
}

/// A sum of up to 16 doubles that are not rounded: parts that do not overlap, the smallest first (Shewchuk: Adaptive
/// Precision Floating-Point Arithmetic, 1997, theorem 10).
class exact_sum {
public:
    ABUT_HD constexpr void add(double x) {
        if (x == 0) return;
        for (int i = 0; i < count_; ++i) {
            const error_free<double> s = two_sum(part_[i], x);
            part_[i] = s.error;
            x = s.value;
        }
        part_[count_++] = x;
    }
    /// Exact but for errors of products that fall below the least positive number.
    ABUT_HD constexpr void add_product(double a, double b) {
        if (a == 0 || b == 0) return;
        const double p = plain_product(a, b);
        add(error_of_product(a, b, p));
        add(p);
    }
    ABUT_HD constexpr void add_product(const two_doubles& a, const two_doubles& b) {
        add_product(a.low, b.low);
        add_product(a.low, b.high);
        add_product(a.high, b.low);
        add_product(a.high, b.high);
    }
    [[nodiscard]] ABUT_HD constexpr two_doubles total() const {
        two_doubles sum{0, 0};
        for (int i = count_ - 1; i >= 0; --i) sum = sum + two_doubles::of(part_[i]);
        return sum;
    }

private:
    double part_[16]{};
    int count_ = 0;
};

/// a b - c d, rounded once.
ABUT_NOINLINE ABUT_HD constexpr two_doubles difference_of_products(const two_doubles& a, const two_doubles& b,
                                                                   const two_doubles& c, const two_doubles& d) {
    exact_sum all;
    all.add_product(a, b);
    all.add_product(-c, d);
    return all.total();
}

/// u x v, right in nearly all of its digits also where u and v are nearly parallel. Both have been brought to one. Zero
/// where the sine between them is below 2^-900, for there products underflow.
ABUT_NOINLINE ABUT_HD constexpr vec3<two_doubles> accurate_cross(const vec3<two_doubles>& u, const vec3<two_doubles>& v) {
    const vec3<two_doubles> n = cross(u, v);
    if (largest_of(rounded_off(n)) > 0x1p-40) return n;
    const vec3<two_doubles> exact{difference_of_products(u.y, v.z, u.z, v.y), difference_of_products(u.z, v.x, u.x, v.z),
                                  difference_of_products(u.x, v.y, u.y, v.x)};
    if (largest_of(rounded_off(exact)) > 0x1p-900) return exact;
    return {two_doubles::of(0), two_doubles::of(0), two_doubles::of(0)};
}

/// v / |v|, and zero for zero. No overflow or underflow on the way.
template <class N>
ABUT_HD constexpr point unit_vector(const vec3<N>& v) {
    const vec3<N> w = brought_to_one(v);
    const N length = root(dot(w, w));
    if (!(length.high > 0)) return {0, 0, 0};
    return {(w.x / length).high, (w.y / length).high, (w.z / length).high};
}

}  // namespace abut::detail::contact_math

namespace abut::detail {

/// Rounded to T, and no farther than its largest number.
template <scalar T>
ABUT_HD constexpr T rounded_within(double x) {
    constexpr auto far = static_cast<double>(largest_finite<T>);
    return x > far ? largest_finite<T> : x < -far ? -largest_finite<T> : rounded(static_cast<T>(x));
}

}  // namespace abut::detail
