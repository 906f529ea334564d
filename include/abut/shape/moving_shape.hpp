// SPDX-License-Identifier: MIT
#pragma once

// Shapes in motion: each point of a shape moves in a straight line, at constant speed, from where it is at t = 0 to where it
// is at t = 1. `moving` makes one of two shapes; sets in motion are in shape/motion.hpp.

#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/shape.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// A shape that moves: point, segment or triangle, by its corners.
template <shape S>
struct motion {
    /// float or double
    using scalar_type = scalar_type_of<S>;
    S t0;  ///< where it is at t = 0
    S t1;  ///< where it is at t = 1
};

/// Around the shape at all times. Exact: a point in between is between.
template <shape S>
ABUT_HD constexpr aabb<scalar_type_of<S>> bounds(const motion<S>& m) {
    return merge(bounds(m.t0), bounds(m.t1));
}
/// Whether it is a shape at t = 0 and at t = 1.
template <shape S>
ABUT_HD constexpr bool is_valid(const motion<S>& m) {
    return is_valid(m.t0) && is_valid(m.t1);
}
/// The motion of the placed shape: both ends are placed.
template <placeable S>
ABUT_HD motion<placed_shape<S>> place(const rigid<scalar_type_of<S>>& pose, const motion<S>& m) {
    return {place(pose, m.t0), place(pose, m.t1)};
}

/// One shape in motion.
template <shape S>
[[nodiscard]] ABUT_HD constexpr motion<S> moving(const S& t0, const S& t1) {
    return {t0, t1};
}

///@}

}  // namespace abut
