// SPDX-License-Identifier: MIT
#pragma once

// Exact numbers for spans of exponents that no fixed width in registers covers: denormals beside the largest floats, up to
// 2098 bits in double. A value is kept as its terms, each an integer times a power of two; products multiply term by term.
// Terms that are few bits apart become one as they are written, so that a number has as many terms as its size and the
// spread of its exponents ask for. The long sum over all of them is made only where a sign is asked for, of degree 2, 4 or 6
// by then: in one accumulator (Kulisch's), so that a thread's stack holds one and not a dozen long integers. The loops are
// kept out of line: this is the rare path, and unrolled it would cost every caller registers and compile time.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut {

/// mantissa * 2^exponent, exponent >= 0, a product of `Degree` coordinates; |mantissa| <= 2^(64 Degree - 2).
template <int Degree>
struct sparse_term {
    wide_int<Degree> mantissa;  ///< with its sign
    int exponent;               ///< of the power of two, 0 or more
};

/// The exact sum of at most `Terms` terms, none of them 0, whose coordinates had type `T`.
template <scalar T, int Terms, int Degree>
struct sparse_sum {
    sparse_term<Degree> term[std::size_t{Terms}];  ///< in any order
    int count;                                     ///< how many of them there are
};

/// Number i, in the unit of all.
template <scalar T, std::size_t V>
ABUT_HD constexpr sparse_sum<T, 1, 1> sparse_number(const aligned<V>& x, int i) {
    const binary_parts& p = x.part[i];
    if (p.mantissa == 0) return {};
    return {{{wide_int<1>::shifted(p.mantissa, 0), p.exponent - x.low}}, 1};
}

namespace detail {

/// How far x may be shifted: x * 2^room(x) is at most 2^(64 D - 3) in magnitude, half of a term's limit.
template <int D>
ABUT_HD constexpr int room(const wide_int<D>& x) {
    const auto top = static_cast<std::int64_t>(x.limb[D - 1]), size = (top < 0 ? ~top : top) | 1;
    // The conversion may round up: then there is room for one bit less, and one less is said.
    return 61 - (static_cast<int>(ABUT_BIT_CAST(std::uint64_t, static_cast<double>(size)) >> 52) - 1022);
}

/// x * 2^shift, for 0 <= shift < 64.
template <int D>
ABUT_HD constexpr wide_int<D> moved_up(const wide_int<D>& x, int shift) {
    wide_int<D> r{};
    for (int i = 0; i < D; ++i) r.limb[i] = x.limb[i] << shift | (i > 0 && shift > 0 ? x.limb[i - 1] >> (64 - shift) : 0);
    return r;
}

/// Terms that come one after another. A term is added to one before it where both are few bits apart, so that numbers of
/// like size stay one term.
template <int D>
struct term_writer {
    sparse_term<D>* term;
    int count;

    ABUT_NOINLINE ABUT_HD constexpr void append(const wide_int<D>& mantissa, int exponent) {
        int k = 0;
        while (k < count && k < looked_at && !fits(term[k], mantissa, exponent)) ++k;
        if (k == count || k == looked_at) {
            term[count++] = {mantissa, exponent};
            return;
        }
        const int up = exponent - term[k].exponent;
        const wide_int<D> sum = moved_up(mantissa, up > 0 ? up : 0) + moved_up(term[k].mantissa, up < 0 ? -up : 0);
        term[k] = {sum, up < 0 ? exponent : term[k].exponent};
        if (abut::sign(sum) == 0) term[k] = term[--count];
    }

    /// Whether a number and a term, in the unit of the lesser exponent, are both at most half of a term's limit.
    ABUT_HD static constexpr bool fits(const sparse_term<D>& before, const wide_int<D>& mantissa, int exponent) {
        const int up = exponent - before.exponent, spare = room(mantissa), spare_before = room(before.mantissa);
        return up <= spare && -up <= spare_before && spare >= 0 && spare_before >= 0;
    }
    static constexpr int looked_at = 4;
};

/// Writes terms, with their signs changed where `negated`, behind `count` others. Returns how many there are then.
template <int D>
ABUT_NOINLINE ABUT_HD constexpr int copy_terms(const sparse_term<D>* a, int count_a, bool negated, sparse_term<D>* r,
                                               int count) {
    term_writer<D> out{r, count};
    for (int i = 0; i < count_a; ++i) out.append(negated ? -a[i].mantissa : a[i].mantissa, a[i].exponent);
    return out.count;
}

/// The same with the terms of a product.
template <int D, int E>
ABUT_NOINLINE ABUT_HD constexpr int multiply_terms(const sparse_term<D>* a, int count_a, const sparse_term<E>* b,
                                                   int count_b, bool negated, sparse_term<D + E>* r, int count) {
    term_writer<D + E> out{r, count};
    for (int i = 0; i < count_a; ++i) {
        const wide_int<D> x = negated ? -a[i].mantissa : a[i].mantissa;
        for (int j = 0; j < count_b; ++j) out.append(x * b[j].mantissa, a[i].exponent + b[j].exponent);
    }
    return out.count;
}

/// No terms. What is behind them is left as it is, but for constant expressions, which copy nothing that has no value.
template <scalar T, int K, int D>
ABUT_HD constexpr void clear(sparse_sum<T, K, D>& r) {
    if (ABUT_CONSTANT_EVALUATED()) r = {};
    r.count = 0;
}

template <scalar T, int K, int D, int M, int E, int R>
ABUT_HD constexpr void add_product(sparse_sum<T, R, D + E>& r, const sparse_sum<T, K, D>& a, const sparse_sum<T, M, E>& b,
                                   bool negated) {
    r.count = multiply_terms(a.term, a.count, b.term, b.count, negated, r.term, r.count);
}

}  // namespace detail

/// Sum and difference of one degree: the terms of both.
///@{
template <scalar T, int K, int M, int D>
ABUT_NOINLINE ABUT_HD constexpr sparse_sum<T, K + M, D> operator+(const sparse_sum<T, K, D>& a,
                                                                  const sparse_sum<T, M, D>& b) {
    sparse_sum<T, K + M, D> r;
    detail::clear(r);
    r.count = detail::copy_terms(a.term, a.count, false, r.term, 0);
    r.count = detail::copy_terms(b.term, b.count, false, r.term, r.count);
    return r;
}

template <scalar T, int K, int M, int D>
ABUT_NOINLINE ABUT_HD constexpr sparse_sum<T, K + M, D> operator-(const sparse_sum<T, K, D>& a,
                                                                  const sparse_sum<T, M, D>& b) {
    sparse_sum<T, K + M, D> r;
    detail::clear(r);
    r.count = detail::copy_terms(a.term, a.count, false, r.term, 0);
    r.count = detail::copy_terms(b.term, b.count, true, r.term, r.count);
    return r;
}
///@}

/// The product: each term of one times each of the other.
template <scalar T, int K, int D, int M, int E>
ABUT_HD constexpr sparse_sum<T, K * M, D + E> operator*(const sparse_sum<T, K, D>& a, const sparse_sum<T, M, E>& b) {
    sparse_sum<T, K * M, D + E> r;
    detail::clear(r);
    detail::add_product(r, a, b, false);
    return r;
}

// The general `dot` and `cross` of vec.hpp would do; these write their terms in place, without temporaries on the stack.

/// a . b
template <scalar T, int K, int D, int M, int E>
ABUT_NOINLINE ABUT_HD constexpr auto dot(const vec3<sparse_sum<T, K, D>>& a, const vec3<sparse_sum<T, M, E>>& b) {
    sparse_sum<T, 3 * K * M, D + E> r;
    detail::clear(r);
    detail::add_product(r, a.x, b.x, false);
    detail::add_product(r, a.y, b.y, false);
    detail::add_product(r, a.z, b.z, false);
    return r;
}

/// a x b
template <scalar T, int K, int D, int M, int E>
ABUT_NOINLINE ABUT_HD constexpr auto cross(const vec3<sparse_sum<T, K, D>>& a, const vec3<sparse_sum<T, M, E>>& b) {
    vec3<sparse_sum<T, 2 * K * M, D + E>> r;
    detail::clear(r.x), detail::clear(r.y), detail::clear(r.z);
    detail::add_product(r.x, a.y, b.z, false);
    detail::add_product(r.x, a.z, b.y, true);
    detail::add_product(r.y, a.z, b.x, false);
    detail::add_product(r.y, a.x, b.z, true);
    detail::add_product(r.z, a.x, b.y, false);
    detail::add_product(r.z, a.y, b.x, true);
    return r;
}

/// A fixed-point sum of products of up to `Degree` coordinates of type `T`. Digits of 32 bits lie in 64-bit slots, so that
/// carries wait until the sign is asked for. A term adds less than 2^34 to a slot, so that 2^27 terms stay below 2^61;
/// predicates add some thousands.
template <scalar T, int Degree>
class accumulator {
public:
    /// Adds `weight` (1 or -1) times the product.
    template <int K, int D, int M, int E>
    ABUT_HD constexpr void add_product(const sparse_sum<T, K, D>& a, const sparse_sum<T, M, E>& b, int weight) {
        static_assert(D + E <= Degree);
        add_products(a.term, a.count, b.term, b.count, weight);
    }

    /// Adds the terms of a sum.
    template <int K, int D>
    ABUT_HD constexpr void add_sum(const sparse_sum<T, K, D>& a) {
        static_assert(D <= Degree);
        for (int i = 0; i < a.count; ++i) add(a.term[i].mantissa, a.term[i].exponent, 1);
    }

    /// Adds `weight` (1 or -1) times a^2 or |a|^2.
    ///@{
    template <int K, int D>
    ABUT_HD constexpr void add_square(const sparse_sum<T, K, D>& a, int weight) {
        add_squares(a.term, a.count, weight);
    }

    template <class N>
    ABUT_HD constexpr void add_square(const vec3<N>& a, int weight) {
        add_square(a.x, weight);
        add_square(a.y, weight);
        add_square(a.z, weight);
    }
    ///@}

    /// The sign of what has been added: -1, 0 or 1. From the top: all digits below one add up to less than 2^30 of its
    /// units, since none exceeds 2^61.
    ABUT_HD constexpr int sign() const {
        constexpr std::int64_t enough = std::int64_t{1} << 30;
        std::int64_t sum = 0;
        for (int k = used_ - 1; k >= 0 && sum < enough && sum > -enough; --k)
            sum = sum * (std::int64_t{1} << 32) + digit_[k];
        return (sum > 0) - (sum < 0);
    }

private:
    using format = detail::float_format<T>;
    // The highest first digit, and behind it the product's own digits and one for the shift.
    static constexpr int size =
        Degree * (format::max_exponent - format::min_exponent + format::digits) / 32 + 2 * Degree + 2;

    template <int D, int E>
    ABUT_NOINLINE ABUT_HD constexpr void add_products(const sparse_term<D>* a, int count_a, const sparse_term<E>* b,
                                                      int count_b, int weight) {
        for (int i = 0; i < count_a; ++i) {
            for (int j = 0; j < count_b; ++j) add(a[i].mantissa * b[j].mantissa, a[i].exponent + b[j].exponent, weight);
        }
    }

    template <int D>
    ABUT_NOINLINE ABUT_HD constexpr void add_squares(const sparse_term<D>* a, int count, int weight) {
        for (int i = 0; i < count; ++i) {
            for (int j = 0; j <= i; ++j) {
                add(a[i].mantissa * a[j].mantissa, a[i].exponent + a[j].exponent, j < i ? 2 * weight : weight);
            }
        }
    }

    template <int N>
    ABUT_HD constexpr void add(const wide_int<N>& x, int exponent, int weight) {
        const int first = exponent / 32, shift = exponent % 32;
        for (; used_ <= first + 2 * N; ++used_) digit_[used_] = 0;
        for (int k = 0; k < 2 * N; ++k) {
            const auto half = static_cast<std::int64_t>(x.limb[k / 2] << (k % 2 == 0 ? 32 : 0)) >> 32;
            const auto digit = k == 2 * N - 1 ? half : half & 0xffffffff;  // the uppermost carries the sign
            const auto moved = digit * (std::int64_t{1} << shift);
            digit_[first + k] += weight * (moved & 0xffffffff);
            digit_[first + k + 1] += weight * (moved >> 32);
        }
    }

    std::int64_t digit_[std::size_t{size}];  // the lowest `used_` are set
    int used_ = 0;
};

/// -1, 0 or 1.
template <scalar T, int K, int D>
ABUT_NOINLINE ABUT_HD constexpr int sign(const sparse_sum<T, K, D>& a) {
    accumulator<T, D> sum;
    sum.add_sum(a);
    return sum.sign();
}

/// The sign of a . b
template <scalar T, int K, int D, int M, int E>
ABUT_NOINLINE ABUT_HD constexpr int sign_of_dot(const vec3<sparse_sum<T, K, D>>& a, const vec3<sparse_sum<T, M, E>>& b) {
    accumulator<T, D + E> sum;
    sum.add_product(a.x, b.x, 1);
    sum.add_product(a.y, b.y, 1);
    sum.add_product(a.z, b.z, 1);
    return sum.sign();
}

namespace detail {

template <scalar T, int Degree, class A, class B>
ABUT_NOINLINE ABUT_HD constexpr bool sparse_squares_at_most(const A& a, const B& b) {
    accumulator<T, 2 * Degree> sum;
    sum.add_square(a, 1);
    sum.add_square(b, -1);
    return sum.sign() <= 0;
}

}  // namespace detail

/// |a|^2 <= |b|^2, where a and b are numbers or vectors of one degree.
///@{
template <scalar T, int K, int M, int D>
ABUT_HD constexpr bool squares_at_most(const vec3<sparse_sum<T, K, D>>& a, const sparse_sum<T, M, D>& b) {
    return detail::sparse_squares_at_most<T, D>(a, b);
}

template <scalar T, int K, int M, int D>
ABUT_HD constexpr bool squares_at_most(const sparse_sum<T, K, D>& a, const vec3<sparse_sum<T, M, D>>& b) {
    return detail::sparse_squares_at_most<T, D>(a, b);
}

template <scalar T, int K, int M, int D>
ABUT_HD constexpr bool squares_at_most(const vec3<sparse_sum<T, K, D>>& a, const vec3<sparse_sum<T, M, D>>& b) {
    return detail::sparse_squares_at_most<T, D>(a, b);
}
///@}

}  // namespace abut
