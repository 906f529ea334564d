// SPDX-License-Identifier: MIT
#pragma once

// A filter before the search of capsule_hull.hpp, for a ball and a hull of eight points that are the corners of a box under
// a pose, in the order of `points_of`, but for rounding. Such a hull is nearly the parallelepiped of the first corner and
// the three next to it, whose nearest point to the centre has a closed form. Not for hulls that are no boxes: these are left
// to the search, as is what this does not know.
//
// Why it holds. All is seen from the first corner, rounded once; size is the sum of the magnitudes of the centre p and of
// three edges e_k, u = 2^-52. `off` is how far the other four corners are from sums of edges. Any point of the hull is the
// mean of corners, and so within `off` and 4u size of the point of the parallelepiped with these weights, and alike in the
// other sense.
//
// Touching: w = p - sum of x_k e_k with x_k in [0, 1], whatever these are, is the way from a point of the parallelepiped;
// rounding it takes less than 16u size. Apart: along w the parallelepiped is at least (w.p - sum of the w.e_k > 0) / |w|
// from p; computed, that is within 16u size. The code takes 2^-46 size for all of it, and 2^-40 of squares for theirs. What
// is flushed to zero is below 2^-120 (float) or 2^-1010.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/certified_capsule.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Calls f with the eight points of a hull that has as many, one behind the other in memory.
template <scalar T, class F>
ABUT_HD constexpr auto with_eight_points(const hull<T>& h, const F& f) {
    if (!h.is_placed && h.stride == sizeof(vec3<T>)) return f(h.points);
    const vec3<T> at[8] = {h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7]};
    return f(&at[0]);
}

template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict near_corner_box(const vec3<T>* h, const vec3<T>& center, double radius) {
    const vec3<T> first = h[0];
    const vec3<double> p = relative_to(first, center),
                       e[3] = {relative_to(first, h[1]), relative_to(first, h[2]), relative_to(first, h[4])};
    const vec3<double> ef = e[0] + e[1];
    const double off =
        greatest(magnitudes(relative_to(first, h[3]) - ef), magnitudes(relative_to(first, h[5]) - (e[0] + e[2])),
                 magnitudes(relative_to(first, h[6]) - (e[1] + e[2])), magnitudes(relative_to(first, h[7]) - (ef + e[2])));
    const double size = magnitudes(p) + (magnitudes(e[0]) + magnitudes(e[1]) + magnitudes(e[2]));
    if (!(size < 0x1p240 && radius < 0x1p240 && off < size)) return verdict::unknown;
    const double slack = off + (0x1p-46 * size + (std::same_as<T, float> ? 0x1p-110 : 0x1p-1000));
    vec3<double> w = p;
    for (const vec3<double>& edge : e) w = w - into_unit(dot(p, edge) / dot(edge, edge)) * edge;
    const double square = (1 + 0x1p-40) * dot(w, w), inner = radius - slack, outer = radius + slack;
    if (inner > 0 && square + 0x1p-1000 <= inner * inner) return verdict::yes;
    double ahead = dot(w, p);
    for (const vec3<double>& edge : e) ahead -= not_below_zero(dot(w, edge));
    return ahead > 0 && ahead * ahead > square * (outer * outer) + 0x1p-1000 ? verdict::no : verdict::unknown;
}

}  // namespace abut::detail
