// SPDX-License-Identifier: MIT
#pragma once

// Does a convex hull touch a solid ball or a capsule, that is: is it within the radius of the centre or of the axis? These
// are hulls of one and two points. The search of gjk.hpp finds the feature of all differences that is nearest to the origin,
// and the square of its distance, a quotient of degree 6 over 4 at most, is compared with that of the radius.
//
// Why the certificates hold, with the names of hull_numbers.hpp; lengths |g| are Euclidean here.
//
// Apart. The shapes are at least m / |g| apart, for any way g and the least m of g along all differences. A computed m is
// within 12u of the sum of g's magnitudes times M, and so within 21u |g| M. They are apart where m > (r + 21uM) |g|, and
//     (r + 21uM)^2 <= (1 + 2^-30) r^2 + 2^-65 M^2    by (x + y)^2 <= (1 + e) x^2 + (1 + 1/e) y^2.
// The code takes 2^-29 and 2^-63.
//
// Touching. q is a combination of up to three computed differences, none longer than 2 sqrt(3) M, whose weights, as they
// stand in their registers, are >= 0 and sum to 1 within 4u. So q is within 56uM of one of the true ones, as
// certified_ball.hpp says, and (|q| + 56uM)^2 <= (1 + 2^-30) |q|^2 + 2^-62 M^2. The code takes 2^-29 and 2^-60.

#include <concepts>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/predicate/certified_corner_box.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// Where the feature of the first corners is nearest to the origin, in floating point. Weights are quotients of numbers that
/// are not negative by their sum, however wrong they are.
template <scalar F>
ABUT_HD constexpr vec3<F> nearest_on_feature(const vec3<F> (&w)[4], int count, F (&weight)[3]) {
    weight[0] = 1, weight[1] = weight[2] = 0;
    if (count == 1) return w[0];
    if (count == 2) {
        const vec3<F> e = w[1] - w[0];
        weight[0] = greatest(dot(e, w[1]), F(0));
        weight[1] = greatest(-dot(e, w[0]), F(0));
    } else {
        const vec3<F> n = cross(w[1] - w[0], w[2] - w[0]);
        weight[0] = greatest(dot(n, cross(w[1], w[2])), F(0));
        weight[1] = greatest(dot(n, cross(w[2], w[0])), F(0));
        weight[2] = greatest(dot(n, cross(w[0], w[1])), F(0));
    }
    const F sum = weight[0] + weight[1] + weight[2];
    if (!(sum > 0)) {
        weight[0] = 1, weight[1] = weight[2] = 0;
        return w[0];
    }
    for (F& x : weight) x /= sum;
    vec3<F> q = w[0] + weight[1] * (w[1] - w[0]);
    if (count > 2) q = q + weight[2] * (w[2] - w[0]);
    return q;
}

/// A hull and a core of points with something around it that reaches r far: of `filtered` off by up to 4u of that, and by
/// what is lost where small numbers are read as 0.
template <bool Certified, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict near_in_floats(const hull<T>& core, typename hulls_in_floats<Certified, T>::number r,
                                                       const hull<T>& h) {
    using hulls = hulls_in_floats<Certified, T>;
    using number = typename hulls::number;
    const hulls x(core, h);
    difference_simplex at;
    vec3<number> w[4];
    number weight[3];
    const number rr = r * r;
    const verdict meeting = search_origin<sought::nearest>(x, at, w);
    if constexpr (Certified) {
        constexpr double tiny = std::same_as<T, float> ? 0x1p-210 : 0x1p-1000;
        if (meeting == verdict::yes) return meeting;
        if (at.count == 4 || !(x.size() < 0x1p240 && r < 0x1p240)) return verdict::unknown;
        const vec3<double> q = nearest_on_feature(w, at.count, weight);
        const double mm = x.size() * x.size();
        if ((1 + 0x1p-29) * dot(q, q) + (0x1p-60 * mm + tiny) <= rr) return verdict::yes;
        std::uint32_t i = 0, j = 0;
        x.look_back(q, i, j);
        const double m = x.ahead(q, i, j), reach = (1 + 0x1p-29) * rr + (0x1p-63 * mm + tiny);
        return m > 0 && m * m > reach * (dot(q, q) + tiny) + 0x1p-1000 ? verdict::no : verdict::unknown;
    } else {
        // The feature that the search came to, of a tetrahedron the face before its last corner. Where the origin is on it, q is
        // what differences were rounded by.
        const vec3<T> q = nearest_on_feature(w, at.count < 4 ? at.count : 3, weight);
        const T qq = dot(q, q);
        if (qq <= rr) return verdict::yes;
        if (at.count < 4) {
            T size = 0;
            for (int k = 0; k < at.count; ++k) size = greatest(size, magnitudes(w[k]));
            const T rounding = 8 * unit_roundoff<T> * size;
            return to_verdict(qq <= rr + rounding * rounding);
        }
        // Rounding finds the origin as well in a flat tetrahedron, as two parallel edges make it. But then all differences are
        // ahead, as far as q is.
        std::uint32_t i = 0, j = 0;
        x.look_back(q, i, j);
        const T m = x.ahead(q, i, j);
        return to_verdict(!(m > 0 && m * m > rr * qq));
    }
}

/// Whether the feature of the first corners, whose nearest point to the origin is inside of it, is within a distance r.
template <int Room>
ABUT_NOINLINE ABUT_HD constexpr bool is_feature_within(const vec3<rolled_int<Room>> (&w)[4], int count,
                                                       const rolled_int<Room>& r) {
    const auto rr = r * r;
    if (count == 1) return (dot(w[0], w[0]) - rr).sign() <= 0;
    const vec3<rolled_int<Room>> e = w[1] - w[0];
    if (count == 2) {
        const auto moment = cross(w[0], e);
        return (dot(moment, moment) - rr * dot(e, e)).sign() <= 0;
    }
    const auto normal = cross(e, w[2] - w[0]);
    const auto height = dot(normal, w[0]);
    return (height * height - rr * dot(normal, normal)).sign() <= 0;
}

/// The same, of a core within a radius and a distance, in integers whose differences have up to `Room` limbs; `unknown`
/// where they need more.
template <int Room, bool Sifted, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict near_in_integers(const hull<T>& core, T radius, const hull<T>& h,
                                                         double distance = 0) {
    const unit_of_hulls<T> unit(core, h, radius, distance);
    if (unit.width() + spare_bits > 64 * Room) return verdict::unknown;
    difference_simplex at = guess_simplex<sought::nearest>(core, h);
    vec3<rolled_int<Room>> w[4];
    const hulls_in_integers<Room, T, Sifted> x(core, h, unit);
    if (search_origin<sought::nearest>(x, at, w) == verdict::yes) return verdict::yes;
    return to_verdict(is_feature_within(w, at.count, x.reach(radius, distance)));
}

/// The points whose hull is the core of a shape: of a ball its centre, of a capsule the ends of its axis, and of what is a
/// hull of points all of them. Not named points_of, of which nvcc 13.0 would take a ball for a point.
///@{
template <class S>
    requires made_of_points<S, scalar_type_of<S>>
ABUT_HD constexpr auto core_points_of(const S& s) {
    return points_of(s);
}
template <class S>
    requires(has_radius<S> && corners_of_core<S> > 0)
ABUT_HD constexpr auto core_points_of(const S& s) {
    return core_of(s);
}
///@}

}  // namespace detail

/// One stage of the decision, as for two hulls, of a sphere or a capsule and a hull. Its radius is >= 0.
template <arithmetic A, scalar T, class S>
    requires(std::same_as<S, sphere<T>> || std::same_as<S, capsule<T>>)
ABUT_HD constexpr verdict decide(const S& s, const hull<T>& h) {
    const auto core = detail::core_points_of(s);
    if constexpr (std::same_as<A, exact>) {
        return detail::near_in_integers<2, false>(core.as_hull(), s.radius, h);
    } else {
        constexpr bool certified = std::same_as<A, filtered>;
        using number = typename detail::hulls_in_floats<certified, T>::number;
        if constexpr (certified && std::same_as<S, sphere<T>>) {
            if (h.count == 8) {
                const auto near = [&](const vec3<T>* at) {
                    return detail::near_corner_box(at, s.center, static_cast<double>(s.radius));
                };
                const verdict v = detail::with_eight_points(h, near);
                if (v != verdict::unknown) return v;
            }
        }
        return detail::near_in_floats<certified>(core.as_hull(), static_cast<number>(s.radius), h);
    }
}

/// What the filter left, in integers, with points compared in double first.
template <arithmetic A, scalar T, class S>
    requires(std::same_as<A, filtered> && (std::same_as<S, sphere<T>> || std::same_as<S, capsule<T>>))
ABUT_HD constexpr verdict decide_late(const S& s, const hull<T>& h) {
    const auto core = detail::core_points_of(s);
    return detail::near_in_integers<2, true>(core.as_hull(), s.radius, h);
}

/// The last stage: decides every finite input.
template <scalar T, class S>
    requires(std::same_as<S, sphere<T>> || std::same_as<S, capsule<T>>)
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const S& s, const hull<T>& h) {
    const auto core = detail::core_points_of(s);
    return detail::near_in_integers<detail::limbs_of_any<T>, true>(core.as_hull(), s.radius, h) == verdict::yes;
}

}  // namespace abut
