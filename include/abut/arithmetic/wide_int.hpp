// SPDX-License-Identifier: MIT
#pragma once

// Signed integers of a fixed number of 64-bit limbs, for exact predicates. A product is as wide as its factors together
// and a sum as wide as its terms, so a polynomial written over a number type grows its own widths: where the coordinates
// take L limbs, a value of degree d takes d*L. Nothing here allocates, rounds or heeds a compiler flag: integers know no
// contraction, no fast-math and no flush to zero. Not for long numbers: multiplication is the schoolbook's.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/two_words.hpp>
#include <abut/config.hpp>

namespace abut {

/// Integers of 128 bits: the compiler's, an extension of g++, clang and nvcc, or two words (arithmetic/two_words.hpp).
///@{
#if ABUT_INT128
__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;
#else
using int128 = detail::two_words<true>;
using uint128 = detail::two_words<false>;
#endif
///@}

namespace detail {

ABUT_HD constexpr std::uint64_t lower_limb(uint128 x) { return static_cast<std::uint64_t>(x); }
ABUT_HD constexpr std::uint64_t upper_limb(uint128 x) { return static_cast<std::uint64_t>(x >> 64); }
ABUT_HD constexpr std::uint64_t mask_if(bool wanted) { return wanted ? ~std::uint64_t{0} : std::uint64_t{0}; }

}  // namespace detail

/// Two's complement of `N` limbs, least significant first. Sums wrap: whoever adds leaves headroom for the carries.
template <int N>
struct wide_int {
    static_assert(N > 0);
    std::uint64_t limb[std::size_t{N}];  ///< least significant first

    /// value * 2^shift, for shift >= 0; the caller guarantees that it fits.
    ABUT_HD static constexpr wide_int shifted(std::int64_t value, int shift) {
        wide_int r{};
        if constexpr (N == 1) {
            r.limb[0] = static_cast<std::uint64_t>(value) << shift;
        } else {
            const uint128 bits = static_cast<uint128>(static_cast<int128>(value)) << (shift % 64);
            for (int i = 0; i < N; ++i) {
                const int k = i - shift / 64;
                r.limb[i] = k < 0    ? 0
                            : k == 0 ? detail::lower_limb(bits)
                            : k == 1 ? detail::upper_limb(bits)
                                     : detail::mask_if(value < 0);
            }
        }
        return r;
    }

    /// Whether it is below 0.
    ABUT_HD constexpr bool negative() const { return static_cast<std::int64_t>(limb[N - 1]) < 0; }
};

namespace detail {

/// a + b + carry, or with `Invert` a + ~b + carry: subtraction where the carry is 1.
template <bool Invert, int N>
ABUT_HD constexpr wide_int<N> add_limbs(const wide_int<N>& a, const wide_int<N>& b, std::uint64_t carry) {
    wide_int<N> r{};
    for (int i = 0; i < N; ++i) {
        const uint128 t = static_cast<uint128>(a.limb[i]) + (Invert ? ~b.limb[i] : b.limb[i]) + carry;
        r.limb[i] = lower_limb(t);
        carry = upper_limb(t);
    }
    return r;
}

/// r -= x * 2^(64 * From) where `wanted`, modulo the width of r.
template <int From, int N, int M>
ABUT_HD constexpr void subtract_if(bool wanted, wide_int<N>& r, const wide_int<M>& x) {
    static_assert(From + M == N);
    std::uint64_t borrow = 0;
    for (int i = 0; i < M; ++i) {
        const uint128 t = static_cast<uint128>(r.limb[From + i]) - (x.limb[i] & mask_if(wanted)) - borrow;
        r.limb[From + i] = lower_limb(t);
        borrow = upper_limb(t) & 1;
    }
}

}  // namespace detail

/// Sum and difference modulo 2^(64 N).
///@{
template <int N>
ABUT_HD constexpr wide_int<N> operator+(const wide_int<N>& a, const wide_int<N>& b) {
    return detail::add_limbs<false>(a, b, 0);
}

template <int N>
ABUT_HD constexpr wide_int<N> operator-(const wide_int<N>& a, const wide_int<N>& b) {
    return detail::add_limbs<true>(a, b, 1);
}
///@}

/// -a, modulo 2^(64 N).
template <int N>
ABUT_HD constexpr wide_int<N> operator-(const wide_int<N>& a) {
    return wide_int<N>{} - a;
}

/// The product, which always fits.
template <int N, int M>
ABUT_HD constexpr wide_int<N + M> operator*(const wide_int<N>& a, const wide_int<M>& b) {
    wide_int<N + M> r{};
    if constexpr (N == 1 && M == 1) {
        const auto x = static_cast<std::int64_t>(a.limb[0]), y = static_cast<std::int64_t>(b.limb[0]);
        const auto p = static_cast<uint128>(static_cast<int128>(x) * y);
        r.limb[0] = detail::lower_limb(p);
        r.limb[1] = detail::upper_limb(p);
    } else {
        for (int i = 0; i < N; ++i) {
            std::uint64_t carry = 0;
            for (int j = 0; j < M; ++j) {
                const uint128 t = static_cast<uint128>(a.limb[i]) * b.limb[j] + r.limb[i + j] + carry;
                r.limb[i + j] = detail::lower_limb(t);
                carry = detail::upper_limb(t);
            }
            r.limb[i + M] = carry;
        }
        // A negative factor was read as itself + 2^(64 * its limbs): take back what that added of the other factor.
        detail::subtract_if<N>(a.negative(), r, b);
        detail::subtract_if<M>(b.negative(), r, a);
    }
    return r;
}

template <int N>
ABUT_HD constexpr bool operator==(const wide_int<N>& a, const wide_int<N>& b) {
    std::uint64_t differing = 0;
    for (int i = 0; i < N; ++i) differing |= a.limb[i] ^ b.limb[i];
    return differing == 0;
}

/// -1, 0 or 1.
template <int N>
ABUT_HD constexpr int sign(const wide_int<N>& a) {
    std::uint64_t any = 0;
    for (int i = 0; i < N; ++i) any |= a.limb[i];
    return a.negative() ? -1 : any != 0;
}

// Where a predicate ends: the two questions that it asks of its polynomials. Each exact number type answers both.

/// The sign of a . b
template <int N, int M>
ABUT_HD constexpr int sign_of_dot(const vec3<wide_int<N>>& a, const vec3<wide_int<M>>& b) {
    return sign(dot(a, b));
}

/// a^2 or |a|^2
///@{
template <int N>
ABUT_HD constexpr wide_int<2 * N> square(const wide_int<N>& a) {
    return a * a;
}

template <int N>
ABUT_HD constexpr wide_int<2 * N> square(const vec3<wide_int<N>>& a) {
    return dot(a, a);
}
///@}

/// |a|^2 <= |b|^2, where a and b are numbers or vectors of one degree.
template <class A, class B>
ABUT_HD constexpr auto squares_at_most(const A& a, const B& b) -> decltype(sign(square(a) - square(b)) <= 0) {
    return sign(square(a) - square(b)) <= 0;
}

}  // namespace abut
