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
#include <abut/predicate/farthest_points.hpp>
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

/// Whether they are within a distance, in 256 digits; `unknown` where the search does not come to an end.
template <solid_of_revolution S, solid_of_revolution U>
ABUT_NOINLINE ABUT_HD constexpr verdict search_in_bits(const S& s, const U& t, double distance) {
    const auto origin = axis_of(s).a;
    return search_near(solid_in_numbers<wide_float>(s, origin), solid_in_numbers<wide_float>(t, origin),
                       wide_float(distance));
}

/// The same in double.
template <bool Certified, solid_of_revolution S, solid_of_revolution U>
ABUT_NOINLINE ABUT_HD constexpr verdict search_near_solids(const S& s, const U& t, double reach) {
    using T = scalar_type_of<S>;
    const corner_hull<T, 2> axis_of_s = points_of(axis_of(s)), axis_of_t = points_of(axis_of(t));
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
