// SPDX-License-Identifier: MIT
#pragma once

// What a shape is made around: its core, which is the hull of some corners or a box, and how far around that it reaches. A
// ball is a point and a radius, a capsule a segment and a radius; triangles, segments, points and boxes are their own cores.
// Distances of shapes are those of their cores, less the radii. Not for how cores are measured: narrow/nearest_ways.hpp
// measures them in floating point, and predicate/exact_within.hpp compares them exactly.

#include <abut/shape/corners.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

/// How far around its core a shape reaches.
template <class S>
ABUT_HD constexpr scalar_type_of<S> radius_around_core(const S& s) {
    if constexpr (has_radius<S>) {
        return s.radius;
    } else {
        return 0;
    }
}

}  // namespace abut::detail
