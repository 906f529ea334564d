// SPDX-License-Identifier: MIT
#pragma once

// Triangles on a coarse grid: lattices, voxel models, what is drawn with a grid. There `hulls_meet` (exact_triangles.hpp) is
// exact in plain double, and its many ties cost no more than with `fast`.
//
// All coordinates are integers below 2^16 of one unit, so all corners lie in a cube of side E < 2^17. Every determinant has
// its three vectors from one corner, so a coordinate of a normal is twice the area of a triangle in a square of side E: no
// more than E^2. Its product with a difference is at most E^3, a sum of three such below 3 * 2^51 < 2^53. Nothing is rounded
// on the way, then, nor contracted to something else; and since the unit's cube is a normal number, nothing is flushed to 0.

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

inline constexpr int coarse_grid_bits = 16;

template <scalar T>
ABUT_HD constexpr vec3<T> farthest(const vec3<T>& a, const vec3<T>& b) {
    return {greatest(absolute(a.x), absolute(b.x)), greatest(absolute(a.y), absolute(b.y)),
            greatest(absolute(a.z), absolute(b.z))};
}

/// Whether all coordinates are multiples of one power of two, the unit, and below 2^16 units. Says no of some of which that
/// is true: where all are 0, and near the ends of the range.
///
/// Rounding finds out. The largest number gives the only unit that is of use, and x >= 0 is a multiple of it if adding the
/// power of two whose last digit is worth a unit, and taking that off again, gives back x: what comes out is a multiple in
/// any rounding mode, and where x is one, nothing is rounded. Bits are compared, since a processor may be told to read
/// subnormal numbers as 0: x is lost on the way then, and differs.
template <scalar T>
ABUT_HD constexpr bool on_coarse_grid(const triangle<T>& s, const triangle<T>& t) {
#if defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 1 || __FLT_EVAL_METHOD__ == 2)
    return false;  // sums are rounded to another type than their own
#else
    using word = typename float_format<T>::word;
    constexpr int fraction = float_format<T>::digits - 1;
    constexpr word bias = std::same_as<T, float> ? 127 : 1023, reach = std::same_as<T, float> ? 110 : 320;
    const vec3<T> most = farthest(farthest(farthest(s.a, s.b), farthest(s.c, t.a)), farthest(t.b, t.c));
    const word exponent = ABUT_BIT_CAST(word, greatest(most.x, most.y, most.z)) >> fraction;
    if (static_cast<word>(exponent - (bias - reach)) > 2 * reach) return false;
    const T last_digit = ABUT_BIT_CAST(T, static_cast<word>(exponent + fraction + 1 - coarse_grid_bits) << fraction);
    const auto lost_of = [last_digit](T x) {
        const T size = absolute(x), back = plain_sum(plain_sum(size, last_digit), -last_digit);
        return ABUT_BIT_CAST(word, back) ^ ABUT_BIT_CAST(word, size);
    };
    const auto lost = [&](const vec3<T>& p) { return lost_of(p.x) | lost_of(p.y) | lost_of(p.z); };
    return (lost(s.a) | lost(s.b) | lost(s.c) | lost(t.a) | lost(t.b) | lost(t.c)) == 0;
#endif
}

}  // namespace abut::detail
