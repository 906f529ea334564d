// SPDX-License-Identifier: MIT
#pragma once

// Do two planes touch? They do if their normals are not parallel, and parallel ones if they are one plane. A plane whose
// normal is 0 is everything or nothing.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// Degree 2: whether normal_a . x = offset_a and normal_b . x = offset_b have a solution. The normals and the offsets.
struct plane_meets_plane {
    static constexpr int degree = 2, points = 0;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[8]) {
        const vec3<N> a{value[0], value[1], value[2]}, b{value[4], value[5], value[6]};
        const N &offset_a = value[3], &offset_b = value[7];
        if (!is_null(cross(a, b))) return true;
        // Parallel, and so the equations are multiples of each other, unless both are 0 = offset.
        if (is_null(a) && is_null(b)) return sign(offset_a) == 0 && sign(offset_b) == 0;
        return is_null(scale(offset_b, a) - scale(offset_a, b));
    }

private:
    template <class N>
    ABUT_HD static constexpr bool is_null(const vec3<N>& v) {
        return sign(v.x) == 0 && sign(v.y) == 0 && sign(v.z) == 0;
    }
};

template <scalar T>
ABUT_HD constexpr auto values_of(const plane<T>& a, const plane<T>& b) {
    return in_a_row(a.normal, a.offset, b.normal, b.offset);
}

/// In double: normals that are surely not parallel. A difference of two products is within 3u of the sum of their
/// magnitudes, and flush to zero takes less than `tiny` times the numbers; as for a plane and corners.
template <scalar T>
ABUT_HD constexpr verdict certified_normals(const plane<T>& a, const plane<T>& b) {
    constexpr double tiny = std::same_as<T, float> ? 0x1p-122 : 0x1p-1018;
    const vec3<double> m = widened(a.normal), n = widened(b.normal);
    const double size_m = magnitudes(m), size_n = magnitudes(n), size = size_m * size_n;
    if (std::same_as<T, double> && !(size < 0x1p1000)) return verdict::unknown;
    const vec3<double> across = absolute(cross(m, n));
    const double bound = 0x1p-49 * size + tiny * (size_m + size_n + 1);
    return greatest(across.x, across.y, across.z) > bound ? verdict::yes : verdict::unknown;
}

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const plane<T>& a, const plane<T>& b) {
    const auto values = detail::values_of(a, b);
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::plane_meets_plane>(values.value);
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified_normals(a, b);
    } else {
        return to_verdict(detail::plane_meets_plane::holds(values.value));
    }
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const plane<T>& a, const plane<T>& b) {
    return decide_at_any_span<detail::plane_meets_plane>(detail::values_of(a, b).value);
}

}  // namespace abut
