// SPDX-License-Identifier: MIT
#pragma once

// A filter for a ball and a cylinder, whose point nearest to the centre has a closed form. What it does not know is asked of
// estimates (revolution.hpp).
//
// Why it holds. All is seen from the axis's first end, rounded once; size is the sum of the magnitudes of the centre p, of
// the axis d, and of the cylinder's radius r, u = 2^-52. The share of the axis is off by 4u |p| / |d|, whatever d is, and
// the part across the axis by 6u |p|, so it is orthogonal to the axis but for that.
//
// Touching: the point at the share t in [0, 1] of the axis, and no farther than r across it, is within 16u size of one of the
// cylinder; w is the way from it to p, and |w| the distance at most. Apart: along w the cylinder reaches no farther than
// (w.d > 0) + r |part of w across d|; computed, the gap is within 32u size |w|. The code takes 2^-46 size for all of it, and
// 2^-40 of squares for theirs. What is flushed to zero is below 2^-120 (float) or 2^-1010.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/certified_capsule.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

template <scalar T>
ABUT_HD constexpr verdict near_cylinder(const cylinder<T>& s, const vec3<T>& center, double radius) {
    const vec3<double> p = relative_to(s.axis.a, center), d = relative_to(s.axis.a, s.axis.b);
    const double r = s.radius, dd = dot(d, d), size = magnitudes(p) + magnitudes(d) + r;
    if (!(size < 0x1p240 && radius < 0x1p240 && dd > 0x1p-500)) return verdict::unknown;
    const double slack = 0x1p-46 * size + (std::same_as<T, float> ? 0x1p-110 : 0x1p-1000);
    const double share = dot(p, d) / dd;
    const vec3<double> across = p - share * d;
    const double far = square_root(dot(across, across)), over = far > r ? 1 - r / far : 0;
    const vec3<double> w = (share - into_unit(share)) * d + over * across;
    const double square = (1 + 0x1p-40) * dot(w, w), inner = radius - slack, outer = radius + slack;
    if (inner > 0 && square + 0x1p-1000 <= inner * inner) return verdict::yes;
    const double along = dot(w, d);
    const vec3<double> aside = w - (along / dd) * d;
    const double ahead = dot(w, p) - not_below_zero(along) - r * square_root(dot(aside, aside));
    return ahead > 0 && ahead * ahead > square * (outer * outer) + 0x1p-1000 ? verdict::no : verdict::unknown;
}

}  // namespace abut::detail
