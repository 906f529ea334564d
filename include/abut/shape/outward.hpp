// SPDX-License-Identifier: MIT
#pragma once

// What volumes are built with: numbers that have to be large enough, computed in double with what rounding may have taken
// put back on top, and a walk over the corners of triangles.

#include <cmath>
#include <cstddef>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

template <scalar T, class Triangles, class See>
ABUT_HD constexpr void for_each_corner(const Triangles& triangles, const See& see) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const triangle<T> t = triangles[i];
        see(t.a);
        see(t.b);
        see(t.c);
    }
}

/// The smallest box around triangles. Exact; of none, the empty box.
template <scalar T, class Triangles>
ABUT_HD constexpr aabb<T> box_around(const Triangles& triangles) {
    aabb<T> box = empty_box<T>();
    for (std::size_t i = 0; i < triangles.size(); ++i) box = merge(box, bounds(triangle<T>(triangles[i])));
    return box;
}

/// A number of type T that is not less than x >= 0, nor than 4 m more, m being the smallest normal number of T: so much may
/// x lack where it is a length or a product with a unit vector, each of three coordinates is a difference of two that are
/// read as zero, and the difference is flushed to zero. Infinite where there is none, and where x is NaN.
template <scalar T>
ABUT_HD constexpr T rounded_up(double x) {
    const double most = x + 4 * static_cast<double>(smallest_normal<T>);
    if (!(most < static_cast<double>(largest_finite<T>))) return infinity<T>;
    return next_up(static_cast<T>(most));
}

/// sqrt(x) within a few roundings, for x >= 0. In constant expressions, where the library's may not be called, by Newton's
/// iteration, which falls until it has arrived.
ABUT_HD constexpr double square_root(double x) {
    if (!ABUT_CONSTANT_EVALUATED()) return std::sqrt(x);
    double root = x > 1 ? x : 1;
    if (x == 0) return 0;
    for (;;) {
        const double next = 0.5 * (root + x / root);
        if (!(next < root)) return root;
        root = next;
    }
}

/// Not less than |v|. Scaled by the largest coordinate, so that no square overflows or underflows: what is left of an
/// underflow is below 2 m. Infinite where a coordinate is, or is NaN.
ABUT_HD constexpr double length_above(const vec3<double>& v) {
    const double x = absolute(v.x), y = absolute(v.y), z = absolute(v.z), xy = x > y ? x : y, most = xy > z ? xy : z;
    if (!(x + y + z <= largest_finite<double>)) return infinity<double>;
    if (most == 0) return 2 * smallest_normal<double>;
    const vec3<double> n{x / most, y / most, z / most};
    return (1 + 32 * unit_roundoff<double>)*(most * square_root(dot(n, n))) + 2 * smallest_normal<double>;
}

}  // namespace abut::detail
