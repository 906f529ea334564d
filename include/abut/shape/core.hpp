// SPDX-License-Identifier: MIT
#pragma once

// What a shape is made around: its core, which is the hull of some corners or a box, and how far around that it reaches. A
// ball is a point and a radius, a capsule a segment and a radius; triangles, segments, points and boxes are their own cores.
// Distances of shapes are those of their cores, less the radii. Not for how cores are measured: narrow/nearest_ways.hpp
// measures them in floating point, and predicate/exact_within.hpp compares them exactly.

#include <cstddef>
#include <utility>

#include <abut/arithmetic/vec.hpp>
#include <abut/shape/corners.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

/// A hull of corners. A triangle, a segment or a point.
template <scalar T, int N>
struct corner_hull {
    static constexpr int corners = N, edges = N == 3 ? 3 : N - 1;
    vec3<T> at[std::size_t{N}];
};
template <scalar T>
ABUT_HD constexpr corner_hull<T, 3> hull_of(const triangle<T>& t) {
    return {{t.a, t.b, t.c}};
}
template <scalar T>
ABUT_HD constexpr corner_hull<T, 2> hull_of(const segment<T>& s) {
    return {{s.a, s.b}};
}
template <scalar T>
ABUT_HD constexpr corner_hull<T, 1> hull_of(const vec3<T>& p) {
    return {{p}};
}

template <has_corners S>
ABUT_HD constexpr auto core_of(const S& s) {
    return hull_of(s);
}
template <scalar T>
ABUT_HD constexpr auto core_of(const sphere<T>& s) {
    return hull_of(s.center);
}
template <scalar T>
ABUT_HD constexpr auto core_of(const capsule<T>& s) {
    return hull_of(s.axis);
}
template <scalar T>
ABUT_HD constexpr aabb<T> core_of(const aabb<T>& s) {
    return s;
}

/// The corners of a core that is a hull of some.
template <class S>
inline constexpr int corners_of_core = 0;
template <class S>
    requires requires(const S& s) { decltype(core_of(s))::corners; }
inline constexpr int corners_of_core<S> = decltype(core_of(std::declval<const S&>()))::corners;

/// How far around its core a shape reaches.
template <class S>
ABUT_HD constexpr scalar_type_of<S> radius_around_core(const S& s) {
    if constexpr (requires { s.radius; }) {
        return s.radius;
    } else {
        return 0;
    }
}

}  // namespace abut::detail
