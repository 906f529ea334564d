// SPDX-License-Identifier: MIT
#pragma once

// The cone as a shape.

#include <abut/shape/segment.hpp>
#include <abut/shape/sphere.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// The hull of the apex and of a disc, the base, at right angles to the axis from the apex to the base's centre: a solid. An
/// axis without length leaves the ball around it, as of a cylinder. Radius 0 is the axis itself; a negative radius is no
/// cone.
template <scalar T>
struct cone {
    vec3<T> apex;         ///< its tip
    vec3<T> base_center;  ///< the base's centre
    T radius;             ///< of the base; 0 or more
};

/// Around the apex and a ball, which the base is a part of, since `place` may turn the axis.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const cone<T>& s) {
    return merge(bounds(s.apex), bounds(sphere<T>{s.base_center, s.radius}));
}

/// By the ends of its axis; the radius stays, as of a ball.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr cone<T> place(const rigid<T>& pose, const cone<T>& s) {
    return {place(pose, s.apex), place(pose, s.base_center), s.radius};
}

/// As of a ball.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const cone<T>& s) {
    return detail::flaw_of_round(s.radius, s.apex, s.base_center);
}

template <scalar T>
inline constexpr detail::shape_name detail::name_of<cone<T>>{"cone", "abut::cones", 7};

/// By the line of its axis, with a slack for rounding.
template <scalar T>
ABUT_HD auto reach_of(const cone<T>& s) {
    return detail::swept_reach<T>({s.apex, s.base_center}, s.radius, bounds(s));
}

///@}

}  // namespace abut
