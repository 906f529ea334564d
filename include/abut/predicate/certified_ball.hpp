// SPDX-License-Identifier: MIT
#pragma once

// The floating-point half of the predicates between a ball and the hull of one, two or three points: plain arithmetic in
// the input's type (`fast`), and in double with certificates that are never wrong (`filtered`).
//
// Both ask three questions, cheapest first: is a vertex in the ball; does the direction g of the vertices' sum separate ball
// and hull; and if neither, where is the hull's point q nearest to the centre. The first two leave few pairs of a real
// scene, and their branches are predictable where the regions of the nearest point are not.
//
// Why the certificates hold. The centre is the origin; v are the true vertices and w the computed ones; u = 2^-52, so that
// every bound holds in each rounding mode, with and without contraction; M = max |v|. Differences of inputs round once:
// |w - v| <= u |v|. Nothing trusts that g or q is where it should be.
//
// Apart. Of all the hull, a vertex has the smallest g . x, so the distance is at least min g . v / |g|, for any g. A
// computed g . w is within 6u |g| M of g . v. With m the least of them, the shapes are apart where m > (r + 6uM) |g|, and
//     (r + 6uM)^2 <= (1 + 2^-30) r^2 + 2^-68 M^2    by (x + y)^2 <= (1 + e) x^2 + (1 + 1/e) y^2.
// The code takes 2^-29 and 2^-66, which pays for rounding both sides of m^2 > reach g . g as well (some 16u).
//
// Touching. A vertex with |w|^2 <= r^2 up to some 16u; the code takes 2^-40. And q is a combination of the w whose weights,
// as they stand in their registers, are >= 0 and sum to 1 within 4u. Rounding the edges (2uM), the products (2uM), the sums
// (2uM), the points (uM) and the sum of the weights (8uM) leaves q within 16uM of the hull, which so has a point x with
//     |x|^2 <= (|q| + 16uM)^2 <= (1 + 2^-31) |q|^2 + 2^-65 (1 + 2^-31) M^2.
// The code takes 2^-29 and 2^-64.
//
// So pairs that are not within 2^-30 of tangency are decided, unless the shape is larger than the radius by many orders of
// magnitude: the terms in M^2 amount to 2^-33 M in length, and how well q separates falls with (M / |q|)^2. The normal of a
// face does not suffer from that and is tried last.
//
// Overflow cannot happen for float input; double input beyond 2^240 is left undecided, so that no product of degree 6 (the
// normal's) reaches infinity but to make a comparison false. Underflow: what a product, or a number flushed to zero, loses
// is below 2^-1020, and a float flushed before it becomes a double (some compilers and modes do) is off by less than 2^-126,
// its square with the factor 1 + 1/e by less than 2^-219; `tiny` is more. Where m^2 > 2^-1000, what m lost does not matter.
// NaN makes every comparison false.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

/// The hull's point nearest to the origin: of a point,
template <scalar F>
ABUT_HD constexpr vec3<F> nearest_to_origin(const vec3<F>& a) {
    return a;
}

/// of a segment,
template <scalar F>
ABUT_HD constexpr vec3<F> nearest_to_origin(const vec3<F>& a, const vec3<F>& b) {
    const vec3<F> ab = b - a;
    const F from_a = -dot(ab, a), from_b = dot(ab, b);
    if (!(from_a > 0)) return a;
    if (!(from_b > 0)) return b;
    return a + (from_a / (from_a + from_b)) * ab;
}

/// and of a triangle, by regions: C. Ericson, Real-Time Collision Detection (2005), 5.1.5. Comparisons are strict where a
/// degenerate edge would divide zero by zero. Each weight is a quotient of a number by a sum that contains it, of numbers
/// that are not negative: so the weights are convex, however wrong their numbers.
template <scalar F>
ABUT_HD constexpr vec3<F> nearest_to_origin(const vec3<F>& a, const vec3<F>& b, const vec3<F>& c) {
    const vec3<F> ab = b - a, ac = c - a;
    const F d1 = -dot(ab, a), d2 = -dot(ac, a);
    if (d1 <= 0 && d2 <= 0) return a;
    const F d3 = -dot(ab, b), d4 = -dot(ac, b);
    if (d3 >= 0 && d4 <= d3) return b;
    const F d5 = -dot(ab, c), d6 = -dot(ac, c);
    if (d6 >= 0 && d5 <= d6) return c;
    const F vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 > 0 && d3 < 0) return a + (d1 / (d1 - d3)) * ab;
    const F vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 > 0 && d6 < 0) return a + (d2 / (d2 - d6)) * ac;
    const F va = d3 * d6 - d5 * d4, d43 = d4 - d3, d56 = d5 - d6;
    if (va <= 0 && d43 > 0 && d56 > 0) return b + (d43 / (d43 + d56)) * (c - b);
    const F wa = greatest(va, F(0)), wb = greatest(vb, F(0)), wc = greatest(vc, F(0));
    const F whole = 1 / (wa + wb + wc);
    return a + (wb * whole) * ab + (wc * whole) * ac;
}

/// `fast`: the sphere against the hull of points relative to its centre. Where input is not finite it says no.
template <scalar T, class... Points>
ABUT_HD constexpr bool approximate(T radius, const Points&... w) {
    const T rr = radius * radius;
    if (least(dot(w, w)...) <= rr) return true;
    const vec3<T> g = (w + ...);
    const T m = least(dot(g, w)...);
    if (m > 0 && m * m > rr * dot(g, g)) return false;
    const vec3<T> q = nearest_to_origin(w...);
    return dot(q, q) <= rr;
}

/// x - origin in double, rounded once. A double that a caller computes as a product, inlined to here, must not be contracted
/// into this subtraction: the certificate would speak of another number than the exact stage. A float cannot be, because it
/// is converted first.
ABUT_HD constexpr double difference(float x, float origin) { return static_cast<double>(x) - static_cast<double>(origin); }
ABUT_HD constexpr double difference(double x, double origin) { return plain_sum(rounded(x), -rounded(origin)); }

template <scalar T>
ABUT_HD constexpr vec3<double> relative_to(const vec3<T>& origin, const vec3<T>& p) {
    return {difference(p.x, origin.x), difference(p.y, origin.y), difference(p.z, origin.z)};
}

/// Whether all x of the hull have g . x > sqrt(reach) |g|.
template <class... Points>
ABUT_HD constexpr bool separates(const vec3<double>& g, double reach, double tiny, const Points&... w) {
    const double m = least(dot(g, w)...);
    return m > 0 && m * m > reach * (dot(g, g) + tiny) + 0x1p-1000;
}

template <class... Points>
ABUT_HD constexpr bool normal_separates(double, double, const Points&...) {
    return false;
}

ABUT_HD constexpr bool normal_separates(double reach, double tiny, const vec3<double>& a, const vec3<double>& b,
                                        const vec3<double>& c) {
    const vec3<double> n = cross(b - a, c - a);
    return separates(dot(n, a) < 0 ? vec3<double>{-n.x, -n.y, -n.z} : n, reach, tiny, a, b, c);
}

/// `filtered`: the same in double, with the certificates above; `T` is the type that the input had.
template <scalar T, class... Points>
ABUT_HD constexpr verdict certified_relative(double radius, const Points&... w) {
    constexpr double tiny = std::same_as<T, float> ? 0x1p-216 : 0x1p-1000;
    const double rr = radius * radius, mm = greatest(dot(w, w)...);
    if (std::same_as<T, double> && !(mm < 0x1p480 && rr < 0x1p480)) return verdict::unknown;
    if ((1 + 0x1p-40) * least(dot(w, w)...) + tiny <= rr) return verdict::yes;
    const double reach = (1 + 0x1p-29) * rr + (0x1p-66 * mm + tiny);
    if (separates((w + ...), reach, tiny, w...)) return verdict::no;

    const vec3<double> q = nearest_to_origin(w...);
    if ((1 + 0x1p-29) * dot(q, q) + (0x1p-64 * mm + tiny) <= rr) return verdict::yes;
    if (separates(q, reach, tiny, w...) || normal_separates(reach, tiny, w...)) return verdict::no;
    return verdict::unknown;
}

/// The same, of a sphere and the hull of `points` in the input's type.
template <scalar T, class... Points>
ABUT_HD constexpr verdict certified(const vec3<T>& center, T radius, const Points&... points) {
    return certified_relative<T>(static_cast<double>(radius), relative_to(center, points)...);
}

}  // namespace abut::detail
