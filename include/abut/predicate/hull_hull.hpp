// SPDX-License-Identifier: MIT
#pragma once

// Does a convex hull touch another, or a point, a segment, a triangle or a solid box, which are hulls of their corners? The
// search of gjk.hpp in the numbers of hull_numbers.hpp.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/shape/hull.hpp>

namespace abut {

namespace detail {

template <bool Certified, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_in_floats(const hull<T>& a, const hull<T>& b) {
    difference_simplex at;
    vec3<typename hulls_in_floats<Certified, T>::number> w[4];
    return search_origin<sought::meeting>(hulls_in_floats<Certified, T>(a, b), at, w);
}

/// In integers whose differences have up to `Room` limbs; `unknown` where they need more.
template <int Room, bool Sifted, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_in_integers(const hull<T>& a, const hull<T>& b) {
    const unit_of_hulls<T> unit(a, b);
    if (unit.width() + spare_bits > 64 * Room) return verdict::unknown;
    difference_simplex at = guess_simplex<sought::meeting>(a, b);
    vec3<rolled_int<Room>> w[4];
    return search_origin<sought::meeting>(hulls_in_integers<Room, T, Sifted>(a, b, unit), at, w);
}

}  // namespace detail

/// One stage of the decision, as for two triangles: a hull, and a hull or another shape that is one of its corners. `exact`
/// is unknown only where the exponents span more than 124 bits.
template <arithmetic A, scalar T, detail::made_of_points<T> S>
ABUT_HD constexpr verdict decide(const hull<T>& a, const S& s) {
    const auto points = detail::points_of(s);
    const hull<T>& b = points.as_hull();
    if constexpr (std::same_as<A, exact>) {
        return detail::decide_in_integers<2, false>(a, b);
    } else {
        return detail::decide_in_floats<std::same_as<A, filtered>>(a, b);
    }
}

/// What the filter left, in integers, with points compared in double first.
template <arithmetic A, scalar T, detail::made_of_points<T> S>
requires std::same_as<A, filtered> ABUT_HD constexpr verdict decide_late(const hull<T>& a, const S& s) {
    const auto points = detail::points_of(s);
    return detail::decide_in_integers<2, true>(a, points.as_hull());
}

/// The last stage: decides every finite input.
template <scalar T, detail::made_of_points<T> S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const hull<T>& a, const S& s) {
    const auto points = detail::points_of(s);
    return detail::decide_in_integers<detail::limbs_of_any<T>, true>(a, points.as_hull()) == verdict::yes;
}

}  // namespace abut
