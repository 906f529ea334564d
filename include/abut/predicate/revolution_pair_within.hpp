// SPDX-License-Identifier: MIT
#pragma once

// The stages of `within` for a cylinder or a cone and another of these. Exact signs would need polynomials of degree 40 for
// two rims, and of a degree above 100 for the sides of two cones. So their answer is certified instead: it is "no" if and
// only if a way is found on which they are farther apart than the distance, first in double and then in 256 digits.
// Where they touch the distance within rounding, the search in 256 digits ends with points that are no farther apart than
// the distance and 2^-200 of the size of both, and the answer is "yes". In one of a hundred of the ties that tests are made
// of it comes to no end, and is then as near to that as 2^-100. So it is right but for pairs that are farther apart than the
// distance, and by less than that. With the distance 0 it is that of revolution_pair.hpp, which is exact; and so it
// is where one of them has no radius or no axis, and is a segment or a ball.

#include <concepts>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_float.hpp>
#include <abut/predicate/certified_cones.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/revolution_pair.hpp>
#include <abut/predicate/revolution_within.hpp>
#include <abut/predicate/solid_on_ways.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Two solids of revolution in the order in which revolution_pair.hpp takes them.
template <class S, class U>
concept revolution_pair_as_given =
    solid_of_revolution<S> && solid_of_revolution<U> && std::same_as<scalar_type_of<S>, scalar_type_of<U>> &&
    (questions_of<S>::type::is_cone || !questions_of<U>::type::is_cone);

/// A solid whose axis has a length, in 256 digits, as seen from some origin.
struct solid_in_bits {
    vec3<wide_float> first, last, unit;  ///< `unit` along the axis
    wide_float radius;
    bool is_cone;

    template <solid_of_revolution S>
    ABUT_HD constexpr solid_in_bits(const S& s, const vec3<scalar_type_of<S>>& origin)
        : first(seen(axis_of(s).a, origin)),
          last(seen(axis_of(s).b, origin)),
          unit(made_unit(seen(axis_of(s).b, axis_of(s).a))),
          radius(s.radius),
          is_cone(questions_of<S>::type::is_cone) {}

    /// The farthest point on a way of length 1. What is across the axis is made orthogonal to it twice: rounding leaves
    /// anything of a way along it, and then 2^-248 of its length. Where it is shorter than 2^-240, the centre is as far.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr vec3<wide_float> farthest(const vec3<wide_float>& one) const {
        const wide_float along = dot(one, unit);
        vec3<wide_float> across = one - along * unit;
        const wide_float square = dot(across, across);
        if (sign(square - wide_float(0x1p-480)) < 0) {
            return sign(along) > 0 || (is_cone && sign(dot(one, last - first)) > 0) ? last : first;
        }
        across = made_unit(across);
        across = made_unit(across - dot(across, unit) * unit);
        const vec3<wide_float> rim = last + radius * across;
        if (is_cone) return sign(dot(one, rim - first)) > 0 ? rim : first;
        return sign(along) > 0 ? rim : first + radius * across;
    }
    /// No less than how far any point of it is from the origin.
    [[nodiscard]] ABUT_HD constexpr wide_float size() const { return magnitude(first) + magnitude(last) + radius; }

    ABUT_HD static constexpr vec3<wide_float> made_unit(const vec3<wide_float>& v) { return inverse_root(dot(v, v)) * v; }

private:
    template <scalar T>
    ABUT_HD static constexpr vec3<wide_float> seen(const vec3<T>& p, const vec3<T>& from) {
        return {wide_float(p.x) - wide_float(from.x), wide_float(p.y) - wide_float(from.y),
                wide_float(p.z) - wide_float(from.z)};
    }
    ABUT_HD static constexpr wide_float magnitude(const vec3<wide_float>& v) {
        const auto of = [](const wide_float& x) { return sign(x) < 0 ? -x : x; };
        return of(v.x) + of(v.y) + of(v.z);
    }
};

/// The difference of points that was asked for last, and how many were.
struct asked_in_bits {
    vec3<wide_float> difference;
    std::uint32_t count = 0;
};

/// Two solids that are to be within `reach`, as gjk.hpp reads two hulls.
class solids_in_bits {
public:
    using number = wide_float;
    static constexpr int most_steps = 400;

    ABUT_HD constexpr solids_in_bits(const solid_in_bits& s, const solid_in_bits& t, const wide_float& reach,
                                     asked_in_bits& asked)
        : s_(s), t_(t), enough_(reach + (s.size() + t.size() + reach).scaled(-200)), asked_(asked) {}

    [[nodiscard]] ABUT_HD constexpr vec3<wide_float> way_between_middles() const {
        return (s_.first + s_.last) - (t_.first + t_.last);
    }
    [[nodiscard]] ABUT_HD constexpr vec3<wide_float> difference(std::uint32_t, std::uint32_t) const {
        return asked_.difference;
    }
    ABUT_HD constexpr void look_back(const vec3<wide_float>& way, std::uint32_t& i, std::uint32_t& j) const {
        i = j = ++asked_.count;
        const vec3<wide_float> one = sign(dot(way, way)) > 0 ? solid_in_bits::made_unit(way) : s_.unit;
        asked_.difference = s_.farthest(wide_float(-1.0) * one) - t_.farthest(one);
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<wide_float>& way, std::uint32_t, std::uint32_t) const {
        const wide_float ahead = dot(way, asked_.difference);
        return sign(ahead) > 0 && sign(ahead * ahead - enough_ * enough_ * dot(way, way)) > 0;
    }
    /// Whether the feature's point that is nearest to the origin is near enough, by weights that are not negative.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool is_enough(const vec3<wide_float> (&w)[4],
                                                                 const difference_simplex& at) const {
        const wide_float none;
        const auto kept = [&](const wide_float& x) { return sign(x) > 0 ? x : none; };
        wide_float weight[3]{wide_float(1.0), none, none};
        if (at.count == 2) {
            const vec3<wide_float> e = w[1] - w[0];
            weight[0] = kept(dot(e, w[1]));
            weight[1] = kept(-dot(e, w[0]));
        } else if (at.count == 3) {
            const vec3<wide_float> n = cross(w[1] - w[0], w[2] - w[0]);
            weight[0] = kept(dot(n, cross(w[1], w[2])));
            weight[1] = kept(dot(n, cross(w[2], w[0])));
            weight[2] = kept(dot(n, cross(w[0], w[1])));
        } else if (at.count == 4) {
            return false;
        }
        vec3<wide_float> q = weight[0] * w[0];
        if (at.count > 1) q = q + weight[1] * w[1];
        if (at.count > 2) q = q + weight[2] * w[2];
        const wide_float most = enough_ * (weight[0] + weight[1] + weight[2]);
        return sign(most) > 0 && sign(dot(q, q) - most * most) <= 0;
    }
    ABUT_HD constexpr verdict holds_origin(const vec3<wide_float> (&)[4], const difference_simplex&) const {
        return verdict::yes;
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex&) const { return verdict::unknown; }

private:
    const solid_in_bits &s_, &t_;
    wide_float enough_;
    asked_in_bits& asked_;
};

/// Whether they are within a distance, in 256 digits; `unknown` where the search does not come to an end.
template <solid_of_revolution S, solid_of_revolution U>
ABUT_NOINLINE ABUT_HD constexpr verdict search_in_bits(const S& s, const U& t, double distance) {
    const auto origin = axis_of(s).a;
    const solid_in_bits a(s, origin), b(t, origin);
    asked_in_bits asked;
    vec3<wide_float> w[4]{};
    difference_simplex at;
    return search_origin<sought::meeting>(solids_in_bits(a, b, wide_float(distance), asked), at, w);
}

/// The same in double.
template <bool Certified, solid_of_revolution S, solid_of_revolution U>
ABUT_NOINLINE ABUT_HD constexpr verdict search_near_solids(const S& s, const U& t, double reach) {
    using T = scalar_type_of<S>;
    const hull_points<T, 2> axis_of_s = points_of(axis_of(s)), axis_of_t = points_of(axis_of(t));
    const hull<T> ends_of_s = axis_of_s.as_hull(), ends_of_t = axis_of_t.as_hull();
    points_of_solid of_s, of_t;
    difference_simplex at;
    vec3<double> w[4];
    return search_origin<sought::meeting>(
        near_on_ways<Certified, solids_on_ways<Certified, S, U>>(s, t, ends_of_s, ends_of_t, of_s, of_t, reach), at, w);
}

/// A stage of another pair that has a ball or a segment in it, in either order.
///@{
template <arithmetic A, class S, class U>
ABUT_HD constexpr verdict decide_within_in_place(const S& s, const U& t, double distance) {
    if constexpr (requires { decide_within<A>(s, t, distance); }) {
        return decide_within<A>(s, t, distance);
    } else {
        return decide_within<A>(t, s, distance);
    }
}
template <class S, class U>
ABUT_HD constexpr bool resolve_within_in_place(const S& s, const U& t, double distance) {
    if constexpr (requires { resolve_within(s, t, distance); }) {
        return resolve_within(s, t, distance);
    } else {
        return resolve_within(t, s, distance);
    }
}
///@}

/// The first stage: in double; or of `exact` in 256 digits, and unknown only where that search does not end.
template <arithmetic A, class S, class U>
requires revolution_pair_as_given<S, U> ABUT_HD constexpr verdict decide_within(const S& s, const U& t, double distance) {
    if (distance == 0) return decide<A>(s, t);
    return with_solids(
        s, t,
        [&](const S& a, const U& b) {
            if constexpr (std::same_as<A, exact>) {
                return search_in_bits(a, b, distance);
            } else {
                return search_near_solids<std::same_as<A, filtered>>(a, b, rounded(distance));
            }
        },
        [&](const auto& a, const auto& b) { return decide_within_in_place<A>(a, b, distance); });
}

/// The last one. Where the search does not end, both are within the distance, as far as it came.
template <class S, class U>
requires revolution_pair_as_given<S, U> ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const S& s, const U& t,
                                                                                            double distance) {
    if (distance == 0) return resolve(s, t);
    return with_solids(
        s, t, [&](const S& a, const U& b) { return search_in_bits(a, b, distance) != verdict::no; },
        [&](const auto& a, const auto& b) { return resolve_within_in_place(a, b, distance); });
}

}  // namespace abut::detail
