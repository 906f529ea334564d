// SPDX-License-Identifier: MIT
#pragma once

// Contacts of a half space with what touches it. It comes apart by its normal alone, by as much as the shape's deepest point
// lies in it; that point is the contact's, and where several are as deep, as far as double tells, their middle.

#include <cstddef>

#include <abut/narrow/common_unit.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/flat_contact.hpp>
#include <abut/narrow/hull_distance.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_plane.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/half_space.hpp>

namespace abut::detail {

// All of shapes that are known to touch, with ids 0. A half space of normal 0 is everything, as a plane of normal 0 is.

/// The shape's core is a hull of points.
template <scalar T, has_core_points<T> S>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const half_space<T>& s, const S& t) {
    using namespace contact_math;
    const auto core = core_points_of(t);
    const hull<T>& h = core.as_hull();
    if (is_zero(widened(s.normal))) return {0, 0, h[0], {0, 0, 1}, largest_finite<T>};
    const plane<T> surface = surface_of(s);
    const auto magnitude = static_cast<double>(magnitude_of(t));
    // In plain doubles, where the plane is no farther from the origin than the shape.
    if (const plain_plane plain(surface, magnitude); plain.is_good && absolute(plain.offset) < 2 * magnitude) {
        point sum{0, 0, 0}, origin = widened(h[0]);
        double lowest = infinity<double>, count = 0;
        for (std::size_t i = 0; i < h.count; ++i) {
            const point at = widened(h[i]);
            const double height = plain.height(at);
            if (height > lowest) continue;
            if (height < lowest) lowest = height, origin = at, sum = {0, 0, 0}, count = 0;
            sum = plain_step(sum, 1, plain_difference(at, origin));
            count += 1;
        }
        const point n = std::same_as<T, float> ? as_stored_direction<T>(plain.unit) : plain.unit;
        const auto reach = static_cast<double>(radius_around_core(t));
        const point where = plain_step(plain_step(origin, 1 / count, sum), -reach, n);
        const auto one = [](double x) { return rounded(static_cast<T>(x)); };
        return plain_contact(vec3<T>{one(where.x), one(where.y), one(where.z)}, negated(n), plain_sum(reach, -lowest));
    }
    const common_scale scale(surface, t);
    common_scale deep = scale;  // of heights, where the plane is far
    point first{}, n{}, sum{0, 0, 0};
    double lowest = infinity<double>, count = 0;
    for (std::size_t i = 0; i < h.count; ++i) {
        const point at[1] = {scale(h[i])};
        const plane_heights<1> over(surface, at, scale);
        const double height = over.height[0].high;
        if (height > lowest) continue;
        if (height < lowest) {
            lowest = height, first = at[0], sum = {0, 0, 0}, count = 0;
            n = as_stored_direction<T>(unit_vector(over.normal));
            deep.exponent = over.exponent;
        }
        sum = plain_step(sum, 1, plain_difference(at[0], first));
        count += 1;
    }
    const double reach = scale(radius_around_core(t));
    least_overlap way;
    way.offer(negated(n), plain_sum(deep.exponent == scale.exponent ? reach : 0, -lowest));
    contact<T> found = assembled<T>(scale, plain_step(plain_step(first, 1 / count, sum), -reach, n), way);
    found.depth = deep.back<T>(greatest(way.depth, 0.0));
    return found;
}

/// A cylinder or a cone.
template <scalar T, solid_of_revolution S>
    requires std::same_as<scalar_type_of<S>, T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const half_space<T>& s, const S& t) {
    if (is_point(axis_of(t))) return contact_between(s, ball_around(t));
    if (contact_math::is_zero(widened(s.normal))) return {0, 0, axis_of(t).a, {0, 0, 1}, largest_finite<T>};
    const plane<T> surface = surface_of(s);
    const revolution_over_plane<T> over(t, surface, common_unit(t, surface));
    const vec3<double>& n = over.normal();
    const vec3<T> normal{rounded(static_cast<T>(-n.x)), rounded(static_cast<T>(-n.y)), rounded(static_cast<T>(-n.z))};
    return {0, 0, over.lowest_point(), normal, rounded_within<T>(greatest(over.depth(), 0.0))};
}

}  // namespace abut::detail
