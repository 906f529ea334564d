// SPDX-License-Identifier: MIT
#pragma once

// The stages of `within`, for shapes that are hulls of up to three corners, or what is within a radius of such a hull. They
// are those of `intersects`, and decide that too for shapes without a face, whose distance is then 0 (near_cores.hpp). The
// face over them is within.hpp.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/certified_within.hpp>
#include <abut/predicate/exact_within.hpp>
#include <abut/predicate/segment_triangle.hpp>
#include <abut/predicate/triangle_triangle.hpp>
#include <abut/shape/core.hpp>

namespace abut {

namespace detail {

/// Predicates are written for the core of fewer corners first.
template <class S, class U>
concept cores_in_order = corners_of_core<S> > 0 && corners_of_core<S> <= corners_of_core<U>;

/// A float as a double, also where a processor is told to read denormals as 0.
ABUT_HD constexpr double widened_exactly(float x) {
    if (!is_subnormal(x)) return static_cast<double>(x);
    const auto steps = static_cast<double>(ABUT_BIT_CAST(std::uint32_t, x) & 0x7fffffffu) * 0x1p-149;
    return has_sign(x) ? -steps : steps;
}
ABUT_HD constexpr double widened_exactly(double x) { return x; }

/// As exact_within.hpp expects them, in double, whatever the input's type is: the distance is one.
template <class S, class U>
    requires cores_in_order<S, U>
ABUT_HD constexpr auto values_within(const S& s, const U& t, double distance) {
    const auto a = core_of(s);
    const auto b = core_of(t);
    constexpr int n = decltype(a)::corners, m = decltype(b)::corners;
    row_of<double, std::size_t{3 * (n + m) + 3}> row{};
    double* end = row.value;
    const auto append_point = [&end](const auto& p) {
        end = append(append(append(end, widened_exactly(p.x)), widened_exactly(p.y)), widened_exactly(p.z));
    };
    for (int i = 0; i < n; ++i) append_point(a.at[i]);
    for (int j = 0; j < m; ++j) append_point(b.at[j]);
    append(append(append(end, widened_exactly(radius_around_core(s))), widened_exactly(radius_around_core(t))), distance);
    return row;
}

/// Both radii and the distance, rounded: for `filtered` in double, for `fast` in the input's type.
template <bool Certified, class S, class U>
ABUT_HD constexpr auto radius_within(const S& s, const U& t, double distance) {
    if constexpr (Certified) {
        const double radii =
            rounded(static_cast<double>(radius_around_core(s))) + rounded(static_cast<double>(radius_around_core(t)));
        return radii + rounded(distance);
    } else {
        return (radius_around_core(s) + radius_around_core(t)) + static_cast<scalar_type_of<S>>(distance);
    }
}

template <bool Certified, class S, class U>
ABUT_HD constexpr auto two_hulls_of(const S& s, const U& t, double distance) {
    const auto radius = radius_within<Certified>(s, t, distance);
    return two_hulls<Certified, std::remove_const_t<decltype(radius)>, corners_of_core<S>, corners_of_core<U>>(
        core_of(s), core_of(t), radius);
}

/// From a point to a hull.
template <class A, class S, class U, std::size_t... J>
ABUT_HD constexpr verdict decide_from_point(const S& s, const U& t, double distance, std::index_sequence<J...>) {
    constexpr bool certified = std::same_as<A, filtered>;
    const auto center = core_of(s).at[0];
    const auto hull = core_of(t);
    const auto radius = radius_within<certified>(s, t, distance);
    if constexpr (certified) {
        return certified_relative<scalar_type_of<S>>(radius, relative_to(center, hull.at[J])...);
    } else {
        return to_verdict(approximate(radius, (hull.at[J] - center)...));
    }
}

template <class A, class S, scalar T>
ABUT_HD constexpr bool seem_to_touch(const S& s, const triangle<T>& t) {
    const verdict v = decide<A>(s, t);
    if constexpr (std::same_as<A, fast>) return (v == verdict::unknown ? decide_late<fast>(s, t) : v) == verdict::yes;
    return v == verdict::yes;
}
/// Whether cores without radii touch, as signs in floating point tell: of `filtered` surely, where it says so.
template <class A, scalar T>
ABUT_HD constexpr bool seem_to_touch(const corner_hull<T, 3>& a, const corner_hull<T, 3>& b) {
    return seem_to_touch<A>(triangle<T>{a.at[0], a.at[1], a.at[2]}, triangle<T>{b.at[0], b.at[1], b.at[2]});
}
template <class A, scalar T>
ABUT_HD constexpr bool seem_to_touch(const corner_hull<T, 2>& a, const corner_hull<T, 3>& b) {
    return seem_to_touch<A>(segment<T>{a.at[0], a.at[1]}, triangle<T>{b.at[0], b.at[1], b.at[2]});
}
template <class A, scalar T>
ABUT_HD constexpr bool seem_to_touch(const corner_hull<T, 2>&, const corner_hull<T, 2>&) {
    return false;  // but where they are in one plane, which is for the integers
}

// The stages, as those of `intersects`. Shapes come with their cores in order.

/// The first one, in registers.
template <arithmetic A, class S, class U>
    requires cores_in_order<S, U>
ABUT_HD constexpr verdict decide_within(const S& s, const U& t, double distance) {
    constexpr int n = corners_of_core<S>, m = corners_of_core<U>;
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<hulls_within<n, m>>(values_within(s, t, distance).value);
    } else if constexpr (n == 1) {
        return decide_from_point<A>(s, t, distance, std::make_index_sequence<std::size_t{m}>{});
    } else {
        return near_by_corners(two_hulls_of<std::same_as<A, filtered>>(s, t, distance));
    }
}

/// What that leaves of pairs without a point: all features, in floating point. `fast` always answers.
template <arithmetic A, class S, class U>
    requires(cores_in_order<S, U> && corners_of_core<S> > 1)
ABUT_NOINLINE ABUT_HD constexpr verdict decide_within_late(const S& s, const U& t, double distance) {
    constexpr bool certified = std::same_as<A, filtered>;
    if (seem_to_touch<A>(core_of(s), core_of(t))) return verdict::yes;
    return near_by_ways(two_hulls_of<certified>(s, t, distance));
}

/// The last one: decides every finite input.
template <class S, class U>
    requires cores_in_order<S, U>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const S& s, const U& t, double distance) {
    return decide_at_any_span<hulls_within<corners_of_core<S>, corners_of_core<U>>>(values_within(s, t, distance).value);
}

}  // namespace detail

}  // namespace abut
