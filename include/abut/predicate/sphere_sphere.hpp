// SPDX-License-Identifier: MIT
#pragma once

// Do two solid spheres touch? The centres' distance against the sum of the radii, which is exact in the exact stages. The
// stages are those of sphere_triangle.hpp.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/exact_ball.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <scalar T>
ABUT_HD constexpr auto values_of(const sphere<T>& s, const sphere<T>& t) {
    return in_a_row(s.center, t.center, s.radius, t.radius);
}

}  // namespace detail

/// One stage of the decision, as for a triangle.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const sphere<T>& s, const sphere<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::ball_meets_ball>(detail::values_of(s, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        const double radii = detail::rounded(static_cast<double>(s.radius)) + detail::rounded(static_cast<double>(t.radius));
        return detail::certified_relative<T>(radii, detail::relative_to(s.center, t.center));
    } else {
        const vec3<T> d = t.center - s.center;
        const T r = s.radius + t.radius;
        return to_verdict(dot(d, d) <= r * r);
    }
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const sphere<T>& s, const sphere<T>& t) {
    return decide_at_any_span<detail::ball_meets_ball>(detail::values_of(s, t).value);
}

}  // namespace abut
