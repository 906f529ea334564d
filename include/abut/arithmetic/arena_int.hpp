// SPDX-License-Identifier: MIT
#pragma once

// Integers whose length is known at run time, as in rolled_int.hpp, but whose limbs lie in an arena. Numbers of all lengths
// have one type, are handed on as pointers, and are given back by scopes. So a formula of a high degree is compiled once,
// and takes the limbs that it needs at a time. Where each number has room of its own, a kernel copies all of that room
// whenever one is returned: for degree 40 in double ptxas came to no end in ten minutes.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>

namespace abut::detail {

/// Limbs that are taken one after another, and given back in the opposite order.
struct limb_arena {
    std::uint64_t* limb;
    int room, used = 0;

    /// n limbs that are 0. To ask for more than there is room for is an error of the program, which ends.
    ABUT_NOINLINE ABUT_HD constexpr std::uint64_t* take(int n) {
        if (n > room - used) abut_trap();
        std::uint64_t* const first = limb + used;
        ABUT_ROLLED
        for (int i = 0; i < n; ++i) first[i] = 0;
        used += n;
        return first;
    }

private:
    ABUT_HD static void abut_trap() {
#if ABUT_DEVICE_CODE
        __trap();
#else
        ABUT_TRAP();
#endif
    }
};

/// Gives back what is taken after it is made, at its end.
class arena_scope {
public:
    ABUT_HD constexpr explicit arena_scope(limb_arena& in) : in_(in), before_(in.used) {}
    arena_scope(const arena_scope&) = delete;
    arena_scope& operator=(const arena_scope&) = delete;
    ABUT_HD constexpr ~arena_scope() { in_.used = before_; }

private:
    limb_arena& in_;
    int before_;
};

/// A number in two's complement, of `count` limbs in an arena, the least significant first; of none it is 0. It does not
/// change.
struct arena_int {
    const std::uint64_t* limb;
    limb_arena* in;
    int count;
};

/// -1, 0 or 1.
ABUT_NOINLINE ABUT_HD constexpr int sign(const arena_int& a) {
    if (a.count == 0) return 0;
    if (static_cast<std::int64_t>(a.limb[a.count - 1]) < 0) return -1;
    std::uint64_t any = 0;
    ABUT_ROLLED
    for (int i = 0; i < a.count; ++i) any |= a.limb[i];
    return any != 0 ? 1 : 0;
}

/// A sum in the making, in limbs of its own. It wraps: whoever sets the count leaves room for what is added.
class arena_sum {
public:
    ABUT_HD constexpr arena_sum(limb_arena& in, int count) : limb_(in.take(count)), in_(in), count_(count) {}
    /// Begins with a, or with a b.
    ///@{
    ABUT_HD constexpr explicit arena_sum(const arena_int& a) : arena_sum(*a.in, a.count) { add(a); }
    ABUT_HD constexpr arena_sum(const arena_int& a, const arena_int& b) : arena_sum(*a.in, a.count + b.count) { add(a, b); }
    ///@}
    arena_sum(const arena_sum&) = delete;
    arena_sum& operator=(const arena_sum&) = delete;

    ABUT_HD constexpr operator arena_int() const { return {limb_, &in_, count_}; }

    /// Adds or subtracts a, or a b.
    ///@{
    ABUT_NOINLINE ABUT_HD constexpr arena_sum& add(const arena_int& a, bool negated = false) {
        const std::uint64_t one = 1;
        if (a.count > 0) add_product(limb_, count_, &one, 1, a.limb, a.count, negated);
        return *this;
    }
    ABUT_NOINLINE ABUT_HD constexpr arena_sum& add(const arena_int& a, const arena_int& b, bool negated = false) {
        if (a.count > 0 && b.count > 0) add_product(limb_, count_, a.limb, a.count, b.limb, b.count, negated);
        return *this;
    }
    ///@}
    /// Adds `times` a b.
    ABUT_NOINLINE ABUT_HD constexpr arena_sum& add_times(int times, const arena_int& a, const arena_int& b) {
        if (a.count == 0) return *this;
        const arena_scope scope(in_);
        const auto factor = static_cast<std::uint64_t>(times < 0 ? -times : times);
        arena_sum more(in_, a.count + 1);
        add_product(more.limb_, more.count_, &factor, 1, a.limb, a.count, false);
        return add(more, b, times < 0);
    }
    /// Adds value 2^shift.
    ABUT_HD constexpr void add_shifted(std::int64_t value, int shift) {
        detail::add_shifted(limb_, count_, value, shift, false);
    }

private:
    std::uint64_t* limb_;
    limb_arena& in_;
    int count_;
};

// A product has the limbs of both factors, a sum those of its terms, which have one length.

ABUT_NOINLINE ABUT_HD constexpr arena_int operator*(const arena_int& a, const arena_int& b) { return arena_sum(a, b); }
ABUT_NOINLINE ABUT_HD constexpr arena_int operator-(const arena_int& a, const arena_int& b) {
    return arena_sum(a).add(b, true);
}
ABUT_NOINLINE ABUT_HD constexpr arena_int operator+(const arena_int& a, const arena_int& b) { return arena_sum(a).add(b); }

ABUT_NOINLINE ABUT_HD constexpr arena_int dot(const vec3<arena_int>& a, const vec3<arena_int>& b) {
    return arena_sum(a.x, b.x).add(a.y, b.y).add(a.z, b.z);
}

ABUT_NOINLINE ABUT_HD constexpr vec3<arena_int> cross(const vec3<arena_int>& a, const vec3<arena_int>& b) {
    return {arena_sum(a.y, b.z).add(a.z, b.y, true), arena_sum(a.z, b.x).add(a.x, b.z, true),
            arena_sum(a.x, b.y).add(a.y, b.x, true)};
}

/// s v
ABUT_NOINLINE ABUT_HD constexpr vec3<arena_int> scale(const arena_int& s, const vec3<arena_int>& v) {
    return {s * v.x, s * v.y, s * v.z};
}

/// a^2 or |a|^2
///@{
ABUT_HD constexpr arena_int square(const arena_int& a) { return a * a; }
ABUT_HD constexpr arena_int square(const vec3<arena_int>& a) { return dot(a, a); }
///@}

/// The i-th three numbers in a row, as a point.
template <std::size_t V>
ABUT_HD constexpr vec3<arena_int> point_at(const arena_int (&value)[V], int i) {
    return {value[3 * i], value[3 * i + 1], value[3 * i + 2]};
}

/// Whether Predicate::holds of numbers that span so many bits that `Limbs` limbs hold one, where Predicate::most_limbs is
/// how many such it takes at a time.
template <class Predicate, int Limbs, std::size_t V>
ABUT_NOINLINE ABUT_HD constexpr bool holds_in_arena(const aligned<V>& x) {
    std::uint64_t room[std::size_t{Predicate::most_limbs} * Limbs];  // taken where it is needed
    if (ABUT_CONSTANT_EVALUATED()) {
        for (std::uint64_t& limb : room) limb = 0;
    }
    const int width = x.width() > 0 ? x.width() : 0, limbs = (width + spare_bits_of_length + 63) / 64;
    limb_arena in{room, Predicate::most_limbs * Limbs};
    arena_int number[V]{};
    ABUT_ROLLED
    for (int i = 0; i < int{V}; ++i) {
        arena_sum one(in, limbs);
        const binary_parts& p = x.part[i];
        if (p.mantissa != 0) one.add_shifted(p.mantissa, p.exponent - x.low);
        number[i] = one;
    }
    return Predicate::holds(number);
}

/// As decide_at_short_length and decide_at_any_length in rolled_int.hpp.
///@{
template <class Predicate, scalar T, std::size_t V>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_in_short_arena(const T (&value)[V]) {
    const aligned<V> x(value);
    constexpr int limbs = 2;
    return x.width() <= 64 * limbs - spare_bits_of_length ? to_verdict(holds_in_arena<Predicate, limbs>(x))
                                                          : verdict::unknown;
}
template <class Predicate, scalar T, std::size_t V>
ABUT_NOINLINE ABUT_HD constexpr bool decide_in_arena(const T (&value)[V]) {
    using format = float_format<T>;
    constexpr int most = format::max_exponent + format::digits - format::min_exponent;
    return holds_in_arena<Predicate, (most + spare_bits_of_length + 63) / 64>(aligned<V>(value));
}
///@}

}  // namespace abut::detail
