// SPDX-License-Identifier: MIT
#pragma once

// Exact numbers for spans of exponents that no fixed width in registers covers: denormals beside the largest floats, up to
// 2098 bits in double. A value is kept as its terms, each a small integer times a power of two, and never added up;
// products multiply term by term. Only where a sign is asked for do the terms, of degree 2, 4 or 6 by then, go one after
// another into one long accumulator (Kulisch's). So a thread's stack holds one accumulator and not a dozen long integers.
// The loops are kept out of line: this is the rare path, and unrolled it would cost every caller registers and compile time.

#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut {

/// mantissa * 2^exponent, exponent >= 0, a product of `Degree` coordinates.
template <int Degree>
struct sparse_term {
    wide_int<Degree> mantissa;  ///< with its sign
    int exponent;               ///< of the power of two, 0 or more
};

/// The exact sum of `Terms` terms whose coordinates had type `T`.
template <scalar T, int Terms, int Degree>
struct sparse_sum {
    sparse_term<Degree> term[Terms];  ///< in any order; equal powers are not joined
};

namespace detail {

template <int D>
ABUT_NOINLINE ABUT_HD constexpr void copy_terms(const sparse_term<D>* a, int count, bool negated, sparse_term<D>* r) {
    for (int i = 0; i < count; ++i) r[i] = {negated ? -a[i].mantissa : a[i].mantissa, a[i].exponent};
}

/// Writes the terms of the product, with its sign changed where `negated`.
template <int D, int E>
ABUT_NOINLINE ABUT_HD constexpr void multiply_terms(const sparse_term<D>* a, int count_a, const sparse_term<E>* b,
                                                    int count_b, bool negated, sparse_term<D + E>* r) {
    for (int i = 0; i < count_a; ++i) {
        const wide_int<D> x = negated ? -a[i].mantissa : a[i].mantissa;
        for (int j = 0; j < count_b; ++j) *r++ = {x * b[j].mantissa, a[i].exponent + b[j].exponent};
    }
}

}  // namespace detail

/// Sum and difference of one degree: the terms of both.
///@{
template <scalar T, int K, int M, int D>
ABUT_HD constexpr sparse_sum<T, K + M, D> operator+(const sparse_sum<T, K, D>& a, const sparse_sum<T, M, D>& b) {
    sparse_sum<T, K + M, D> r;
    detail::copy_terms(a.term, K, false, r.term);
    detail::copy_terms(b.term, M, false, r.term + K);
    return r;
}

template <scalar T, int K, int M, int D>
ABUT_HD constexpr sparse_sum<T, K + M, D> operator-(const sparse_sum<T, K, D>& a, const sparse_sum<T, M, D>& b) {
    sparse_sum<T, K + M, D> r;
    detail::copy_terms(a.term, K, false, r.term);
    detail::copy_terms(b.term, M, true, r.term + K);
    return r;
}
///@}

/// The product: each term of one times each of the other.
template <scalar T, int K, int D, int M, int E>
ABUT_HD constexpr sparse_sum<T, K * M, D + E> operator*(const sparse_sum<T, K, D>& a, const sparse_sum<T, M, E>& b) {
    sparse_sum<T, K * M, D + E> r;
    detail::multiply_terms(a.term, K, b.term, M, false, r.term);
    return r;
}

// The general `dot` and `cross` of vec.hpp would do; these write their terms in place, without temporaries on the stack.

/// a . b
template <scalar T, int K, int D, int M, int E>
ABUT_HD constexpr auto dot(const vec3<sparse_sum<T, K, D>>& a, const vec3<sparse_sum<T, M, E>>& b) {
    sparse_sum<T, 3 * K * M, D + E> r;
    detail::multiply_terms(a.x.term, K, b.x.term, M, false, r.term);
    detail::multiply_terms(a.y.term, K, b.y.term, M, false, r.term + K * M);
    detail::multiply_terms(a.z.term, K, b.z.term, M, false, r.term + 2 * K * M);
    return r;
}

/// a x b
template <scalar T, int K, int D, int M, int E>
ABUT_HD constexpr auto cross(const vec3<sparse_sum<T, K, D>>& a, const vec3<sparse_sum<T, M, E>>& b) {
    vec3<sparse_sum<T, 2 * K * M, D + E>> r;
    detail::multiply_terms(a.y.term, K, b.z.term, M, false, r.x.term);
    detail::multiply_terms(a.z.term, K, b.y.term, M, true, r.x.term + K * M);
    detail::multiply_terms(a.z.term, K, b.x.term, M, false, r.y.term);
    detail::multiply_terms(a.x.term, K, b.z.term, M, true, r.y.term + K * M);
    detail::multiply_terms(a.x.term, K, b.y.term, M, false, r.z.term);
    detail::multiply_terms(a.y.term, K, b.x.term, M, true, r.z.term + K * M);
    return r;
}

/// A fixed-point sum of products of up to `Degree` coordinates of type `T`. Digits of 32 bits lie in 64-bit slots, so that
/// carries wait until the sign is asked for; 2^30 additions fit, and predicates make some thousands.
template <scalar T, int Degree>
class accumulator {
public:
    /// Adds `weight` (1 or -1) times the product.
    template <int K, int D, int M, int E>
    ABUT_HD constexpr void add_product(const sparse_sum<T, K, D>& a, const sparse_sum<T, M, E>& b, int weight) {
        static_assert(D + E <= Degree);
        add_products(a.term, K, b.term, M, weight);
    }

    /// Adds the terms of a sum.
    template <int K, int D>
    ABUT_HD constexpr void add_sum(const sparse_sum<T, K, D>& a) {
        static_assert(D <= Degree);
        for (int i = 0; i < K; ++i) add(a.term[i].mantissa, a.term[i].exponent, 1);
    }

    /// Adds `weight` (1 or -1) times a^2 or |a|^2.
    ///@{
    template <int K, int D>
    ABUT_HD constexpr void add_square(const sparse_sum<T, K, D>& a, int weight) {
        add_product(a, a, weight);
    }

    template <class N>
    ABUT_HD constexpr void add_square(const vec3<N>& a, int weight) {
        add_square(a.x, weight);
        add_square(a.y, weight);
        add_square(a.z, weight);
    }
    ///@}

    /// The sign of what has been added: -1, 0 or 1.
    ABUT_HD constexpr int sign() const {
        std::int64_t carry = 0;
        bool any = false;
        for (int k = 0; k < used_; ++k) {
            carry += digit_[k];
            any = any || (carry & 0xffffffff) != 0;
            carry >>= 32;
        }
        return carry < 0 ? -1 : carry > 0 || any;
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

    std::int64_t digit_[size];  // the lowest `used_` are set
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
