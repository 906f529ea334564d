// SPDX-License-Identifier: MIT
#pragma once

// When a shape that goes along a vector touches another one first, and where. Whether it does at all, and when, is exact for
// `filtered` and `exact`: doubles tell two times between which it does (narrow/sweep_search.hpp), pairs of doubles how that is
// rounded, and where these do not, integers do (predicate/exact_sweep.hpp). One formulation serves all kinds of shapes that
// have a core of points: points, segments, triangles, boxes along the axes or not, hulls, and spheres and capsules. These and
// planes or half spaces are in narrow/sweep_flat.hpp. Cylinders and cones are certified instead (narrow/sweep_round.hpp).
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
#include <abut/narrow/sweep_flat.hpp>
#include <abut/narrow/sweep_round.hpp>
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
concept sweepable_cores = has_core_points<S, scalar_type_of<S>> && has_core_points<U, scalar_type_of<S>>;
/// All that can go, and be met.
template <class S, class U>
concept sweepable_pair = sweepable_cores<S, U> || sweepable_flat<S, U> || sweepable_round<S, U>;

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
    requires sweepable_cores<S, U>
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

/// Bounds of what sweep_time gives, or negative ones where it is surely later than `until`. Where doubles do not tell whether it is,
/// they come from integers, or, `InDoubles`, the last is infinite.
template <arithmetic A, bool InDoubles = false, class S, class U>
    requires sweepable_cores<S, U>
ABUT_HD constexpr time_bounds sweep_bounds(const swept<S>& s, const U& t, double until) {
    using T = scalar_type_of<S>;
    if constexpr (std::same_as<A, filtered>) {
        if (!ABUT_CONSTANT_EVALUATED()) {
            return with_cores_on_way(s, t, [until](const cores_on_way<T>& both) {
                const sweep_search<T> found(both, least(until * (1 + 0x1p-50), 1.0));
                if (found.met == verdict::no) return time_bounds{-1, -1};
                if (found.met == verdict::yes) return time_bounds{found.first, found.last};
                if constexpr (InDoubles) return time_bounds{found.apart_until(), infinity<double>};
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
    requires sweepable_cores<S, U>
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

/// Whether they touch at the start, of any finite input.
template <class S, class U>
    requires sweepable_cores<S, U>
ABUT_HD constexpr bool touch_at_start(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return with_cores_on_way(s, t, [](const cores_on_way<T>& both) {
        difference_simplex at;
        return has_touched_by(both, {0, 0}, at);
    });
}

// The same of a plane or a half space, and a shape with a core.

template <class S, class U>
    requires sweepable_flat<S, U>
ABUT_HD constexpr bool touch_at_start(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return with_flat_on_way(s, t, [](const flat_on_way<T>& both) {
        return with_first_to_come(both, true, [](const flat_in_integers<T>&) { return false; });
    });
}
template <arithmetic A, class S, class U>
    requires sweepable_flat<S, U>
ABUT_NOINLINE ABUT_HD constexpr double sweep_time(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return with_flat_on_way(s, t, [](const flat_on_way<T>& both) { return flat_time<A>(both); });
}
template <arithmetic A, class S, class U>
    requires sweepable_flat<S, U>
ABUT_HD constexpr time_bounds sweep_bounds(const swept<S>& s, const U& t, double until) {
    using T = scalar_type_of<S>;
    if constexpr (std::same_as<A, filtered>) {
        if (!ABUT_CONSTANT_EVALUATED()) {
            const time_bounds between = with_flat_on_way(s, t, [until](const flat_on_way<T>& both) {
                return flat_time_bounds(both, least(until * (1 + 0x1p-50), 1.0));
            });
            if (between.last <= 1) return between;
        }
    }
    const double time = sweep_time<A>(s, t);
    return {time, time};
}
template <class S, class U>
    requires sweepable_flat<S, U>
ABUT_NOINLINE ABUT_HD constexpr auto sweep_place_of(const swept<S>& s, const U& t, double time) {
    using T = scalar_type_of<S>;
    return with_flat_on_way(s, t, [&](const flat_on_way<T>& both) {
        flat_place place = flat_place_of(both, time);
        if constexpr (flat<S>) {
            place.on = plain_step(place.on, time, widened(s.way));
            place.normal = {-place.normal.x, -place.normal.y, -place.normal.z};
        }
        const vec3<double>& n = place.normal;
        return sweep_place<T>{from_seen<T>(widened(both.core[0]), place.on),
                              {rounded(static_cast<T>(n.x)), rounded(static_cast<T>(n.y)), rounded(static_cast<T>(n.z))}};
    });
}

// The same of a cylinder or a cone and any shape. Whether and when they meet is certified by narrow/sweep_round.hpp, and not decided
// exactly, whatever is asked. They meet no sooner than the boxes around them: so nothing depends on the boxes of an index.

template <arithmetic A, class S, class U>
    requires sweepable_round<S, U>
ABUT_NOINLINE ABUT_HD constexpr time_bounds sweep_bounds(const swept<S>& s, const U& t, double until) {
    if (is_ball(s.start) || is_ball(t)) {
        return with_balls(s, t, [until](const auto& a, const auto& b) { return sweep_bounds<A>(a, b, until); });
    }
    double soonest = 0;
    if (have_boxes(s.start, t)) {
        const swept<aabb<scalar_type_of<S>>> box{bounds(s.start), s.way};
        soonest = sweep_time<filtered>(box, bounds(t));
        if (soonest < 0 || soonest > until) return {-1, -1};
    }
    const round_meeting met = round_meeting_of(s, t, least(until, 1.0));
    const double time = met.time < 0 ? -1 : greatest(met.time, soonest);
    return {time, time};
}
template <arithmetic A, class S, class U>
    requires sweepable_round<S, U>
ABUT_HD constexpr double sweep_time(const swept<S>& s, const U& t) {
    if (is_ball(s.start) || is_ball(t)) {
        return with_balls(s, t, [](const auto& a, const auto& b) { return sweep_time<A>(a, b); });
    }
    return sweep_bounds<A>(s, t, 1).first;
}
template <class S, class U>
    requires sweepable_round<S, U>
ABUT_HD constexpr bool touch_at_start(const swept<S>& s, const U& t) {
    return intersects(s.start, t);
}
template <class S, class U>
    requires sweepable_round<S, U>
ABUT_NOINLINE ABUT_HD constexpr sweep_place<scalar_type_of<S>> sweep_place_of(const swept<S>& s, const U& t, double time) {
    using T = scalar_type_of<S>;
    if (is_ball(s.start) || is_ball(t)) {
        return with_balls(s, t, [time](const auto& a, const auto& b) { return sweep_place_of(a, b, time); });
    }
    using namespace contact_math;
    const round_meeting met = round_meeting_of(s, t, 1);
    const point to_other = is_zero(met.along) ? met.along : unit_vector(as<one_double>(met.along));
    constexpr bool solid_goes = solid_of_revolution<S>;
    const point out = solid_goes ? negated(to_other) : to_other;
    return with_solid_first(s.start, t, [&](const auto& solid, const auto& other, bool) {
        point on = met.on_solid;
        if constexpr (solid_goes) {
            double radius = 0;
            if constexpr (!solid_of_revolution<U> && !flat<U>) radius = static_cast<double>(radius_around_core(other));
            on = plain_step(met.on_other, least(radius, met.length), out);
        } else {
            on = plain_step(on, met.time, widened(s.way));
        }
        return sweep_place<T>{from_seen<T>(widened(axis_of(solid).a), on),
                              {rounded(static_cast<T>(out.x)), rounded(static_cast<T>(out.y)), rounded(static_cast<T>(out.z))}};
    });
}

}  // namespace detail

/// One stage of the decision, as for two shapes at rest: whether a shape on its way touches another one.
template <arithmetic A, class S, class U>
    requires detail::sweepable_cores<S, U>
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
    requires detail::sweepable_cores<S, U>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return detail::with_cores_on_way(s, t, [](const detail::cores_on_way<T>& both) {
        detail::difference_simplex at;
        return detail::has_touched_by(both, {1, 0}, at);
    });
}

/// The same of a plane or a half space, and a shape with a core: either goes.
///@{
template <arithmetic A, class S, class U>
    requires detail::sweepable_flat<S, U>
ABUT_HD constexpr verdict decide(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return detail::with_flat_on_way(s, t, [](const detail::flat_on_way<T>& both) {
        if constexpr (std::same_as<A, exact>) {
            return to_verdict(detail::touches_flat(both));
        } else if constexpr (std::same_as<A, fast>) {
            return to_verdict(detail::flat_time<fast>(both) >= 0);
        } else {
            const detail::time_bounds between = detail::flat_time_bounds(both, 1);
            return between.first < 0 ? verdict::no : between.last <= 1 ? verdict::yes : verdict::unknown;
        }
    });
}
template <class S, class U>
    requires detail::sweepable_flat<S, U>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const swept<S>& s, const U& t) {
    using T = scalar_type_of<S>;
    return detail::with_flat_on_way(s, t, [](const detail::flat_on_way<T>& both) { return detail::touches_flat(both); });
}
///@}

/// The same of a cylinder or a cone and any shape: certified, and not exact.
///@{
template <arithmetic A, class S, class U>
    requires detail::sweepable_round<S, U>
ABUT_HD constexpr verdict decide(const swept<S>& s, const U& t) {
    return to_verdict(detail::sweep_time<A>(s, t) >= 0);
}
template <class S, class U>
    requires detail::sweepable_round<S, U>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const swept<S>& s, const U& t) {
    return detail::sweep_time<filtered>(s, t) >= 0;
}
///@}

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
    static_assert(is, "abut: points, segments, triangles, spheres, capsules, cylinders, cones, boxes, oriented boxes and hulls can be swept, "
                      "and be met; planes and half spaces by these");
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
