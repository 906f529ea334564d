// SPDX-License-Identifier: MIT
#pragma once

// Does a ray meet a triangle? It begins at its origin and has no end. The sides of a triangle belong to it: of two faces at
// an edge, a ray through the edge meets both.
//
// The filter computes in double, also for float input. Errors are those of certified_faces.hpp: a determinant of three
// vectors is off by less than 10e times the product of their sums of magnitudes, and by what is flushed to zero.

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

template <bool Certified, scalar T>
ABUT_HD constexpr verdict decide_in_general_position(const ray<T>& r, const triangle<T>& t) {
    using F = filter_scalar<Certified, T>;
    const vec3<F> a = edge_between<Certified>(r.origin, t.a), b = edge_between<Certified>(r.origin, t.b),
                  c = edge_between<Certified>(r.origin, t.c), f = edge_between<Certified>(t.a, t.b),
                  g = edge_between<Certified>(t.a, t.c),
                  d{static_cast<F>(r.direction.x), static_cast<F>(r.direction.y), static_cast<F>(r.direction.z)};
    F error_of_sides = 0, error_of_plane = 0;
    if constexpr (Certified) {
        const F to_a = magnitudes(a), to_b = magnitudes(b), to_c = magnitudes(c), length = magnitudes(d);
        const F reach = (to_a + to_b) + (to_c + length);
        if (!(reach < difference_limit<F>)) return verdict::unknown;
        const F lost = flushed_in_three<T>(reach);
        error_of_sides = determinant_error<F> * length * greatest(to_a * to_b, to_b * to_c, to_c * to_a) + lost;
        error_of_plane = determinant_error<F> * to_a * (magnitudes(f) * magnitudes(g)) + lost;
    }
    const F ab = dot(cross(a, b), d), bc = dot(cross(b, c), d), ca = dot(cross(c, a), d);
    const F lowest = least(ab, bc, ca), highest = greatest(ab, bc, ca);
    if (lowest < -error_of_sides && highest > error_of_sides) return verdict::no;
    if (!(lowest > error_of_sides || highest < -error_of_sides)) return verdict::unknown;
    const F height = dot(cross(f, g), a), ahead = lowest > 0 ? height : -height;
    return absolute(height) > error_of_plane ? to_verdict(ahead > 0) : verdict::unknown;
}

}  // namespace detail

/// One stage of the decision, as for two triangles.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const ray<T>& r, const triangle<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::ray_meets_triangle>(detail::values_of(r, t).value);
    } else {
        return detail::decide_in_general_position<std::same_as<A, filtered>>(r, t);
    }
}

/// `fast`, where a determinant came out as 0, in plain arithmetic. Always answers.
template <arithmetic A, scalar T>
    requires std::same_as<A, fast>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const ray<T>& r, const triangle<T>& t) {
    return to_verdict(detail::ray_meets_triangle::holds(detail::values_of(r, t).value));
}

/// The last stage: decides every finite input, slowly and with a stack frame that docs/numerics.md states.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const ray<T>& r, const triangle<T>& t) {
    return decide_at_any_span<detail::ray_meets_triangle>(detail::values_of(r, t).value);
}

}  // namespace abut
