// SPDX-License-Identifier: MIT
#pragma once

// The exact stages of any predicate whose polynomials have degree 6 or less. A predicate is a type with one function,
// `holds(const N (&value)[V]) -> bool`, written over a number type N with +, -, *, `sign_of_dot` and `squares_at_most`; the
// values are the coordinates (and radii) that it depends on, all of one unit.

#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut {

namespace detail {

/// Numbers in a row, as a predicate's `holds` takes them.
template <scalar T, int V>
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

/// In integers of `L` limbs a degree. Coordinates of up to 64 L - 4 bits leave headroom: a sum of three products of
/// differences (a bit wider each) has degree 2 and at most 128 L - 4 bits, and it is down from there for higher degrees.
template <class Predicate, int L, int V>
ABUT_HD constexpr bool holds_in_limbs(const aligned<V>& x) {
    wide_int<L> value[V]{};
    for (int i = 0; i < V; ++i) value[i] = x.template integer<L>(i);
    return Predicate::holds(value);
}

namespace detail {

/// The degree of a predicate that states it, or the highest.
template <class Predicate>
inline constexpr int degree_of = 6;
template <class Predicate>
    requires requires { Predicate::degree; }
inline constexpr int degree_of<Predicate> = Predicate::degree;

/// Coordinates of so many bits keep all values in 63 bits: a determinant is a sum of six products of differences.
template <class Predicate>
inline constexpr int word_bits = 60 / degree_of<Predicate> - 1;

}  // namespace detail

/// The stage in registers: `unknown` only where the exponents span more than 124 bits. Not inlined: it is rarely reached,
/// and every kernel that decides would else be compiled with its thousands of instructions once more. Numbers on a coarse
/// lattice need no wide integers.
template <class Predicate, scalar T, int V>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_in_limbs(const T (&value)[V]) {
    const aligned<V> x(value);
    if constexpr (detail::degree_of<Predicate> <= 3) {
        if (x.width() <= detail::word_bits<Predicate>) {
            std::int64_t word[V]{};
            for (int i = 0; i < V; ++i) word[i] = static_cast<std::int64_t>(x.template integer<1>(i).limb[0]);
            return to_verdict(Predicate::holds(word));
        }
    }
    if (x.width() <= 60) return to_verdict(holds_in_limbs<Predicate, 1>(x));
    if (x.width() <= 124) return to_verdict(holds_in_limbs<Predicate, 2>(x));
    return verdict::unknown;
}

/// The last stage: any finite values, through sums that are never added up.
template <class Predicate, scalar T, int V>
ABUT_HD constexpr bool decide_at_any_span(const T (&value)[V]) {
    const aligned<V> x(value);
    sparse_sum<T, 1, 1> sum[V]{};
    for (int i = 0; i < V; ++i) {
        const binary_parts& p = x.part[i];
        sum[i].term[0] = {wide_int<1>::shifted(p.mantissa, 0), p.mantissa == 0 ? 0 : p.exponent - x.low};
    }
    return Predicate::holds(sum);
}

}  // namespace abut
