// SPDX-License-Identifier: MIT
#pragma once

// Do two triangles touch? Each is closed, and the segment or the point that it spans where it is degenerate.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_triangles.hpp>
#include <abut/predicate/exact_triangles.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// As exact_triangles.hpp expects them.
template <scalar T>
ABUT_HD constexpr auto values_of(const triangle<T>& s, const triangle<T>& t) {
    return in_a_row(s.a, s.b, s.c, t.a, t.b, t.c);
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
    return to_verdict(detail::triangle_meets_triangle::holds(detail::values_of(s, t).value));
}

/// `filtered` in float: once more in double, which decides what is in general position and not within an ulp of a double.
template <arithmetic A>
    requires std::same_as<A, filtered>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const triangle<float>& s, const triangle<float>& t) {
    return detail::decide_widened(s, t, detail::values_of(s, t));
}

/// The last stage: decides every finite input, slowly and with a stack frame that docs/numerics.md states.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const triangle<T>& s, const triangle<T>& t) {
    return decide_at_any_span<detail::triangle_meets_triangle>(detail::values_of(s, t).value);
}

}  // namespace abut
