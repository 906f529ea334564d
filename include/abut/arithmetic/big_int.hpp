// SPDX-License-Identifier: MIT
#pragma once

// Integers of any length, for the last word on questions whose numbers have no bound that is known beforehand. On hosts
// alone: they allocate. Not for long numbers: multiplication is the schoolbook's.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut::detail {

/// Limbs in a row. Most numbers are short: those do not allocate.
class limb_row {
public:
    limb_row() = default;
    limb_row(const limb_row& other) { assign(other); }
    limb_row(limb_row&& other) noexcept { take(other); }
    limb_row& operator=(const limb_row& other) {
        if (this != &other) assign(other);
        return *this;
    }
    limb_row& operator=(limb_row&& other) noexcept {
        if (this != &other) take(other);
        return *this;
    }
    ~limb_row() = default;

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    std::uint64_t& operator[](std::size_t i) { return data()[i]; }
    std::uint64_t operator[](std::size_t i) const { return data()[i]; }
    [[nodiscard]] std::uint64_t back() const { return data()[size_ - 1]; }
    void pop_back() { --size_; }
    /// So many zeros.
    void set_zero(std::size_t n) {
        make_room(n);
        size_ = n;
        std::fill_n(data(), n, std::uint64_t{0});
    }

private:
    static constexpr std::size_t most_near = 10;

    [[nodiscard]] std::uint64_t* data() { return far_ ? far_.get() : near_; }
    [[nodiscard]] const std::uint64_t* data() const { return far_ ? far_.get() : near_; }
    void make_room(std::size_t n) {
        if (n <= room_) return;
        far_ = std::make_unique<std::uint64_t[]>(n);
        room_ = n;
    }
    void assign(const limb_row& other) {
        make_room(other.size_);
        size_ = other.size_;
        std::copy_n(other.data(), size_, data());
    }
    void take(limb_row& other) noexcept {
        size_ = std::exchange(other.size_, 0);
        room_ = std::exchange(other.room_, most_near);
        far_ = std::move(other.far_);
        if (!far_) std::copy_n(other.near_, size_, near_);
    }

    std::size_t size_ = 0, room_ = most_near;
    std::uint64_t near_[most_near];
    std::unique_ptr<std::uint64_t[]> far_;
};

/// Sign and magnitude; of the magnitude the least significant limb comes first, and the last one is not 0.
class big_int {
public:
    big_int() = default;
    /// value * 2^shift, for shift >= 0.
    explicit big_int(std::int64_t value, int shift = 0) : negative_(value < 0) {
        if (value == 0) return;
        const auto magnitude = value < 0 ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
        limbs_.set_zero(1);
        limbs_[0] = magnitude;
        *this = *this << shift;
    }

    /// -1, 0 or 1.
    [[nodiscard]] int sign() const { return limbs_.empty() ? 0 : negative_ ? -1 : 1; }
    /// Bits of the magnitude.
    [[nodiscard]] int bits() const {
        return limbs_.empty() ? 0 : 64 * (static_cast<int>(limbs_.size()) - 1) + bits_up_to(limbs_.back());
    }
    /// The largest integer that is not above the number divided by 2^shift, if the number is not negative and the result is
    /// below 2^63.
    [[nodiscard]] std::int64_t shifted_down(int shift) const {
        const auto whole = static_cast<std::size_t>(shift / 64);
        uint128 word = 0;
        for (std::size_t i = whole + 2; i-- > whole;) word = word << 64 | (i < limbs_.size() ? limbs_[i] : 0);
        return static_cast<std::int64_t>(lower_limb(word >> shift % 64));
    }
    /// The number divided by 2^shift, where its first 64 bits are all that is kept.
    [[nodiscard]] double scaled(int shift) const {
        double value = 0;
        const std::size_t n = limbs_.size();
        for (std::size_t i = n; i > 0 && i + 2 > n; --i) {
            value += std::ldexp(static_cast<double>(limbs_[i - 1]), 64 * static_cast<int>(i - 1) - shift);
        }
        return negative_ ? -value : value;
    }

    friend big_int operator-(big_int a) {
        a.negative_ = !a.negative_;
        return a;
    }
    friend big_int operator+(const big_int& a, const big_int& b) { return sum(a, b, b.negative_); }
    friend big_int operator-(const big_int& a, const big_int& b) { return sum(a, b, !b.negative_); }
    friend big_int operator*(const big_int& a, const big_int& b) {
        big_int r;
        if (a.limbs_.empty() || b.limbs_.empty()) return r;
        r.negative_ = a.negative_ != b.negative_;
        r.limbs_.set_zero(a.limbs_.size() + b.limbs_.size());
        for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
            std::uint64_t carry = 0;
            for (std::size_t j = 0; j < b.limbs_.size(); ++j) {
                const uint128 t = static_cast<uint128>(a.limbs_[i]) * b.limbs_[j] + r.limbs_[i + j] + carry;
                r.limbs_[i + j] = lower_limb(t);
                carry = upper_limb(t);
            }
            r.limbs_[i + b.limbs_.size()] = carry;
        }
        r.trim();
        return r;
    }
    friend big_int operator<<(const big_int& a, int shift) {
        if (a.limbs_.empty() || shift == 0) return a;
        big_int r;
        r.negative_ = a.negative_;
        const auto whole = static_cast<std::size_t>(shift / 64);
        const int part = shift % 64;
        r.limbs_.set_zero(whole + a.limbs_.size() + 1);
        for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
            const uint128 moved = static_cast<uint128>(a.limbs_[i]) << part;
            r.limbs_[whole + i] |= lower_limb(moved);
            r.limbs_[whole + i + 1] = upper_limb(moved);
        }
        r.trim();
        return r;
    }

private:
    void trim() {
        while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
    }
    static bool is_less(const limb_row& a, const limb_row& b) {
        if (a.size() != b.size()) return a.size() < b.size();
        std::size_t i = a.size();
        while (i > 0 && a[i - 1] == b[i - 1]) --i;
        return i > 0 && a[i - 1] < b[i - 1];
    }
    /// a + b, where b counts as negative or not.
    static big_int sum(const big_int& a, const big_int& b, bool b_negative) {
        big_int r;
        const bool less = is_less(a.limbs_, b.limbs_);
        const auto &more = less ? b.limbs_ : a.limbs_, &fewer = less ? a.limbs_ : b.limbs_;
        r.negative_ = less ? b_negative : a.negative_;
        const bool adds = a.negative_ == b_negative;
        r.limbs_.set_zero(more.size() + 1);
        std::uint64_t carry = 0;
        for (std::size_t i = 0; i < more.size(); ++i) {
            const std::uint64_t other = i < fewer.size() ? fewer[i] : 0;
            const uint128 x = more[i], t = adds ? x + other + carry : x - other - carry;
            r.limbs_[i] = lower_limb(t);
            carry = upper_limb(t) & 1;
        }
        r.limbs_[more.size()] = adds ? carry : 0;
        r.trim();
        return r;
    }

    limb_row limbs_;
    bool negative_ = false;
};

}  // namespace abut::detail
