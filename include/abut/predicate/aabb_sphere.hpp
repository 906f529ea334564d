// SPDX-License-Identifier: MIT
#pragma once

// Does a solid sphere touch a solid box with faces along the axes? The box's point nearest to the centre has coordinates of
// the box or of the centre, and so no rounding: the question is that of two spheres, of which one has radius 0.

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/aabb_aabb.hpp>
#include <abut/predicate/sphere_sphere.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <scalar T>
ABUT_HD constexpr T clamped_by_bits(T x, T lower, T upper) {
    return at_most(x, lower) ? lower : at_most(upper, x) ? upper : x;
}

/// The box's point that is nearest to p. Exact, in every mode of the processor.
template <scalar T>
ABUT_HD constexpr vec3<T> nearest_in_box(const aabb<T>& box, const vec3<T>& p) {
    return {clamped_by_bits(p.x, box.lower.x, box.upper.x), clamped_by_bits(p.y, box.lower.y, box.upper.y),
            clamped_by_bits(p.z, box.lower.z, box.upper.z)};
}
template <scalar T>
ABUT_HD constexpr sphere<T> nearest_in_box(const aabb<T>& box, const sphere<T>& s) {
    return {nearest_in_box(box, s.center), T(0)};
}

}  // namespace detail

/// One stage of the decision, as for two spheres.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const aabb<T>& box, const sphere<T>& s) {
    const sphere<T> nearest = detail::nearest_in_box(box, s);
    const bool is_inside = detail::overlaps_by_bits(bounds(nearest.center), bounds(s.center));
    return is_inside ? verdict::yes : decide<A>(nearest, s);
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_HD constexpr bool resolve(const aabb<T>& box, const sphere<T>& s) {
    return resolve(detail::nearest_in_box(box, s), s);
}

}  // namespace abut
