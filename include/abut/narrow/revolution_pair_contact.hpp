// SPDX-License-Identifier: MIT
#pragma once

// Contacts of cylinders and cones with each other and with capsules: the least move in any direction, as in
// revolution_contact.hpp, whose head tells where the boundary of K, all differences, can be nearest to the origin. Here that
// is
//   where a flat end is: along an axis
//   where a side is, of a cylinder, a cone or a capsule: along a normal of that side. These are a circle of directions, and
//       the move along each of them is looked at: it is least where its slope changes from falling to rising
//   where a rim of one meets a rim of the other, and K has neither an edge nor a corner. Let p be the way from the first rim
//       to the second. No point of K's boundary is nearer to the origin, so no two points of both rims beside these are
//       nearer to each other: the place is one where the two circles are nearest, of all places around. Then the larger
//       rim's point is the one that is nearest to the smaller's. So one angle on the smaller rim is looked for. The
//       direction is orthogonal to both tangents
//   where a capsule's ball is: along the way to the nearest point of the other shape, if the axis does not meet it.
//
// Slopes are looked at in 16 places of a circle, and in up to 16 times as many where those do not go with a plain curve. So
// a place may be overlooked where it hardly shows. What is then lost was measured, not proved: docs/numerics/contacts.md.

#include <concepts>
#include <cstddef>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/common_unit.hpp>
#include <abut/narrow/cone_ways.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_contact.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Two cylinders or cones, a cone before a cylinder, or one of them and a capsule.
template <class S, class U>
concept pair_of_revolutions = solid_of_revolution<S> &&
    (std::same_as<U, capsule<scalar_type_of<S>>> || std::same_as<S, U> ||
     (std::same_as<S, cone<scalar_type_of<S>>> && std::same_as<U, cylinder<scalar_type_of<S>>>));

}  // namespace abut::detail

namespace abut::detail::contact_math {

/// c^2 + s^2 = 1
struct circle_point {
    double c, s;
};
/// The k-th of sixteen, counterclockwise from (1, 0).
ABUT_HD constexpr circle_point circle_point_of(int k) {
    constexpr double part[5] = {1, 0x1.d906bcf328d46p-1, 0x1.6a09e667f3bcdp-1, 0x1.87de2a6aea963p-2, 0};  // cosines
    const int at = k % 4;
    const double c = part[at], s = part[4 - at];
    switch (k / 4 % 4) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}
ABUT_HD constexpr circle_point unit_circle_point(const point& p) {
    const double length = root(one_double{plain_dot(p, p)}).high;
    return {p.x / length, p.y / length};
}
ABUT_HD constexpr circle_point between_circle_points(const circle_point& p, const circle_point& q) {
    return unit_circle_point({plain_sum(p.c, q.c), plain_sum(p.s, q.s), 0});
}

/// What something is at a place of a circle, and how steeply it rises there, counterclockwise, for each radian.
struct circle_place {
    circle_point at;
    double value, slope;
};

/// Where it is least between two places: it falls after the first and rises before the second. In turns of three, the chord
/// of both slopes is taken twice and the middle once; of an end that stays, half the slope (the Illinois method). Both ends
/// of what is left are used.
template <class Look, class Use>
ABUT_HD constexpr void use_least_between(circle_place from, circle_place to, const Look& look, const Use& use) {
    constexpr int most_steps = 150;
    int stayed = 0;  // -1 the first, 1 the second
    ABUT_ROLLED
    for (int i = 0; i < most_steps && from.slope < 0 && to.slope > 0; ++i) {
        const point chord{plain_sum(to.at.c, -from.at.c), plain_sum(to.at.s, -from.at.s), 0};
        if (!(plain_sum(absolute(chord.x), absolute(chord.y)) > 0x1p-51)) break;
        const double part = i % 3 == 2 ? 0.5 : from.slope / plain_sum(from.slope, -to.slope);
        const circle_place middle = look(unit_circle_point(plain_step({from.at.c, from.at.s, 0}, part, chord)));
        if (middle.slope < 0) {
            from = middle;
            if (stayed == 1) to.slope /= 2;
            stayed = 1;
        } else {
            to = middle;
            if (stayed == -1) from.slope /= 2;
            stayed = -1;
        }
    }
    use(from.at);
    use(to.at);
}

/// Whether something that rises at two places, or falls at both, may do neither in between, as values and slopes tell: a
/// cubic that has these is monotone if the slopes' sum is no more than three times the mean slope (Fritsch and Carlson:
/// Monotone piecewise cubic interpolation, 1980).
ABUT_HD constexpr bool may_turn_between(const circle_place& from, const circle_place& to, double angle) {
    const double slopes = plain_product(plain_sum(from.slope, to.slope), angle),
                 rise = plain_product(3.0, plain_sum(to.value, -from.value));
    return absolute(slopes) > 0x1p-48 && (slopes > 0 ? rise < slopes : rise > slopes);
}

/// Calls use(place) where something of a circle's points is least, of all around.
template <class Look, class Use>
ABUT_HD constexpr void for_each_least(const Look& look, const Use& use) {
    constexpr int places = 16, halvings = 4;
    constexpr double angle_between = 0x1.921fb54442d18p-2;  // pi / 8
    circle_place from = look(circle_point_of(places - 1));
    ABUT_ROLLED
    for (int k = 0; k < places; ++k) {
        circle_place to[halvings + 1];
        double angle[halvings + 1];
        int count = 1;
        to[0] = look(circle_point_of(k));
        angle[0] = angle_between;
        ABUT_ROLLED
        while (count > 0) {
            const circle_place next = to[count - 1];
            double& between = angle[count - 1];
            if (from.slope <= 0 && next.slope >= 0) {
                use_least_between(from, next, look, use);
            } else if ((from.slope > 0) == (next.slope > 0) && count <= halvings && may_turn_between(from, next, between)) {
                between /= 2;
                angle[count] = between;
                to[count++] = look(between_circle_points(from.at, next.at));
                continue;
            }
            from = next;
            --count;
        }
    }
}

/// Two cylinders, cones or capsules, the first of which goes and is no capsule.
template <scalar T>
class two_round_solids : public ways_out_of_solid<T, seen_round_solid> {
    using base = ways_out_of_solid<T, seen_round_solid>;

public:
    using base::base;

    ABUT_HD constexpr void offer_all() {
        const seen_round_solid &a = this->solid_, &b = this->other_;
        this->offer_both(a.axis);
        this->offer_both(b.axis);
        const normals_of_sides both(a.axis, a.side_out, b.axis, -b.side_out);
        for (int k = 0; k < 2 && both.are; ++k) this->offer(unit_vector(both.at[k]));
        offer_side(a, -1);
        offer_side(b, 1);
        ABUT_ROLLED
        for (int k = 0; k < 4; ++k) {
            if (a.has_rim(k / 2) && b.has_rim(k % 2)) offer_rims(k / 2, k % 2);
        }
    }

private:
    /// Along the normals of a side, or against them.
    ABUT_NOINLINE ABUT_HD constexpr void offer_side(const seen_round_solid& of, double sense) {
        const point first = any_orthogonal(of.along), second = plain_cross(of.axis, first);
        const auto direction = [&](const circle_point& p) {
            const point n = of.side_normal(on_circle(p, first, second));
            return sense < 0 ? negated(n) : n;
        };
        for_each_least(
            [&](const circle_point& p) {
                const point n = direction(p), tangent = on_circle({-p.s, p.c}, first, second);
                const point way = plain_difference(this->other_.farthest(n), this->solid_.farthest(negated(n)));
                const double rise = plain_product(sense, of.side_along.high);
                return circle_place{p, plain_dot(way, n), plain_product(rise, plain_dot(way, tangent))};
            },
            [&](const circle_point& p) { this->offer(direction(p)); });
    }
    /// Along what is orthogonal to both rims, where they are nearest to each other: for places on the smaller one, beside
    /// which the other one changes slowly.
    ABUT_NOINLINE ABUT_HD constexpr void offer_rims(int end_a, int end_b) {
        const seen_round_solid &a = this->solid_, &b = this->other_;
        const bool is_a_smaller = a.radius < b.radius;
        const seen_round_solid &small = is_a_smaller ? a : b, &large = is_a_smaller ? b : a;
        const point between =
            plain_difference(small.end[is_a_smaller ? end_a : end_b], large.end[is_a_smaller ? end_b : end_a]);
        const point first = any_orthogonal(small.along), second = plain_cross(small.axis, first);
        const auto look = [&](const circle_point& p) {
            const point to_small = plain_step(between, small.radius, on_circle(p, first, second));
            const point across = plain_step(to_small, -plain_dot(to_small, large.axis), large.axis);
            const double length = root(one_double{plain_dot(across, across)}).high;
            const point out = length > 0 ? plain_step({0, 0, 0}, 1 / length, across) : any_orthogonal(large.along);
            return place_on_rims{out, plain_step(to_small, -large.radius, out), on_circle({-p.s, p.c}, first, second)};
        };
        for_each_least(
            [&](const circle_point& p) {
                const place_on_rims place = look(p);
                return circle_place{p, plain_dot(place.way, place.way) / 2,
                                    plain_product(small.radius, plain_dot(place.way, place.tangent))};
            },
            [&](const circle_point& p) {
                const place_on_rims place = look(p);
                this->offer_both(
                    unit_vector(as<one_double>(plain_cross(plain_cross(large.axis, place.out), place.tangent))));
                this->offer_both(unit_vector(as<one_double>(place.way)));
            });
    }
    struct place_on_rims {
        point out;      ///< from the larger rim's centre, of length 1
        point way;      ///< from the larger rim to the smaller
        point tangent;  ///< of the smaller rim, of length 1
    };
    ABUT_HD static constexpr point on_circle(const circle_point& p, const point& first, const point& second) {
        return plain_step(plain_step({0, 0, 0}, p.c, first), p.s, second);
    }
};

}  // namespace abut::detail::contact_math

namespace abut::detail {

/// Of two that have axes with a length.
template <class S, class U>
ABUT_NOINLINE ABUT_HD constexpr contact<scalar_type_of<S>> contact_of_round_solids(const S& s, const U& t) {
    using namespace contact_math;
    using T = scalar_type_of<S>;
    if (const auto known = find_contact_in_doubles(s, t); known.is_known) return known.found;
    const common_scale scale(s, t);
    const auto unit = common_unit(s, t);
    const point origin = scale(axis_of(s).a);
    const seen_round_solid a(s, origin, scale), b(t, origin, scale);
    two_round_solids<T> pair(a, b);
    pair.offer_all();
    vec3<T> where{};
    if constexpr (std::same_as<U, capsule<T>>) {
        const auto nearest = nearest_way_from<true>(s, core_of(t), unit);
        pair.offer(unit_vector(as<one_double>(negated(nearest.way))));
        where = point_of_both(s, t, nearest, unit);
    } else {
        where = shared_point_of(s, t);
    }
    contact<T> found = assembled<T>(scale, {0, 0, 0}, pair.way());
    found.point = where;
    return found;
}

/// The normal points to the first one.
template <class S, class U>
ABUT_HD constexpr contact<scalar_type_of<S>> contact_in_this_order(const S& s, const U& t) {
    using T = scalar_type_of<S>;
    if constexpr (std::same_as<U, capsule<T>>) {
        if (is_point(axis_of(s))) return contact_with_ball(ball_around(s), t);
        if (is_point(t.axis)) return contact_between(s, sphere<T>{t.axis.a, t.radius});
    } else {
        if (is_point(axis_of(s)) && is_point(axis_of(t))) return contact_between(ball_around(s), ball_around(t));
        if (is_point(axis_of(s))) return reversed(contact_between(t, ball_around(s)));
        if (is_point(axis_of(t))) return contact_between(s, ball_around(t));
    }
    return contact_of_round_solids(s, t);
}
/// Two of one kind are taken in one order, so that the other one has the same contact reversed.
template <class S, class U>
requires pair_of_revolutions<S, U> ABUT_HD constexpr contact<scalar_type_of<S>> contact_between(const S& s, const U& t) {
    if constexpr (std::same_as<S, U>) {
        const bool swap = precedes(t, s);
        const contact<scalar_type_of<S>> found = contact_in_this_order(swap ? t : s, swap ? s : t);
        return swap ? reversed(found) : found;
    } else {
        return contact_in_this_order(s, t);
    }
}

}  // namespace abut::detail
