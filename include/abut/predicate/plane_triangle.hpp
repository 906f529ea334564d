// SPDX-License-Identifier: MIT
#pragma once

// Does a triangle touch a plane? The corners' heights, normal . v - offset, must not be all above or all below: the height
// is linear, so it takes every value between its least and its greatest, on degenerate triangles as well. A plane whose
// normal is 0 has one height everywhere and needs no case of its own.

#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// Degree 2. The exact stages see one unit of all values, so that a product is worth its square: the offset is multiplied
/// by a 1 of that unit.
struct plane_meets_triangle {
    static constexpr int degree = 2, points = 0;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[14]) {
        const vec3<N> normal{value[0], value[1], value[2]};
        const auto offset = value[3] * value[4];
        int lowest = 1, highest = -1;
        for (int i = 5; i < 14; i += 3) {
            const int height = sign(dot(normal, vec3<N>{value[i], value[i + 1], value[i + 2]}) - offset);
            lowest = height < lowest ? height : lowest;
            highest = height > highest ? height : highest;
        }
        return lowest <= 0 && highest >= 0;
    }
};

/// The plane's normal and offset, a 1, and the triangle's corners.
template <scalar T>
ABUT_HD constexpr auto values_of(const plane<T>& p, const triangle<T>& t) {
    return in_a_row(p.normal, p.offset, T(1), t.a, t.b, t.c);
}

/// In double, also for float input. A height is a sum of three products and the offset, with at most four roundings on the
/// way of any of them. Let `size` be the sum of those terms' magnitudes, the greatest over all corners: heights
/// are within 5u of it, u = 2^-52, in each rounding mode and with or without contraction. The code takes 8u, which pays for
/// the rounding of `size` as well. What flush to zero takes from an input or a product is below 2^-126 (float) or 2^-1022
/// times the other factor, for each of three terms and the offset. Double input whose products may overflow is left
/// undecided.
template <scalar T>
ABUT_HD constexpr verdict certified_heights(const plane<T>& p, const triangle<T>& t) {
    constexpr double tiny = std::same_as<T, float> ? 0x1p-122 : 0x1p-1018;
    const vec3<double> n = widened(p.normal), a = widened(t.a), b = widened(t.b), c = widened(t.c), size_n = absolute(n),
                       size_a = absolute(a), size_b = absolute(b), size_c = absolute(c);
    const double offset = rounded(static_cast<double>(p.offset));
    const vec3<double> reach{greatest(size_a.x, size_b.x, size_c.x), greatest(size_a.y, size_b.y, size_c.y),
                             greatest(size_a.z, size_b.z, size_c.z)};
    const double size = dot(size_n, reach) + absolute(offset);
    const double at_a = dot(n, a) - offset, at_b = dot(n, b) - offset, at_c = dot(n, c) - offset;
    const double bound = 0x1p-49 * size + tiny * (magnitudes(n) + magnitudes(reach) + 1);
    if (std::same_as<T, double> && !(size < 0x1p1000)) return verdict::unknown;
    const double lowest = least(at_a, at_b, at_c), highest = greatest(at_a, at_b, at_c);
    if (lowest > bound || highest < -bound) return verdict::no;
    return lowest < -bound && highest > bound ? verdict::yes : verdict::unknown;
}

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const plane<T>& p, const triangle<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::plane_meets_triangle>(detail::values_of(p, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified_heights(p, t);
    } else {
        const T at_a = dot(p.normal, t.a) - p.offset, at_b = dot(p.normal, t.b) - p.offset;
        const T at_c = dot(p.normal, t.c) - p.offset;
        return to_verdict(detail::least(at_a, at_b, at_c) <= 0 && detail::greatest(at_a, at_b, at_c) >= 0);
    }
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const plane<T>& p, const triangle<T>& t) {
    return decide_at_any_span<detail::plane_meets_triangle>(detail::values_of(p, t).value);
}

}  // namespace abut
