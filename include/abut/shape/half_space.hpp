// SPDX-License-Identifier: MIT
#pragma once

// The solid side of a plane, as a floor is. It has no box but all of space, so that it is an argument of queries against
// sets, and no body of a scene.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/reach.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/shape.hpp>

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

/// Numbers are finite, and the normal is not 0.
template <scalar T>
ABUT_HD constexpr bool is_valid(const half_space<T>& s) {
    const bool is_null = detail::is_zero(s.normal.x) && detail::is_zero(s.normal.y) && detail::is_zero(s.normal.z);
    return is_valid(detail::surface_of(s)) && !is_null;
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
