// SPDX-License-Identifier: MIT
#pragma once

// Does a triangle touch a capsule, that is: is it within the radius of the axis? The stages are those of
// sphere_triangle.hpp.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_capsule.hpp>
#include <abut/predicate/exact_capsule.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// The ends of the axis, the triangle's corners, and the radius.
template <scalar T>
ABUT_HD constexpr auto values_of(const capsule<T>& s, const triangle<T>& t) {
    return in_a_row(s.axis.a, s.axis.b, t.a, t.b, t.c, s.radius);
}

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle. A capsule has radius >= 0.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const capsule<T>& s, const triangle<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::capsule_meets_triangle>(detail::values_of(s, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified_capsule(s, t);
    } else {
        return to_verdict(detail::approximate_capsule(s, t));
    }
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const capsule<T>& s, const triangle<T>& t) {
    return decide_at_any_span<detail::capsule_meets_triangle>(detail::values_of(s, t).value);
}

}  // namespace abut
