// SPDX-License-Identifier: MIT
#pragma once

// Two solids of revolution in floating point: the search of gjk.hpp. It ends with a way on which they are apart by more
// than rounding, or with a tetrahedron of differences of their points that holds a ball about the origin of more than that.

#include <concepts>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/kept_points.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/solid_on_ways.hpp>
#include <abut/shape/hull.hpp>

namespace abut::detail {

/// Two solids whose axes have a length, as gjk.hpp reads two hulls. Their points are those that were asked for. They count as
/// apart where they are by more than `reach`.
template <bool Certified, solid_of_revolution S, solid_of_revolution U>
class solids_on_ways {
public:
    using T = scalar_type_of<S>;
    using number = double;
    static constexpr int most_steps = points_of_solid::room - 1;

    ABUT_HD constexpr solids_on_ways(const S& s, const U& t, const hull<T>& axis_of_s, const hull<T>& axis_of_t,
                                     points_of_solid& asked_of_s, points_of_solid& asked_of_t, double reach = 0)
        : axes_(axis_of_s, axis_of_t), s_(s), t_(t), of_s_(asked_of_s), of_t_(asked_of_t), reach_(reach) {}

    [[nodiscard]] ABUT_HD constexpr vec3<double> way_between_middles() const { return axes_.way_between_middles(); }
    [[nodiscard]] ABUT_HD constexpr vec3<double> difference(std::uint32_t i, std::uint32_t j) const {
        return axes_.difference(of_s_.end[i], of_t_.end[j]) - (of_s_.to_rim[i] + of_t_.to_rim[j]);
    }
    ABUT_HD constexpr void look_back(const vec3<double>& way, std::uint32_t& i, std::uint32_t& j) const {
        std::uint32_t k = 0, l = 0;
        const vec3<double> one = of_size_1(way);
        axes_.look_back(one, k, l);
        const auto ahead = [&](std::uint32_t at_s, std::uint32_t at_t) {
            return axes_.ahead(one, at_s, at_t) - s_.reach(one, at_s) - t_.reach(one, at_t);
        };
        if (s_.is_cone) k = ahead(1, l) < ahead(0, l) ? 1 : 0;
        if (t_.is_cone) l = ahead(k, 1) < ahead(k, 0) ? 1 : 0;
        i = of_s_.append(k, s_.to_rim(one, k));
        j = of_t_.append(l, t_.to_rim(one, l));
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<double>& way, std::uint32_t i, std::uint32_t j) const {
        const vec3<double> one = of_size_1(way);
        const std::uint32_t k = of_s_.end[i], l = of_t_.end[j];
        double ahead = axes_.ahead(one, k, l) - s_.reach(one, k) - t_.reach(one, l);
        if (reach_ > 0) ahead -= reach_ * square_root(dot(one, one));
        if constexpr (!Certified) return ahead > 0;
        return is_known() && is_more_than_lost<T>(ahead, size());
    }
    [[nodiscard]] ABUT_HD constexpr verdict holds_origin(const vec3<double> (&w)[4], const difference_simplex& at) const {
        if constexpr (!Certified) return verdict::yes;
        return at.count == 4 && is_known() && holds_ball(w) ? verdict::yes : verdict::unknown;
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex&) const {
        return Certified ? verdict::unknown : verdict::yes;
    }

protected:
    [[nodiscard]] ABUT_HD constexpr double reach() const { return reach_; }
    [[nodiscard]] ABUT_HD constexpr bool is_known() const { return s_.is_known && t_.is_known; }
    [[nodiscard]] ABUT_HD constexpr double size() const { return axes_.size() + (s_.radius + t_.radius) + reach_; }

private:
    /// Whether a tetrahedron holds all points that are as near to the origin as points of the solids are known.
    [[nodiscard]] ABUT_HD constexpr bool holds_ball(const vec3<double> (&w)[4]) const {
        const double lost = lost_on_ways<T>(size());
        if (!(size() < 0x1p300)) return false;
        const int side = side_of(w[1], w[2], w[3], lost);
        return side != 0 && side_of(w[0], w[3], w[2], lost) == side && side_of(w[0], w[1], w[3], lost) == side &&
               side_of(w[0], w[2], w[1], lost) == side;
    }
    /// The sign of p . (q x r), if the plane of the three is farther from the origin than `lost`; or else 0.
    [[nodiscard]] ABUT_HD static constexpr int side_of(const vec3<double>& p, const vec3<double>& q, const vec3<double>& r,
                                                       double lost) {
        const vec3<double> e = q - p, f = r - p;
        const double volume = dot(p, cross(e, f)),
                     bound = (lost + 0x1p-48 * magnitudes(p)) * magnitudes(e) * magnitudes(f) + 0x1p-900;
        return volume > bound ? 1 : volume < -bound ? -1 : 0;
    }

    hulls_in_floats<true, T> axes_;
    solid_beside_axis<S> s_;
    solid_beside_axis<U> t_;
    points_of_solid &of_s_, &of_t_;
    double reach_;
};

/// Whether they touch, if the search tells.
template <arithmetic A, solid_of_revolution S, solid_of_revolution U>
ABUT_NOINLINE ABUT_HD constexpr verdict search_solids(const S& s, const U& t) {
    using T = scalar_type_of<S>;
    const corner_hull<T, 2> axis_of_s = points_of(axis_of(s)), axis_of_t = points_of(axis_of(t));
    const hull<T> ends_of_s = axis_of_s.as_hull(), ends_of_t = axis_of_t.as_hull();
    points_of_solid of_s, of_t;
    difference_simplex at;
    vec3<double> w[4];
    return search_origin<sought::meeting>(
        solids_on_ways<!std::same_as<A, fast>, S, U>(s, t, ends_of_s, ends_of_t, of_s, of_t), at, w);
}

}  // namespace abut::detail
