// SPDX-License-Identifier: MIT
#pragma once

// The solid side of a plane, as a floor is. It has no box but all of space, so that it is an argument of queries against
// sets, and no body of a scene.

#include <abut/shape/plane.hpp>
#include <abut/shape/rigid.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// All x with normal . x <= offset: solid, and without end. The normal points out of it, and has any length but 0.
template <scalar T>
struct half_space {
    vec3<T> normal;  ///< of any length but 0
    T offset;        ///< in units of the normal's length times a coordinate

    friend constexpr bool operator==(const half_space&, const half_space&) = default;
};

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<half_space<T>>{"half space", "abut::shapes", 4};

/// The plane that a half space ends at.
template <scalar T>
ABUT_HD constexpr plane<T> surface_of(const half_space<T>& s) {
    return {s.normal, s.offset};
}

}  // namespace detail

/// All of space.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const half_space<T>& s) {
    return bounds(detail::surface_of(s));
}

/// That a number is not finite, or the normal 0.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const half_space<T>& s) {
    if (const shape_flaw flaw = flaw_of(detail::surface_of(s))) return flaw;
    const bool is_null = detail::is_zero(s.normal.x) && detail::is_zero(s.normal.y) && detail::is_zero(s.normal.z);
    return is_null ? shape_flaw{"the normal has no length", 0} : shape_flaw{};
}

/// The half space whose plane goes through where a pose puts points of the first one's, but for rounding: the normal is
/// turned, and each number is rounded as a placed point's is.
template <scalar T>
ABUT_HD constexpr half_space<T> place(const rigid<T>& pose, const half_space<T>& s) {
    rigid<T> turn = pose;
    turn.translation = {0, 0, 0};
    const vec3<T> n = place(turn, s.normal);
    return {n, detail::placed(n.x, n.y, n.z, pose.translation, s.offset)};
}

/// By the box's corner that is deepest.
template <scalar T>
ABUT_HD auto reach_of(const half_space<T>& s) {
    return detail::plane_reach<T, true>(detail::surface_of(s));
}

///@}

}  // namespace abut
