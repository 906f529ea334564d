// SPDX-License-Identifier: MIT
#pragma once

// The first stage of distances and contacts between a cylinder or a cone and a point or a sphere, as plain_ways.hpp is of
// other pairs. In the half plane of the axis and the centre the solid is a rectangle or a right triangle, and where the
// centre is beside that tells the foot and how far it is. Where rounding leaves open whether the centre is inside, or the
// shapes touch, revolution_foot.hpp and revolution_contact.hpp answer.
//
// Let u = 2^-53, e the axis and p the centre as it is seen from the nearer end of that, or of a cone's side; p is no longer
// than D, the largest distance of two points of both shapes. Rounding e and p (u each, of themselves), their product (3u
// |p|), and the root of e.e and the quotient (3.5u of the height) leaves the height over the end within 5u |p| and 3.5u of
// itself. What p has across the axis is off by 3u |p|, its length by 2.5u of itself; what of it is left along the axis, some
// 8u |p|, counts with its square. So both coordinates are off by less than 10u D together, the distance in the half plane by
// less than 13u D, and 15u D without the radius. Which part the foot is on matters no more than that: where two are as near,
// they are near to each other, as the solid is convex. `size` is the sum of magnitudes of p, e and the radii, above D and
// below 8D. The way is longer than 2^-20 of it.

#include <concepts>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_ways.hpp>
#include <abut/narrow/round_contact.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A solid's axis and a point beside it, and the solid's point that is nearest to that.
template <scalar T>
struct plain_foot {
    vec3<double> e, p{0, 0, 0};  ///< the axis, and the point as it is seen from `end`
    vec3<T> end;
    double radius, size;
    double height = 0, per_height = 0;
    bool is_cone, is_last = false;  ///< whether that is the second end: of a cone the base
    bool is_good = false, is_inside = false;
    vec3<double> way{0, 0, 0}, ahead{0, 0, 0};  ///< from the foot to the point; and of about length 1, known better
    double length = 0;                          ///< of the way; or inside, to the nearest part of the boundary

    template <solid_of_revolution S>
    ABUT_INLINE ABUT_HD constexpr plain_foot(const S& s, const vec3<T>& center, double radius_of_center)
        : radius(s.radius), is_cone(requires { s.apex; }) {
        using namespace contact_math;
        const segment<T> axis = axis_of(s);
        e = plain_way_to(axis.a, axis.b);
        p = plain_way_to(axis.a, center);
        end = axis.a;
        size = plain_sum(plain_sum(plain_magnitudes(p), plain_magnitudes(e)), plain_sum(radius, radius_of_center));
        if (!are_plain_sizes<T>(size)) return;
        const double ee = plain_dot(e, e), all = plain_product(size, size);
        if (!(ee > 0x1p-60 * all)) return;
        double pe = plain_dot(p, e);
        height = root(one_double{ee}).high;
        per_height = 1 / height;
        const point across = plain_step(p, -plain_product(plain_product(pe, per_height), per_height), e);
        const double rho = root(one_double{plain_dot(across, across)}).high, out = plain_sum(rho, -radius);
        const double per_rho = rho > 0x1p-20 * size ? 1 / rho : 0;  // nearer to the axis nothing is said that asks for it
        const double side_square = is_cone ? plain_sum(ee, plain_product(radius, radius)) : ee;
        is_last = (2 * (is_cone ? plain_sum(pe, plain_product(rho, radius)) : pe) > side_square) | (pe > ee);
        const vec3<T> ends[] = {axis.a, axis.b};
        end = ends[is_last ? 1 : 0];
        p = plain_way_to(end, center);
        pe = plain_dot(p, e);
        const double over_end = plain_product(pe, per_height);
        const double beyond = is_last ? over_end : -over_end;
        // So much of e, and of the direction across.
        const auto take = [&](double along, double aside) {
            way = plain_step(plain_times(plain_product(along, per_height), e), plain_product(aside, per_rho), across);
        };
        // A unit vector across the axis, without what rounding left along it.
        const auto straight = [&] {
            const double part = plain_product(plain_product(plain_dot(across, e), per_height), per_height);
            return plain_times(per_rho, plain_step(across, -part, e));
        };
        const auto measure = [&] {
            length = root(one_double{plain_dot(way, way)}).high;
            ahead = plain_times(1 / length, way);
        };
        const auto to_end = [&] {
            take(over_end, 0);
            ahead = plain_times(is_last ? per_height : -per_height, e);
            length = absolute(beyond);
        };
        if (!is_cone) {
            // Along the axis and across, as far as the centre is outside; inside, to what is nearer. Without branches, which
            // nobody can predict.
            const double most = rounded(greatest(beyond, out)), to_side = out >= rounded(least(beyond, 0.0)),
                         to_cap = beyond > rounded(least(out, 0.0)), along = plain_product(to_cap, over_end),
                         aside = plain_product(to_side, out);
            is_inside = !(most > 0);
            take(along, aside);
            length = root(one_double{plain_sum(plain_product(along, along), plain_product(aside, aside))}).high;
            if (!(length > 0) || (per_rho == 0 && aside != 0) || absolute(most) <= 0x1p-40 * size) return;
            const double outward = is_inside ? -length : length;
            ahead = plain_step(plain_times(plain_product(along / outward, per_height), e), aside / outward, straight());
        } else {
            const double side = root(one_double{side_square}).high, c = height / side, k = radius / side;
            // Along the side, from its end that is nearer.
            const double aside = is_last ? out : rho;
            const double reached = plain_sum(plain_product(over_end, c), plain_product(aside, k)),
                         over = plain_sum(plain_product(aside, c), -plain_product(over_end, k));
            const double below = is_last ? over_end : plain_sum(over_end, -height);  // the base
            if (below > 0 && !(out > 0)) {
                if (!is_last) return;
                to_end();
            } else if (is_last ? reached >= 0 : reached <= 0) {
                if (is_last && !(per_rho > 0)) return;
                is_last ? take(over_end, out) : void(way = p);
                measure();
            } else {
                is_inside = !(over > 0);
                if (is_inside && below > over) {
                    length = -below;
                    ahead = plain_times(per_height, e);
                } else {
                    take(-plain_product(over, k), plain_product(over, c));
                    length = absolute(over);
                    ahead = plain_step(plain_times(plain_product(-k, per_height), e), c, straight());
                    if (!(per_rho > 0)) return;
                }
                if (is_inside && !(below < -0x1p-40 * size && over < -0x1p-40 * size)) return;
            }
        }
        is_good = plain_product(length, length) > 0x1p-40 * all;
    }
    /// How far the solid reaches along n, of about length 1, from the nearer end.
    [[nodiscard]] ABUT_HD constexpr double reach(const vec3<double>& n) const {
        using namespace contact_math;
        const point turned = plain_cross(n, e);
        const double around =
                         plain_product(radius, plain_product(root(one_double{plain_dot(turned, turned)}).high, per_height)),
                     along = plain_dot(n, e), to_last = is_last, first = plain_product(-to_last, along),
                     last = plain_product(1 - to_last, along);
        return greatest(is_cone ? first : plain_sum(first, around), plain_sum(last, around));
    }
};

/// A cylinder or a cone, and a point or a sphere.
template <solid_of_revolution S, class U>
    requires(corners_of_core<U> == 1 && std::same_as<scalar_type_of<S>, scalar_type_of<U>>)
struct plain_pair<S, U> : plain_gap {
    using T = scalar_type_of<S>;
    plain_foot<T> foot;

    ABUT_INLINE ABUT_HD constexpr plain_pair(const S& s, const U& t)
        : plain_gap{0, static_cast<double>(radius_around_core(t))}, foot(s, core_of(t).at[0], radius_b) {
        length = foot.length, size = foot.size, is_good = foot.is_good && !foot.is_inside;
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& way() const { return foot.way; }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_a(const S&) const {
        return {foot.end, contact_math::plain_difference(foot.p, foot.way)};
    }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_b(const U& t) const { return {core_of(t).at[0]}; }
};

/// Straight away from the foot; or if the solid holds the centre, out of the nearest part of its boundary. The normal is
/// right as in round_contact.hpp.
template <solid_of_revolution S, class U>
    requires has_plain_pair<S, U>
ABUT_INLINE ABUT_HD constexpr auto first_contact_of(const S& s, const U& t, const plain_pair<S, U>& both) {
    using namespace contact_math;
    using T = scalar_type_of<S>;
    const plain_foot<T>& foot = both.foot;
    first_contact<T> answer{foot.is_good && foot.is_inside ? verdict::yes : both.touch()};
    if (answer.touch != verdict::yes) return answer;
    const point n = plain_normal<T>(foot.ahead);
    const double depth = plain_sum(plain_sum(both.radius_b, -plain_dot(n, foot.p)), foot.reach(n)),
                 least_depth = plain_sum(both.radius_b, foot.is_inside ? both.length : -both.length);
    if (!is_tolerable(plain_sum(depth, -least_depth), foot.size / 14, s, t)) return first_contact<T>{};
    const vec3<T> where = foot.is_inside ? core_of(t).at[0] : both.on_a(s).at(0, n);
    answer.found = plain_contact(where, negated(n), depth);
    return answer;
}

}  // namespace abut::detail
