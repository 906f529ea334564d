// SPDX-License-Identifier: MIT
#pragma once

// Contacts as points of a six-dimensional space: what reductions compare them by. A contact's wrench is its normal and that
// normal's torque about a centre; bodies are held by the cone that wrenches span. Rounded one operation at a time, so that
// the same contacts are kept everywhere.

#include <abut/narrow/directions.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// From positions to [-1, 1]: about the middle of the box around them, by half its longest side.
struct contact_frame {
    int exponent = 0;  ///< positions times 2^-exponent are below 2
    point middle{0, 0, 0};
    double half_side = 0;

    template <scalar T>
    ABUT_HD static constexpr contact_frame around(const aabb<T>& box) {
        contact_frame f;
        const double largest = static_cast<double>(magnitude_of(box));
        if (largest > 0) f.exponent = exponent_of(largest);
        const point lower = f.brought(box.lower), upper = f.brought(box.upper);
        f.middle = {plain_sum(lower.x, upper.x) / 2, plain_sum(lower.y, upper.y) / 2, plain_sum(lower.z, upper.z) / 2};
        f.half_side = largest_of(plain_difference(upper, lower)) / 2;
        return f;
    }
    template <scalar T>
    ABUT_HD constexpr point brought(const vec3<T>& p) const {
        return scaled(point{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)}, -exponent);
    }
    /// All 0 where all positions are one.
    template <scalar T>
    ABUT_HD constexpr point operator()(const vec3<T>& p) const {
        if (!(half_side > 0)) return {0, 0, 0};
        const point d = plain_difference(brought(p), middle);
        return {d.x / half_side, d.y / half_side, d.z / half_side};
    }
};

/// A wrench, or a direction in the space of wrenches.
struct wrench {
    point force, torque;

    friend ABUT_HD constexpr double dot(const wrench& a, const wrench& b) {
        return plain_sum(plain_dot(a.force, b.force), plain_dot(a.torque, b.torque));
    }
};

template <scalar T>
ABUT_HD constexpr wrench wrench_of(const contact<T>& c, const contact_frame& frame) {
    const point n{static_cast<double>(c.normal.x), static_cast<double>(c.normal.y), static_cast<double>(c.normal.z)};
    return {n, rounded_off(cross(as<one_double>(frame(c.point)), as<one_double>(n)))};
}

/// Directions in which contacts are looked for: a normal out of 14 (along axes and along diagonals) with a torque out of
/// none and the same 14, which tells the positions among contacts of like normals apart.
inline constexpr int direction_count = 14 * 15;

ABUT_HD constexpr point one_of_14(int i) {
    if (i < 6) {
        const double sign = i % 2 == 0 ? 1 : -1;
        return {i / 2 == 0 ? sign : 0, i / 2 == 1 ? sign : 0, i / 2 == 2 ? sign : 0};
    }
    constexpr double third = 0.57735026918962576;
    const int k = i - 6;
    return {(k & 1) != 0 ? -third : third, (k & 2) != 0 ? -third : third, (k & 4) != 0 ? -third : third};
}
ABUT_HD constexpr wrench wrench_direction(int i) {
    const int torque = i / 14;
    return {one_of_14(i % 14), torque == 0 ? point{0, 0, 0} : one_of_14(torque - 1)};
}

}  // namespace abut::detail::contact_math
