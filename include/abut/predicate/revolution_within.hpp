// SPDX-License-Identifier: MIT
#pragma once

// The stages of `within` for a cylinder or a cone and a point or a ball: whether the solid meets a ball that is larger by
// the distance. Its radius is that sum as it is: integers add it without rounding, and estimates know how far it is off. The
// questions are those of revolution.hpp. And for a plane, which has one of its own. Not for segments, triangles and boxes:
// how far those are from a rim takes polynomials of a higher degree.

#include <concepts>
#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/predicate/exact_revolution.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/outward.hpp>
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

/// A cylinder or a cone and a plane.
template <class S, class T>
concept revolution_over_planes = solid_of_revolution<S> && std::same_as<scalar_type_of<S>, T>;

template <scalar T, revolution_over_planes<T> S>
ABUT_HD constexpr auto values_within(const S& s, const plane<T>& p, double distance) {
    const auto exactly = [](const vec3<T>& v) {
        return vec3<double>{widened_exactly(v.x), widened_exactly(v.y), widened_exactly(v.z)};
    };
    const segment<T> axis = axis_of(s);
    return in_a_row(exactly(p.normal), widened_exactly(p.offset), 1.0, exactly(axis.a), exactly(axis.b),
                    widened_exactly(s.radius), distance);
}

/// As it is rounded: heights, and how much lower a rim reaches.
template <scalar T, revolution_over_planes<T> S>
ABUT_HD constexpr bool seems_within(const S& s, const plane<T>& p, T distance) {
    const segment<T> axis = axis_of(s);
    const T at_first = dot(p.normal, axis.a) - p.offset, at_last = dot(p.normal, axis.b) - p.offset;
    if ((at_first <= 0) != (at_last <= 0)) return true;
    const auto length_of = [](const vec3<T>& v) { return static_cast<T>(square_root(dot(widened(v), widened(v)))); };
    const T rim = s.radius * length_of(cross(p.normal, unit_frame<T>(axis).d)), gap = distance * length_of(p.normal);
    constexpr bool is_cone = questions_of<S>::type::is_cone;
    return absolute(at_last) <= rim + gap || absolute(at_first) <= (is_cone ? gap : rim + gap);
}

template <class S>
using asked_over_plane = plane_within_of_revolution<typename questions_of<S>::type>;

/// The first stage, as above. A capsule around the solid says no to most that are too far.
template <arithmetic A, scalar T, revolution_over_planes<T> S>
ABUT_HD constexpr verdict decide_within(const S& s, const plane<T>& p, double distance) {
    if (is_point(axis_of(s))) return decide_within<A>(p, ball_around(s), distance);
    if constexpr (std::same_as<A, exact>) {
        return ask_integers<asked_over_plane<S>>(values_within(s, p, distance).value);
    } else if constexpr (std::same_as<A, filtered>) {
        if (decide_within<filtered>(p, capsule_around(s), distance) == verdict::no) return verdict::no;
        return ask_estimates<asked_over_plane<S>>(values_within(s, p, distance).value);
    } else {
        return to_verdict(seems_within(s, p, static_cast<T>(distance)));
    }
}

/// The last one: decides every finite input.
template <scalar T, revolution_over_planes<T> S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const S& s, const plane<T>& p, double distance) {
    if (is_point(axis_of(s))) return resolve_within(p, ball_around(s), distance);
    return decide_at_any_length<asked_exactly<asked_over_plane<S>>>(values_within(s, p, distance).value);
}

}  // namespace abut::detail
