// SPDX-License-Identifier: MIT
#pragma once

// When a cylinder or a cone that goes along a vector comes to another shape, or another shape to it: never too late, and early by no
// more than a length, 2^-36 of the sizes, if doubles lead so near; else it ends sooner, and so early. By conservative advancement (G. van den Bergen, Ray casting against general convex objects,
// 2004): at a time the search of narrow/plain_search.hpp brackets how far apart the two are. If that is within the tolerance, it is
// the time. Else no points of the two are nearer to each other along some way than some length, and until that is gone they are
// apart; the search goes on from there. That they never come together is proven alike.
//
// The solid is the shape that moves here; where it is the one that is met, it moves back. Points are seen from the first end of its
// axis. Let s be the largest coordinate of a point, of the way, or the radius. Points are off by less than 2^-50 s, and so is a
// length along a way; 2^-44 s is taken. Where s is not between 2^-150 and 2^150 only boxes tell.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_search.hpp>
#include <abut/narrow/sweep_flat.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/swept.hpp>

namespace abut::detail {

/// A cylinder or a cone, and a shape of its scalar type that may come to it.
///@{
template <class S, class U>
concept meets_solid = solid_of_revolution<S> && std::same_as<scalar_type_of<S>, scalar_type_of<U>> &&
                      (solid_of_revolution<U> || flat<U> || has_core_points<U, scalar_type_of<S>>);
template <class S, class U>
concept sweepable_round = meets_solid<S, U> || meets_solid<U, S>;
///@}

/// What is found of a solid and another shape: the time, or a negative one; and where both are nearest then, as seen.
struct round_meeting {
    double time = -1;
    vec3<double> on_solid{0, 0, 0}, on_other{0, 0, 0}, along{0, 0, 0};  ///< of any length, to the other one; zero if it is not known
    double length = 0;                                                 ///< between both points
};

/// A solid that goes along a way from t = 0, and a shape at rest, the core of which tells its farthest points.
template <class Core>
class round_search {
    using point = vec3<double>;

public:
    ABUT_HD constexpr round_search(const plain_solid& solid, const point& way, const Core& core, double radius)
        : solid_(solid), way_(way), core_(core), radius_(radius),
          size_(greatest(greatest(solid.size, core.size), greatest(contact_math::largest_of(way), radius))) {}

    static constexpr double share = 0x1p-44, tolerance = 0x1p-36;  ///< of the sizes
    static constexpr int most_steps = 4096;

    /// Where they come together, if not for certain after `until`.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr round_meeting find(double until) const {
        using namespace contact_math;
        round_meeting found;
        double time = 0;
        point along{0, 0, 0};
        if (!is_searched(size_)) return {0, along, along, along, 0};
        const double off = plain_product(share, size_), near = plain_sum(radius_, plain_product(tolerance, size_));
        for (int step = 0, again = 0;; ++step) {
            plain_solid here = solid_;
            for (point& end : here.end) end = plain_step(end, time, way_);
            plain_simplex at;
            const plain_nearest nearest = search_in_doubles(here, core_, at, along);
            along = is_zero(nearest.along) ? at.along : nearest.along;
            found = {time, nearest.on_a, nearest.on_b, nearest.meet ? point{0, 0, 0} : along, nearest.meet ? 0 : nearest.length};
            if (!nearest.is_sure) found.on_solid = at.mean_of(at.on_a), found.on_other = at.mean_of(at.on_b);
            if (nearest.meet || !(nearest.length > near) || step >= most_steps) return found;
            double gap = plain_sum(gap_along(here, along), -off);
            if (!(gap > plain_product(0x1p-3, plain_sum(nearest.length, -radius_)))) {
                // A search that has not come near enough begins again where it ended, or where a closed form of the feature leads to.
                const plain_guess guess = finish_search(here, core_, at);
                const point ways[] = {at.mean, guess.along, plain_difference(guess.on_b, guess.on_a)};
                for (const point& way : ways) {
                    const double other = plain_sum(gap_along(here, way), -off);
                    if (other > gap) gap = other, along = way;
                }
                if (!(gap > plain_product(0x1p-3, plain_sum(nearest.length, -radius_))) && again++ < most_again) continue;
            }
            if (!(gap > 0)) return found;
            found.along = along;
            const double speed = plain_dot(along, way_) / root(one_double{plain_dot(along, along)}).high;
            again = 0;
            if (plain_sum(gap, -plain_product(speed, plain_sum(until, -time))) > 0) return {};
            const double next = plain_sum(time, plain_product(gap / speed, 1 - 0x1p-50));
            if (!(next > time)) return found;
            time = least(next, until);
        }
    }

private:
    static constexpr int most_again = 24;

    /// How far they are apart along a way of any length, at least but for rounding.
    [[nodiscard]] ABUT_HD constexpr double gap_along(const plain_solid& here, const point& n) const {
        using namespace contact_math;
        const double length = root(one_double{plain_dot(n, n)}).high;
        if (!(length > shortest_usable_way)) return -infinity<double>;
        return plain_sum(plain_dot(n, plain_difference(core_.farthest(negated(n)), here.farthest(n))) / length, -radius_);
    }

    plain_solid solid_;
    point way_;
    const Core& core_;
    double radius_, size_;
};

/// A solid and a plane, or a half space, by the height of its farthest point over it.
template <scalar T>
ABUT_HD constexpr round_meeting meet_flat(const plain_solid& solid, const vec3<double>& origin, const vec3<double>& way, const plane<T>& met,
                                          bool is_solid) {
    using namespace contact_math;
    const point none{0, 0, 0}, given = widened(met.normal);
    if (largest_of(given) == 0) return {met.offset == 0 ? 0.0 : -1.0, none, none, none, 0};
    const int of_normal = exponent_of(largest_of(given));
    const point n = scaled(given, -of_normal);
    const double length = root(one_double{plain_dot(n, n)}).high, offset = scaled(static_cast<double>(met.offset), -of_normal) / length;
    const point unit{n.x / length, n.y / length, n.z / length};
    const double base = plain_sum(plain_dot(unit, origin), -offset),
                 size = greatest(greatest(solid.size, largest_of(way)), greatest(largest_of(origin), absolute(offset)));
    const double off = plain_product(0x1p-44, size);
    const auto come = [&](const point& down) {
        const point first = solid.farthest(down);
        const double height = plain_sum(is_solid || plain_dot(down, unit) < 0 ? base : -base, -plain_dot(down, first)), gap = plain_sum(height, -off),
                     ahead = plain_dot(down, way);
        round_meeting found{0, first, plain_step(first, height, down), down, absolute(height)};
        if (!(gap > 0)) {
            found.time = 0;
            if (height < -off) found.length = -1;  // it is inside
        } else if (plain_sum(gap, -ahead) > 0) {
            found.time = -1;
        } else {
            found.time = plain_product(gap / ahead, 1 - 0x1p-50);
            found.on_solid = plain_step(first, found.time, way);
            found.on_other = plain_step(found.on_solid, plain_sum(height, -plain_product(found.time, ahead)), down);
        }
        return found;
    };
    const round_meeting from_above = come(negated(unit));
    if (is_solid) {
        if (from_above.length < 0) return {0, from_above.on_solid, from_above.on_solid, negated(unit), 0};
        return from_above;
    }
    if (from_above.time != 0) return from_above;
    const round_meeting from_below = come(unit);
    if (from_below.time != 0 || from_above.length >= 0) return from_below.time != 0 ? from_below : from_above;
    if (from_below.length >= 0) return from_below;
    // It lies on both sides: somewhere between both points.
    const double rise = plain_dot(unit, plain_difference(from_below.on_solid, from_above.on_solid)),
                 low = plain_sum(base, plain_dot(unit, from_above.on_solid));
    const point on = plain_step(from_above.on_solid, rise > 0 ? -low / rise : 0, plain_difference(from_below.on_solid, from_above.on_solid));
    return {0, on, on, none, 0};
}

/// When they come together, if not after `until`. A solid whose axis has a length, which goes along the way, and any shape.
template <solid_of_revolution S, class U>
ABUT_HD constexpr round_meeting meet_solid(const S& s, const vec3<double>& way, const U& t, double until) {
    const vec3<double> origin = widened(axis_of(s).a);
    const plain_solid solid(s, origin);
    if constexpr (flat<U>) {
        return meet_flat(solid, origin, way, plane<scalar_type_of<U>>{t.normal, t.offset}, is_half_space<U>);
    } else if constexpr (solid_of_revolution<U>) {
        const plain_solid other(t, origin);
        return round_search<plain_solid>(solid, way, other, 0).find(until);
    } else {
        const auto points = core_points_of(t);
        const hull<scalar_type_of<U>>& corners = points.as_hull();  // perhaps of what is made here
        const plain_points<scalar_type_of<U>> core(corners, origin);
        return round_search<plain_points<scalar_type_of<U>>>(solid, way, core, static_cast<double>(radius_around_core(t))).find(until);
    }
}

/// f(a solid, the other shape) of the two, where `Mover` says that the solid is what goes.
template <class S, class U, class F>
ABUT_HD constexpr auto with_solid_first(const S& s, const U& t, const F& f) {
    if constexpr (solid_of_revolution<S>) {
        return f(s, t, true);
    } else {
        return f(t, s, false);
    }
}
/// Whether either has an axis without length: then it is a ball.
template <class S>
ABUT_HD constexpr bool is_ball(const S& s) {
    if constexpr (solid_of_revolution<S>) {
        return is_point(axis_of(s));
    } else {
        return false;
    }
}
template <class S>
ABUT_HD constexpr auto as_ball(const S& s) {
    if constexpr (solid_of_revolution<S>) {
        return ball_around(s);
    } else {
        return s;
    }
}

/// f(both), with what is a ball as one; one of them is.
template <class S, class U, class F>
ABUT_HD constexpr auto with_balls(const swept<S>& s, const U& t, const F& f) {
    const auto a = as_ball(s.start);
    const auto b = as_ball(t);
    const swept<std::remove_const_t<decltype(a)>> ball{a, s.way};
    return !is_ball(t) ? f(ball, t) : !is_ball(s.start) ? f(s, b) : f(ball, b);
}

/// The meeting of a shape on its way and another one, neither of which is a ball.
template <class S, class U>
ABUT_NOINLINE ABUT_HD constexpr round_meeting round_meeting_of(const swept<S>& s, const U& t, double until) {
    return with_solid_first(s.start, t, [&](const auto& solid, const auto& other, bool goes) {
        const vec3<double> way = widened(s.way);
        return meet_solid(solid, goes ? way : vec3<double>{-way.x, -way.y, -way.z}, other, until);
    });
}

/// Boxes around both.
template <class S, class U>
ABUT_HD constexpr bool have_boxes(const S& s, const U& t) {
    const auto a = bounds(s), b = bounds(t);
    const auto has_end = [](const auto& box) {
        using T = std::remove_cvref_t<decltype(box.lower.x)>;
        const auto far = greatest(absolute(box.lower), absolute(box.upper));
        return greatest(far.x, far.y, far.z) < infinity<T>;
    };
    return has_end(a) && has_end(b);
}

}  // namespace abut::detail
