// SPDX-License-Identifier: MIT
#pragma once

// From which side a ray or a segment meets a triangle: the sign of its direction along the normal (b - a) x (c - a).

#include <concepts>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/zero_area.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Of the corners, and of two points whose difference is the direction.
struct goes_along_normal {
    static constexpr int degree = 3, points = 3;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&v)[15]) {
        const vec3<N> a{v[0], v[1], v[2]}, b{v[3], v[4], v[5]}, c{v[6], v[7], v[8]}, end{v[9], v[10], v[11]},
            start{v[12], v[13], v[14]};
        return sign_of_dot(cross(b - a, c - a), end - start) > 0;
    }
};

template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool goes_along_exactly(const triangle<T>& t, const vec3<T>& end, const vec3<T>& start) {
    const auto all = in_a_row(t.a, t.b, t.c, end, start);
    const verdict v = decide_in_limbs<goes_along_normal>(all.value);
    return v == verdict::unknown ? decide_at_any_span<goes_along_normal>(all.value) : v == verdict::yes;
}

/// 1 along the normal, so that the triangle is met from behind, -1 against it, and 0 along the plane, or of a triangle
/// without area. Decided exactly, save by `fast`. In double the sum is off by less than 20 2^-53 times the product of the
/// three magnitudes, as in narrow/hit_time.hpp; where these are between 2^-200 and 2^200 nothing underflows that matters.
template <arithmetic A, class Line, scalar T>
ABUT_HD constexpr int side_of_face(const Line& line, const triangle<T>& t) {
    const line_of<T> l(line);
    const vec3<double> f = difference(t.a, t.b), g = difference(t.a, t.c), d = difference(l.start, l.end);
    if (!std::same_as<A, exact>) {
        const double side = magnitudes(f), other = magnitudes(g), length = magnitudes(d), sum = dot(cross(f, g), d);
        if (std::same_as<A, fast>) return sum > 0 ? 1 : sum < 0 ? -1 : 0;
        if (!ABUT_CONSTANT_EVALUATED() && least(side, other, length) > 0x1p-200 && greatest(side, other, length) < 0x1p200 &&
            absolute(sum) > 0x1p-48 * (side * other * length) &&
            !any_subnormal(in_a_row(t.a, t.b, t.c, l.end, l.start).value)) {
            return sum > 0 ? 1 : -1;
        }
    }
    return goes_along_exactly(t, l.end, l.start) ? 1 : goes_along_exactly(t, l.start, l.end) ? -1 : 0;
}

}  // namespace abut::detail
