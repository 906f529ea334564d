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
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_foot.hpp>
#include <abut/narrow/revolution_plane.hpp>
#include <abut/narrow/revolution_ways.hpp>
#include <abut/narrow/round_contact.hpp>
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
ABUT_HD constexpr quarter_point between_quarter_points(const quarter_point& p, const quarter_point& q) {
    const double c = plain_sum(p.c, q.c), s = plain_sum(p.s, q.s);
    const double length = root(one_double{plain_sum(plain_product(c, c), plain_product(s, s))}).high;
    return {c / length, s / length};
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
            for (int i = 0; i < few_steps; ++i) {
                const quarter_point m = between_quarter_points(from, to);
                const bool is_before = plain_product(p, cube(m.c)) > plain_product(q, cube(m.s));
                is_before ? from = m : to = m;
            }
            found = rise(from) < 0;
            to = {0, 1};
            if (!found) return from;
        }
        for (int i = 0; i < steps; ++i) {
            const quarter_point m = between_quarter_points(from, to);
            rise(m) < 0 ? from = m : to = m;
        }
        return to;
    }

private:
    static constexpr int steps = 56, few_steps = 24;  ///< where it rises the least need not be known so well
    ABUT_HD static constexpr double cube(double t) { return plain_product(plain_product(t, t), t); }
    [[nodiscard]] ABUT_HD constexpr double rise(const quarter_point& p) const {
        const double edge = plain_sum(plain_product(plain_product(a, x), p.s), -plain_product(plain_product(b, y), p.c));
        const double squares = plain_product(plain_sum(a, b), plain_sum(a, -b));
        return plain_sum(edge, -plain_product(plain_product(squares, p.s), p.c));
    }
};

/// A solid, at the common scale, and corners of what touches it.
template <scalar T, int N>
class revolution_and_corners {
public:
    template <solid_of_revolution S>
    ABUT_HD constexpr revolution_and_corners(const S& s, const point (&corner)[std::size_t{N}], const common_scale& scale,
                                             double around = 0)
        : around_(around),
          along_(edge_between(axis_of(s).a, axis_of(s).b).direction),
          axis_(unit_vector(along_)),
          end_{scale(axis_of(s).a), scale(axis_of(s).b)},
          radius_(scale(s.radius)),
          is_cone_(requires { s.apex; }) {
        for (int i = 0; i < N; ++i) corner_[i] = corner[i];
        const double height = plain_dot(axis_, plain_difference(end_[1], end_[0]));
        const point side{height > 0 ? height : 0, radius_, 0};
        const point unit = unit_vector(as<one_double>(side));
        side_along_ = is_zero(unit) || !is_cone_ ? 1 : unit.x;
        side_out_ = is_zero(unit) || !is_cone_ ? 0 : unit.y;
    }

    /// The least way of those that were offered.
    [[nodiscard]] ABUT_HD constexpr least_overlap way() const {
        const point n = as_stored_direction<T>(unit_vector(as<two_doubles>(best_.normal)));
        return {n, overlap(n)};
    }

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
        offer(negated(axis_));
        if (!is_cone_) offer(axis_);
    }
    /// The side goes away from a corner.
    ABUT_HD constexpr void offer_corner(const point& p) {
        const point seen = plain_difference(p, end_[0]);
        const point out = unit_vector(as<one_double>(part_across(seen, axis_)));
        offer_side(is_zero(out) ? any_orthogonal(along_) : out);
    }
    /// The side and the rims go away from an edge, one point of which is p.
    ABUT_HD constexpr void offer_edge(const point& p, const vec3<two_doubles>& edge) {
        const point e = unit_vector(edge);
        if (is_zero(e)) return;
        point across = unit_cross(along_, edge);
        if (is_zero(across)) across = any_orthogonal(along_);
        const double slope = plain_dot(e, axis_);
        if (!is_cone_) {
            offer_side(across);
            offer_side(negated(across));
        } else {
            // Of the directions u across the axis for which the side's normal is across the edge.
            const point flat = plain_cross(across, axis_);  // of the edge, as seen along the axis; or against it
            const double of_flat = plain_dot(e, flat);
            const double part = plain_product(side_out_, slope), whole = plain_product(side_along_, of_flat);
            if (absolute(part) <= absolute(whole) && whole != 0) {
                const double c = part / whole;
                const double s = root(one_double{plain_product(plain_sum(1.0, c), plain_sum(1.0, -c))}).high;
                for (int k = -1; k < 2; k += 2) offer_side(plain_step(times(c, flat), k * s, across));
            }
        }
        for (int k = is_cone_ ? 1 : 0; k < 2; ++k) offer_rim(end_[k], p, e, across, slope);
    }

private:
    least_overlap best_;
    double around_;  ///< a radius around the corners
    vec3<two_doubles> along_;
    point axis_, end_[2];
    double radius_;
    bool is_cone_;
    double side_along_ = 1, side_out_ = 0;
    point corner_[std::size_t{N}]{};

    ABUT_HD static constexpr point times(double t, const point& v) {
        return {plain_product(t, v.x), plain_product(t, v.y), plain_product(t, v.z)};
    }
    /// How far the solid has to go along n.
    [[nodiscard]] ABUT_HD constexpr double overlap(const point& n) const {
        const point sine = plain_cross(n, axis_);
        const double reach = plain_product(radius_, root(one_double{plain_dot(sine, sine)}).high);
        const double height = plain_dot(n, plain_difference(end_[1], end_[0]));
        const double lowest = least(is_cone_ ? 0 : -reach, plain_sum(height, -reach));
        return plain_sum(plain_sum(extent_of(corner_, n, end_[0]).upper, around_), -lowest);
    }
    /// Where the side's outward normal is as seen in the half plane of u, a direction across the axis.
    ABUT_HD constexpr void offer_side(const point& u) {
        offer(negated(plain_step(times(side_along_, u), -side_out_, axis_)));
    }
    /// `across` is orthogonal to the axis and the edge e: the ellipse's larger axis.
    ABUT_HD constexpr void offer_rim(const point& center, const point& p, const point& e, const point& across,
                                     double slope) {
        const point other = plain_cross(e, across), seen = plain_difference(p, center);
        const double x = plain_dot(seen, across), y = plain_dot(seen, other), b = plain_product(radius_, absolute(slope));
        if (!(b > 0)) return;
        // The ellipse, scaled to have the point on it, is no nearer to itself than along the smaller axis. So the way out on
        // the point's side is no shorter than that, and there is none, but for rounding, from outside. The way out on the
        // other side crosses the larger axis.
        const double bx = plain_product(b, x / radius_);
        const double within = plain_sum(b, -root(one_double{plain_sum(plain_product(bx, bx), plain_product(y, y))}).high);
        const bool is_farther = within > best_.depth, is_outside = within < -0x1p-40;
        const bool leave_out[2] = {is_farther || is_outside, is_farther || absolute(y) > best_.depth};
        for (int side = 0; side < 2; ++side) {
            if (leave_out[side]) continue;
            const ellipse_and_point of{radius_, b, absolute(x), side == 0 ? absolute(y) : -absolute(y)};
            bool found = false;
            const quarter_point at = of.nearest(found);
            if (!found) continue;
            const double u = plain_product(b, at.c), v = plain_product(radius_, at.s);
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
    point corner[std::size_t{N}]{};
    for (int i = 0; i < N; ++i) corner[i] = scale(t.at[i]);
    revolution_and_corners<T, N> pair(s, corner, scale);
    if constexpr (N == 3) pair.offer_both(face_normal(triangle<T>{t.at[0], t.at[1], t.at[2]}));
    pair.offer_ends();
    for (int i = 0; i < N; ++i) pair.offer_corner(corner[i]);
    for (int i = 0; i < t.edges; ++i) {
        pair.offer_edge(corner[i], edge_between(t.at[i], t.at[i + 1 == N ? 0 : i + 1]).direction);
    }
    return pair.way();
}
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact_math::least_overlap way_out_of_box(const S& s, const aabb<T>& t,
                                                                           const contact_math::common_scale& scale) {
    using namespace contact_math;
    const point lower = scale(t.lower), upper = scale(t.upper);
    point corner[8]{};
    for (int i = 0; i < 8; ++i) {
        corner[i] = {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z};
    }
    revolution_and_corners<T, 8> pair(s, corner, scale);
    const point axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const point& n : axes) pair.offer_both(n);
    pair.offer_ends();
    for (const point& p : corner) pair.offer_corner(p);
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 8; ++i) {
            if ((i & (1 << axis)) == 0) pair.offer_edge(corner[i], as<two_doubles>(axes[axis]));
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
    const point corner[1] = {scale(t.center)};
    revolution_and_corners<T, 1> pair(s, corner, scale, scale(t.radius));
    pair.offer(negated(unit_vector(as<one_double>(away))));
    pair.offer_ends();
    pair.offer_corner(corner[0]);
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
    const common_scale scale(s, t);
    contact<T> found{};
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
        const auto nearest = nearest_way_from<true>(s, core_of(t), unit);
        if constexpr (std::same_as<U, sphere<T>>) {
            found = assembled<T>(scale, {0, 0, 0}, way_out_of_ball(s, t, nearest.way, scale));
        } else if constexpr (std::same_as<U, aabb<T>>) {
            found = assembled<T>(scale, {0, 0, 0}, way_out_of_box(s, t, scale));
        } else {
            found = assembled<T>(scale, {0, 0, 0}, way_out_of_corners(s, hull_of(t), scale));
        }
        found.point = point_of_both(s, t, nearest, unit);
    }
    return found;
}

}  // namespace abut::detail
