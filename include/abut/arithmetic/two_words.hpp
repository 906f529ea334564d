// SPDX-License-Identifier: MIT
#pragma once

// Integers of 128 bits in two words, for compilers and processors that have none of their own (ABUT_INT128). Two's
// complement, modulo 2^128, with as many operators as exact arithmetic needs. Others use the compiler's type: see
// arithmetic/wide_int.hpp, which names them.

#include <concepts>
#include <cstdint>

#include <abut/config.hpp>

namespace abut::detail {

template <bool Signed>
class two_words {
public:
    two_words() = default;
    /// A number of one word, continued by its sign.
    template <std::integral N>
    ABUT_HD constexpr two_words(N n) : low_(static_cast<std::uint64_t>(n)), high_(sign_of(n)) {}
    /// The same bits with a sign, or without.
    ABUT_HD explicit constexpr two_words(const two_words<!Signed>& n)
        : low_(static_cast<std::uint64_t>(n)), high_(static_cast<std::uint64_t>(n >> 64)) {}

    /// The lower word.
    ABUT_HD explicit constexpr operator std::uint64_t() const { return low_; }

    friend ABUT_HD constexpr two_words operator+(two_words a, two_words b) {
        const std::uint64_t low = a.low_ + b.low_;
        return two_words(low, a.high_ + b.high_ + (low < a.low_ ? 1 : 0));
    }
    friend ABUT_HD constexpr two_words operator-(two_words a, two_words b) {
        return two_words(a.low_ - b.low_, a.high_ - b.high_ - (a.low_ < b.low_ ? 1 : 0));
    }
    friend ABUT_HD constexpr two_words operator*(two_words a, two_words b) {
        const std::uint64_t half = 0xffffffff;
        const std::uint64_t a0 = a.low_ & half, a1 = a.low_ >> 32, b0 = b.low_ & half, b1 = b.low_ >> 32;
        const std::uint64_t least = a0 * b0, middle = a1 * b0 + (least >> 32), other = a0 * b1 + (middle & half);
        return two_words(other << 32 | (least & half),
                         a1 * b1 + (middle >> 32) + (other >> 32) + a.low_ * b.high_ + a.high_ * b.low_);
    }
    friend ABUT_HD constexpr two_words operator|(two_words a, two_words b) {
        return two_words(a.low_ | b.low_, a.high_ | b.high_);
    }
    friend ABUT_HD constexpr two_words operator&(two_words a, two_words b) {
        return two_words(a.low_ & b.low_, a.high_ & b.high_);
    }
    /// By 0 ... 127 bits.
    friend ABUT_HD constexpr two_words operator<<(two_words a, int bits) {
        if (bits == 0) return a;
        if (bits >= 64) return two_words(0, a.low_ << (bits - 64));
        return two_words(a.low_ << bits, a.high_ << bits | a.low_ >> (64 - bits));
    }
    /// By 0 ... 127 bits; a sign comes after.
    friend ABUT_HD constexpr two_words operator>>(two_words a, int bits) {
        if (bits == 0) return a;
        const bool negative = Signed && a.high_ >> 63 != 0;
        if (bits >= 64) return two_words(shifted(a.high_, bits - 64), negative ? ~std::uint64_t{0} : 0);
        return two_words(a.low_ >> bits | a.high_ << (64 - bits), shifted(a.high_, bits));
    }
    friend ABUT_HD constexpr two_words& operator+=(two_words& a, two_words b) { return a = a + b; }
    friend ABUT_HD constexpr two_words& operator-=(two_words& a, two_words b) { return a = a - b; }
    friend ABUT_HD constexpr two_words& operator>>=(two_words& a, int bits) { return a = a >> bits; }

    friend ABUT_HD constexpr bool operator==(two_words a, two_words b) { return a.low_ == b.low_ && a.high_ == b.high_; }
    friend ABUT_HD constexpr bool operator<(two_words a, two_words b) {
        // With the highest bit turned a sign counts for what it is.
        const std::uint64_t turn = Signed ? std::uint64_t{1} << 63 : 0;
        return a.high_ != b.high_ ? (a.high_ ^ turn) < (b.high_ ^ turn) : a.low_ < b.low_;
    }
    friend ABUT_HD constexpr bool operator>(two_words a, two_words b) { return b < a; }
    friend ABUT_HD constexpr bool operator<=(two_words a, two_words b) { return !(b < a); }
    friend ABUT_HD constexpr bool operator>=(two_words a, two_words b) { return !(a < b); }

private:
    ABUT_HD constexpr two_words(std::uint64_t low, std::uint64_t high) : low_(low), high_(high) {}
    /// All bits of a negative number's next word, and none of another's.
    template <std::integral N>
    ABUT_HD static constexpr std::uint64_t sign_of(N n) {
        if constexpr (std::signed_integral<N>) {
            return n < 0 ? ~std::uint64_t{0} : 0;
        } else {
            return 0;
        }
    }
    ABUT_HD static constexpr std::uint64_t shifted(std::uint64_t word, int bits) {
        return Signed ? static_cast<std::uint64_t>(static_cast<std::int64_t>(word) >> bits) : word >> bits;
    }

    std::uint64_t low_, high_;
};

}  // namespace abut::detail
