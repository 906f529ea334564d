// SPDX-License-Identifier: MIT
#pragma once

// The shapes that scenes are made of, as plain aggregates. All are closed point sets: touching counts as intersecting.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut {

/// @defgroup shapes Shapes and poses
///
/// The shapes that scenes are made of, as plain values, and the poses that move them. All are closed sets of points:
/// touching counts. Coordinates, radii and offsets are float or double, in a unit of length of the caller's. Functions here
/// allocate nothing and run on hosts and devices, unless they say otherwise.
///@{

/// The convex hull of three points; a degenerate one is the segment or the point that it spans.
template <scalar T>
struct triangle {
    vec3<T> a;  ///< first corner
    vec3<T> b;  ///< second
    vec3<T> c;  ///< third
};

/// A solid ball. Radius 0 is a point; a negative radius is no sphere.
template <scalar T>
struct sphere {
    vec3<T> center;  ///< finite
    T radius;        ///< 0 or more
};

/// The convex hull of two points; they may coincide.
template <scalar T>
struct segment {
    vec3<T> a;  ///< one end
    vec3<T> b;  ///< the other
};

/// A solid box with faces along the axes, lower <= upper in each coordinate.
template <scalar T>
struct aabb {
    vec3<T> lower;  ///< the corner with the least coordinates
    vec3<T> upper;  ///< the corner with the greatest
};

/// All x with normal . x == offset: a surface, and no half space. A normal of any length will do; with normal 0 it is
/// everything where offset is 0, and else nothing, as the equation says.
template <scalar T>
struct plane {
    vec3<T> normal;  ///< of any length
    T offset;        ///< in units of the normal's length times a coordinate
};

/// All points within `radius` of a segment, which may have no length: a solid ball swept along it. Radius 0 is the segment
/// itself; a negative radius is no capsule.
template <scalar T>
struct capsule {
    segment<T> axis;  ///< from the centre of one end to that of the other
    T radius;         ///< 0 or more
};

/// All points within `radius` of a point of the axis, at right angles to it: a solid, with flat ends. An axis without length is
/// at right angles to every direction, which leaves the ball around it. Radius 0 is the axis itself; a negative radius is
/// no cylinder.
template <scalar T>
struct cylinder {
    segment<T> axis;  ///< from the centre of one end to that of the other
    T radius;         ///< 0 or more
};

/// The hull of the apex and of a disc, the base, at right angles to the axis from the apex to the base's centre: a solid. An
/// axis without length leaves the ball around it, as of a cylinder. Radius 0 is the axis itself; a negative radius is no
/// cone.
template <scalar T>
struct cone {
    vec3<T> apex;         ///< its tip
    vec3<T> base_center;  ///< the base's centre
    T radius;             ///< of the base; 0 or more
};

/// All origin + t direction with t >= 0. The direction has any length; with direction 0 it is the point `origin`.
template <scalar T>
struct ray {
    vec3<T> origin;     ///< where it begins
    vec3<T> direction;  ///< of any length; t is measured in it
};

///@}

}  // namespace abut
