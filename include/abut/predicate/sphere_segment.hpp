// SPDX-License-Identifier: MIT
#pragma once

// Does a solid sphere touch a segment? The stages are those of sphere_triangle.hpp.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/exact_ball.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <scalar T>
ABUT_HD constexpr auto values_of(const sphere<T>& s, const segment<T>& t) {
    return in_a_row(s.center, t.a, t.b, s.radius);
}

}  // namespace detail

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

}  // namespace abut
