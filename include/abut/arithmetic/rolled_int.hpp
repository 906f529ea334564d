// SPDX-License-Identifier: MIT
#pragma once

// Integers whose length is known at run time, in room that is known when it is compiled: for exact results, and not only
// signs, of any finite input. All loops are over limbs and none is unrolled, and all lengths share one function out of line.
// So a formula costs a kernel a few calls, where wide_int.hpp writes out each product. It is slower for that: for what is
// rarely asked.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>
#include <abut/config.hpp>

namespace abut::detail {

/// Limb i of a number in two's complement of n limbs, continued by its sign.
ABUT_HD constexpr std::uint64_t limb_of(const std::uint64_t* a, int n, int i) {
    return i < n ? a[i] : mask_if(static_cast<std::int64_t>(a[n - 1]) < 0);
}

#if ABUT_DEVICE_CODE
/// r += a b, or r -= a b, modulo 2^(64 n), for an r of n limbs. What hosts do, below, made kernels of nvcc 13.0 write to wild
/// addresses (docs/numerics/compilers.md).
ABUT_NOINLINE ABUT_HD constexpr void add_product(std::uint64_t* r, int n, const std::uint64_t* a, int limbs_a,
                                                 const std::uint64_t* b, int limbs_b, bool negated) {
    ABUT_ROLLED
    for (int i = 0; i < n; ++i) {
        const std::uint64_t x = limb_of(a, limbs_a, i);
        if (x == 0) continue;
        std::uint64_t carry = negated ? x : 0;  // -b is ~b + 1
        ABUT_ROLLED
        for (int j = 0; i + j < n; ++j) {
            const uint128 t = static_cast<uint128>(x) * (limb_of(b, limbs_b, j) ^ mask_if(negated)) + r[i + j] + carry;
            r[i + j] = lower_limb(t);
            carry = upper_limb(t);
        }
    }
}
#else
/// r += x b, or r -= x b, modulo 2^(64 n), of limbs without a sign.
constexpr void add_row(std::uint64_t* r, int n, std::uint64_t x, const std::uint64_t* b, int limbs, bool negated) {
    const int both = limbs < n ? limbs : n;
    std::uint64_t carry = 0;
    int j = 0;
    if (negated) {
        for (; j < both; ++j) {
            const uint128 t = static_cast<uint128>(x) * b[j] + carry;
            const std::uint64_t low = lower_limb(t), before = r[j];
            r[j] = before - low;
            carry = upper_limb(t) + static_cast<std::uint64_t>(before < low);
        }
        for (; carry != 0 && j < n; ++j) {
            const std::uint64_t before = r[j];
            r[j] = before - carry;
            carry = static_cast<std::uint64_t>(before < carry);
        }
        return;
    }
    for (; j < both; ++j) {
        const uint128 t = static_cast<uint128>(x) * b[j] + r[j] + carry;
        r[j] = lower_limb(t);
        carry = upper_limb(t);
    }
    for (; carry != 0 && j < n; ++j) {
        r[j] += carry;
        carry = static_cast<std::uint64_t>(r[j] < carry);
    }
}

/// The limbs of a number in two's complement that are not 0 at its lower end, and not but its sign at its upper one.
struct used_limbs {
    int first = 0, end;
    bool is_negative;

    constexpr used_limbs(const std::uint64_t* a, int n) : end(n), is_negative(static_cast<std::int64_t>(a[n - 1]) < 0) {
        while (end > 1 && a[end - 1] == limb_of(a, end - 1, end - 1)) --end;
        while (first < end && a[first] == 0) ++first;
    }
};

/// The same, of no more limbs than are used: what is taken without signs is taken back.
ABUT_NOINLINE ABUT_HD constexpr void add_product(std::uint64_t* r, int n, const std::uint64_t* a, int limbs_a,
                                                 const std::uint64_t* b, int limbs_b, bool negated) {
    const used_limbs x(a, limbs_a), y(b, limbs_b);
    const auto add = [&](int at, std::uint64_t times, const std::uint64_t* of, const used_limbs& used, bool minus) {
        if (at + used.first < n) {
            add_row(r + at + used.first, n - at - used.first, times, of + used.first, used.end - used.first, minus);
        }
    };
    for (int i = x.first; i < x.end; ++i) {
        if (a[i] != 0) add(i, a[i], b, y, negated);
    }
    if (x.is_negative) add(x.end, 1, b, y, !negated);
    if (y.is_negative) add(y.end, 1, a, x, !negated);
    const std::uint64_t one = 1;
    if (x.is_negative && y.is_negative && x.end + y.end < n) add_row(r + x.end + y.end, n - x.end - y.end, 1, &one, 1, negated);
}
#endif

/// r += value 2^shift, or r -= it, modulo 2^(64 n).
ABUT_NOINLINE ABUT_HD constexpr void add_shifted(std::uint64_t* r, int n, std::int64_t value, int shift, bool negated) {
    const auto moved = static_cast<int128>(negated ? -value : value) * (static_cast<int128>(1) << shift % 64);
    const auto bits = static_cast<uint128>(moved);
    std::uint64_t carry = 0;
    ABUT_ROLLED
    for (int i = shift / 64; i < n; ++i) {
        const int k = i - shift / 64;
        const uint128 t = static_cast<uint128>(r[i]) + carry +
                          (k == 0 ? lower_limb(bits) : k == 1 ? upper_limb(bits) : mask_if(moved < 0));
        r[i] = lower_limb(t);
        carry = upper_limb(t);
    }
}

/// A number in two's complement, of `count` limbs, the least significant first; no more than `Room`. Sums wrap: whoever sets
/// the count leaves room for what is added. Trivial to copy: where it had a copy constructor, which copied `count` limbs,
/// kernels that nvcc 13.0 made wrote beyond their stack in a function that returns one, and hulls were wrong on a device.
template <int Room>
struct rolled_int {
    std::uint64_t limb[std::size_t{Room}];  // not initialised
    int count;

    /// 0, of n limbs.
    ABUT_HD constexpr void clear(int n) {
        count = n;
        ABUT_ROLLED
        for (int i = 0; i < n; ++i) limb[i] = 0;
    }
    /// The same, and 0 in all its room in a constant expression, which may not copy what was not set.
    ABUT_HD constexpr void begin(int n) {
        clear(ABUT_CONSTANT_EVALUATED() ? Room : n);
        count = n;
    }
    template <int A, int B>
    ABUT_HD constexpr void add(const rolled_int<A>& a, const rolled_int<B>& b, bool negated = false) {
        add_product(limb, count, a.limb, a.count, b.limb, b.count, negated);
    }
    template <int A>
    ABUT_HD constexpr void add(const rolled_int<A>& a, bool negated = false) {
        const std::uint64_t one = 1;
        add_product(limb, count, &one, 1, a.limb, a.count, negated);
    }
    /// Adds or subtracts number i, in the unit of all.
    template <std::size_t V>
    ABUT_HD constexpr void add(const aligned<V>& x, int i, bool negated = false) {
        const binary_parts& p = x.part[i];
        if (p.mantissa != 0) add_shifted(limb, count, p.mantissa, p.exponent - x.low, negated);
    }
    /// -1, 0 or 1.
    [[nodiscard]] ABUT_HD constexpr int sign() const {
        if (static_cast<std::int64_t>(limb[count - 1]) < 0) return -1;
        std::uint64_t any = 0;
        ABUT_ROLLED
        for (int i = 0; i < count; ++i) any |= limb[i];
        return any != 0 ? 1 : 0;
    }
    ABUT_HD friend constexpr int sign(const rolled_int& a) { return a.sign(); }
    /// Changes the sign if it is negative.
    ABUT_HD constexpr void drop_sign() {
        if (static_cast<std::int64_t>(limb[count - 1]) >= 0) return;
        std::uint64_t carry = 1;
        ABUT_ROLLED
        for (int i = 0; i < count; ++i) {
            limb[i] = ~limb[i] + carry;
            carry = carry != 0 && limb[i] == 0 ? 1 : 0;
        }
    }
};

// Numbers as results: a product has the limbs of both factors, a sum those of its terms, which have one length and leave
// room for it. Whoever computes polynomials of them leaves two bits of each number's first limb. All are returned out of
// line: nvcc 13.0 may give what one inlined call returns the memory of what another one returned and is still read. So
// templates of vec.hpp, which are inlined, have an overload here.

template <int A, int B>
ABUT_NOINLINE ABUT_HD constexpr rolled_int<A + B> operator*(const rolled_int<A>& a, const rolled_int<B>& b) {
    rolled_int<A + B> r;
    r.begin(a.count + b.count);
    r.add(a, b);
    return r;
}

/// r = a - b, of n limbs each.
ABUT_NOINLINE ABUT_HD constexpr void subtract(std::uint64_t* r, const std::uint64_t* a, const std::uint64_t* b, int n) {
    std::uint64_t carry = 1;
    ABUT_ROLLED
    for (int i = 0; i < n; ++i) {
        const uint128 t = static_cast<uint128>(a[i]) + ~b[i] + carry;
        r[i] = lower_limb(t);
        carry = upper_limb(t);
    }
}

template <int A>
ABUT_NOINLINE ABUT_HD constexpr rolled_int<A> operator-(const rolled_int<A>& a, const rolled_int<A>& b) {
    rolled_int<A> r;
    r.begin(a.count);
    subtract(r.limb, a.limb, b.limb, a.count);
    return r;
}

template <int A>
ABUT_NOINLINE ABUT_HD constexpr rolled_int<A> operator+(const rolled_int<A>& a, const rolled_int<A>& b) {
    rolled_int<A> r;
    r.begin(a.count);
    r.add(a);
    r.add(b);
    return r;
}

template <int A>
ABUT_NOINLINE ABUT_HD constexpr vec3<rolled_int<A>> operator-(const vec3<rolled_int<A>>& a, const vec3<rolled_int<A>>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <int A, int B>
ABUT_NOINLINE ABUT_HD constexpr auto cross(const vec3<rolled_int<A>>& a, const vec3<rolled_int<B>>& b) {
    vec3<rolled_int<A + B>> r;
    const auto write = [](rolled_int<A + B>& to, const auto& p, const auto& q, const auto& s, const auto& t) {
        to.begin(p.count + q.count);
        to.add(p, q);
        to.add(s, t, true);
    };
    write(r.x, a.y, b.z, a.z, b.y);
    write(r.y, a.z, b.x, a.x, b.z);
    write(r.z, a.x, b.y, a.y, b.x);
    return r;
}

template <int A, int B>
ABUT_NOINLINE ABUT_HD constexpr rolled_int<A + B> dot(const vec3<rolled_int<A>>& a, const vec3<rolled_int<B>>& b) {
    rolled_int<A + B> sum;
    sum.begin(a.x.count + b.x.count);
    sum.add(a.x, b.x);
    sum.add(a.y, b.y);
    sum.add(a.z, b.z);
    return sum;
}

/// The sign of a . b
template <int A, int B>
ABUT_HD constexpr int sign_of_dot(const vec3<rolled_int<A>>& a, const vec3<rolled_int<B>>& b) {
    return dot(a, b).sign();
}

/// s v
template <int A, int B>
ABUT_NOINLINE ABUT_HD constexpr vec3<rolled_int<A + B>> scale(const rolled_int<A>& s, const vec3<rolled_int<B>>& v) {
    vec3<rolled_int<A + B>> r;
    const auto write = [](rolled_int<A + B>& to, const auto& p, const auto& q) {
        to.begin(p.count + q.count);
        to.add(p, q);
    };
    write(r.x, s, v.x);
    write(r.y, s, v.y);
    write(r.z, s, v.z);
    return r;
}

/// The i-th three numbers in a row, as a point.
template <int A, std::size_t V>
ABUT_NOINLINE ABUT_HD constexpr vec3<rolled_int<A>> point_at(const rolled_int<A> (&value)[V], int i) {
    return {value[3 * i], value[3 * i + 1], value[3 * i + 2]};
}

inline constexpr int spare_bits_of_length = 4;  ///< for sums, and the sign

/// a^2 or |a|^2
///@{
template <int A>
ABUT_NOINLINE ABUT_HD constexpr rolled_int<2 * A> square(const rolled_int<A>& a) {
    return a * a;
}
template <int A>
ABUT_NOINLINE ABUT_HD constexpr rolled_int<2 * A> square(const vec3<rolled_int<A>>& a) {
    return dot(a, a);
}
///@}

/// Whether Predicate::holds of numbers that span so many bits that `Room` limbs hold them.
template <class Predicate, int Room, std::size_t V>
ABUT_HD constexpr bool holds_at_length(const aligned<V>& x) {
    const int width = x.width() > 0 ? x.width() : 0, limbs = (width + spare_bits_of_length + 63) / 64;
    rolled_int<Room> number[V];
    ABUT_ROLLED
    for (int i = 0; i < int{V}; ++i) {
        number[i].begin(limbs);
        number[i].add(x, i);
    }
    return Predicate::holds(number);
}

/// Of any finite values: for polynomials of a higher degree than sums of terms can be kept for (decide_at_any_span in
/// exact_stages.hpp), with a stack of kilobytes for each.
template <class Predicate, scalar T, std::size_t V>
ABUT_HD constexpr bool decide_at_any_length(const T (&value)[V]) {
    using format = float_format<T>;
    constexpr int most = format::max_exponent + format::digits - format::min_exponent;
    return holds_at_length<Predicate, (most + spare_bits_of_length + 63) / 64>(aligned<V>(value));
}

/// As decide_in_limbs in exact_stages.hpp, in two limbs at most; of a kernel it makes a tenth of the code.
template <class Predicate, scalar T, std::size_t V>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_at_short_length(const T (&value)[V]) {
    const aligned<V> x(value);
    constexpr int limbs = 2;
    return x.width() <= 64 * limbs - spare_bits_of_length ? to_verdict(holds_at_length<Predicate, limbs>(x))
                                                          : verdict::unknown;
}

// Magnitudes: n limbs without a sign.

ABUT_NOINLINE ABUT_HD constexpr bool limbs_less(const std::uint64_t* a, const std::uint64_t* b, int n) {
    int i = n - 1;
    while (i > 0 && a[i] == b[i]) --i;
    return a[i] < b[i];
}

/// The magnitude is below 2^bits.
ABUT_NOINLINE ABUT_HD constexpr int bits_of_limbs(const std::uint64_t* a, int n) {
    int i = n - 1;
    while (i > 0 && a[i] == 0) --i;
    int bits = 64 * i;
    std::uint64_t x = a[i];
    ABUT_ROLLED
    for (int step = 32; step > 0; step /= 2) {
        if (x >> step == 0) continue;
        x >>= step;
        bits += step;
    }
    return bits + (x != 0 ? 1 : 0);
}

ABUT_NOINLINE ABUT_HD constexpr void move_up(std::uint64_t* a, int n, int shift) {
    const int whole = shift / 64, part = shift % 64;
    ABUT_ROLLED
    for (int i = n - 1; i >= 0; --i) {
        const int k = i - whole;
        const std::uint64_t high = k >= 0 ? a[k] : 0, low = k > 0 ? a[k - 1] : 0;
        a[i] = part == 0 ? high : high << part | low >> (64 - part);
    }
}

/// a / b, for a of 0 or more and a b above 0, rounded to the nearest double, and of two that are as near to the lesser; the
/// largest one if it is above that. Both have to leave a bit beside that of the sign, and both are changed.
ABUT_NOINLINE ABUT_HD constexpr double divide_magnitudes(std::uint64_t* a, std::uint64_t* b, int n) {
    constexpr int lowest = float_format<double>::min_exponent, digits = float_format<double>::digits;
    constexpr std::uint64_t largest = 0x7fefffffffffffff;
    const int bits_a = bits_of_limbs(a, n), bits_b = bits_of_limbs(b, n);
    if (bits_a == 0) return 0;
    if (bits_a < bits_b) move_up(a, n, bits_b - bits_a);
    if (bits_b < bits_a) move_up(b, n, bits_a - bits_b);
    // The quotient, by its digits: the first stands for 2^weight, and one of the first two is 1. As many follow as a double
    // of this magnitude has.
    int weight = bits_a - bits_b, last = lowest;
    if (weight < lowest) return weight == lowest - 1 && limbs_less(b, a, n) ? ABUT_BIT_CAST(double, std::uint64_t{1}) : 0;
    std::uint64_t quotient = 0;
    for (;; --weight) {
        const bool is_one = !limbs_less(a, b, n);
        const std::uint64_t one = 1;
        if (is_one) add_product(a, n, &one, 1, b, n, true);
        quotient = quotient << 1 | (is_one ? 1 : 0);
        if (quotient == 1) last = weight - digits + 1 > lowest ? weight - digits + 1 : lowest;
        move_up(a, n, 1);
        if (weight == last) break;
    }
    if (limbs_less(b, a, n)) ++quotient;
    if (last - lowest > 2100) return ABUT_BIT_CAST(double, largest);
    const std::uint64_t bits = (static_cast<std::uint64_t>(last - lowest) << (digits - 1)) + quotient;
    return ABUT_BIT_CAST(double, bits < largest ? bits : largest);
}

/// |a| / |b| as above.
template <int Room>
ABUT_HD constexpr double rounded_quotient(rolled_int<Room>& a, rolled_int<Room>& b) {
    a.drop_sign();
    b.drop_sign();
    return divide_magnitudes(a.limb, b.limb, a.count);
}

}  // namespace abut::detail
