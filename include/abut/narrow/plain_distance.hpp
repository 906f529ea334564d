// SPDX-License-Identifier: MIT
#pragma once

// Cylinders and cones beside other shapes, measured by the search of plain_search.hpp: mostly that knows the distance, and
// whether the shapes are apart too. What it does not know is left to revolution_ways.hpp and what belongs to it.

#include <concepts>
#include <type_traits>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/cylinder_ways.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_search.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A cylinder or a cone, and another one, a box, a hull, or a shape around a segment, in this order. A triangle is none of
/// them: which of several nearest points it has is said elsewhere. A point has a closed form (plain_foot.hpp).
template <class S, class U>
concept searched_plainly =
    solid_of_revolution<S> && std::same_as<scalar_type_of<S>, scalar_type_of<U>> &&
    (std::same_as<S, U> || std::same_as<U, cylinder<scalar_type_of<U>>> || std::same_as<U, aabb<scalar_type_of<U>>> || std::same_as<U, hull<scalar_type_of<U>>> ||
     corners_of_core<U> == 2);

/// f(a, b) of both as the search sees them, from a point.
template <class S, class U, class F>
ABUT_HD constexpr auto with_seen_plainly(const S& s, const U& t, const vec3<double>& origin, const F& f) {
    using T = scalar_type_of<S>;
    const plain_solid a(s, origin);
    if constexpr (solid_of_revolution<U>) {
        return f(a, plain_solid(t, origin));
    } else if constexpr (std::same_as<U, aabb<T>>) {
        return f(a, plain_box(t, origin));
    } else if constexpr (std::same_as<U, hull<T>>) {
        return f(a, plain_points<T>(t, origin));
    } else {
        return f(a, plain_core<corners_of_core<U>>(core_of(t).at, origin));
    }
}

/// Two shapes as the search leaves them. Their axes have a length.
template <scalar T>
struct measured_plainly {
    vec3<double> origin;
    plain_nearest nearest;
    double radius_b = 0;
    bool is_swapped = false;

    template <class S, class U>
    requires searched_plainly<S, U> ABUT_HD constexpr measured_plainly(const S& s, const U& t) {
        if constexpr (std::same_as<S, U>) {  // the same in either order
            if (precedes(t, s)) {
                look(t, s);
                is_swapped = true;
                nearest = {nearest.on_b, nearest.on_a, contact_math::negated(nearest.way),
                           contact_math::negated(nearest.along), nearest.length, nearest.least,
                           nearest.size, nearest.meet, nearest.is_sure};
                return;
            }
        }
        look(s, t);
        if constexpr (!solid_of_revolution<U>) radius_b = static_cast<double>(radius_around_core(t));
    }
    /// For sure.
    [[nodiscard]] ABUT_HD constexpr bool are_apart() const { return nearest.is_sure && nearest.are_surely_beyond(radius_b); }
    [[nodiscard]] ABUT_HD constexpr double distance() const { return plain_sum(nearest.length, -radius_b); }
    [[nodiscard]] ABUT_HD constexpr vec3<T> point_on_a() const { return placed(nearest.on_a); }
    template <class U>
    [[nodiscard]] ABUT_HD constexpr vec3<T> point_on_b(const U& t) const {
        vec3<double> p = nearest.on_b;
        if (radius_b > 0 && nearest.length > 0) p = plain_step(p, -radius_b / nearest.length, nearest.way);
        if constexpr (std::same_as<U, aabb<T>>) {
            return least(greatest(placed(p), t.lower), t.upper);
        } else {
            return placed(p);
        }
    }
    /// Of shapes that touch, if it is known.
    [[nodiscard]] ABUT_HD constexpr vec3<T> shared_point() const {
        return placed(is_swapped ? nearest.on_b : nearest.on_a);
    }

private:
    template <class S, class U>
    ABUT_HD constexpr void look(const S& s, const U& t) {
        origin = widened(axis_of(s).a);
        nearest = with_seen_plainly(s, t, origin, [](const auto& a, const auto& b) { return search_in_doubles(a, b); });
    }
    [[nodiscard]] ABUT_HD constexpr vec3<T> placed(const vec3<double>& p) const { return from_seen<T>(origin, p); }
};

/// Whether the search may be asked.
template <class S, class U>
ABUT_HD constexpr bool have_axes(const S& s, const U& t) {
    if constexpr (solid_of_revolution<U>) {
        if (is_point(axis_of(t))) return false;
    }
    return !is_point(axis_of(s));
}

}  // namespace abut::detail
