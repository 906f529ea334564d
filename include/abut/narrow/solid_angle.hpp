// SPDX-License-Identifier: MIT
#pragma once

// The solid angle under which a triangle is seen from a point, as a share of the whole: what winding numbers are sums of.
// One rounded operation after another in double, so that the bits are the same under every compiler, flag and device that
// rounds to nearest and keeps subnormals. Not for decisions.
//
// With a, b, c the ways from the point to the corners, half of the solid angle is the angle of the complex number
//
//   x + i y = |a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|  +  i det(a, b, c)
//
// (A. Van Oosterom, J. Strackee: The Solid Angle of a Plane Triangle, 1983). It is linear in the length of each way, so that
// each may be measured in a unit of its own. Let D = |a||b||c|. Then |x + i y| is D times the root of 2 (1 + cos ab)
// (1 + cos bc)(1 + cos ca), between the ways: small where the point is close to an edge, and there alone.

#include <cmath>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>
#include <abut/narrow/exact_hit_time.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/rounded_lanes.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// The arc tangent of q in turns, for |q| <= tan(pi / 8).
template <class N>
ABUT_INLINE ABUT_HD constexpr N arc_tangent(const N& q) {
    constexpr double coefficients[] = {0x1.45f306dc9c882p-3,  -0x1.b2995e7b7b1e1p-5, 0x1.04c26be3734cfp-5,
                                       -0x1.7483756254124p-6, 0x1.21bb8c26e37f0p-6,  -0x1.da19e726290e8p-7,
                                       0x1.910c413a0116fp-7,  -0x1.5a51b4dc146c9p-7, 0x1.28bfcea816556p-7,
                                       -0x1.c604729a03330p-8, 0x1.ba0ff54a5b8e4p-9};
    const N square = q * q;
    N value = N::of(coefficients[10]);
    for (int k = 9; k >= 0; --k) value = value * square + N::of(coefficients[k]);
    return value * q;
}

/// The angle of x + i y in turns, from -1/2 to 1/2: atan2(y, x) / (2 pi), within 2^-52. 0 for 0, and positive for a negative
/// x and a y that is 0. Magnitudes stay below 2^1022.
///
/// The angle is folded to [0, pi / 4], and by the tangent of a difference to [-pi / 8, pi / 8]. There the arc tangent is q
/// times a polynomial in q^2, of least error (Remez): off by 2^-56 with its coefficients as they are rounded.
ABUT_HD constexpr double angle_in_turns(double y, double x) {
    const double of_x = absolute(x), of_y = absolute(y), larger = of_y > of_x ? of_y : of_x,
                 smaller = of_y > of_x ? of_x : of_y;
    if (!(larger > 0)) return 0;
    const bool is_wide = smaller > plain_product(0.41421356237309503, larger);  // tan(pi / 8)
    const double q = is_wide ? plain_sum(smaller, -larger) / plain_sum(smaller, larger) : smaller / larger;
    double turns = arc_tangent(contact_math::one_double{q}).high;
    if (is_wide) turns = plain_sum(0.125, turns);
    if (of_y > of_x) turns = plain_sum(0.25, -turns);
    if (x < 0) turns = plain_sum(0.5, -turns);
    return y < 0 ? -turns : turns;
}

/// The sign of det(a, b, c), exactly: 1 where the point is behind the triangle, whose normal points away from it.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr int exact_side(const vec3<T>& p, const triangle<T>& t) {
    using numbers = rolled_numbers<T>;
    const aligned<12> x(in_a_row(p, t.a, t.b, t.c).value);
    const int w = x.width() > 1 ? x.width() : 1;
    typename numbers::length way[3][3];
    ABUT_ROLLED
    for (int k = 0; k < 9; ++k) {
        auto& number = way[k / 3][k % 3];
        number.clear((w + 3 + 63) / 64);
        number.add(x, 3 + k);
        number.add(x, k % 3, true);
    }
    typename numbers::volume height;
    height.clear((3 * w + 9 + 63) / 64);
    ABUT_ROLLED
    for (int k = 0; k < 3; ++k) {
        const int i = next_axis(k), j = next_axis(i);
        typename numbers::area minor;
        minor.clear((2 * w + 5 + 63) / 64);
        minor.add(way[1][i], way[2][j]);
        minor.add(way[1][j], way[2][i], true);
        height.add(minor, way[0][k]);
    }
    return height.sign();
}

/// A way between two points, 2^exponent times a vector whose largest coordinate is in [1, 2), or 0.
struct scaled_way {
    vec3<contact_math::two_doubles> v;
    int exponent;
};

ABUT_HD constexpr scaled_way scaled_way_between(const vec3<double>& from, const vec3<double>& to) {
    using contact_math::two_doubles;
    // The difference of two large numbers overflows. It is taken of their quarters then, and what these lose is far below.
    int exponent = 0;
    vec3<two_doubles> v = contact_math::between<two_doubles>(from, to);
    if (!(contact_math::largest_of(contact_math::rounded_off(v)) < 0x1p1020)) {
        exponent = 2;
        v = contact_math::between<two_doubles>(contact_math::scaled(from, -2), contact_math::scaled(to, -2));
    }
    const double largest = contact_math::largest_of(contact_math::rounded_off(v));
    if (!(largest > 0)) return {v, 0};
    const int e = contact_math::exponent_of(largest);
    return {contact_math::scaled_vector(v, -e), exponent + e};
}

/// The same as `solid_angle_share` for what it leaves open: points near the plane of a triangle or near an edge, and lengths
/// whose products are out of range. Each way has a unit of its own; sums of two doubles are off by some 2^-98 of D, and what
/// side the point is on is certain.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr double careful_solid_angle_share(const triangle<T>& t, const vec3<T>& p) {
    using contact_math::two_doubles;
    const vec3<double> from = widened(p);
    scaled_way a = scaled_way_between(from, widened(t.a)), b = scaled_way_between(from, widened(t.b)),
               c = scaled_way_between(from, widened(t.c));
    const auto is_at_corner = [](const scaled_way& way) { return contact_math::is_zero(way.v); };
    if (is_at_corner(a) || is_at_corner(b) || is_at_corner(c)) return 0;
    // The shortest way comes first: no edge is then much longer than the way to its end, and the product that follows is
    // small where it should be.
    const auto is_shorter = [](const scaled_way& v, const scaled_way& w) {
        return v.exponent < w.exponent || (v.exponent == w.exponent && dot(v.v, v.v) < dot(w.v, w.v));
    };
    if (is_shorter(b, a) && !is_shorter(c, b)) {
        rotate(a, b, c);
    } else if (is_shorter(c, a)) {
        rotate(c, b, a);
    }
    const auto edge_to = [&](const scaled_way& to) {
        const int below = a.exponent - to.exponent;
        return to.v - contact_math::scaled_vector(a.v, below < -1100 ? -1100 : below);
    };
    const two_doubles height = dot(a.v, cross(edge_to(b), edge_to(c)));
    const two_doubles of_a = root(dot(a.v, a.v)), of_b = root(dot(b.v, b.v)), of_c = root(dot(c.v, c.v));
    const two_doubles along = of_a * of_b * of_c + dot(a.v, b.v) * of_c + dot(b.v, c.v) * of_a + dot(c.v, a.v) * of_b;
    const double y = absolute(height.high);
    int side = height.high > 0 ? 1 : -1;
    if (!(y > 0x1p-80)) side = exact_side(p, t);
    return side * angle_in_turns(y, along.high);
}

/// x and y of the ways to the corners, the shortest first, and of their lengths; and the product of these.
template <class N>
struct half_angle {
    N product, x, y;
    ABUT_INLINE ABUT_HD constexpr half_angle(const vec3<N>& a, const vec3<N>& b, const vec3<N>& c, const N& of_a, const N& of_b,
                                             const N& of_c)
        : product(of_a * of_b * of_c),
          x((product + dot(a, b) * of_c) + (dot(b, c) * of_a + dot(c, a) * of_b)),
          y(dot(a, cross(b - a, c - a))) {}
};

/// The solid angle of a triangle from p, over 4 pi: from -1/2 to 1/2, positive where p is behind the triangle, which is
/// where its corners go round clockwise. 0 where p is in the triangle's plane, on the triangle too: the mean of what it is
/// on both sides.
///
/// Off by less than 2^-45 where p is not nearer to any edge than 2^-26 times the distance of that edge's farther corner; of
/// other points it is off by any amount that leaves it its sign. In double, y is off by at most 32u D and x by 20u D, with
/// u = 2^-53. Here one of them is D / 8 or more, and x if y is small: so the angle is off by 304u, and the share, a 2 pi-th,
/// by 49u; the coordinates of the ways are rounded as well, by u of themselves. In sums of two doubles the same errors are
/// 40 2^-104 D; and x + i y is no less than D d^2 / 2 where an edge is d times as far as its farther corner, since at most
/// two of the three angles between the ways are near pi, and then each by d or more.
template <scalar T>
ABUT_HD constexpr double solid_angle_share(const triangle<T>& t, const vec3<T>& p) {
    using contact_math::plain_difference;
    using contact_math::plain_dot;
    const auto length_of = [](const vec3<double>& v) {
        return contact_math::root(contact_math::one_double{plain_dot(v, v)}).high;
    };
    const vec3<double> from = widened(p);
    vec3<double> a = plain_difference(widened(t.a), from), b = plain_difference(widened(t.b), from),
                 c = plain_difference(widened(t.c), from);
    double of_a = length_of(a), of_b = length_of(b), of_c = length_of(c);
    // NaN of an overflow is not between the bounds.
    if (!(of_a > 0x1p-250 && of_b > 0x1p-250 && of_c > 0x1p-250 && of_a < 0x1p250 && of_b < 0x1p250 && of_c < 0x1p250)) {
        return careful_solid_angle_share(t, p);
    }
    // The shortest way comes first, as above.
    if (of_b < of_a && !(of_c < of_b)) {
        rotate(a, b, c);
        rotate(of_a, of_b, of_c);
    } else if (of_c < of_a) {
        rotate(c, b, a);
        rotate(of_c, of_b, of_a);
    }
    const auto in_doubles = [](const vec3<double>& v) { return contact_math::as<contact_math::one_double>(v); };
    const half_angle<contact_math::one_double> of(in_doubles(a), in_doubles(b), in_doubles(c), {of_a}, {of_b}, {of_c});
    const double x = of.x.high, y = of.y.high, product = of.product.high;
    if (!(greatest(x, absolute(y)) > plain_product(0.125, product))) return careful_solid_angle_share(t, p);
    return angle_in_turns(y, x);
}

/// angle_in_turns of each.
template <class N>
ABUT_INLINE ABUT_HD N angles_in_turns(const N& y, const N& x) {
    const N none = N::of(0), of_x = absolute(x), of_y = absolute(y);
    const auto is_steep = of_y > of_x;
    const N larger = select(is_steep, of_y, of_x), smaller = select(is_steep, of_x, of_y);
    const auto is_wide = smaller > N::of(0.41421356237309503) * larger;
    const N q = select(is_wide, smaller - larger, smaller) / select(is_wide, smaller + larger, larger);
    N turns = arc_tangent(q);
    turns = select(is_wide, N::of(0.125) + turns, turns);
    turns = select(is_steep, N::of(0.25) - turns, turns);
    turns = select(x < none, N::of(0.5) - turns, turns);
    turns = select(y < none, none - turns, turns);
    return select(larger > none, turns, none);
}

/// Four triangles, by coordinates: those of a, b, c, one after another.
template <scalar T>
struct four_triangles {
    T at[9][4];
    [[nodiscard]] ABUT_HD triangle<T> one(int k) const {
        return {{at[0][k], at[1][k], at[2][k]}, {at[3][k], at[4][k], at[5][k]}, {at[6][k], at[7][k], at[8][k]}};
    }
};

#if ABUT_VECTORS
/// From p to three coordinates of all.
template <scalar T>
ABUT_INLINE vec3<four_rounded<double>> ways_to(const four_triangles<T>& of, int first, const vec3<T>& p) {
    using number = four_rounded<double>;
    const T* const x = of.at[first];
    if constexpr (std::same_as<T, double>) {
        return {number::load(x) - number::of(p.x), number::load(x + 4) - number::of(p.y), number::load(x + 8) - number::of(p.z)};
    } else {
        const auto row = [&](int k) { return number::of(x[k], x[k + 1], x[k + 2], x[k + 3]); };
        return {row(0) - number::of(p.x), row(4) - number::of(p.y), row(8) - number::of(p.z)};
    }
}
template <class Mask, class V>
ABUT_INLINE void rotate_some(const Mask& once, const Mask& twice, V& a, V& b, V& c) {
    const V first = a, second = b;
    a = select(once, second, select(twice, c, first));
    b = select(once, c, select(twice, first, second));
    c = select(once, first, select(twice, second, c));
}
#endif

/// solid_angle_share of each, bit for bit but for the sign of 0. On a host they are computed together.
template <scalar T>
ABUT_HD void solid_angle_shares(const four_triangles<T>& of, const vec3<T>& p, double* out) {
#if ABUT_VECTORS
    using number = four_rounded<double>;
    vec3<number> a = ways_to(of, 0, p), b = ways_to(of, 3, p), c = ways_to(of, 6, p);
    number of_a = root(dot(a, a)), of_b = root(dot(b, b)), of_c = root(dot(c, c));
    const number smallest = number::of(0x1p-250), largest = number::of(0x1p250);
    auto is_plain = (of_a > smallest) & (of_b > smallest) & (of_c > smallest) & (of_a < largest) & (of_b < largest) &
                    (of_c < largest);
    // To b, c, a where b is the shortest, and to c, a, b where c is.
    const auto is_b = (of_b < of_a) & (of_b <= of_c), is_c = of_c < of_a;
    rotate_some(is_b, is_c, a, b, c);
    rotate_some(is_b, is_c, of_a, of_b, of_c);
    const half_angle<number> half(a, b, c, of_a, of_b, of_c);
    const number bound = number::of(0.125) * half.product;
    is_plain = is_plain & ((half.x > bound) | (absolute(half.y) > bound));
    angles_in_turns(half.y, half.x).value.store(out);
    typename number::mask row[1] = {is_plain};
    for (unsigned left = bits_of(row) ^ 15u; left != 0; left &= left - 1) {
        const auto k = static_cast<int>(lowest_bit(left));
        out[k] = careful_solid_angle_share(of.one(k), p);
    }
#else
    for (int k = 0; k < 4; ++k) out[k] = solid_angle_share(of.one(k), p);
#endif
}

}  // namespace abut::detail
