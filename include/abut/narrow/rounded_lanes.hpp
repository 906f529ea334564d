// SPDX-License-Identifier: MIT
#pragma once

// One number, or four at a time, each of whose operations is rounded: four triangles, or four nodes of a tree, of which each
// gets the bits that it gets alone. On a device four one after another.

#include <cmath>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>

namespace abut::detail {

template <scalar T>
struct one_rounded {
    T value;

    ABUT_HD static one_rounded of(T x) { return {x}; }
    ABUT_HD friend one_rounded operator+(one_rounded a, one_rounded b) { return {plain_sum(a.value, b.value)}; }
    ABUT_HD friend one_rounded operator-(one_rounded a, one_rounded b) { return {plain_sum(a.value, -b.value)}; }
    ABUT_HD friend one_rounded operator*(one_rounded a, one_rounded b) { return {plain_product(a.value, b.value)}; }
    ABUT_HD friend one_rounded operator/(one_rounded a, one_rounded b) { return {a.value / b.value}; }
    ABUT_HD friend bool operator<(one_rounded a, one_rounded b) { return a.value < b.value; }
    ABUT_HD friend bool operator>(one_rounded a, one_rounded b) { return a.value > b.value; }
};
template <scalar T>
ABUT_HD one_rounded<T> select(bool answer, one_rounded<T> yes, one_rounded<T> no) {
    return answer ? yes : no;
}
template <scalar T>
ABUT_HD one_rounded<T> root(one_rounded<T> x) {
    return {std::sqrt(x.value)};
}

/// The register is a parameter as it is of lanes.
template <scalar T, class Register = typename register_of<T>::type>
struct four_rounded {
    using row = lanes<T, Register>;
    using mask = typename row::mask;
    row value;

    ABUT_INLINE ABUT_HD static four_rounded of(T x) { return {row::all(x)}; }
    ABUT_INLINE ABUT_HD static four_rounded of(T a, T b, T c, T d) { return {row::of(a, b, c, d)}; }
    ABUT_INLINE ABUT_HD static four_rounded load(const T* from) { return {row::load(from)}; }
    ABUT_INLINE ABUT_HD static four_rounded load_aligned(const T* from) { return {row::load_aligned(from)}; }

#if ABUT_VECTORS
    ABUT_INLINE friend four_rounded operator+(const four_rounded& a, const four_rounded& b) { return {a.value + b.value}; }
    ABUT_INLINE friend four_rounded operator-(const four_rounded& a, const four_rounded& b) { return {a.value - b.value}; }
    ABUT_INLINE friend four_rounded operator*(const four_rounded& a, const four_rounded& b) {
#if defined(__SSE2__) && !defined(__FMA__) && !defined(__FMA4__)
        return {a.value * b.value};  // there is no instruction that would contract it
#else
        return {rounded(a.value * b.value)};
#endif
    }
#else
    ABUT_INLINE ABUT_HD friend four_rounded operator+(four_rounded a, const four_rounded& b) {
        for (int k = 0; k < 4; ++k) a.value.at[k] = plain_sum(a.value.at[k], b.value.at[k]);
        return a;
    }
    ABUT_INLINE ABUT_HD friend four_rounded operator-(four_rounded a, const four_rounded& b) {
        for (int k = 0; k < 4; ++k) a.value.at[k] = plain_sum(a.value.at[k], -b.value.at[k]);
        return a;
    }
    ABUT_INLINE ABUT_HD friend four_rounded operator*(four_rounded a, const four_rounded& b) {
        for (int k = 0; k < 4; ++k) a.value.at[k] = plain_product(a.value.at[k], b.value.at[k]);
        return a;
    }
#endif
    ABUT_INLINE ABUT_HD friend four_rounded operator/(const four_rounded& a, const four_rounded& b) {
        return {a.value / b.value};
    }
    ABUT_INLINE ABUT_HD friend mask operator<(const four_rounded& a, const four_rounded& b) { return b.value > a.value; }
    ABUT_INLINE ABUT_HD friend mask operator<=(const four_rounded& a, const four_rounded& b) { return a.value <= b.value; }
    ABUT_INLINE ABUT_HD friend mask operator>(const four_rounded& a, const four_rounded& b) { return a.value > b.value; }
};

template <scalar T, class R>
ABUT_INLINE ABUT_HD four_rounded<T, R> absolute(const four_rounded<T, R>& x) {
    return {absolute(x.value)};
}
/// The first where the answer is yes.
///@{
template <scalar T, class R>
ABUT_INLINE ABUT_HD four_rounded<T, R> select(const typename four_rounded<T, R>::mask& answer, const four_rounded<T, R>& yes,
                                              const four_rounded<T, R>& no) {
    return {select(answer, yes.value, no.value)};
}
template <scalar T, class R>
ABUT_INLINE ABUT_HD vec3<four_rounded<T, R>> select(const typename four_rounded<T, R>::mask& answer,
                                                    const vec3<four_rounded<T, R>>& yes,
                                                    const vec3<four_rounded<T, R>>& no) {
    return {select(answer, yes.x, no.x), select(answer, yes.y, no.y), select(answer, yes.z, no.z)};
}
///@}

/// As of other vectors (arithmetic/vec.hpp), and where they stand: calls would keep registers in memory.
///@{
template <scalar T, class R>
ABUT_INLINE ABUT_HD vec3<four_rounded<T, R>> operator-(const vec3<four_rounded<T, R>>& a, const vec3<four_rounded<T, R>>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <scalar T, class R>
ABUT_INLINE ABUT_HD four_rounded<T, R> dot(const vec3<four_rounded<T, R>>& a, const vec3<four_rounded<T, R>>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <scalar T, class R>
ABUT_INLINE ABUT_HD vec3<four_rounded<T, R>> cross(const vec3<four_rounded<T, R>>& a, const vec3<four_rounded<T, R>>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
///@}

/// Of what is not negative.
template <scalar T, class R>
ABUT_INLINE ABUT_HD four_rounded<T, R> root(four_rounded<T, R> x) {
#if ABUT_VECTORS && defined(__SSE2__)
    for (auto& some : x.value.at) {
        if constexpr (std::same_as<T, float>) {
            some = __builtin_ia32_sqrtps(some);
        } else {
            some = __builtin_ia32_sqrtpd(some);
        }
    }
#else
    T four[4];
    x.value.store(four);
    for (T& one : four) one = std::sqrt(one);
    x = four_rounded<T, R>::load(four);
#endif
    return x;
}

/// To the nearest float.
ABUT_HD inline one_rounded<float> in_floats(one_rounded<double> x) { return {static_cast<float>(x.value)}; }
template <class R>
ABUT_INLINE ABUT_HD auto in_floats(const four_rounded<double, R>& x) {
#if ABUT_VECTORS
    typedef float two __attribute__((vector_size(8)));
    const two a = __builtin_convertvector(x.value.at[0], two), b = __builtin_convertvector(x.value.at[1], two);
    return four_rounded<float>::of(a[0], a[1], b[0], b[1]);
#else
    const auto& at = x.value.at;
    return four_rounded<float>::of(static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]),
                                   static_cast<float>(at[3]));
#endif
}
/// The same numbers.
template <class R>
ABUT_INLINE ABUT_HD auto in_doubles(const four_rounded<float, R>& x) {
#if ABUT_VECTORS
    typedef float two __attribute__((vector_size(8)));
    typedef ABUT_VECTOR_OF(double) wide;
    const auto& at = x.value.at[0];
    return four_rounded<double>{{__builtin_convertvector((two{at[0], at[1]}), wide),
                                 __builtin_convertvector((two{at[2], at[3]}), wide)}};
#else
    const auto& at = x.value.at;
    return four_rounded<double>::of(static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2]),
                                    static_cast<double>(at[3]));
#endif
}
template <class N>
ABUT_INLINE ABUT_HD auto in_floats(const vec3<N>& v) {
    return vec3<decltype(in_floats(v.x))>{in_floats(v.x), in_floats(v.y), in_floats(v.z)};
}

}  // namespace abut::detail
