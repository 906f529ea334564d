// SPDX-License-Identifier: MIT
#pragma once

// The segment as a shape, and how far it, or what is swept along it, reaches.

#include <abut/shape/aabb.hpp>
#include <abut/shape/form.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// The convex hull of two points; they may coincide.
template <scalar T>
struct segment {
    vec3<T> a;  ///< one end
    vec3<T> b;  ///< the other
};

/// As large as its box. Exact.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const segment<T>& s) {
    return {detail::least(s.a, s.b), detail::greatest(s.a, s.b)};
}

/// By its ends.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr segment<T> place(const rigid<T>& pose, const segment<T>& s) {
    return {place(pose, s.a), place(pose, s.b)};
}

/// That an end is not finite.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const segment<T>& s) {
    return detail::flaw_of_points(s.a, s.b);
}

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<segment<T>>{"segment", "abut::segments", 6};

template <scalar T>
ABUT_HD constexpr corner_hull<T, 2> core_of(const segment<T>& s) {
    return {{s.a, s.b}};
}

// This and plane_reach (plane.hpp) compare sums of products whose magnitudes add up to `size`. Each number carries at most
// six roundings, two numbers twelve, of 2u each in any rounding mode; 32u is more. Let m be the smallest normal number.
// Where denormals are read as zero and flushed to zero, a number is off by less than m, a sum of two by 3 m, the difference
// of two sums by 7 m: so a product by 7 m times its other factor, or by m where it vanishes itself. Added up, that is below
// 26 m times the one factor, 19 m times the other, and 12 m. Where `size` is so large that something may overflow, every box
// is kept.

/// A segment, or what is within a radius of it: by its box, and by the three axes that are orthogonal to it and to a
/// coordinate axis, on which a segment is a point. A segment that runs across a scene touches few of the boxes in its own
/// box.
template <scalar T>
struct swept_reach {
    aabb<T> query;
    vec3<T> middle, direction, grown;  ///< a + b, b - a, and the doubled radius times (|direction|'s other two coordinates)
    T length, reach;                   ///< sums of magnitudes

    swept_reach() = default;
    ABUT_HD swept_reach(const segment<T>& axis, T radius, const aabb<T>& around)
        : query(around), middle(axis.a + axis.b), direction(axis.b - axis.a) {
        const vec3<T> d = absolute(direction);
        grown = (radius + radius) * vec3<T>{d.y + d.z, d.z + d.x, d.x + d.y};
        length = magnitudes(direction);
        reach = magnitudes(axis.a) + magnitudes(axis.b) + (radius + radius);
    }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return query; }
    ABUT_HD bool operator()(const aabb<T>& box) const {
        if (!overlaps(query, box)) return false;
        constexpr T slack = 32 * unit_roundoff<T>, tiny = 32 * smallest_normal<T>;
        const vec3<T> extent = box.upper - box.lower, d = absolute(direction);
        const vec3<T> off = absolute(cross(direction, (box.lower + box.upper) - middle));
        const T far = reach + magnitudes(box.lower) + magnitudes(box.upper), size = length * far;
        const T lost = slack * size + tiny * (length + far + 1);
        const bool apart = off.x > (d.y * extent.z + d.z * extent.y) + (grown.x + lost) ||
                           off.y > (d.z * extent.x + d.x * extent.z) + (grown.y + lost) ||
                           off.z > (d.x * extent.y + d.y * extent.x) + (grown.z + lost);
        return !(apart && size < largest_finite<T> / 16 && far < largest_finite<T> / 16);
    }
};

}  // namespace detail

/// By the line, with a slack for rounding.
template <scalar T>
ABUT_HD auto reach_of(const segment<T>& s) {
    return detail::swept_reach<T>(s, T(0), bounds(s));
}

///@}

}  // namespace abut
