// SPDX-License-Identifier: MIT
#pragma once

// Contacts of boxes with spheres and capsules that touch them. As of round shapes with a triangle: they come apart soonest
// straight away from each other's nearest points; where the axis (a sphere's: its centre) is in the box, along an axis of
// the box or across one and the capsule's. Depth is the least move in any direction.

#include <concepts>

#include <abut/narrow/directions.hpp>
#include <abut/narrow/flat_contact.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/round_contact.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// A box, and a ball swept along an axis, at the common scale.
struct box_and_ball {
    point lower, upper, axis[2];
    double radius;

    [[nodiscard]] ABUT_HD constexpr point corner(int i) const {
        return {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z};
    }
    /// How far the box has to go along n.
    [[nodiscard]] ABUT_HD constexpr double overlap(const point& n) const {
        const point first{n.x > 0 ? lower.x : upper.x, n.y > 0 ? lower.y : upper.y, n.z > 0 ? lower.z : upper.z};
        const double most = extent_of(axis, n, axis[0]).upper, least_of_box = plain_dot(n, plain_difference(first, axis[0]));
        return plain_sum(plain_sum(most, radius), -least_of_box);
    }
    /// Calls f with ways from the axis to the box, of which one is the shortest where they do not meet.
    template <class N, class F>
    ABUT_HD constexpr void for_each_way(const F& f) const {
        ABUT_ROLLED
        for (const point& end : axis) {
            const point y{into_range(end.x, lower.x, upper.x), into_range(end.y, lower.y, upper.y),
                          into_range(end.z, lower.z, upper.z)};
            f(near_points<N>{{y, end}, between<N>(end, y)});
        }
        ABUT_ROLLED
        for (int i = 0; i < 8; ++i) {
            const point c = corner(i);
            const foot_point<N> foot = foot_on_segment<N>(c, axis[0], axis[1]);
            f(near_points<N>{{c, foot.at}, foot.away});
            for (int along = 1; along < 8; along *= 2) {
                if ((i & along) == 0) f(near_segments<N>(c, corner(i | along), axis[0], axis[1]));
            }
        }
    }
    /// The middle of the part of the axis that is in the box, or nearly is.
    [[nodiscard]] ABUT_HD constexpr point middle_of_axis() const {
        double from = 0, to = 1;
        for (int k = 0; k < 3; ++k) {
            const double start = coordinate(axis[0], k), way = plain_sum(coordinate(axis[1], k), -start);
            if (way == 0) continue;
            const double x = plain_sum(coordinate(lower, k), -start) / way;
            const double y = plain_sum(coordinate(upper, k), -start) / way;
            from = greatest(least(x, y), from);
            to = least(greatest(x, y), to);
        }
        const point p = on_segment(axis[0], axis[1], into_unit(one_double::of(plain_sum(from, to) / 2)));
        return {into_range(p.x, lower.x, upper.x), into_range(p.y, lower.y, upper.y), into_range(p.z, lower.z, upper.z)};
    }
};

/// The directions of faces of the sum of a box and an axis.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr void offer_faces(const box_and_ball& pair, const segment<T>& axis, least_overlap& way) {
    const auto offer_both = [&](const point& n) {
        if (is_zero(n)) return;
        way.offer(n, pair.overlap(n));
        way.offer(negated(n), pair.overlap(negated(n)));
    };
    const point along = rounded_off(edge_between(axis.a, axis.b).direction);
    for (const point& n : {point{1, 0, 0}, point{0, 1, 0}, point{0, 0, 1}}) {
        offer_both(n);
        const point across = plain_cross(n, along);  // rounds nothing
        if (!is_zero(across)) offer_both(plain_normal<T>(unit_vector(as<one_double>(across))));
    }
}

}  // namespace abut::detail::contact_math

namespace abut::detail {

/// The same of a box and a sphere in plain doubles (plain_ways.hpp): along the way to the centre, or if that is inside,
/// along an axis.
template <scalar T, class U>
    requires(has_radius<U> && corners_of_core<U> == 1 && has_plain_pair<aabb<T>, U>)
ABUT_NOINLINE ABUT_HD constexpr first_contact<T> first_contact_of(const aabb<T>& s, const U& t,
                                                                  const plain_pair<aabb<T>, U>& both) {
    using namespace contact_math;
    first_contact<T> answer{both.touch()};
    if (answer.touch == verdict::no) return answer;
    const double radius = both.radius_b;
    if (answer.touch == verdict::yes) {
        const point n = plain_normal<T>(plain_times(-1 / both.length, both.way()));
        answer.found = plain_contact(both.nearest, n, plain_sum(radius, plain_dot(n, both.way())));
    } else if (is_zero(both.way())) {
        const point lower = plain_way_to(s.lower, t.center), upper = plain_way_to(t.center, s.upper);
        if (!are_plain_sizes<T>(plain_sum(plain_sum(radius, plain_magnitudes(lower)), plain_magnitudes(upper))))
            return answer;
        least_overlap way;
        const auto offer = [&](const point& n, double to_lower, double to_upper) {
            way.offer(n, plain_sum(radius, to_lower));
            way.offer(negated(n), plain_sum(radius, to_upper));
        };
        offer({1, 0, 0}, lower.x, upper.x), offer({0, 1, 0}, lower.y, upper.y), offer({0, 0, 1}, lower.z, upper.z);
        answer = {verdict::yes, plain_contact(t.center, way.normal, way.depth)};
    }
    return answer;
}

/// The same of a box and a capsule whose axis is not in it. The normal is right as in round_contact.hpp.
template <scalar T, class U>
    requires(has_radius<U> && corners_of_core<U> == 2 && has_plain_pair<aabb<T>, U>)
ABUT_INLINE ABUT_HD constexpr first_contact<T> first_contact_of(const aabb<T>& s, const U& t,
                                                                  const plain_pair<aabb<T>, U>& both) {
    using namespace contact_math;
    first_contact<T> answer{both.touch()};
    if (answer.touch != verdict::yes) return answer;
    const point& ahead = both.box.ahead;
    const double per_length = 1 / root(one_double{plain_dot(ahead, ahead)}).high;
    const point n = plain_normal<T>(plain_times(-per_length, ahead));
    const double depth = plain_sum(both.radius_b, both.box.overlap(n)), least_depth = plain_sum(both.radius_b, -both.length);
    if (!is_tolerable(plain_sum(depth, -least_depth), both.size / 13, s, t)) return {};
    answer.found = plain_contact(both.on_a(s).at(0, n), n, depth);
    return answer;
}

/// The point is the box's one that is nearest to the axis, or the middle of the axis's part in the box.
template <scalar T, class S>
    requires(has_radius<S> && has_point_or_axis<S> && std::same_as<scalar_type_of<S>, T>)
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const aabb<T>& s, const S& t) {
    using namespace contact_math;
    using N = number_for<T>;
    if constexpr (has_plain_pair<aabb<T>, S>) {
        if (const auto first = first_contact_of(s, t, plain_pair<aabb<T>, S>(s, t)); first.touch == verdict::yes)
            return first.found;
    }
    const common_scale scale(s, t);
    const segment<T> axis = axis_around(t);
    const box_and_ball pair{scale(s.lower), scale(s.upper), {scale(axis.a), scale(axis.b)}, scale(t.radius)};
    least_overlap way;
    if (abut::intersects(s, axis)) {
        offer_faces(pair, axis, way);
        return assembled<T>(scale, pair.middle_of_axis(), way);
    }
    near_points<N> nearest{};
    N least_square = N::of(infinity<double>);
    pair.template for_each_way<N>([&](const near_points<N>& found) {
        const N square = dot(found.away, found.away);
        if (square < least_square) least_square = square, nearest = found;
    });
    double distance = 0;
    const point straight = as_stored_direction<T>(unit_vector(nearest.away));
    if (!is_zero(straight)) {
        way.offer(straight, pair.overlap(straight));
        distance = plain_dot(straight, rounded_off(nearest.away));
    }
    const double enough = plain_sum(plain_sum(pair.radius, -distance), tolerable_excess<T>);
    if (!(largest_of(rounded_off(nearest.away)) > 0x1p-12 && way.depth <= enough)) {
        offer_faces(pair, axis, way);
        if (way.depth > enough) {
            pair.template for_each_way<N>([&](const near_points<N>& found) {
                const point n = as_stored_direction<T>(unit_vector(found.away));
                if (!is_zero(n)) way.offer(n, pair.overlap(n));
            });
        }
    }
    return assembled<T>(scale, nearest.at.on_a, way);
}

}  // namespace abut::detail
