// SPDX-License-Identifier: MIT
#pragma once

// The cylinder as a shape. What is asked of it and of a cone alike is in predicate/revolution.hpp.

#include <abut/shape/capsule.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// All points within `radius` of a point of the axis, at right angles to it: a solid, with flat ends. An axis without length
/// is at right angles to every direction, which leaves the ball around it. Radius 0 is the axis itself; a negative radius is
/// no cylinder.
template <scalar T>
struct cylinder {
    segment<T> axis;  ///< from the centre of one end to that of the other
    T radius;         ///< 0 or more
};

/// Around the capsule that a cylinder is a part of: so the box holds also what `place` makes of the cylinder, whose axis may
/// turn where its ends are rounded. Much too large for a flat disc alone.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const cylinder<T>& s) {
    return bounds(capsule<T>{s.axis, s.radius});
}

/// By the ends of its axis; the radius stays, as of a ball.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr cylinder<T> place(const rigid<T>& pose, const cylinder<T>& s) {
    return {place(pose, s.axis), s.radius};
}

/// As of a ball.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const cylinder<T>& s) {
    return detail::flaw_of_round(s.radius, s.axis.a, s.axis.b);
}

template <scalar T>
inline constexpr detail::shape_name detail::name_of<cylinder<T>>{"cylinder", "abut::cylinders", 7};

/// By the line of its axis, with a slack for rounding.
template <scalar T>
ABUT_HD auto reach_of(const cylinder<T>& s) {
    return detail::swept_reach<T>(s.axis, s.radius, bounds(s));
}

///@}

}  // namespace abut
