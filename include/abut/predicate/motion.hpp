// SPDX-License-Identifier: MIT
#pragma once

// Does a moving vertex touch a moving triangle, or a moving segment another, at any time of a step? The stages of these two
// pairs; narrow/time_of_impact.hpp says when. What the last stage needs is more than a device has: it is the host's alone.

#include <concepts>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_motion.hpp>
#include <abut/predicate/exact_motion.hpp>
#include <abut/predicate/exact_triangles.hpp>
#include <abut/predicate/fast_motion.hpp>
#include <abut/shape/moving_shape.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <scalar T>
ABUT_HD constexpr moving_points<T> points_of(const motion<vec3<T>>& p, const motion<triangle<T>>& t) {
    return {{p.t0, t.t0.a, t.t0.b, t.t0.c}, {p.t1, t.t1.a, t.t1.b, t.t1.c}};
}
template <scalar T>
ABUT_HD constexpr moving_points<T> points_of(const motion<segment<T>>& s, const motion<segment<T>>& t) {
    return {{s.t0.a, s.t0.b, t.t0.a, t.t0.b}, {s.t1.a, s.t1.b, t.t1.a, t.t1.b}};
}

/// Two features that may meet in motion, in this order; and whether they are edges.
template <class S, class U>
inline constexpr bool are_features = false;
template <scalar T>
inline constexpr bool are_features<motion<vec3<T>>, motion<triangle<T>>> = true;
template <scalar T>
inline constexpr bool are_features<motion<segment<T>>, motion<segment<T>>> = true;
template <class S>
inline constexpr bool is_moving_edge = false;
template <scalar T>
inline constexpr bool is_moving_edge<motion<segment<T>>> = true;

/// Whether they touch at t = 0, by integers in registers. Not inlined, as decide_in_limbs.
template <bool Edges, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict touch_at_start(const moving_points<T>& p) {
    const vec3<T>&a = p.t0[0], &b = p.t0[1], &c = p.t0[2], &d = p.t0[3];
    if constexpr (Edges) {
        return decide_in_limbs<triangle_meets_triangle>(in_a_row(a, b, b, c, d, d).value);
    } else {
        return decide_in_limbs<triangle_meets_triangle>(in_a_row(a, a, a, b, c, d).value);
    }
}

/// Whether all points come to one place at t = 1. Before that all is as it was at the start, but smaller: so the features
/// touch at t = 1, and before that only if they do so at the start. By bits: some modes take denormal numbers for 0.
template <scalar T>
ABUT_HD constexpr bool come_together(const moving_points<T>& p) {
    using bits = std::conditional_t<std::same_as<T, float>, std::uint32_t, std::uint64_t>;
    const auto alike = [](T x, T y) { return ABUT_BIT_CAST(bits, x) == ABUT_BIT_CAST(bits, y); };
    const vec3<T>& at = p.t1[0];
    for (int i = 1; i < 4; ++i) {
        if (!(alike(at.x, p.t1[i].x) && alike(at.y, p.t1[i].y) && alike(at.z, p.t1[i].z))) return false;
    }
    return true;
}

/// The time of impact, a multiple of 2^-40 that is not above it, times 2^40; or -1. On hosts.
template <bool Edges, scalar T>
std::int64_t exact_time(const moving_points<T>& p) {
    T value[24];
    T* end = value;
    for (const vec3<T>& at : p.t0) end = append(end, at);
    for (const vec3<T>& at : p.t1) end = append(end, at);
    const exact_features features(value);
    return Edges ? features.edges_meet() : features.vertex_meets_face();
}

}  // namespace detail

/// One stage of the decision, as of shapes at rest. `exact` knows nothing here: all is left to `resolve`.
template <arithmetic A, class S, class U>
    requires detail::are_features<S, U>
ABUT_HD constexpr verdict decide(const S& s, const U& t) {
    constexpr bool edges = detail::is_moving_edge<S>;
    if constexpr (std::same_as<A, exact>) {
        return verdict::unknown;
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::motion_filter<edges>(detail::points_of(s, t)).look_once();
    } else {
        return to_verdict(detail::fast_motion<edges, scalar_type_of<S>>(detail::points_of(s, t)).time() >= 0);
    }
}

/// What the first stage left: in parts of the step, and at its start in integers.
template <arithmetic A, class S, class U>
    requires(std::same_as<A, filtered> && detail::are_features<S, U>)
ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const S& s, const U& t) {
    constexpr bool edges = detail::is_moving_edge<S>;
    const auto points = detail::points_of(s, t);
    if (detail::come_together(points)) return verdict::yes;
    const detail::motion_filter<edges> filter(points);
    const std::uint32_t shared = detail::shared_coordinates<edges>(points);
    const int axis = detail::axis_of_plane<edges>(shared);
    if (axis >= 0) {
        const verdict start = filter.start_apart() ? verdict::no : detail::touch_at_start<edges>(points);
        return start == verdict::no ? filter.search_in_plane(axis).touch : start;
    }
    const verdict v = filter.search(false, shared).touch;
    if (v != verdict::unknown) return v;
    return !filter.start_apart() && detail::touch_at_start<edges>(points) == verdict::yes ? verdict::yes : verdict::unknown;
}

/// The last stage: decides every finite input, slowly, on a host.
template <class S, class U>
    requires detail::are_features<S, U>
bool resolve(const S& s, const U& t) {
    return detail::exact_time<detail::is_moving_edge<S>>(detail::points_of(s, t)) >= 0;
}

}  // namespace abut
