// SPDX-License-Identifier: MIT
#pragma once

// The shapes that scenes are made of, as plain aggregates. All are closed point sets: touching counts as intersecting.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut {

/// The convex hull of three points; a degenerate one is the segment or the point that it spans.
template <scalar T>
struct triangle {
    vec3<T> a, b, c;
};

/// A solid ball. Radius 0 is a point; a negative radius is no sphere.
template <scalar T>
struct sphere {
    vec3<T> center;
    T radius;
};

/// The convex hull of two points; they may coincide.
template <scalar T>
struct segment {
    vec3<T> a, b;
};

/// A solid box with faces along the axes, lower <= upper in each coordinate.
template <scalar T>
struct aabb {
    vec3<T> lower, upper;
};

/// All x with normal . x == offset: a surface, and no half space. A normal of any length will do; with normal 0 it is
/// everything where offset is 0, and else nothing, as the equation says.
template <scalar T>
struct plane {
    vec3<T> normal;
    T offset;
};

/// All points within `radius` of a segment, which may have no length: a solid ball swept along it. Radius 0 is the segment
/// itself; a negative radius is no capsule.
template <scalar T>
struct capsule {
    segment<T> axis;
    T radius;
};

}  // namespace abut
