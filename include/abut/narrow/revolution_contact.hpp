// SPDX-License-Identifier: MIT
#pragma once

// Contacts of a cylinder or a cone and what touches it: a point of both, and the way on which they come apart soonest. Depth
// is the least move in any direction.
//
// Let K be all differences of a point of the other shape and a point of the solid. The least move is the way from the origin
// to the nearest point of the boundary of K. Of a convex K that holds the origin, only one plane bounds K there: with a
// second one, a nearer point would be on one of the two. So it is no point where K has an edge or a corner. What is left of
// the boundary is made of
//   the inside of a flat end, or a place inside the side, and a corner of the other: along the axis; or from the axis
//   towards
//       the corner, and of a cone across the side there
//   a line on the side and an edge: across both
//   a rim and an edge: along a normal of the rim as it is seen along the edge, an ellipse
//   a rim or an apex and a face: along the face's normal
// of which all directions are tried. Of the ellipse, whose centre is the origin, half axes are A >= B > 0, and a point is (A
// c, B s) with c^2 + s^2 = 1, the edge is seen as a point (x, y), with x >= 0. Its distance from a point of the ellipse
// rises where A x s - B y c - (A^2 - B^2) s c is positive. If y >= 0, that is negative or 0 at (1, 0) and positive or 0 at
// (0, 1), and once 0 between: the nearest point of all. On the other side of the larger axis, where y < 0, it is positive at
// both; over s c it is convex, and least where B |y| c^3 = A x s^3. If it is negative there, it is 0 between that and (0,
// 1), at a point that is nearer than those beside it. There are no other such points.

#include <cstddef>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/box_contact.hpp>
#include <abut/narrow/common_unit.hpp>
#include <abut/narrow/cone_ways.hpp>
#include <abut/narrow/cylinder_ways.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/flat_contact.hpp>
#include <abut/narrow/hull_contact.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_distance.hpp>
#include <abut/narrow/plain_foot.hpp>
#include <abut/narrow/plain_least_move.hpp>
#include <abut/narrow/revolution_foot.hpp>
#include <abut/narrow/revolution_plane.hpp>
#include <abut/narrow/revolution_ways.hpp>
#include <abut/narrow/round_contact.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

// --- a point of both ------------------------------------------------------------------------------------------------------

/// Of a solid and another shape that touch, by the least way between them as it is rounded.
template <solid_of_revolution S, class U, scalar T>
ABUT_HD constexpr vec3<T> point_of_both(const S& s, const U& t, const nearest_way<T>& nearest, const length_unit<T>& unit) {
    if constexpr (std::same_as<U, sphere<T>> || std::same_as<U, capsule<T>>) {  // of the solid, the one nearest to the core
        return end_of_way(s, nearest.from_a, nearest.to_a, unit);
    } else if constexpr (std::same_as<S, U>) {  // the same in either order
        return precedes(s, t) ? end_of_way(s, nearest.from_a, nearest.to_a, unit)
                              : end_of_way(t, nearest.from_b, nearest.to_b, unit);
    } else if constexpr (std::same_as<U, aabb<T>>) {
        return end_of_way<T>(nearest.from_b, nearest.to_b, t, unit);
    } else {
        return end_of_way(t, nearest.from_b, nearest.to_b, unit);
    }
}

/// A point of a solid and another shape that touch. The solid has an axis.
template <solid_of_revolution S, class U>
ABUT_HD constexpr auto shared_point_of(const S& s, const U& t) {
    const auto unit = common_unit(s, t);
    if constexpr (solid_of_revolution<U>) {
        return point_of_both(s, t, nearest_way_from<true>(s, t, unit), unit);
    } else {
        return point_of_both(s, t, nearest_way_from<true>(s, core_of(t), unit), unit);
    }
}
template <solid_of_revolution S, scalar T>
ABUT_HD constexpr vec3<T> shared_point_of(const S& s, const plane<T>& t) {
    if (t.normal == vec3<T>{0, 0, 0}) return axis_of(s).b;
    return revolution_over_plane<T>(s, t, common_unit(s, t)).shared_point();
}

}  // namespace abut::detail

namespace abut::detail::contact_math {

/// Points of the quarter of a unit circle from (1, 0) to (0, 1).
struct quarter_point {
    double c, s;
};
ABUT_HD constexpr quarter_point unit_quarter_point(double c, double s) {
    const double length = root(one_double{plain_sum(plain_product(c, c), plain_product(s, s))}).high;
    return {c / length, s / length};
}
ABUT_HD constexpr quarter_point between_quarter_points(const quarter_point& p, const quarter_point& q) {
    return unit_quarter_point(plain_sum(p.c, q.c), plain_sum(p.s, q.s));
}

/// An ellipse around the origin with half axes `a` >= `b` > 0, and a point with x >= 0.
struct ellipse_and_point {
    double a, b, x, y;

    /// Of the nearest point of the quarter x, y >= 0, if its distance is least there, within; `found` tells.
    [[nodiscard]] ABUT_HD constexpr quarter_point nearest(bool& found) const {
        quarter_point from{1, 0}, to{0, 1};
        found = true;
        if (y < 0) {
            // Where it rises the least, over s c.
            const double p = plain_product(b, -y), q = plain_product(a, x);
            for (int i = 0; i < few_steps || (from.s == 0 && i < most_steps); ++i) {  // at (1, 0) it says nothing
                const quarter_point m = between_quarter_points(from, to);
                const bool is_before = plain_product(p, cube(m.c)) > plain_product(q, cube(m.s));
                is_before ? from = m : to = m;
            }
            if (!(rise(from) < 0)) from = to;
            found = rise(from) < 0;
            to = {0, 1};
            if (!found) return from;
        }
        // By tangents, and halves where these lead out. The move is least there, and so off by the square of what the place is.
        quarter_point m = between_quarter_points(from, to);
        for (int i = 0; i < most_steps; ++i) {
            const double here = rise(m), steep = steepness(m);
            here < 0 ? from = m : to = m;
            const double turn = steep > 0 ? -here / steep : 2;
            const quarter_point next = unit_quarter_point(plain_sum(m.c, -plain_product(turn, m.s)),
                                                          plain_sum(m.s, plain_product(turn, m.c)));
            if (absolute(turn) < 1 && is_between(from, next, to)) {
                m = next;
                if (absolute(turn) < 0x1p-27) break;
            } else {
                m = between_quarter_points(from, to);
            }
        }
        return m;
    }

private:
    static constexpr int most_steps = 60, few_steps = 12;  ///< where it rises the least need not be known so well
    ABUT_HD static constexpr double cube(double t) { return plain_product(plain_product(t, t), t); }
    ABUT_HD static constexpr bool is_between(const quarter_point& from, const quarter_point& m, const quarter_point& to) {
        return m.s >= from.s && m.c <= from.c && m.s <= to.s && m.c >= to.c;
    }
    /// How it rises with the angle.
    [[nodiscard]] ABUT_HD constexpr double steepness(const quarter_point& p) const {
        const double edge = plain_sum(plain_product(plain_product(a, x), p.c), plain_product(plain_product(b, y), p.s));
        const double squares = plain_product(plain_sum(a, b), plain_sum(a, -b));
        return plain_sum(edge, -plain_product(squares, plain_product(plain_sum(p.c, p.s), plain_sum(p.c, -p.s))));
    }
    [[nodiscard]] ABUT_HD constexpr double rise(const quarter_point& p) const {
        const double edge = plain_sum(plain_product(plain_product(a, x), p.s), -plain_product(plain_product(b, y), p.c));
        const double squares = plain_product(plain_sum(a, b), plain_sum(a, -b));
        return plain_sum(edge, -plain_product(plain_product(squares, p.s), p.c));
    }
};

/// A cylinder, a cone or a capsule at the common scale, as seen from some point.
struct seen_round_solid {
    vec3<two_doubles> along;
    point axis, end[2];  ///< the first end of a cone is its apex
    double radius;
    bool is_cone, is_capsule;
    two_doubles side_along{1, 0}, side_out{0, 0};  ///< of a cone's side, from the apex to the rim

    template <class S>
    ABUT_HD constexpr seen_round_solid(const S& s, const point& origin, const common_scale& scale)
        : along(edge_between(ends_of(s).a, ends_of(s).b).direction),
          axis(unit_vector(along)),
          end{plain_difference(scale(ends_of(s).a), origin), plain_difference(scale(ends_of(s).b), origin)},
          radius(scale(s.radius)),
          is_cone(requires { s.apex; }),
          is_capsule(!solid_of_revolution<S>) {
        know_side();
    }
    [[nodiscard]] ABUT_HD constexpr bool has_rim(int k) const { return !is_capsule && radius > 0 && !(is_cone && k == 0); }

    /// How far it reaches along n, of about length 1.
    [[nodiscard]] ABUT_HD constexpr double reach(const point& n) const {
        const point sine = plain_cross(n, axis);
        const double around = is_capsule ? radius : plain_product(radius, root(one_double{plain_dot(sine, sine)}).high);
        const double first = plain_dot(n, end[0]), last = plain_dot(n, end[1]);
        return is_cone ? greatest(first, plain_sum(last, around)) : plain_sum(greatest(first, last), around);
    }
    /// Which point that is.
    [[nodiscard]] ABUT_HD constexpr point farthest(const point& n) const {
        const double first = plain_dot(n, end[0]), last = plain_dot(n, end[1]);
        if (is_capsule) return plain_step(end[last > first ? 1 : 0], radius, n);
        point across = plain_step(n, -plain_dot(n, axis), axis);
        double length = root(one_double{plain_dot(across, across)}).high;
        if (length < 0x1p-5) {  // of what rounding leaves there, no small part may lead along the axis
            across = part_across(n, axis);
            length = root(one_double{plain_dot(across, across)}).high;
        }
        const double around = plain_product(radius, length);
        const int k = plain_sum(last, is_cone ? around : 0) > first ? 1 : 0;
        return has_rim(k) && length > 0 ? plain_step(end[k], radius / length, across) : end[k];
    }
    /// Where the side's outward normal is as seen in the half plane of u, a direction across the axis.
    [[nodiscard]] ABUT_HD constexpr point side_normal(const point& u) const {
        return plain_step(plain_step({0, 0, 0}, side_along.high, u), -side_out.high, axis);
    }

private:
    ABUT_HD constexpr void know_side() {
        if (!is_cone) return;
        const double height = plain_dot(axis, plain_difference(end[1], end[0]));
        const vec3<two_doubles> side = brought_to_one(as<two_doubles>({height > 0 ? height : 0, radius, 0}));
        const two_doubles length = root(side.x * side.x + side.y * side.y);
        if (!(length.high > 0)) return;
        side_along = side.x / length;
        side_out = side.y / length;
    }
    template <class S>
    ABUT_HD static constexpr auto ends_of(const S& s) {
        if constexpr (solid_of_revolution<S>) {
            return axis_of(s);
        } else {
            return s.axis;
        }
    }
};

/// Corners of what touches a solid, seen from the same point, and a radius around them.
template <int N>
struct seen_corners {
    point at[std::size_t{N}]{};
    double around = 0;

    template <scalar T>
    ABUT_HD constexpr seen_corners(const vec3<T> (&corner)[std::size_t{N}], const point& origin, const common_scale& scale,
                                   double radius = 0)
        : around(radius) {
        for (int i = 0; i < N; ++i) at[i] = plain_difference(scale(corner[i]), origin);
    }
    [[nodiscard]] ABUT_HD constexpr double reach(const point& n) const {
        return plain_sum(extent_of(at, n, {0, 0, 0}).upper, around);
    }
};

/// A box, seen from the same point.
struct seen_box {
    point lower, upper;
    [[nodiscard]] ABUT_HD constexpr point corner(int i) const {
        return {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z};
    }
    [[nodiscard]] ABUT_HD constexpr double reach(const point& n) const {
        return plain_dot(n, corner((n.x > 0 ? 1 : 0) | (n.y > 0 ? 2 : 0) | (n.z > 0 ? 4 : 0)));
    }
};

/// A solid that goes and another shape, which has a reach too, that stays.
template <scalar T, class Other>
class ways_out_of_solid {
public:
    ABUT_HD constexpr ways_out_of_solid(const seen_round_solid& s, const Other& other) : solid_(s), other_(other) {}

    /// The least way of those that were offered.
    [[nodiscard]] ABUT_HD constexpr least_overlap way() const {
        const point n = as_stored_direction<T>(unit_vector(as<two_doubles>(best_.normal)));
        return {n, overlap(n)};
    }

    /// Its overlap, but for rounding.
    [[nodiscard]] ABUT_HD constexpr double depth() const { return best_.depth; }

    /// The solid goes along n, of about length 1.
    ABUT_HD constexpr void offer(const point& n) {
        if (is_zero(n)) return;
        const point stored = as_stored_direction<T>(n);
        best_.offer(stored, overlap(stored));
    }
    ABUT_HD constexpr void offer_both(const point& n) {
        offer(n);
        offer(negated(n));
    }
    /// Out of the flat ends.
    ABUT_HD constexpr void offer_ends() {
        offer(negated(solid_.axis));
        if (!solid_.is_cone) offer(solid_.axis);
    }
    /// The side goes away from a corner.
    ABUT_HD constexpr void offer_corner(const point& p) {
        const point seen = plain_difference(p, solid_.end[0]);
        const point out = unit_vector(as<one_double>(part_across(seen, solid_.axis)));
        offer_side(is_zero(out) ? any_orthogonal(solid_.along) : out);
    }
    /// The side and the rims go away from an edge, a point of which is p.
    ABUT_HD constexpr void offer_edge(const point& p, const vec3<two_doubles>& along_edge) {
        const direction_of_edge edge(solid_, along_edge);
        offer_side_of_edge(edge);
        offer_rims_of_edge(p, edge);
    }
    /// A direction, and what is across it and the axis.
    struct direction_of_edge {
        point e, across;
        double slope;

        ABUT_HD constexpr direction_of_edge(const seen_round_solid& solid, const vec3<two_doubles>& along)
            : e(unit_vector(along)),
              across(unit_cross(solid.along, brought_to_one(along))),
              slope(plain_dot(e, solid.axis)) {
            if (is_zero(across)) across = any_orthogonal(solid.along);
        }
    };
    ABUT_HD constexpr void offer_side_of_edge(const direction_of_edge& edge) {
        if (is_zero(edge.e)) return;
        if (!solid_.is_cone) {
            offer_side(edge.across);
            offer_side(negated(edge.across));
            return;
        }
        // Of the directions u across the axis for which the side's normal is across the edge.
        const point flat = plain_cross(edge.across, solid_.axis);  // of the edge, as seen along the axis; or against it
        const double of_flat = plain_dot(edge.e, flat);
        const double part = plain_product(solid_.side_out.high, edge.slope),
                     whole = plain_product(solid_.side_along.high, of_flat);
        if (!(absolute(part) <= absolute(whole) && whole != 0)) return;
        const double c = part / whole;
        const double s = root(one_double{plain_product(plain_sum(1.0, c), plain_sum(1.0, -c))}).high;
        for (int k = -1; k < 2; k += 2) offer_side(plain_step(times(c, flat), k * s, edge.across));
    }
    ABUT_HD constexpr void offer_rims_of_edge(const point& p, const direction_of_edge& edge) {
        if (is_zero(edge.e)) return;
        for (int k = solid_.is_cone ? 1 : 0; k < 2; ++k) offer_rim(solid_.end[k], p, edge.e, edge.across, edge.slope);
    }

    /// All of a triangle, a segment or a point, whose corners are seen at `at`.
    template <int N>
    ABUT_HD constexpr void offer_corners(const corner_hull<T, N>& t, const point (&at)[std::size_t{N}]) {
        if constexpr (N == 3) offer_both(face_normal(triangle<T>{t.at[0], t.at[1], t.at[2]}));
        for (int i = 0; i < N; ++i) offer_corner(at[i]);
        for (int i = 0; i < t.edges; ++i) offer_edge(at[i], edge_between(t.at[i], t.at[i + 1 == N ? 0 : i + 1]).direction);
    }

protected:
    const seen_round_solid& solid_;
    const Other& other_;

private:
    least_overlap best_;

    /// How far the solid has to go along n.
    [[nodiscard]] ABUT_HD constexpr double overlap(const point& n) const {
        return plain_sum(other_.reach(n), solid_.reach(negated(n)));
    }
    ABUT_HD static constexpr point times(double t, const point& v) {
        return {plain_product(t, v.x), plain_product(t, v.y), plain_product(t, v.z)};
    }
    /// Across the side, as seen in the half plane of u, a direction across the axis.
    ABUT_HD constexpr void offer_side(const point& u) { offer(negated(solid_.side_normal(u))); }
    /// `across` is orthogonal to the axis and the edge e: the ellipse's larger axis.
    ABUT_HD constexpr void offer_rim(const point& center, const point& p, const point& e, const point& across,
                                     double slope) {
        const point other = plain_cross(e, across), seen = plain_difference(p, center);
        const double x = plain_dot(seen, across), y = plain_dot(seen, other),
                     b = plain_product(solid_.radius, absolute(slope));
        if (!(b > 0)) return;
        // The ellipse, scaled to have the point on it, is no nearer to itself than along the smaller axis. So the way out on
        // the point's side is no shorter than that, and there is none, but for rounding, from outside. The way out on the
        // other side crosses the larger axis.
        const double bx = plain_product(b, x / solid_.radius);
        const double within = plain_sum(b, -root(one_double{plain_sum(plain_product(bx, bx), plain_product(y, y))}).high);
        const bool is_farther = within > best_.depth, is_outside = within < -0x1p-40;
        const bool leave_out[2] = {is_farther || is_outside, is_farther || absolute(y) > best_.depth};
        for (int side = 0; side < 2; ++side) {
            if (leave_out[side]) continue;
            const ellipse_and_point of{solid_.radius, b, absolute(x), side == 0 ? absolute(y) : -absolute(y)};
            bool found = false;
            const quarter_point at = of.nearest(found);
            if (!found) continue;
            const double u = plain_product(b, at.c), v = plain_product(solid_.radius, at.s);
            const bool is_above = (y >= 0) == (side == 0);
            const point n = plain_step(times(x < 0 ? -u : u, across), is_above ? v : -v, other);
            offer(negated(unit_vector(as<one_double>(n))));
        }
    }
};

}  // namespace abut::detail::contact_math

namespace abut::detail {

/// A cylinder or a cone whose axis has a length, and a hull of corners.
template <solid_of_revolution S, scalar T, int N>
ABUT_NOINLINE ABUT_HD constexpr contact_math::least_overlap way_out_of_corners(const S& s, const corner_hull<T, N>& t,
                                                                               const contact_math::common_scale& scale) {
    using namespace contact_math;
    const point origin = scale(axis_of(s).a);
    const seen_round_solid solid(s, origin, scale);
    const seen_corners<N> corners(t.at, origin, scale);
    ways_out_of_solid<T, seen_corners<N>> pair(solid, corners);
    pair.offer_ends();
    pair.offer_corners(t, corners.at);
    return pair.way();
}
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact_math::least_overlap way_out_of_box(const S& s, const aabb<T>& t,
                                                                           const contact_math::common_scale& scale) {
    using namespace contact_math;
    const point origin = scale(axis_of(s).a);
    const seen_round_solid solid(s, origin, scale);
    const seen_box box{plain_difference(scale(t.lower), origin), plain_difference(scale(t.upper), origin)};
    ways_out_of_solid<T, seen_box> pair(solid, box);
    const point axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const point& n : axes) pair.offer_both(n);
    pair.offer_ends();
    for (int i = 0; i < 8; ++i) pair.offer_corner(box.corner(i));
    for (const point& n : axes) pair.offer_side_of_edge({solid, as<two_doubles>(n)});
    for (int axis = 0; axis < 3; ++axis) {
        const typename ways_out_of_solid<T, seen_box>::direction_of_edge edge(solid, as<two_doubles>(axes[axis]));
        for (int i = 0; i < 8; ++i) {
            if ((i & (1 << axis)) == 0) pair.offer_rims_of_edge(box.corner(i), edge);
        }
    }
    return pair.way();
}

/// Of a ball: straight away from the nearest point of the solid; or if that holds the centre, as of a point.
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact_math::least_overlap way_out_of_ball(const S& s, const sphere<T>& t,
                                                                            const vec3<double>& away,
                                                                            const contact_math::common_scale& scale) {
    using namespace contact_math;
    const point origin = scale(axis_of(s).a);
    const seen_round_solid solid(s, origin, scale);
    const vec3<T> center[1] = {t.center};
    const seen_corners<1> corners(center, origin, scale, scale(t.radius));
    ways_out_of_solid<T, seen_corners<1>> pair(solid, corners);
    pair.offer(negated(unit_vector(as<one_double>(away))));
    pair.offer_ends();
    pair.offer_corner(corners.at[0]);
    return pair.way();
}

/// What an axis without length leaves.
template <scalar T, class U>
ABUT_HD constexpr contact<T> contact_with_ball(const sphere<T>& s, const U& t) {
    if constexpr (requires { contact_between(s, t); }) {
        return contact_between(s, t);
    } else {
        return reversed(contact_between(t, s));
    }
}

// All of shapes that are known to touch, with ids 0. The normal points to the solid.

/// A hull of corners, a box or a ball.
template <solid_of_revolution S, class U>
requires revolution_pair<S, U> ABUT_HD constexpr contact<scalar_type_of<S>> contact_between(const S& s, const U& t) {
    using namespace contact_math;
    using T = scalar_type_of<S>;
    if (is_point(axis_of(s))) return contact_with_ball(ball_around(s), t);
    if constexpr (has_plain_pair<S, U>) {
        if (const auto first = first_contact_of(s, t, plain_pair<S, U>(s, t)); first.touch == verdict::yes) return first.found;
    }
    if constexpr (searched_plainly<S, U>) {
        if (const auto known = find_contact_in_doubles(s, t); known.is_known) return known.found;
    }
    contact<T> found{};
    const common_scale scale(s, t);
    if constexpr (std::same_as<U, plane<T>>) {
        const vec3<T> where = shared_point_of(s, t);
        if (is_zero(widened(t.normal))) return {0, 0, where, {0, 0, 1}, largest_finite<T>};
        const revolution_over_plane<T> over(s, t, common_unit(s, t));
        const extent heights = over.heights();
        const point n = as_stored_direction<T>(over.normal());
        least_overlap way;
        way.offer(n, -heights.lower);
        way.offer(negated(n), heights.upper);
        found = assembled<T>(scale, {0, 0, 0}, way);
        found.point = where;
    } else {
        const auto unit = common_unit(s, t);
        if constexpr (std::same_as<U, aabb<T>>) {
            found = assembled<T>(scale, {0, 0, 0}, way_out_of_box(s, t, scale));
            const measured_plainly<T> m(s, t);
            found.point = m.nearest.knows_shared_point() ? m.shared_point() : shared_point_of(s, t);
        } else {
            const auto nearest = nearest_way_from<true>(s, core_of(t), unit);
            if constexpr (std::same_as<U, sphere<T>>) {
                found = assembled<T>(scale, {0, 0, 0}, way_out_of_ball(s, t, nearest.way, scale));
            } else {
                found = assembled<T>(scale, {0, 0, 0}, way_out_of_corners(s, core_of(t), scale));
            }
            found.point = point_of_both(s, t, nearest, unit);
        }
    }
    return found;
}

}  // namespace abut::detail
