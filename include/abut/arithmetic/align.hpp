// SPDX-License-Identifier: MIT
#pragma once

// From floating point to integers: the coordinates of a predicate as integer multiples of one power of two. The sign of a
// homogeneous polynomial does not see that power, so it never has to be put back. Numbers are taken apart by their bit
// patterns: no operation here is floating-point arithmetic on them, so flush-to-zero modes and fast-math change nothing.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut {

/// A finite number as mantissa * 2^exponent with an odd mantissa; zero has mantissa 0 and exponent 0.
struct binary_parts {
    std::int64_t mantissa;  ///< odd, or 0
    int exponent;           ///< of the power of two
    int bits;               ///< an upper bound on the mantissa's width
};

namespace detail {

/// log2 of the lowest set bit of x, for 0 < x < 2^62. A power of two converts exactly to double, whose exponent field is
/// then the answer: one instruction on hosts and devices, and no intrinsic that differs between them.
ABUT_HD constexpr int lowest_bit(std::int64_t x) {
    return static_cast<int>(ABUT_BIT_CAST(std::uint64_t, static_cast<double>(x & -x)) >> 52) - 1023;
}

/// Number of bits of the numbers up to x.
constexpr int bits_up_to(std::uint64_t x) {
    int bits = 0;
    while (bits < 64 && x >> bits != 0) ++bits;
    return bits;
}

/// log2 of the highest set bit of x > 0, as that of the lowest one.
ABUT_HD constexpr std::uint32_t highest_bit(std::uint32_t x) {
    return static_cast<std::uint32_t>(ABUT_BIT_CAST(std::uint64_t, static_cast<double>(x)) >> 52) - 1023;
}

template <scalar T>
struct float_format;
template <>
struct float_format<float> {
    using word = std::uint32_t;
    static constexpr int digits = 24, min_exponent = -149, max_exponent = 104;
};
template <>
struct float_format<double> {
    using word = std::uint64_t;
    static constexpr int digits = 53, min_exponent = -1074, max_exponent = 971;
};

}  // namespace detail

/// A number as its parts, by its bits. It has to be finite: of an infinity or a NaN the answer means nothing.
template <scalar T>
ABUT_HD constexpr binary_parts take_apart(T x) {
    using format = detail::float_format<T>;
    using word = typename format::word;
    constexpr int fraction = format::digits - 1;
    const word w = ABUT_BIT_CAST(word, x);
    const int biased = static_cast<int>((w << 1) >> (fraction + 1));
    const word hidden = static_cast<word>(biased != 0) << fraction;
    const auto m = static_cast<std::int64_t>((w & ((word{1} << fraction) - 1)) | hidden);
    if (m == 0) return {0, 0, 0};
    const int trailing = detail::lowest_bit(m);
    const bool negative = (w >> (8 * static_cast<int>(sizeof(T)) - 1)) != 0;
    return {(negative ? -m : m) >> trailing, format::min_exponent + (biased == 0 ? 0 : biased - 1) + trailing,
            format::digits - trailing};
}

/// Whether x is neither zero nor normal. By its bits, since a processor may be told to read such a number as zero.
template <scalar T>
ABUT_HD constexpr bool is_subnormal(T x) {
    using format = detail::float_format<T>;
    using word = typename format::word;
    const word magnitude = static_cast<word>(ABUT_BIT_CAST(word, x) << 1);
    return static_cast<word>(magnitude - 1) < (word{1} << format::digits) - 1;  // 0 wraps around, and is none
}

/// Whether any of the numbers is neither zero nor normal.
template <scalar T, std::size_t V>
ABUT_HD constexpr bool any_subnormal(const T (&value)[V]) {
    bool any = false;
    for (int i = 0; i < int{V}; ++i) any |= is_subnormal(value[i]);  // all of them: no branch for each
    return any;
}

/// A finite number as an integer that is less than another's where the number is; equal for 0 and -0. By its bits, so that
/// comparisons are right also where denormal numbers are read as 0.
template <scalar T>
ABUT_HD constexpr auto ordered_bits(T x) {
    using word = std::conditional_t<std::same_as<T, float>, std::int32_t, std::int64_t>;
    constexpr auto least = static_cast<word>(std::uint64_t{1} << (8 * sizeof(T) - 1));
    const auto w = ABUT_BIT_CAST(word, x);
    return w < 0 ? least - w : w;
}

/// `V` finite numbers and the power of two, 2^low, that all are multiples of.
template <std::size_t V>
struct aligned {
    binary_parts part[V];  ///< of each number
    int low;               ///< the largest power of two that divides all numbers
    int high;              ///< all magnitudes are below 2^high

    /// Takes the numbers apart and finds the span of their bits.
    template <scalar T>
    ABUT_HD explicit constexpr aligned(const T (&value)[V]) : part{}, low{1 << 20}, high{-(1 << 20)} {
        for (int i = 0; i < int{V}; ++i) {
            const binary_parts p = take_apart(value[i]);
            part[i] = p;
            if (p.mantissa == 0) continue;
            low = p.exponent < low ? p.exponent : low;
            high = p.exponent + p.bits > high ? p.exponent + p.bits : high;
        }
    }

    /// All magnitudes are below 2^width() units of 2^low; negative where all numbers are zero.
    ABUT_HD constexpr int width() const { return high - low; }

    /// Number i in units of 2^low. The caller sees to it that width() bits and a sign fit into `L` limbs.
    template <int L>
    ABUT_HD constexpr wide_int<L> integer(int i) const {
        return wide_int<L>::shifted(part[i].mantissa, part[i].mantissa == 0 ? 0 : part[i].exponent - low);
    }
};

}  // namespace abut
