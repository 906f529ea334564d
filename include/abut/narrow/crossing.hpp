// SPDX-License-Identifier: MIT
#pragma once

// What the way up from a point, along z, meets of a triangle: what `inside` counts. The filter computes in double; its
// errors are those of certified_faces.hpp. Of what it leaves open, integers know all (exact_hit_time.hpp).

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/exact_hit_time.hpp>
#include <abut/predicate/certified_faces.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Where the point is surely not below or above the rim, nor in the plane.
template <scalar T>
ABUT_HD constexpr met_above certified_crossing(const vec3<T>& p, const triangle<T>& t) {
    const vec3<double> a = edge_between<true>(p, t.a), b = edge_between<true>(p, t.b), c = edge_between<true>(p, t.c);
    const double to_a = magnitudes(a), to_b = magnitudes(b), to_c = magnitudes(c), reach = to_a + (to_b + to_c);
    if (!(reach < difference_limit<double>)) return met_above::unknown;
    const auto beside = [](const vec3<double>& v, const vec3<double>& w) { return v.x * w.y - v.y * w.x; };
    const double ab = beside(a, b), bc = beside(b, c), ca = beside(c, a);
    const double lowest = least(ab, bc, ca), highest = greatest(ab, bc, ca);
    const double error = product_error * greatest(to_a * to_b, to_b * to_c, to_c * to_a) + flushed_in_two<T>(reach);
    if (lowest < -error && highest > error) return met_above::nothing;
    if (!(lowest > error || highest < -error)) return met_above::unknown;
    const double height = dot(cross(a, b), c);
    const double error_of_height = determinant_error<double> * (to_a * to_b) * to_c + flushed_in_three<T>(reach);
    if (!(absolute(height) > error_of_height)) return met_above::unknown;
    if ((height > 0) != (lowest > 0)) return met_above::nothing;
    return lowest > 0 ? met_above::leaving : met_above::entering;
}

template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr met_above exact_crossing(const vec3<T>& p, const triangle<T>& t) {
    exact_line<T> way(aligned<18>(in_a_row(p, t.a, t.b, t.c, vec3<T>{0, 0, 1}, vec3<T>{0, 0, 0}).value), false);
    return way.meets_above();
}

/// Never `unknown`.
template <arithmetic A, scalar T>
ABUT_HD constexpr met_above crossing_of(const vec3<T>& p, const triangle<T>& t) {
    if (std::same_as<A, filtered> && !ABUT_CONSTANT_EVALUATED()) {
        const met_above found = certified_crossing(as_stored(p), as_stored(t));
        if (found != met_above::unknown) return found;
    }
    return exact_crossing(p, t);
}

}  // namespace abut::detail
