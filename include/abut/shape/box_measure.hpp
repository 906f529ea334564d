// SPDX-License-Identifier: MIT
#pragma once

// How large boxes are: what builders, converters and traversals choose by. No answer depends on it.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Half of a box's sides, in U: these do not overflow.
template <scalar U, scalar T>
ABUT_HD constexpr vec3<U> half_sides(const aabb<T>& box) {
    const auto half = [](T lower, T upper) { return U(0.5) * static_cast<U>(upper) - U(0.5) * static_cast<U>(lower); };
    return {half(box.lower.x, box.upper.x), half(box.lower.y, box.upper.y), half(box.lower.z, box.upper.z)};
}

template <scalar T>
ABUT_HD constexpr T longest(const vec3<T>& sides) {
    return greatest(sides.x, sides.y, sides.z);
}

/// Half the surface of a box with these sides.
template <scalar T>
ABUT_HD constexpr T half_surface(const vec3<T>& sides) {
    return sides.x * sides.y + (sides.y * sides.z + sides.z * sides.x);
}
/// The same bits on every policy.
template <scalar T>
ABUT_HD constexpr T plain_half_surface(const vec3<T>& sides) {
    return plain_sum(plain_product(sides.x, sides.y), plain_product(plain_sum(sides.x, sides.y), sides.z));
}

/// What sides are multiplied by so that no surface overflows, and not all underflow: 1 / longest, but for a box that has no
/// extent. 0 for one that is infinite.
template <scalar T>
ABUT_HD constexpr T surface_unit(T longest) {
    return 1 / greatest(longest, smallest_normal<T>);
}

}  // namespace abut::detail
