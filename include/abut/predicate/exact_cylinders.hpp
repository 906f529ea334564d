// SPDX-License-Identifier: MIT
#pragma once

// Do two cylinders have a point in common? Decided by signs of polynomials in integers of a length that is known at run
// time.
//
// Axes along u and v, whose lengths are not 0; e = u x v, and E = |e|^2.
//
// Parallel, E = 0. The lines of the axes are no farther apart than both radii, and the heights of both along v have one in
// common.
//
// Else. If the lines are farther apart than both radii, no. If the feet of their common perpendicular lie between the ends
// of both axes, yes. And else they have a point in common if and only if the disc of an end does with the other cylinder: if
// none does, what both endless cylinders have in common meets no end, so it lies between all ends or none of it does; and it
// has a point of the perpendicular.
//
// A disc of radius R about c, orthogonal to u, and a cylinder of radius r from a along v. Let U = |u|^2, V = |v|^2, w = u .
// v, x = c - a, M = x . e, N = (x x v) . e. The point c + (s e + g (u x e)) / E of the disc's plane is
//     in the disc                where s^2 + U g^2 <= R^2 E
//     in the endless cylinder    where V (M + s)^2 + (N + w g)^2 <= r^2 V E
//     between the ends           where x . v - V <= g <= x . v
// since e and u x e are orthogonal, and so are e x v and (u x e) x v = w e. So at each g both have an interval of s, about 0
// and -M, and those have a point in common where |M| <= S(g)^(1/2) + (T(g) / V)^(1/2) with
//     S = R^2 E - U g^2,  T = r^2 V E - (N + w g)^2,
// both of them not negative. The right side is concave. So the disc meets the cylinder if that holds at one of both ends; or
// else if it holds anywhere, and there is where it does between the ends. On which side of an end it holds, the slope tells,
// or where S and T are not negative.
//
// Whether it holds anywhere: seen along v the disc is an ellipse, and the endless cylinder a circle. They are apart if and
// only if for some y > 0
//     m y / (y + 1) + n y / (y + b / a) > q y + p,
//     m = V M^2, n = N^2, p = r^2 V E, q = R^2 V E, a = U V, b = w^2:
// by the S-lemma a sum of both quadratics, one of them times y, is positive everywhere. Without the denominators it is a
// cubic
//     - a q y^3 + (a (m + n - p) - (a + b) q) y^2 + (a (n - p) + b (m - p) - b q) y - b p > 0,
// which is not positive at 0 and negative far off. If b p > 0 one root at least is negative. The two others are positive and
// differ if all roots are real and differ and a coefficient between the first and the last is positive, by Descartes's rule
// of signs. (W. Wang, J. Wang, M.-S. Kim, An algebraic condition for the separation of two ellipsoids, 2001, has the same
// for matrices.) With A, B and C those of the Hessian form, the discriminant's sign is that of 4 A C - B^2. Degree 48.

#include <cstddef>

#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

/// The sum of products that are added to it, of numbers of `Limbs` limbs at most together.
template <int Limbs>
struct sum_of_products {
    rolled_int<Limbs> sum;

    template <int A, int B>
    ABUT_HD constexpr sum_of_products(const rolled_int<A>& a, const rolled_int<B>& b) {
        sum.begin(a.count + b.count);
        sum.add(a, b);
    }
    template <int A, int B>
    ABUT_NOINLINE ABUT_HD constexpr void add(int times, const rolled_int<A>& a, const rolled_int<B>& b) {
        ABUT_ROLLED
        for (int i = times; i > 0; --i) sum.add(a, b);
        ABUT_ROLLED
        for (int i = times; i < 0; ++i) sum.add(a, b, true);
    }
};
template <int A, int B>
sum_of_products(const rolled_int<A>&, const rolled_int<B>&) -> sum_of_products<A + B>;

/// Whether - c3 y^3 + c2 y^2 + c1 y - c0 is positive for a y > 0, where c3 >= 0 and c0 >= 0. One of an ellipse and a circle
/// as above: where c3 = 0 it is only if c2 > 0.
template <int L>
ABUT_NOINLINE ABUT_HD constexpr bool is_positive_somewhere(const rolled_int<L>& c3, const rolled_int<L>& c2,
                                                           const rolled_int<L>& c1, const rolled_int<L>& c0) {
    const bool rises = sign(c2) > 0, starts = sign(c1) > 0;
    if (!rises && !starts) return false;
    sum_of_products a(c2, c2);
    if (sign(c0) == 0) {
        a.add(4, c3, c1);
        return starts || sign(c3) == 0 || sign(a.sum) > 0;
    }
    sum_of_products b(c2, c1), c(c1, c1);
    a.add(3, c3, c1);
    b.add(-9, c3, c0);
    c.add(3, c2, c0);
    sum_of_products d(a.sum, c.sum);
    d.add(3, a.sum, c.sum);
    d.add(-1, b.sum, b.sum);
    return sign(d.sum) > 0;
}

/// The sign of x y^(1/2) + z w^(1/2), where y and w are positive.
template <int X, int Y, int Z, int W>
ABUT_NOINLINE ABUT_HD constexpr int sign_of_roots(const rolled_int<X>& x, const rolled_int<Y>& y, const rolled_int<Z>& z,
                                                  const rolled_int<W>& w) {
    const int first = sign(x), second = sign(z);
    if (first * second >= 0) return first != 0 ? first : second;
    sum_of_products d(square(x), y);
    d.add(-1, square(z), w);
    return first * sign(d.sum);
}

/// The end of a cylinder at which its axis starts or ends, and what is known there of the disc of another one.
enum class axis_end : int { first = -1, last = 1 };
enum class disc_at_end { meets, beyond, between };

/// A disc and a cylinder, by the numbers above.
template <int L>
struct disc_and_cylinder {
    rolled_int<2 * L> uu, vv, w;
    rolled_int<3 * L> m;
    rolled_int<4 * L> n;
    rolled_int<6 * L> most_s;  ///< R^2 E
    rolled_int<8 * L> most_t;  ///< r^2 V E

    /// Whether they meet in the plane of the end at g, or else whether they may meet on the side of the other end.
    ABUT_NOINLINE ABUT_HD constexpr disc_at_end at(const rolled_int<2 * L>& g, axis_end end) const {
        const auto k = n + w * g;
        const auto s = most_s - uu * square(g);
        const auto t = most_t - square(k);
        const int sign_s = sign(s), sign_t = sign(t), sign_w = sign(w), outward = static_cast<int>(end);
        if (sign_s >= 0 && sign_t >= 0 && overlap(s, t)) return disc_at_end::meets;
        if (sign_s <= 0 && sign(g) * outward <= 0) return disc_at_end::beyond;
        if (sign_w == 0 ? sign_t < 0 : sign_t <= 0 && sign(k) * sign_w * outward <= 0) return disc_at_end::beyond;
        if (sign_s <= 0 || (sign_t <= 0 && sign_w != 0)) return disc_at_end::between;
        const int falls = sign_w == 0 ? sign(g) : sign_of_roots(uu * g, vv * t, w * k, s);
        return falls * outward > 0 ? disc_at_end::between : disc_at_end::beyond;
    }

    /// Whether the disc and the endless cylinder have no point in common.
    ABUT_NOINLINE ABUT_HD constexpr bool is_apart_from_endless() const {
        const auto mm = vv * square(m), nn = square(n), q = vv * most_s;
        const auto a = uu * vv, b = square(w);
        sum_of_products c3(a, q), c2(a, mm), c1(a, nn), c0(b, most_t);
        c2.add(1, a, nn);
        c2.add(-1, a, most_t);
        c2.add(-1, a, q);
        c2.add(-1, b, q);
        c1.add(-1, a, most_t);
        c1.add(1, b, mm);
        c1.add(-1, b, most_t);
        c1.add(-1, b, q);
        return is_positive_somewhere(c3.sum, c2.sum, c1.sum, c0.sum);
    }

private:
    /// Whether |M| <= S^(1/2) + (T / V)^(1/2).
    ABUT_NOINLINE ABUT_HD constexpr bool overlap(const rolled_int<6 * L>& s, const rolled_int<8 * L>& t) const {
        const auto vs = vv * s;
        const auto over = vv * square(m) - vs - t;
        if (sign(over) <= 0) return true;
        sum_of_products d(over, over);
        d.add(-4, vs, t);
        return sign(d.sum) <= 0;
    }
};

/// The ends of the first axis and of the second, and both radii.
struct cylinders_meet {
    template <int L>
    ABUT_HD static constexpr bool holds(const rolled_int<L> (&value)[14]) {
        using point = vec3<rolled_int<L>>;
        const point a[2] = {point_at(value, 0), point_at(value, 1)}, b[2] = {point_at(value, 2), point_at(value, 3)};
        const point u = a[1] - a[0], v = b[1] - b[0], x = a[0] - b[0];
        const auto e = cross(u, v);
        const auto ee = dot(e, e);
        const auto reach = value[12] + value[13];
        if (sign(ee) == 0) return parallel_meet(x, a[1] - b[0], v, reach);
        if (sign(square(dot(x, e)) - square(reach) * ee) > 0) return false;
        const auto at_a = dot(cross(x, v), e), at_b = dot(cross(x, u), e);
        if (sign(at_a) <= 0 && sign(at_a + ee) >= 0 && sign(at_b) <= 0 && sign(at_b + ee) >= 0) return true;
        ABUT_ROLLED
        for (int k = 0; k < 2; ++k) {
            if (disc_meets(a[k] - b[0], u, v, value[12], value[13]) || disc_meets(b[k] - a[0], v, u, value[13], value[12])) {
                return true;
            }
        }
        return false;
    }

private:
    /// The ends of one axis as seen from the first end of the other, along v.
    template <int L>
    ABUT_NOINLINE ABUT_HD static constexpr bool parallel_meet(const vec3<rolled_int<L>>& x, const vec3<rolled_int<L>>& y,
                                                              const vec3<rolled_int<L>>& v, const rolled_int<L>& reach) {
        const auto first = dot(x, v), last = dot(y, v), vv = dot(v, v);
        if (sign(first) < 0 && sign(last) < 0) return false;
        if (sign(first - vv) > 0 && sign(last - vv) > 0) return false;
        return sign(square(cross(x, v)) - square(reach) * vv) <= 0;
    }

    /// A disc orthogonal to u, whose centre is seen from the first end of a cylinder along v.
    template <int L>
    ABUT_NOINLINE ABUT_HD static constexpr bool disc_meets(const vec3<rolled_int<L>>& x, const vec3<rolled_int<L>>& u,
                                                           const vec3<rolled_int<L>>& v, const rolled_int<L>& disc_radius,
                                                           const rolled_int<L>& radius) {
        const auto e = cross(u, v);
        const auto ee = dot(e, e);
        disc_and_cylinder<L> d;
        d.uu = dot(u, u), d.vv = dot(v, v), d.w = dot(u, v);
        d.m = dot(x, e), d.n = dot(cross(x, v), e);
        d.most_s = square(disc_radius) * ee, d.most_t = square(radius) * (d.vv * ee);
        const auto last = dot(x, v);
        const disc_at_end at_last = d.at(last, axis_end::last);
        if (at_last != disc_at_end::between) return at_last == disc_at_end::meets;
        const disc_at_end at_first = d.at(last - d.vv, axis_end::first);
        return at_first == disc_at_end::between ? !d.is_apart_from_endless() : at_first == disc_at_end::meets;
    }
};

}  // namespace abut::detail
