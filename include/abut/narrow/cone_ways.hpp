// SPDX-License-Identifier: MIT
#pragma once

// The least way between two cones, in double, as in cylinder_ways.hpp; u and D are those of the head of revolution_ways.hpp.
// It has an end on the disc or at the apex of one of the two, or goes from side to side, inside of both. A disc is searched
// as a cylinder's, and from an apex the way is that of a point.
//
// From side to side it is along the normal of both sides. Of a cone whose axis from the apex has the direction a, and whose
// side's sine to it is k, the normals are the n of length 1 with n . a = -k. So n . a = -k, and n . b = k' of the other
// cone, where n points to it. With m = a x b and w = k' a + k b that is n = m x w / m^2 + z m / |m| and z^2 = 1 - w^2 / m^2:
// there are two such n, or none. Each of them tells a line on each side, from the apex to the rim. The way between those is
// what is wanted: it is never less than the least way of all, as all its points are points of the cones, and for one n it is
// no more.
//
// What n is off by does not matter if it is the normal of cones that are moved by a few u D. Let c be a cone's height over
// the length of its side. If n . a is off by e, n is the normal of a side that is tilted by e / c, and so is the line that
// it tells. Everything is computed in sums of two doubles, and e is some u^2, however nearly parallel the axes are: m is
// right in nearly all of its digits. It is orthogonal to both axes, and so what w is off by, some u^2, leaves no more than
// that in the products of m x w / m^2 with them. The length of n is 1 by what z is. Where c is below u, the cone is its disc
// but for u D. The way between the two lines is that of edges in nearest_ways.hpp. There parallel edges need no care, and so
// nor do lines here: their ends are an apex and a place on a rim, from which the least ways are candidates too.
//
// If the two touch, what they share meets a disc of one, or an apex or an axis is in the other one; or else it is all that
// two cones without end share, and bounded. Then let t be as wide as makes it touch s: that is not the axis alone, which is
// outside of s. They touch on a line from the apex on the side of s. The plane that they have there is through both apexes,
// and so its normal n is one of those with n . a = -k and n . (the way between the apexes) = 0: as above, with that way in
// the place of b. The point is where that line, and the axis of t as it is seen along n, meet in the plane.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/narrow/cylinder_ways.hpp>
#include <abut/narrow/nearest_ways.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_foot.hpp>
#include <abut/narrow/revolution_ways.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Of length 1, in sums of two doubles.
ABUT_HD constexpr vec3<contact_math::two_doubles> made_unit(const vec3<double>& v) {
    using namespace contact_math;
    const vec3<two_doubles> w = as<two_doubles>(v);
    const two_doubles length = root(dot(w, w));
    return {w.x / length, w.y / length, w.z / length};
}

/// The vectors of length 1 that have given products with two axes, as if those had length 1: two of them, or none.
struct normals_of_sides {
    bool are = false;
    vec3<contact_math::two_doubles> at[2]{};

    ABUT_HD constexpr normals_of_sides(const vec3<double>& a, const contact_math::two_doubles& by_a, const vec3<double>& b,
                                       const contact_math::two_doubles& by_b) {
        using namespace contact_math;
        const vec3<two_doubles> u = made_unit(a), v = made_unit(b);
        const vec3<two_doubles> product = accurate_cross(u, v);
        if (is_zero(product)) return;
        // Both larger by as much, so that m is about 1. There are none if w is longer.
        const int exponent = exponent_of(largest_of(rounded_off(product)));
        const vec3<two_doubles> part = scale(by_b, u) - scale(by_a, v);
        if (!(largest_of(rounded_off(part)) < power_of_two(exponent + 2))) return;
        const vec3<two_doubles> m = scaled_vector(product, -exponent), w = scaled_vector(part, -exponent);
        const two_doubles square = dot(m, m), rest = square - dot(w, w);
        if (rest < two_doubles::of(0)) return;
        are = true;
        const vec3<two_doubles> flat = cross(m, w);
        const two_doubles z = root(rest);
        const auto over = [&](const two_doubles& side) {
            const vec3<two_doubles> n = flat + scale(side, m);
            return vec3<two_doubles>{n.x / square, n.y / square, n.z / square};
        };
        at[0] = over(z);
        at[1] = over(-z);
    }
};

/// From a cone's apex to its rim: the line on the side whose outward normal is n.
ABUT_HD constexpr vec3<double> line_on_side(const revolution_profile& cone, const vec3<contact_math::two_doubles>& n) {
    using namespace contact_math;
    const vec3<two_doubles> axis = as<two_doubles>(cone.axis);
    const point out = unit_vector(n - scale(dot(n, axis) / dot(axis, axis), axis));
    return plain_step(plain_step(point{0, 0, 0}, cone.height, cone.axis), cone.radius, out);
}

/// Gathers the ways from the apex and the disc of a cone, t, to another one; if `Touching`, from its axis too.
template <scalar T, bool Touching>
class cone_way_finder : public disc_way_finder<T, Touching> {
    using base = disc_way_finder<T, Touching>;
    using point = vec3<double>;

public:
    ABUT_HD constexpr cone_way_finder(const cone<T>& s, const cone<T>& t, const length_unit<T>& in,
                                      const nearest_way<T>& known)
        : base(s, in), apex_(t.apex), cone_(t, in) {
        this->best = known;
        if (known.square < infinity<double>) {
            this->length_ = contact_math::root(contact_math::one_double{known.square}).high;
        }
        this->size_ = greatest(this->size_, cone_.radius);
        seen_ = this->see(t.apex);
        const point last = this->see(t.base_center);
        this->offer_point(t.apex, seen_);
        if constexpr (Touching) {
            this->offer_edge(t.apex, this->place_of(seen_), this->place_of(last), way_between(t.apex, t.base_center, in));
        }
        this->offer_disc(t.base_center, last, cone_.axis, cone_.radius);
    }

    /// From side to side.
    ABUT_HD constexpr void offer_sides() {
        using namespace contact_math;
        const normals_of_sides normals(this->solid_.axis, -this->solid_.side_out, cone_.axis, cone_.side_out);
        if (!normals.are) return;
        nearest_way_finder<T> found{this->unit, this->best};
        ABUT_ROLLED
        for (int i = 0; i < 2; ++i) {
            const vec3<two_doubles>& n = normals.at[i];
            const vec3<two_doubles> back{-n.x, -n.y, -n.z};
            found.offer_edges(this->first_, line_on_side(this->solid_, n), apex_, line_on_side(cone_, back), seen_);
        }
        this->best = found.best;
    }
    /// Where the solid is nearest to the axis of t as seen from its apex.
    ABUT_HD constexpr void offer_tangents() {
        using namespace contact_math;
        const point to_apex = unit_vector(as<two_doubles>(seen_));
        if (is_zero(to_apex)) return;
        const normals_of_sides normals(this->solid_.axis, -this->solid_.side_out, to_apex, two_doubles::of(0));
        if (!normals.are) return;
        ABUT_ROLLED
        for (int i = 0; i < 2; ++i) {
            const point line = line_on_side(this->solid_, normals.at[i]), n = rounded_off(normals.at[i]);
            const point across = plain_cross(cone_.axis, n);
            const double whole = plain_dot(line, across), part = plain_dot(seen_, across);
            if (whole == 0 || (part < 0) != (whole < 0)) continue;
            const point z = plain_step(point{0, 0, 0}, least(part / whole, 1.0), line);
            const way_from_foot to_cone = way_from_solid(cone_, plain_difference(z, seen_));
            this->offer(z, negated(to_cone.way), apex_, to_cone.foot);
        }
    }

private:
    vec3<T> apex_;
    revolution_profile cone_;
    point seen_{0, 0, 0};
};

/// Between two cones that have axes: the same in either order.
template <bool Touching, scalar T>
ABUT_HD constexpr nearest_way<T> nearest_way_from(const cone<T>& s, const cone<T>& t, const length_unit<T>& unit) {
    const bool swap = precedes(s, t);
    const cone<T>&a = swap ? t : s, &b = swap ? s : t;
    const cone_way_finder<T, Touching> back(b, a, unit, {});
    cone_way_finder<T, Touching> found(a, b, unit, reversed(back.best));
    found.offer_sides();
    if constexpr (Touching) found.offer_tangents();
    return swap ? reversed(found.best) : found.best;
}

}  // namespace abut::detail
