// SPDX-License-Identifier: MIT
#pragma once

// When a shape that goes along a vector touches another one first, and where. Whether it does at all, and when, is exact for
// `filtered` and `exact`: doubles tell two times between which it does (narrow/sweep_search.hpp), pairs of doubles how that is
// rounded, and where these do not, integers do (predicate/exact_sweep.hpp). One formulation serves all kinds of shapes that
// have a core of points: points, segments, triangles, boxes along the axes or not, hulls, and spheres and capsules.
//
// So a shape on its way is a shape: `decide` and `resolve` here are those of a swept one and any other.

#include <concepts>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/sweep_search.hpp>
#include <abut/predicate/exact_sweep.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/swept.hpp>

namespace abut {

/// What a shape touches first on its way. Where it touches nothing: `no_id`, infinity, and zeros.
/// @ingroup queries
template <scalar T>
struct sweep_hit {
    std::uint32_t id;  ///< of the shape that is touched, in its set
    T t;               ///< when, from 0 to 1: the shape has gone t times its way
    vec3<T> point;     ///< where, on the shape that is touched
    vec3<T> normal;    ///< of length 1, out of the shape that is touched; zero where shapes overlap at the start

    friend constexpr bool operator==(const sweep_hit&, const sweep_hit&) = default;
};

namespace detail {

/// A shape on its way, and another of the same scalar type, that have cores of points.
template <class S, class U>
concept sweepable_pair = has_core_points<S, scalar_type_of<S>> && has_core_points<U, scalar_type_of<S>>;

/// f(cores) of both.
template <class S, class U, class F>
ABUT_HD constexpr auto with_cores_on_way(const swept<S>& s, const U& t, const F& f) {
    using T = scalar_type_of<S>;
    const auto points_a = core_points_of(s.start);
    const auto points_b = core_points_of(t);
    const hull<T>&a = points_a.as_hull(), &b = points_b.as_hull();
    const cores_on_way<T> both{a, radius_around_core(s.start), s.way, b, radius_around_core(t)};
    return f(both);
}

/// As rounding leaves it: where the search comes to, if the cores are near each other there.
template <scalar T>
ABUT_HD constexpr double plain_sweep_time(const sweep_search<T>& found) {
    if (found.met == verdict::no) return -1;
    if (found.met == verdict::yes && found.last == 0) return 0;
    return found.time;
}

/// When a shape on its way touches another one first, rounded to the nearest double; or a negative number.
template <arithmetic A, class S, class U>
    requires sweepable_pair<S, U>
ABUT_NOINLINE ABUT_HD constexpr double sweep_time(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return with_cores_on_way(s, t, [](const cores_on_way<T>& both) {
        double hint = -1;
        if (!std::same_as<A, exact> && !ABUT_CONSTANT_EVALUATED()) {
            const sweep_search<T> found(both, 1);
            if (std::same_as<A, fast>) return plain_sweep_time(found);
            if (found.met == verdict::no) return -1.0;
            const double time = found.rounded_time();
            if (time >= 0) return time;
            hint = found.time;
        }
        return exact_sweep_time(both, hint);
    });
}

/// Bounds of what sweep_time gives, or negative ones where it is surely later than `until`.
template <arithmetic A, class S, class U>
    requires sweepable_pair<S, U>
ABUT_HD constexpr time_bounds sweep_bounds(const swept<S>& s, const U& t, double until) {
    using T = scalar_type_of<S>;
    if constexpr (std::same_as<A, filtered>) {
        if (!ABUT_CONSTANT_EVALUATED()) {
            return with_cores_on_way(s, t, [until](const cores_on_way<T>& both) {
                const sweep_search<T> found(both, least(until * (1 + 0x1p-50), 1.0));
                if (found.met == verdict::no) return time_bounds{-1, -1};
                if (found.met == verdict::yes) return time_bounds{found.first, found.last};
                const double time = exact_sweep_time(both, found.time);
                return time_bounds{time, time};
            });
        }
    }
    const double time = sweep_time<A>(s, t);
    return {time, time};
}

/// Where a shape on its way touches another one at that time, and in which direction. In double, in one order of operations; nothing is
/// decided by them.
template <scalar T>
struct sweep_place {
    vec3<T> point, normal;
};
template <class S, class U>
    requires sweepable_pair<S, U>
ABUT_NOINLINE ABUT_HD constexpr auto sweep_place_of(const swept<S>& s, const U& t, double time) {
    using T = scalar_type_of<S>;
    return with_cores_on_way(s, t, [time](const cores_on_way<T>& both) {
        sweep_search<T> found(both, 1);
        found.come_near(time);
        const vec3<double> along = contact_math::unit_vector(contact_math::as<contact_math::one_double>(found.normal)),
                           out = contact_math::plain_difference({0, 0, 0}, along);
        const vec3<double> on = plain_step(found.on_b, least(static_cast<double>(both.radius_b), found.gap_at_start), out);
        return sweep_place<T>{from_seen<T>(widened(both.a[0]), on),
                              {rounded(static_cast<T>(out.x)), rounded(static_cast<T>(out.y)), rounded(static_cast<T>(out.z))}};
    });
}

}  // namespace detail

/// One stage of the decision, as for two shapes at rest: whether a shape on its way touches another one.
template <arithmetic A, class S, class U>
    requires detail::sweepable_pair<S, U>
ABUT_HD constexpr verdict decide(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return detail::with_cores_on_way(s, t, [](const detail::cores_on_way<T>& both) {
        if constexpr (std::same_as<A, exact>) {
            detail::difference_simplex at;
            return detail::touched_in_integers<3>(both, detail::binary_time{1, 0}, at);
        } else {
            const detail::sweep_search<T> found(both, 1);
            return std::same_as<A, fast> ? to_verdict(detail::plain_sweep_time(found) >= 0) : found.met;
        }
    });
}

/// The last stage: decides every finite input.
template <class S, class U>
    requires detail::sweepable_pair<S, U>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return detail::with_cores_on_way(s, t, [](const detail::cores_on_way<T>& both) {
        detail::difference_simplex at;
        return detail::has_touched_by(both, {1, 0}, at);
    });
}

/// When a shape that goes along a vector touches another one first, and where, as `sweep` of sets defines it: the id is 0, or
/// `no_id` where it does not touch by the time 1. The same bits for `filtered` and `exact` on every device; `fast` is
/// approximate. Constant expressions are decided in integers.
///
///     constexpr auto hit = abut::sweep(abut::sphere<float>{{0, 0, 5}, 1},
///                                      abut::triangle<float>{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {0, 0, -8});
///     static_assert(hit.t == 0.5f);
/// @ingroup one_pair
template <arithmetic A = filtered, shape S, shape U>
[[nodiscard]] ABUT_HD constexpr sweep_hit<scalar_type_of<S>> sweep(const S& mover, const U& met,
                                                                   const vec3<scalar_type_of<S>>& way) {
    using T = scalar_type_of<S>;
    constexpr bool is = detail::sweepable_pair<S, U>;
    static_assert(is, "abut: points, segments, triangles, spheres, capsules, boxes, oriented boxes and hulls can be swept, and be met");
    sweep_hit<T> hit{no_id, infinity<T>, {0, 0, 0}, {0, 0, 0}};
    if constexpr (is) {
        const swept<S> s{mover, way};
        const double time = detail::sweep_time<A>(detail::as_stored(s), detail::as_stored(met));
        if (time < 0) return hit;
        const T at = detail::rounded(static_cast<T>(time));
        const auto place = detail::sweep_place_of(s, met, static_cast<double>(at));
        hit = {0, at, place.point, place.normal};
    }
    return hit;
}

}  // namespace abut
