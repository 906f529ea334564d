// SPDX-License-Identifier: MIT
#pragma once

// The stages of `within` for a box and another shape. Where the other one is a point, a sphere or a box, both have points
// that are nearest to each other and whose coordinates are those of the input: these are compared instead.

#include <concepts>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/aabb_sphere.hpp>
#include <abut/predicate/certified_box.hpp>
#include <abut/predicate/certified_box_hull.hpp>
#include <abut/predicate/exact_box_hull.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Shapes around a point, and around more than that.
template <class S>
concept has_center = (corners_of_core<S> == 1);
template <class S>
concept has_edges = (corners_of_core<S> > 1);

/// The shapes between which the distance of a box and a shape around a point is.
template <scalar T, has_center S>
ABUT_HD constexpr vec3<T> nearest_of_box(const aabb<T>& box, const S& s) {
    return nearest_in_box(box, core_of(s).at[0]);
}

/// Of two boxes, the points that are nearest to each other: where they overlap, one point of both.
template <scalar T>
struct nearest_of_boxes {
    vec3<T> on_a, on_b;

    ABUT_HD constexpr nearest_of_boxes(const aabb<T>& a, const aabb<T>& b)
        : on_a{clamped_by_bits(b.lower.x, a.lower.x, a.upper.x), clamped_by_bits(b.lower.y, a.lower.y, a.upper.y),
               clamped_by_bits(b.lower.z, a.lower.z, a.upper.z)},
          on_b(nearest_in_box(b, on_a)) {}
};

/// As exact_box_hull.hpp expects them, in double as those of two hulls.
template <scalar T, has_edges S>
ABUT_HD constexpr auto values_within(const aabb<T>& box, const S& s, double distance) {
    const auto core = core_of(s);
    constexpr int n = corners_of_core<S>;
    row_of<double, std::size_t{8 + 3 * n}> row{};
    double* end = row.value;
    const auto append_point = [&end](const vec3<T>& p) {
        end = append(end, vec3<double>{widened_exactly(p.x), widened_exactly(p.y), widened_exactly(p.z)});
    };
    append_point(box.lower);
    append_point(box.upper);
    for (int i = 0; i < n; ++i) append_point(core.at[i]);
    append(append(end, widened_exactly(radius_around_core(s))), distance);
    return row;
}

template <bool Certified, scalar T, has_edges S>
ABUT_HD constexpr auto box_and_hull_of(const aabb<T>& box, const S& s, double distance) {
    const auto radius = radius_within<Certified>(box, s, distance);
    return box_and_hull<Certified, std::remove_const_t<decltype(radius)>, corners_of_core<S>>(box, core_of(s), radius);
}

/// Whether the box and the core touch, as floating point tells: of `filtered` surely, where it says so.
template <class A, scalar T, int N>
ABUT_HD constexpr bool seem_to_touch(const aabb<T>& box, const corner_hull<T, N>& core) {
    const auto hull = [&core] {
        if constexpr (N == 2) {
            return segment<T>{core.at[0], core.at[1]};
        } else {
            return triangle<T>{core.at[0], core.at[1], core.at[2]};
        }
    }();
    if constexpr (std::same_as<A, fast>) {
        return approximate_box(box, hull);
    } else {
        return certified_box(box, hull) == verdict::yes;
    }
}

/// The first stage, in registers.
///@{
template <arithmetic A, scalar T, has_center S>
ABUT_HD constexpr verdict decide_within(const aabb<T>& box, const S& s, double distance) {
    return decide_within<A>(nearest_of_box(box, s), s, distance);
}
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide_within(const aabb<T>& a, const aabb<T>& b, double distance) {
    const nearest_of_boxes<T> nearest(a, b);
    return decide_within<A>(nearest.on_a, nearest.on_b, distance);
}
template <arithmetic A, scalar T, has_edges S>
ABUT_HD constexpr verdict decide_within(const aabb<T>& box, const S& s, double distance) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<box_within_hull<corners_of_core<S>>>(values_within(box, s, distance).value);
    } else {
        return near_by_one_way(box_and_hull_of<std::same_as<A, filtered>>(box, s, distance));
    }
}
///@}

/// What that leaves: cores that meet the box, pairs that nearly touch, and of a triangle all features. `fast` always
/// answers.
template <arithmetic A, scalar T, has_edges S>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_within_late(const aabb<T>& box, const S& s, double distance) {
    if (seem_to_touch<A>(box, core_of(s))) return verdict::yes;
    return near_by_ways(box_and_hull_of<std::same_as<A, filtered>>(box, s, distance));
}

/// The last one: decides every finite input.
///@{
template <scalar T, has_center S>
ABUT_HD constexpr bool resolve_within(const aabb<T>& box, const S& s, double distance) {
    return resolve_within(nearest_of_box(box, s), s, distance);
}
template <scalar T>
ABUT_HD constexpr bool resolve_within(const aabb<T>& a, const aabb<T>& b, double distance) {
    const nearest_of_boxes<T> nearest(a, b);
    return resolve_within(nearest.on_a, nearest.on_b, distance);
}
template <scalar T, has_edges S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const aabb<T>& box, const S& s, double distance) {
    return decide_at_any_span<box_within_hull<corners_of_core<S>>>(values_within(box, s, distance).value);
}
///@}

}  // namespace abut::detail
