// SPDX-License-Identifier: MIT
#pragma once

// Do two triangles touch? Each is closed, and the segment or the point that it spans where it is degenerate.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_triangles.hpp>
#include <abut/predicate/coarse_grid.hpp>
#include <abut/predicate/exact_triangles.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// As exact_triangles.hpp expects them.
template <scalar T>
ABUT_HD constexpr auto values_of(const triangle<T>& s, const triangle<T>& t) {
    return in_a_row(s.a, s.b, s.c, t.a, t.b, t.c);
}

template <class N, scalar T>
ABUT_HD constexpr three_points<N> corners_of(const triangle<T>& t) {
    const auto as_numbers = [](const vec3<T>& p) {
        return vec3<N>{static_cast<N>(p.x), static_cast<N>(p.y), static_cast<N>(p.z)};
    };
    return {{as_numbers(t.a), as_numbers(t.b), as_numbers(t.c)}};
}

/// Whether a corner of s is one of t's, as in faces that are neighbours. By their bits, since a processor may be told to
/// read other numbers as 0; so -0.0 and 0.0 differ here.
template <scalar T>
ABUT_HD constexpr bool share_a_corner(const triangle<T>& s, const triangle<T>& t) {
    using word = typename float_format<T>::word;
    const auto differing = [](T x, T y) { return ABUT_BIT_CAST(word, x) ^ ABUT_BIT_CAST(word, y); };
    const auto same = [differing](const vec3<T>& p, const vec3<T>& q) {
        return static_cast<unsigned>((differing(p.x, q.x) | differing(p.y, q.y) | differing(p.z, q.z)) == 0);
    };
    const auto among = [&t, same](const vec3<T>& p) { return same(p, t.a) | same(p, t.b) | same(p, t.c); };
    return (among(s.a) | among(s.b) | among(s.c)) != 0;  // no branch for each
}

/// The pairs that are dense in what no error bound decides, and cheap: `yes` where a corner is in common, and either where
/// all corners are on a coarse grid.
template <scalar T>
ABUT_HD constexpr verdict decide_ties(const triangle<T>& s, const triangle<T>& t) {
    if (share_a_corner(s, t)) return verdict::yes;
    if (!on_coarse_grid(s, t)) return verdict::unknown;
    return to_verdict(hulls_meet(corners_of<double>(s), corners_of<double>(t)));
}

}  // namespace detail

/// One stage of the decision. `fast` and `filtered` answer in general position: where no determinant came out as 0, or none
/// within its error bound. `exact` leaves `unknown` only spans of exponents beyond 124 bits.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const triangle<T>& s, const triangle<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::triangle_meets_triangle>(detail::values_of(s, t).value);
    } else {
        return detail::decide_in_general_position<std::same_as<A, filtered>>(s, t);
    }
}

/// `fast`, where a determinant came out as 0: degenerate, coplanar or touching input, in plain arithmetic. Always answers.
template <arithmetic A, scalar T>
    requires std::same_as<A, fast>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const triangle<T>& s, const triangle<T>& t) {
    return to_verdict(hulls_meet(detail::corners_of<T>(s), detail::corners_of<T>(t)));
}

/// `filtered`, where the first stage left the pair: for triangles with a corner in common, that are on a coarse grid, or in
/// float and decided in double.
template <arithmetic A, scalar T>
    requires std::same_as<A, filtered>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const triangle<T>& s, const triangle<T>& t) {
    const verdict v = detail::decide_ties(s, t);
    if constexpr (std::same_as<T, float>) {
        if (v == verdict::unknown) return detail::decide_widened(s, t, detail::values_of(s, t));
    }
    return v;
}

/// The last stage: decides every finite input, slowly and with a stack frame that docs/numerics.md states.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const triangle<T>& s, const triangle<T>& t) {
    return decide_at_any_span<detail::triangle_meets_triangle>(detail::values_of(s, t).value);
}

}  // namespace abut
