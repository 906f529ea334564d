// SPDX-License-Identifier: MIT
#pragma once

// The exact stages of any predicate whose polynomials have degree 6 or less in words, and 12 or less in limbs. A predicate
// is a type with one function, `holds(const N (&value)[V]) -> bool`, written over a number type N with +, -, *,
// `sign_of_dot` and `squares_at_most`; the values are the coordinates (and radii) that it depends on, all of one unit. It may
// state the `degree` of its polynomials, and how many of the values' first triples are `points`, which may all be moved by
// one vector: then it is also asked in words. In place of bool it may say more, by a type of its own that stage_answer knows.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut {

namespace detail {

/// Numbers in a row, as a predicate's `holds` takes them.
template <scalar T, std::size_t V>
struct row_of {
    T value[V];
};

template <scalar T>
ABUT_HD constexpr T* append(T* end, T x) {
    *end = x;
    return end + 1;
}
template <scalar T>
ABUT_HD constexpr T* append(T* end, const vec3<T>& p) {
    return append(append(append(end, p.x), p.y), p.z);
}

/// The coordinates of points, and single numbers, in the order of the arguments.
template <scalar T, class... Rest>
ABUT_HD constexpr auto in_a_row(const vec3<T>& first, const Rest&... rest) {
    row_of<T, 3 + ((std::same_as<Rest, T> ? 1 : 3) + ... + 0)> row{};
    T* end = append(row.value, first);
    ((end = append(end, rest)), ...);
    return row;
}

}  // namespace detail

namespace detail {

/// What a stage makes of what a predicate says, and what it says where it does not decide.
template <class Said>
struct stage_answer {
    ABUT_HD static constexpr Said of(const Said& said) { return said; }
    ABUT_HD static constexpr Said unknown() { return Said::unknown(); }
};
template <>
struct stage_answer<bool> {
    ABUT_HD static constexpr verdict of(bool said) { return to_verdict(said); }
    ABUT_HD static constexpr verdict unknown() { return verdict::unknown; }
};
template <class Predicate, std::size_t V>
using said_by = decltype(Predicate::holds(std::declval<const double (&)[V]>()));

}  // namespace detail

/// In integers of `L` limbs a degree. Coordinates of up to 64 L - 4 bits leave headroom: a sum of three products of
/// differences (a bit wider each) has degree 2 and at most 128 L - 4 bits, and it is down from there for higher degrees.
template <class Predicate, int L, std::size_t V>
ABUT_HD constexpr auto holds_in_limbs(const aligned<V>& x) {
    wide_int<L> value[V]{};
    for (int i = 0; i < int{V}; ++i) value[i] = x.template integer<L>(i);
    return Predicate::holds(value);
}

namespace detail {

/// Numbers as integers of one unit, below 2^59 in magnitude.
template <std::size_t V>
struct short_integers {
    std::int64_t at[V];
    std::uint64_t digits;  ///< those that are 1 in the magnitude of any
    bool exact;            ///< whether the numbers are such integers; else these are not they

    /// By their bits: each mantissa is moved to its place below that of the largest number.
    template <scalar T>
    ABUT_HD explicit constexpr short_integers(const T (&value)[V]) : at{}, digits{0}, exact{false} {
        using format = float_format<T>;
        using word = typename format::word;
        constexpr int fraction = format::digits - 1;
        word exponent[V]{}, most = 1;
        for (int i = 0; i < int{V}; ++i) {
            exponent[i] = static_cast<word>(ABUT_BIT_CAST(word, value[i]) << 1) >> (fraction + 1);
            most = exponent[i] > most ? exponent[i] : most;
        }
        std::uint64_t lost = 0;
        for (int i = 0; i < int{V}; ++i) {
            const auto bits = ABUT_BIT_CAST(word, value[i]);
            const word normal = exponent[i] != 0, below = most - exponent[i] - (1 - normal), down = below < 63 ? below : 63;
            const std::uint64_t mantissa = (bits & ((word{1} << fraction) - 1)) | normal << fraction;
            const std::uint64_t at_top = mantissa << (59 - format::digits), in_place = at_top >> down;
            lost |= in_place << down ^ at_top;
            digits |= in_place;
            const auto negative = -static_cast<std::int64_t>(bits >> (8 * static_cast<int>(sizeof(T)) - 1));
            at[i] = (static_cast<std::int64_t>(in_place) ^ negative) - negative;
        }
        exact = lost == 0;
    }

    /// How many zeros all of them end with.
    [[nodiscard]] ABUT_HD constexpr int zeros() const {
        return digits == 0 ? 0 : lowest_bit(static_cast<std::int64_t>(digits));
    }
    /// Whether so many digits are enough, without these zeros.
    [[nodiscard]] ABUT_HD constexpr bool fit(int count) const { return digits >> zeros() >> count == 0; }

    /// Takes the first point off all points: fewer digits remain where they are close to it.
    template <int Points>
    ABUT_HD constexpr void move_first_point_to_0() {
        digits = 0;
        for (int i = 3 * Points - 1; i >= 0; --i) at[i] -= at[i % 3];
        for (int i = 0; i < int{V}; ++i) digits |= static_cast<std::uint64_t>(at[i] < 0 ? -at[i] : at[i]);
    }
};

/// So many digits a coordinate keep all that is computed in words, and signs and comparisons of squares in two. Differences
/// are below E = 2^(digits + 1). Up to degree 4 nothing but sums of two products of differences, or of four products of
/// coordinates, is computed before; those stay below 2^63 with 30 digits. In degree 6 the largest number is a difference's
/// product with a vector of such sums: 6 E^3, below 2^63 with 19 digits.
///
/// A predicate that does not state its `degree`, as those of a user need not, is not asked in words: 0.
template <class Predicate>
inline constexpr int word_digits = 0;
template <class Predicate>
    requires requires { Predicate::degree; }
inline constexpr int word_digits<Predicate> = Predicate::degree <= 4 ? 30 : 19;

}  // namespace detail

/// The stage in registers: `unknown` only where the exponents span more than 124 bits. Not inlined: it is rarely reached,
/// and every kernel that decides would else be compiled with its thousands of instructions once more. Numbers that are few
/// digits apart need no wide integers.
template <class Predicate, scalar T, std::size_t V>
ABUT_NOINLINE ABUT_HD constexpr auto decide_in_limbs(const T (&value)[V]) {
    using answer = detail::stage_answer<detail::said_by<Predicate, V>>;
    constexpr int word_digits = detail::word_digits<Predicate>;
    detail::short_integers<V> x(value);
    if (!x.exact) {
        const aligned<V> wide(value);
        return wide.width() <= 124 ? answer::of(holds_in_limbs<Predicate, 2>(wide)) : answer::unknown();
    }
    if constexpr (word_digits > 0) {
        if (!x.fit(word_digits)) x.template move_first_point_to_0<Predicate::points>();
        if (x.fit(word_digits)) {
            const int zeros = x.zeros();
            for (std::int64_t& n : x.at) n >>= zeros;
            return answer::of(Predicate::holds(x.at));
        }
    }
    wide_int<1> limb[V]{};
    for (int i = 0; i < int{V}; ++i) limb[i] = wide_int<1>::shifted(x.at[i], 0);
    return answer::of(Predicate::holds(limb));
}

/// The last stage: any finite values, through sums that are never added up.
template <class Predicate, scalar T, std::size_t V>
ABUT_HD constexpr auto decide_at_any_span(const T (&value)[V]) {
    const aligned<V> x(value);
    sparse_sum<T, 1, 1> sum[V]{};
    for (int i = 0; i < int{V}; ++i) sum[i] = sparse_number<T>(x, i);
    return Predicate::holds(sum);
}

}  // namespace abut
