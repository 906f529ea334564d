// SPDX-License-Identifier: MIT
#pragma once

// Do two shapes touch that have no face: points, segments, spheres and capsules? They are no farther apart than 0, and so
// the stages are those of `within`. Not for two spheres, and a sphere and a segment, which have stages of their own; nor for
// two points (aabb_aabb.hpp).

#include <concepts>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <class S>
inline constexpr bool has_point_or_axis = corners_of_core<S> == 1 || corners_of_core<S> == 2;

template <class S, class U>
inline constexpr bool has_own_stages = false;
template <scalar T>
inline constexpr bool has_own_stages<vec3<T>, vec3<T>> = true;
template <scalar T>
inline constexpr bool has_own_stages<sphere<T>, sphere<T>> = true;
template <scalar T>
inline constexpr bool has_own_stages<sphere<T>, segment<T>> = true;

/// With the core of fewer corners first.
template <class S, class U>
concept pair_without_faces = has_point_or_axis<S> && has_point_or_axis<U> && cores_in_order<S, U> && !has_own_stages<S, U> &&
                             std::same_as<scalar_type_of<S>, scalar_type_of<U>>;

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle.
template <arithmetic A, class S, class U>
    requires detail::pair_without_faces<S, U>
ABUT_HD constexpr verdict decide(const S& s, const U& t) {
    return detail::decide_within<A>(s, t, 0);
}

/// What the first stage left of two shapes with an axis: all features, in floating point.
template <arithmetic A, class S, class U>
    requires(detail::pair_without_faces<S, U> && detail::corners_of_core<S> == 2 && !std::same_as<A, exact>)
ABUT_HD constexpr verdict decide_late(const S& s, const U& t) {
    return detail::decide_within_late<A>(s, t, 0);
}

/// The last stage: decides every finite input.
template <class S, class U>
    requires detail::pair_without_faces<S, U>
ABUT_HD constexpr bool resolve(const S& s, const U& t) {
    return detail::resolve_within(s, t, 0);
}

}  // namespace abut
