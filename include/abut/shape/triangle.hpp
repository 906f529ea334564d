// SPDX-License-Identifier: MIT
#pragma once

// The triangle as a shape: of a mesh, of a soup, or alone.

#include <abut/shape/aabb.hpp>
#include <abut/shape/form.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// The convex hull of three points; a degenerate one is the segment or the point that it spans.
template <scalar T>
struct triangle {
    vec3<T> a;  ///< first corner
    vec3<T> b;  ///< second
    vec3<T> c;  ///< third
};

/// The smallest box around a triangle. Exact.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const triangle<T>& t) {
    return {detail::least(detail::least(t.a, t.b), t.c), detail::greatest(detail::greatest(t.a, t.b), t.c)};
}

/// By its corners.
template <scalar T>
ABUT_HD constexpr triangle<T> place(const rigid<T>& pose, const triangle<T>& t) {
    return {place(pose, t.a), place(pose, t.b), place(pose, t.c)};
}

/// That a corner is not finite.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const triangle<T>& t) {
    return detail::flaw_of_points(t.a, t.b, t.c);
}

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<triangle<T>>{"triangle", "abut::triangle_soup", 9};

template <scalar T>
ABUT_HD constexpr corner_hull<T, 3> core_of(const triangle<T>& t) {
    return {{t.a, t.b, t.c}};
}

}  // namespace detail

///@}

}  // namespace abut
