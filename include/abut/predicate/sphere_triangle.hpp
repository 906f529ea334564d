// SPDX-License-Identifier: MIT
#pragma once

// Does a solid sphere touch a triangle or a segment? And, with radius 0, does a point lie on a triangle?

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/exact_ball.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <scalar T>
ABUT_HD constexpr auto values_of(const sphere<T>& s, const triangle<T>& t) {
    return in_a_row(s.center, t.a, t.b, t.c, s.radius);
}

template <scalar T>
ABUT_HD constexpr auto values_of(const sphere<T>& s, const segment<T>& t) {
    return in_a_row(s.center, t.a, t.b, s.radius);
}

}  // namespace detail

/// One stage of the decision. `fast` always answers, in the input's own type and without a promise; `filtered` answers
/// where its error bound allows; `exact` leaves `unknown` only spans of exponents beyond 124 bits. No stack to speak of.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const sphere<T>& s, const triangle<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::ball_meets_triangle>(detail::values_of(s, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified(s.center, s.radius, t.a, t.b, t.c);
    } else {
        return to_verdict(detail::approximate(s.radius, t.a - s.center, t.b - s.center, t.c - s.center));
    }
}

/// The last stage: decides every finite input, slowly and with a stack frame that docs/numerics.md states.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const sphere<T>& s, const triangle<T>& t) {
    return decide_at_any_span<detail::ball_meets_triangle>(detail::values_of(s, t).value);
}

/// One stage of the decision, as for a triangle.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const sphere<T>& s, const segment<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::ball_meets_segment>(detail::values_of(s, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified(s.center, s.radius, t.a, t.b);
    } else {
        return to_verdict(detail::approximate(s.radius, t.a - s.center, t.b - s.center));
    }
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const sphere<T>& s, const segment<T>& t) {
    return decide_at_any_span<detail::ball_meets_segment>(detail::values_of(s, t).value);
}

/// A point is a sphere of radius 0.
///@{
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const vec3<T>& p, const triangle<T>& t) {
    return decide<A>(sphere<T>{p, T(0)}, t);
}

template <scalar T>
ABUT_HD constexpr bool resolve(const vec3<T>& p, const triangle<T>& t) {
    return resolve(sphere<T>{p, T(0)}, t);
}
///@}

}  // namespace abut
