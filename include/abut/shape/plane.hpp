// SPDX-License-Identifier: MIT
#pragma once

// The plane as a shape: a surface. Its solid side is half_space.hpp.

#include <abut/shape/aabb.hpp>
#include <abut/shape/form.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// All x with normal . x == offset: a surface, and no half space. A normal of any length will do; with normal 0 it is
/// everything where offset is 0, and else nothing, as the equation says.
template <scalar T>
struct plane {
    vec3<T> normal;  ///< of any length
    T offset;        ///< in units of the normal's length times a coordinate
};

/// All of space: few planes have a smaller box.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const plane<T>&) {
    constexpr T far = infinity<T>;
    return {{-far, -far, -far}, {far, far, far}};
}

/// That a number is not finite.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const plane<T>& p) {
    const shape_flaw flaw = flaw_of(p.normal);
    return flaw || detail::is_finite(p.offset) ? flaw : shape_flaw{"offset is not finite", static_cast<double>(p.offset)};
}

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<plane<T>>{"plane", "abut::shapes"};

/// A plane, or the half space below it: by the box's corners that are nearest to it.
template <scalar T, bool Solid = false>
struct plane_reach {
    plane<T> query;
    plane_reach() = default;
    ABUT_HD explicit plane_reach(const plane<T>& p) : query(p) {}
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return abut::bounds(query); }
    ABUT_HD bool operator()(const aabb<T>& box) const {
        constexpr T slack = 32 * unit_roundoff<T>, tiny = 32 * smallest_normal<T>;
        const vec3<T> n = absolute(query.normal), reach = absolute(box.lower) + absolute(box.upper);
        const T height = dot(query.normal, box.lower + box.upper) - (query.offset + query.offset);
        const T size = dot(n, reach) + (absolute(query.offset) + absolute(query.offset));
        const T lost = slack * size + tiny * (magnitudes(n) + magnitudes(reach) + 1);
        return !((Solid ? height : absolute(height)) > dot(n, box.upper - box.lower) + lost &&
                 size < largest_finite<T> / 16);
    }
};

}  // namespace detail

/// By the sides of a box's corners, with a slack for rounding.
template <scalar T>
ABUT_HD auto reach_of(const plane<T>& p) {
    return detail::plane_reach<T>(p);
}

///@}

}  // namespace abut
