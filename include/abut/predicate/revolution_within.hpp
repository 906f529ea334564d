// SPDX-License-Identifier: MIT
#pragma once

// The stages of `within` for a cylinder or a cone and a point or a ball: whether the solid meets a ball that is larger by
// the distance. Its radius is that sum as it is: integers add it without rounding, and estimates know how far it is off. The
// questions are those of revolution.hpp. Not for segments, triangles and boxes: how far those are from a rim takes
// polynomials of a higher degree.

#include <concepts>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/predicate/exact_revolution.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A cylinder or a cone, and a shape around a point.
template <class S, class U>
concept revolution_and_center = solid_of_revolution<S> && corners_of_core<U>
== 1 && std::same_as<scalar_type_of<S>, scalar_type_of<U>>;

/// As exact_revolution.hpp expects them, in double, as those of two hulls.
template <class S, class U>
requires revolution_and_center<S, U> ABUT_HD constexpr auto values_within(const S& s, const U& t, double distance) {
    const auto exactly = [](const auto& p) {
        return vec3<double>{widened_exactly(p.x), widened_exactly(p.y), widened_exactly(p.z)};
    };
    const auto axis = axis_of(s);
    return in_a_row(exactly(axis.a), exactly(axis.b), exactly(core_of(t).at[0]), widened_exactly(s.radius),
                    widened_exactly(radius_around_core(t)), distance);
}

template <class S>
using asked_within = revolution_within_of_ball<typename questions_of<S>::type>;

/// The first stage: in floating point; or of `exact` in integers, and unknown only where the exponents of all numbers span
/// more than 124 bits.
template <arithmetic A, class S, class U>
requires revolution_and_center<S, U> ABUT_HD constexpr verdict decide_within(const S& s, const U& t, double distance) {
    using T = scalar_type_of<S>;
    if (is_point(axis_of(s))) return decide_within<A>(ball_around(s), t, distance);
    if constexpr (std::same_as<A, exact>) {
        return ask_integers<asked_within<S>>(values_within(s, t, distance).value);
    } else if constexpr (std::same_as<A, filtered>) {
        return ask_estimates<asked_within<S>>(values_within(s, t, distance).value);
    } else {
        return decide<fast>(s, sphere<T>{core_of(t).at[0], radius_around_core(t) + static_cast<T>(distance)});
    }
}

/// The last one: decides every finite input.
template <class S, class U>
requires revolution_and_center<S, U> ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const S& s, const U& t,
                                                                                         double distance) {
    if (is_point(axis_of(s))) return resolve_within(ball_around(s), t, distance);
    return decide_at_any_length<asked_exactly<asked_within<S>>>(values_within(s, t, distance).value);
}

}  // namespace abut::detail
