// SPDX-License-Identifier: MIT
#pragma once

// The point of a cylinder or a cone that is nearest to a given one. In the half plane of the axis and the point, the solid
// is a rectangle or a right triangle, and the foot on it is a closed form. Everything is computed from one operation to the
// next, in doubles or in sums of two of them, as in nearest_point.hpp: the same bits everywhere. Where the foot moves as the
// point moves along an edge is in revolution_ways.hpp.

#include <concepts>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/length_unit.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A way in the half plane of an axis, from a solid's foot to a point that is not inside: along the axis, and away from it.
/// `normal` has length 1. It is known better than the quotient of the way and its length wherever the foot lies inside of a
/// side; else the way is. How much the way may be off, over its length, is `loose_along` and `loose_out` in units of
/// roundoff.
template <class N>
struct half_plane_way {
    N along{}, out{}, normal_along{}, normal_out{};
    double length = 0;
    double loose_along = 0, loose_out = 0;
};

/// A cylinder or a cone, as seen from its first end, of a cone the apex. An axis whose length is nothing in the unit still
/// has a direction.
struct revolution_profile {
    using one_double = contact_math::one_double;
    using two_doubles = contact_math::two_doubles;

    vec3<double> axis{0, 0, 1};  ///< of length 1
    double height = 0, radius = 0;
    bool is_cone = false;
    two_doubles side_along{1, 0}, side_out{0, 0}, side_length{0, 0};  ///< of a cone's side, from the apex to the rim

    template <solid_of_revolution S>
    ABUT_HD constexpr revolution_profile(const S& s, const length_unit<scalar_type_of<S>>& unit)
        : radius(unit.of(s.radius)), is_cone(requires { s.apex; }) {
        using namespace contact_math;
        const auto ends = axis_of(s);
        const point first = widened(ends.a), last = widened(ends.b);
        // By a quarter where the difference might overflow.
        const bool far = greatest(largest_of(first), largest_of(last)) >= 0x1p1022;
        const vec3<two_doubles> way =
            far ? between<two_doubles>(scaled(first, -2), scaled(last, -2)) : between<two_doubles>(first, last);
        const double largest = largest_of(rounded_off(way));
        if (!(largest > 0)) return;
        const int exponent = exponent_of(largest);
        const vec3<two_doubles> d = scaled_vector(way, -exponent);
        const two_doubles length = root(dot(d, d));
        axis = {(d.x / length).high, (d.y / length).high, (d.z / length).high};
        height = in_unit(length.high, exponent + (far ? 2 : 0), unit);
        if (!is_cone) return;
        const vec3<two_doubles> side = brought_to_one(as<two_doubles>({height, radius, 0}));
        const two_doubles side_size = root(side.x * side.x + side.y * side.y);
        if (!(side_size.high > 0)) return;
        side_along = side.x / side_size;
        side_out = side.y / side_size;
        side_length = two_doubles::of(height) * side_along + two_doubles::of(radius) * side_out;
    }

    /// To a point at height s and `rho` from the axis. All heights that come into it are below `most_along` in magnitude,
    /// and all distances from the axis below `most_out`; `off` is the relative error of N.
    template <class N>
    [[nodiscard]] ABUT_HD constexpr half_plane_way<N> way_to(const N& s, const N& rho, double most_along, double most_out,
                                                             double off) const {
        return is_cone ? way_from_cone(s, rho, most_along, most_out, off)
                       : way_from_cylinder(s, rho, most_along, most_out, off);
    }

private:
    /// length 2^exponent
    template <scalar T>
    ABUT_HD static constexpr double in_unit(double length, int exponent, [[maybe_unused]] const length_unit<T>& unit) {
        if constexpr (std::same_as<T, double>) exponent += contact_math::exponent_of(unit.per_length);
        return contact_math::scaled(length, exponent < -2044 ? -2044 : exponent);
    }

    template <class N>
    ABUT_HD static constexpr half_plane_way<N> way_from_corner(const N& along, const N& out, double size) {
        const N length = root(along * along + out * out);
        if (!(length.high > 0)) return {};
        const double loose = size / length.high;
        return {along, out, along / length, out / length, length.high, loose, loose};
    }
    /// From a flat end that the point is in front of.
    template <class N>
    ABUT_HD constexpr half_plane_way<N> way_from_disc(const N& along, const N& rho, double most_out, double off) const {
        if (along.high == 0) return {};
        const double size = plain_sum(most_out, radius), length = absolute(along.high);
        const bool at_rim = plain_sum(radius, -rho.high) <= off * size;
        return {along, N::of(0), N::of(along.high < 0 ? -1 : 1), N::of(0), length, 0, at_rim ? size / length : 0};
    }
    template <class N>
    ABUT_HD constexpr half_plane_way<N> way_from_cylinder(const N& s, const N& rho, double most_along, double most_out,
                                                          double off) const {
        const N zero = N::of(0), h = N::of(height), r = N::of(radius);
        const N along = s < zero ? s : h < s ? s - h : zero;
        if (!(r < rho)) return way_from_disc(along, rho, most_out, off);
        const N out = rho - r;
        if (along.high != 0) return way_from_corner(along, out, plain_sum(plain_sum(most_along, most_out), radius));
        const double to_end = least(absolute(s.high), absolute((h - s).high));
        return {zero, out, zero, N::of(1), out.high, to_end <= off * most_along ? most_along / out.high : 0, 0};
    }
    template <class N>
    ABUT_HD constexpr half_plane_way<N> way_from_cone(const N& s, const N& rho, double most_along, double most_out,
                                                      double off) const {
        const N zero = N::of(0), h = N::of(height), r = N::of(radius);
        if (!(s < h) && !(r < rho)) return way_from_disc(s - h, rho, most_out, off);
        const N c = part<N>(side_along), k = part<N>(side_out), length = part<N>(side_length);
        const N ahead = s * c + rho * k, over = rho * c - s * k;
        const double size = plain_sum(plain_sum(most_along, most_out), radius);
        if (!(ahead < length)) return way_from_corner(s - h, rho - r, size);
        if (!(s < zero) && !(h < s) && !(zero < over)) return {};
        if (!(zero < ahead)) return way_from_corner(s, rho, size);
        if (!(zero < over)) return {};
        const bool at_end = least(ahead.high, (length - ahead).high) <= off * size;
        const double loose = at_end ? size / over.high : 0;
        return {-(over * k), over * c, -k, c, over.high, loose, loose};
    }
    template <class N>
    ABUT_HD static constexpr N part(const two_doubles& x) {
        if constexpr (std::same_as<N, two_doubles>) {
            return x;
        } else {
            return N::of(x.high);
        }
    }
};

/// What a vector of length 1 has across an axis of length 1. Orthogonal to the axis, also where there is next to nothing of
/// it but rounding.
ABUT_HD constexpr vec3<double> part_across(const vec3<double>& v, const vec3<double>& axis) {
    return plain_cross(axis, plain_cross(v, axis));
}

/// A point as seen from the first end: how high it is over it, and the way to it from the axis.
struct place_by_axis {
    double height = 0;
    vec3<double> across{0, 0, 0};

    place_by_axis() = default;
    ABUT_HD constexpr place_by_axis(const revolution_profile& solid, const vec3<double>& seen)
        : height(contact_math::plain_dot(seen, solid.axis)), across(plain_step(seen, -height, solid.axis)) {}
};

/// The way between a solid and a point that is seen from the solid's first end, and the foot as seen from there.
struct way_from_foot {
    vec3<double> foot, way;
};
ABUT_HD constexpr way_from_foot way_from_solid(const revolution_profile& solid, double height, const vec3<double>& across,
                                               double rho, double along, double out) {
    const double of_way = rho > 0 ? out / rho : 0, of_foot = rho > 0 ? plain_sum(rho, -out) / rho : 0;
    const auto times = [](double t, const vec3<double>& v) {
        return vec3<double>{plain_product(t, v.x), plain_product(t, v.y), plain_product(t, v.z)};
    };
    return {plain_step(times(of_foot, across), plain_sum(height, -along), solid.axis),
            plain_step(times(of_way, across), along, solid.axis)};
}
ABUT_HD constexpr way_from_foot way_from_solid(const revolution_profile& solid, const vec3<double>& seen) {
    using contact_math::one_double;
    const place_by_axis at(solid, seen);
    const double rho = contact_math::root(one_double{contact_math::plain_dot(at.across, at.across)}).high;
    const auto w = solid.way_to(one_double{at.height}, one_double{rho}, 0, 0, 0);
    if (!(w.length > 0)) return {seen, {0, 0, 0}};
    return way_from_solid(solid, at.height, at.across, rho, w.along.high, w.out.high);
}

}  // namespace abut::detail
