// SPDX-License-Identifier: MIT
#pragma once

// The capsule as a shape.

#include <abut/shape/segment.hpp>
#include <abut/shape/sphere.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// All points within `radius` of a segment, which may have no length: a solid ball swept along it. Radius 0 is the segment
/// itself; a negative radius is no capsule.
template <scalar T>
struct capsule {
    segment<T> axis;  ///< from the centre of one end to that of the other
    T radius;         ///< 0 or more
};

/// Around its two ends, and not around the box of its axis, since a minimum of denormal numbers is any of them where they
/// are read as zero.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const capsule<T>& s) {
    return merge(bounds(sphere<T>{s.axis.a, s.radius}), bounds(sphere<T>{s.axis.b, s.radius}));
}

/// By the ends of its axis; the radius stays, as of a ball.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr capsule<T> place(const rigid<T>& pose, const capsule<T>& s) {
    return {place(pose, s.axis), s.radius};
}

/// As of a ball.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const capsule<T>& s) {
    return detail::flaw_of_round(s.radius, s.axis.a, s.axis.b);
}

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<capsule<T>>{"capsule", "abut::capsules", 7};

template <scalar T>
ABUT_HD constexpr corner_hull<T, 2> core_of(const capsule<T>& s) {
    return core_of(s.axis);
}

}  // namespace detail

/// By the line of its axis, with a slack for rounding.
template <scalar T>
ABUT_HD auto reach_of(const capsule<T>& s) {
    // A box that is a little larger than the smallest, and takes less time: rounding costs less than what it is grown by.
    const vec3<T>&a = s.axis.a, &b = s.axis.b;
    const T r = s.radius;
    const T grown = r + (8 * unit_roundoff<T> * (detail::magnitudes(a) + detail::magnitudes(b) + r) + 2 * smallest_normal<T>);
    const vec3<T> all{grown, grown, grown};
    return detail::swept_reach<T>(s.axis, r, {detail::least(a, b) - all, detail::greatest(a, b) + all});
}

///@}

}  // namespace abut
