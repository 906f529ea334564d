// SPDX-License-Identifier: MIT
#pragma once

// The ray as a shape.

#include <abut/shape/aabb.hpp>
#include <abut/shape/form.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// All origin + t direction with t >= 0. The direction has any length; with direction 0 it is the point `origin`.
template <scalar T>
struct ray {
    vec3<T> origin;     ///< where it begins
    vec3<T> direction;  ///< of any length; t is measured in it
};

/// From the origin to infinity along each axis on which the ray moves, which it is told by the direction's bits.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const ray<T>& r) {
    constexpr T far = infinity<T>;
    const auto lower = [](T from, T along) { return !detail::is_zero(along) && detail::has_sign(along) ? -far : from; };
    const auto upper = [](T from, T along) { return !detail::is_zero(along) && !detail::has_sign(along) ? far : from; };
    const vec3<T>&o = r.origin, &d = r.direction;
    return {{lower(o.x, d.x), lower(o.y, d.y), lower(o.z, d.z)}, {upper(o.x, d.x), upper(o.y, d.y), upper(o.z, d.z)}};
}

/// That a number is not finite.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const ray<T>& r) {
    return detail::flaw_of_points(r.origin, r.direction);
}

template <scalar T>
inline constexpr detail::shape_name detail::name_of<ray<T>>{"ray", "abut::rays"};

///@}

}  // namespace abut
