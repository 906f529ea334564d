// SPDX-License-Identifier: MIT
#pragma once

// Does a solid capsule touch a solid box with faces along the axes, that is: is its axis within the radius of the box? The
// stages are those of `within`, with distance 0.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/aabb_segment.hpp>
#include <abut/predicate/certified_box_axis.hpp>
#include <abut/predicate/exact_box_axis.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// Shapes around a segment.
template <class S>
concept has_axis = (corners_of_core<S> == 2);

template <has_axis S>
ABUT_HD constexpr segment<scalar_type_of<S>> axis_of_core(const S& s) {
    const auto core = core_of(s);
    return {core.at[0], core.at[1]};
}

/// As exact_box_axis.hpp expects them, in double as those of two hulls.
template <scalar T, has_axis S>
ABUT_HD constexpr auto values_within(const aabb<T>& box, const S& s, double distance) {
    const auto widened_point = [](const vec3<T>& p) {
        return vec3<double>{widened_exactly(p.x), widened_exactly(p.y), widened_exactly(p.z)};
    };
    const segment<T> axis = axis_of_core(s);
    return in_a_row(widened_point(box.lower), widened_point(box.upper), widened_point(axis.a), widened_point(axis.b),
                    widened_exactly(radius_around_core(s)), distance);
}

template <bool Certified, scalar T, has_axis S>
ABUT_HD constexpr auto box_from_axis_of(const aabb<T>& box, const S& s, double distance) {
    const auto radius = radius_within<Certified>(box, s, distance);
    return box_from_axis<Certified, std::remove_const_t<decltype(radius)>>(box, axis_of_core(s), radius);
}

/// The first stage, in registers.
template <arithmetic A, scalar T, has_axis S>
ABUT_HD constexpr verdict decide_within(const aabb<T>& box, const S& s, double distance) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<box_within_axis>(values_within(box, s, distance).value);
    } else {
        return near_by_nearest(box_from_axis_of<std::same_as<A, filtered>>(box, s, distance));
    }
}

/// What that leaves: axes that meet the box, and pairs that nearly touch.
template <arithmetic A, scalar T, has_axis S>
    requires std::same_as<A, filtered>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_within_late(const aabb<T>& box, const S& s, double distance) {
    if (certified_box(box, axis_of_core(s)) == verdict::yes) return verdict::yes;
    return near_by_axes(box_from_axis_of<true>(box, s, distance));
}

/// The last one: decides every finite input.
template <scalar T, has_axis S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const aabb<T>& box, const S& s, double distance) {
    return decide_at_any_span<box_within_axis>(values_within(box, s, distance).value);
}

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle. A box has lower <= upper, and a capsule has radius >= 0.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const aabb<T>& box, const capsule<T>& s) {
    return detail::decide_within<A>(box, s, 0);
}

/// What the first stage left.
template <arithmetic A, scalar T>
    requires std::same_as<A, filtered>
ABUT_HD constexpr verdict decide_late(const aabb<T>& box, const capsule<T>& s) {
    return detail::decide_within_late<A>(box, s, 0);
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_HD constexpr bool resolve(const aabb<T>& box, const capsule<T>& s) {
    return detail::resolve_within(box, s, 0);
}

}  // namespace abut
