// SPDX-License-Identifier: MIT
#pragma once

// Do two cylinders have a point in common? Decided by signs of polynomials in integers of an arena.
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
//     V M^2 y / (y + V) + U N^2 y / (U y + w^2) > E (R^2 y + r^2 V):
// by the S-lemma a sum of both quadratics, one of them times y / V, is positive everywhere. Without the denominators it is a
// cubic, which E = U V - w^2 divides, as V M^2 + N^2 = E X with X = |x x v|^2:
//     - c3 y^3 + c2 y^2 + c1 y - c0 > 0,  c3 = R^2 U,  c2 = U X - R^2 (U V + w^2) - r^2 U V,
//     c1 = w^2 X + N^2 - R^2 V w^2 - r^2 V (U V + w^2),  c0 = r^2 V^2 w^2.
// It is not positive at 0, and negative far off. If c0 and c3 are not 0, one root is negative. The two others are positive
// and differ if and only if all roots are real and differ and c1 or c2 is positive, by Descartes's rule of signs. (W. Wang,
// J. Wang, M.-S. Kim, An algebraic condition for the separation of two ellipsoids, 2001, has the same for matrices.) The
// discriminant's sign is that of 4 A C - B^2 with A = c2^2 + 3 c3 c1, B = c2 c1 - 9 c3 c0 and C = c1^2 + 3 c2 c0. Degree 28.

#include <cstddef>

#include <abut/arithmetic/arena_int.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

/// The sign of x y^(1/2) + z w^(1/2), where y and w are positive.
ABUT_NOINLINE ABUT_HD constexpr int sign_of_roots(const arena_int& x, const arena_int& y, const arena_int& z,
                                                  const arena_int& w) {
    const int first = sign(x), second = sign(z);
    if (first * second >= 0) return first != 0 ? first : second;
    const arena_scope scope(*x.in);
    return first * sign(arena_sum(square(x), y).add(square(z), w, true));
}

/// Whether c^(1/2) <= a^(1/2) + b^(1/2), of numbers that are not negative.
ABUT_NOINLINE ABUT_HD constexpr bool roots_reach(const arena_int& a, const arena_int& b, const arena_int& c) {
    const arena_scope scope(*a.in);
    const arena_int over = arena_sum(c).add(a, true).add(b, true);
    return sign(over) <= 0 || sign(arena_sum(over, over).add_times(-4, a, b)) <= 0;
}

/// - c3 y^3 + c2 y^2 + c1 y - c0, where c3 > 0 and c0 >= 0, or it is not positive far off.
struct cubic_of_disc {
    arena_int c3, c2, c1, c0;

    /// 1 if it is positive for a y > 0, 0 if it only is 0 there, and else -1. One as above: where c3 is 0, it is positive
    /// only if c2 > 0.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int sign_of_greatest() const {
        const bool rises = sign(c2) > 0, starts = sign(c1) > 0;
        if (!rises && !starts) return -1;
        const arena_scope scope(*c0.in);
        if (sign(c0) == 0) return starts || sign(c3) == 0 ? 1 : sign(arena_sum(c2, c2).add_times(4, c3, c1));
        const arena_int a = arena_sum(c2, c2).add_times(3, c3, c1), b = arena_sum(c2, c1).add_times(-9, c3, c0),
                        c = arena_sum(c1, c1).add_times(3, c2, c0);
        return sign(arena_sum(a, c).add_times(3, a, c).add(b, b, true));
    }
};

/// The end of a cylinder at which its axis starts or ends, and what is known there of the disc of another one.
enum class axis_end : int { first = -1, last = 1 };
enum class disc_at_end { meets, beyond, between };

/// A disc and a cylinder, by the numbers above.
struct disc_and_cylinder {
    arena_int uu, vv, w, m, n, ee, disc_rr, rr;
    arena_int across;  ///< X
    arena_int last;    ///< g at the last end

    /// Of a disc orthogonal to u, whose centre is seen from the first end of a cylinder along v.
    ABUT_NOINLINE ABUT_HD constexpr void set(const vec3<arena_int>& x, const vec3<arena_int>& u, const vec3<arena_int>& v,
                                             const arena_int& disc_radius, const arena_int& radius) {
        const auto e = cross(u, v), xv = cross(x, v);
        uu = dot(u, u), vv = dot(v, v), w = dot(u, v), last = dot(x, v);
        m = dot(x, e), n = dot(xv, e), across = dot(xv, xv), ee = dot(e, e);
        disc_rr = square(disc_radius), rr = square(radius);
    }

    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool meet() const {
        const arena_scope scope(*ee.in);
        const bool is_parallel = sign(ee) == 0;
        if (is_parallel && (sign(last) < 0 || sign(vv - last) < 0)) return false;
        if (is_parallel) return roots_reach(disc_rr * vv, rr * vv, across);
        const disc_at_end at_last = at(last, axis_end::last);
        if (at_last != disc_at_end::between) return at_last == disc_at_end::meets;
        const disc_at_end at_first = at(last - vv, axis_end::first);
        return at_first == disc_at_end::between ? !is_apart_from_endless() : at_first == disc_at_end::meets;
    }

    /// Whether they meet in the plane of the end at g, or else whether they may meet on the side of the other end.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr disc_at_end at(const arena_int& g, axis_end end) const {
        const arena_scope scope(*g.in);
        const arena_int k = k_at(g), s = s_at(g), t = t_at(k);
        const int sign_s = sign(s), sign_t = sign(t), sign_w = sign(w), outward = static_cast<int>(end);
        if (sign_s >= 0 && sign_t >= 0 && overlap(s, t)) return disc_at_end::meets;
        if (sign_s <= 0 && sign(g) * outward <= 0) return disc_at_end::beyond;
        if (sign_w == 0 ? sign_t < 0 : sign_t <= 0 && sign(k) * sign_w * outward <= 0) return disc_at_end::beyond;
        if (sign_s <= 0 || (sign_t <= 0 && sign_w != 0)) return disc_at_end::between;
        const int falls = sign_w == 0 ? sign(g) : sign_of_fall(g, k, s, t);
        return falls * outward > 0 ? disc_at_end::between : disc_at_end::beyond;
    }

    /// Whether the disc and the endless cylinder have no point in common.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool is_apart_from_endless() const {
        const arena_scope scope(*ee.in);
        return cubic().sign_of_greatest() > 0;
    }

    /// N + w g, S, and T by it.
    ///@{
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr arena_int k_at(const arena_int& g) const { return arena_sum(n).add(w, g); }
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr arena_int s_at(const arena_int& g) const {
        return arena_sum(disc_rr, ee).add(uu, square(g), true);
    }
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr arena_int t_at(const arena_int& k) const {
        return arena_sum(rr * vv, ee).add(k, k, true);
    }
    ///@}

    /// Whether |M| <= S^(1/2) + (T / V)^(1/2).
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool overlap(const arena_int& s, const arena_int& t) const {
        return roots_reach(vv * s, t, vv * square(m));
    }

private:
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr cubic_of_disc cubic() const {
        const arena_int uv = uu * vv, ww = square(w), both = uv + ww, v = rr * vv;
        return {disc_rr * uu, arena_sum(uu, across).add(disc_rr, both, true).add(rr, uv, true),
                arena_sum(ww, across).add(n, n).add(disc_rr * vv, ww, true).add(v, both, true), v * (vv * ww)};
    }

    /// The sign of U g / S^(1/2) + w k / (V T)^(1/2): of how fast the sum of both roots falls.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int sign_of_fall(const arena_int& g, const arena_int& k,
                                                                   const arena_int& s, const arena_int& t) const {
        return sign_of_roots(uu * g, vv * t, w * k, s);
    }
};

/// The ends of the first axis and of the second, and both radii.
struct cylinders_meet {
    static constexpr int most_limbs = 220;

    ABUT_HD static constexpr bool holds(const arena_int (&value)[14]) {
        const verdict at_sides = sides_meet(value);
        if (at_sides != verdict::unknown) return at_sides == verdict::yes;
        ABUT_ROLLED
        for (int k = 0; k < 4; ++k) {
            if (disc_meets(value, k)) return true;
        }
        return false;
    }

private:
    /// Whether they meet where their axes are nearest, or not at all; or else unknown.
    ABUT_NOINLINE ABUT_HD static constexpr verdict sides_meet(const arena_int (&value)[14]) {
        const arena_scope scope(*value[0].in);
        const auto b = point_at(value, 2), u = point_at(value, 1) - point_at(value, 0), v = point_at(value, 3) - b,
                   x = point_at(value, 0) - b;
        const vec3<arena_int> e = cross(u, v);
        const arena_int ee = dot(e, e), reach = value[12] + value[13];
        if (sign(ee) == 0) return to_verdict(parallel_meet(x, point_at(value, 1) - b, v, reach));
        const arena_int apart = dot(x, e);
        if (sign(arena_sum(apart, apart).add(square(reach), ee, true)) > 0) return verdict::no;
        const auto at_first = dot(cross(x, v), e), at_second = dot(cross(x, u), e);
        const bool between =
            sign(at_first) <= 0 && sign(at_first + ee) >= 0 && sign(at_second) <= 0 && sign(at_second + ee) >= 0;
        return between ? verdict::yes : verdict::unknown;
    }

    /// The ends of one axis as seen from the first end of the other, along v.
    ABUT_NOINLINE ABUT_HD static constexpr bool parallel_meet(const vec3<arena_int>& x, const vec3<arena_int>& y,
                                                              const vec3<arena_int>& v, const arena_int& reach) {
        const auto first = dot(x, v), last = dot(y, v), vv = dot(v, v);
        if (sign(first) < 0 && sign(last) < 0) return false;
        if (sign(first - vv) > 0 && sign(last - vv) > 0) return false;
        return sign(arena_sum(square(cross(x, v))).add(square(reach), vv, true)) <= 0;
    }

    /// The disc at end k of all four, and the other cylinder.
    ABUT_NOINLINE ABUT_HD static constexpr bool disc_meets(const arena_int (&value)[14], int k) {
        const arena_scope scope(*value[0].in);
        const int own = k < 2 ? 0 : 1, other = 1 - own;
        const vec3<arena_int> from = point_at(value, 2 * other);
        disc_and_cylinder d{};
        d.set(point_at(value, k) - from, point_at(value, 2 * own + 1) - point_at(value, 2 * own),
              point_at(value, 2 * other + 1) - from, value[12 + own], value[12 + other]);
        return d.meet();
    }
};

}  // namespace abut::detail
