// SPDX-License-Identifier: MIT
#pragma once

// Does a ray meet a triangle? It begins at its origin and has no end. The sides of a triangle belong to it: of two faces at
// an edge, a ray through the edge meets both.
//
// The filter computes in double, also for float input, from the way a to the first corner, two sides f and g, and the
// direction d, by as few products as there are: the determinants of exact_ray.hpp are (a x f).d, a.(d x g) and what these
// leave of n.d = -f.(d x g); and n.a = (a x f).g. By certified_triangles.hpp a determinant is off by less than 8.01e times
// the product of its vectors' sums of magnitudes. Let those be A, F, G and D. The third is off by as much as all of them,
// and by two roundings: by less than 10.1e D (A (F + G) + F G), of which what is computed falls short by 20e at most. The
// code takes 12.5e for each of the three. What is flushed to zero is that of three determinants (certified_faces.hpp: 81 of
// the 128 m).

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_faces.hpp>
#include <abut/predicate/exact_ray.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// As exact_ray.hpp expects them.
template <scalar T>
ABUT_HD constexpr auto values_of(const ray<T>& r, const triangle<T>& t) {
    return in_a_row(r.origin, t.a, t.b, t.c, r.direction, vec3<T>{0, 0, 0});
}

/// A line's way to a triangle's plane, along the normal, and the way that it makes in the time 1; and by how much each may
/// be off. It meets the plane at height / speed.
struct plane_approach {
    double height, speed, error_of_height, error_of_speed;
};

/// `filtered`. Where the answer is yes, `met` is written.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr verdict decide_by_sides(const ray<T>& r, const triangle<T>& t, plane_approach& met) {
    const vec3<double> a = edge_between<true>(r.origin, t.a), f = edge_between<true>(t.a, t.b),
                       g = edge_between<true>(t.a, t.c), d = widened(r.direction);
    const double to_a = magnitudes(a), to_b = magnitudes(f), to_c = magnitudes(g), length = magnitudes(d);
    const double reach = (to_a + to_b) + (to_c + length), product = to_b * to_c;
    if (!(reach < difference_limit<double>)) return verdict::unknown;
    const double lost = flushed_in_three<T>(reach);
    const double error = 1.25 * determinant_error<double> * length * (to_a * (to_b + to_c) + product) + lost;
    const vec3<double> p = cross(d, g), q = cross(a, f);
    const double speed = -dot(f, p), ab = dot(q, d), ca = dot(a, p), bc = (speed - ab) - ca;
    const double lowest = least(ab, bc, ca), highest = greatest(ab, bc, ca);
    if (lowest < -error && highest > error) return verdict::no;
    if (!(lowest > error || highest < -error)) return verdict::unknown;
    met.height = dot(q, g);
    met.speed = speed;
    met.error_of_height = determinant_error<double> * to_a * product + lost;
    met.error_of_speed = determinant_error<double> * length * product + lost;
    if (!(absolute(met.height) > met.error_of_height)) return verdict::unknown;
    return to_verdict((met.height > 0) == (lowest > 0));
}

/// `fast`: a determinant for each side, of which two faces at a side have the same but for its sign.
template <scalar T>
ABUT_HD constexpr verdict decide_by_plain_sides(const ray<T>& r, const triangle<T>& t) {
    const vec3<T> a = between(r.origin, t.a), b = between(r.origin, t.b), c = between(r.origin, t.c), &d = r.direction;
    const T ab = dot(cross(a, b), d), bc = dot(cross(b, c), d), ca = dot(cross(c, a), d);
    const T lowest = least(ab, bc, ca), highest = greatest(ab, bc, ca);
    if (lowest < 0 && highest > 0) return verdict::no;
    if (!(lowest > 0 || highest < 0)) return verdict::unknown;
    const T height = dot(cross(between(t.a, t.b), between(t.a, t.c)), a);
    return height != 0 ? to_verdict((height > 0) == (lowest > 0)) : verdict::unknown;
}

}  // namespace detail

/// One stage of the decision, as for two triangles.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const ray<T>& r, const triangle<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::ray_meets_triangle>(detail::values_of(r, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        detail::plane_approach met{};
        return detail::decide_by_sides(r, t, met);
    } else {
        return detail::decide_by_plain_sides(r, t);
    }
}

/// `fast`, where a determinant came out as 0, in plain arithmetic. Always answers.
template <arithmetic A, scalar T>
requires std::same_as<A, fast> ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const ray<T>& r, const triangle<T>& t) {
    return to_verdict(detail::ray_meets_triangle::holds(detail::values_of(r, t).value));
}

/// The last stage: decides every finite input, slowly and with a stack frame that docs/numerics.md states.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const ray<T>& r, const triangle<T>& t) {
    return decide_at_any_span<detail::ray_meets_triangle>(detail::values_of(r, t).value);
}

}  // namespace abut
