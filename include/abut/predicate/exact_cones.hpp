// SPDX-License-Identifier: MIT
#pragma once

// Do a cone and another one, or a cylinder, have a point in common? Decided by signs of polynomials in integers of an
// arena. Axes have a length and radii are above 0. The disc of an end and a cylinder are those of
// exact_cylinders.hpp, with its names.
//
// They have a point in common if and only if
//   an apex is in the other solid,
//   the disc of an end meets the other solid,
//   or one of a few generators, which are lines on a side from end to end, meets the other solid.
//
// Generators. A nappe is a cone without its base, which goes on. If no apex and no disc has a point of both, what both
// solids have in common meets no end. So it is all that both nappes, or endless cylinders, have in common, and that is
// bounded. Let planes turn about the line through both apexes; the apex of a cylinder is far off along its axis. Some of
// these planes meet what is common to both. They all meet both nappes, in two wedges between rays. As long as planes meet
// both nappes, the rays of one wedge all meet those of the other, since none can become parallel to one of the other's: a
// common direction would not be bounded. So in the last plane that meets both nappes wedges meet, and one of them is a
// generator along which the plane touches a nappe: it meets the other nappe, where both solids are.
//
// From an apex along a, with H = |a|^2 and a radius r, planes along d touch a nappe along G where, with f = a x d, F = |f|^2
// and s = a . d,
//     G = H F a + r^2 s (f x a) +- r (H (H F - r^2 s^2))^(1/2) f,
// which is H F times the way from the apex to the rim. For a cylinder from b along u with a radius r, and planes through b +
// d, generators are along u from b + g with, of U = |u|^2, f = u x d and F as above,
//     F g = r^2 (f x u) +- r (F - r^2 U)^(1/2) f.
// No plane touches where what is under the root is negative. Where it is 0 the other apex, or axis, lies on the side, or on
// that of the opposite nappe: then what is in common is not bounded.
//
// A generator meets the other solid at a point inside of both, where it is deepest: as meets_inside_of_segment in
// exact_revolution.hpp says, here of numbers x + y D^(1/2) of one D. Degree 40.
//
// A disc and a cone with its apex at a, along v. With L = x . v points of the disc's plane are in the cone if and only if
//     V^2 (M + s)^2 <= T,  T = r^2 E (L - g)^2 - V (N + w g)^2,  and L - V <= g <= L.
// In the plane of the base it is the same question as of the cylinder around the cone. On which side of it a point of both
// is, the slope of S^(1/2) + T^(1/2) / V tells, which is concave where L >= g. With k = r^2 E - V w^2 the section of the
// double cone is an ellipse (k < 0), a parabola (k = 0) or a hyperbola (k > 0); and if N + w L = 0 its plane holds the apex.
//
// The double cone. By the S-lemma the disc and it are apart if and only if S - s^2 + y (T - V^2 (M + s)^2), as a quadratic
// form of g, s and 1, is negative everywhere for a y > 0. Its determinant is E times C0 + C1 y + C2 y^2 + C3 y^3 with
//     C0 = U R^2,  C3 = r^2 V^3 (N + w L)^2,
//     C1 = U (r^2 L^2 - V X) + R^2 (U V^2 + V w^2 - r^2 E),
//     C2 = V (k X + r^2 L^2 (U V + w^2) + 2 r^2 w L N - V N^2 - V k R^2).
// C0 and C3 are not negative, so two positive roots or none. The form's part of s and g is negative definite where y k < U.
// So where the determinant is negative, the form is negative definite if y k < U, and else it is so on a line alone; at y =
// U / k the determinant is not negative. If it is negative nowhere for y > 0, the disc meets one nappe. If it is negative
// between two roots below U / k, or k <= 0, the disc meets none; and if they are above, both. A double root below is one
// nappe, touched from outside, and above it is both.
//
// Which one, if it is one. An ellipse and a parabola lie on one nappe. Of a hyperbola it is the nappe on whose side of the
// mirror line the disc's centre is: a point of the other branch, seen in that mirror, is nearer to the centre. So if the
// centre is on the cone's side, the disc meets the cone's nappe if it meets one; or else if it meets both.
// Degree 40.

#include <abut/arithmetic/arena_int.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/exact_cylinders.hpp>

namespace abut::detail {

/// A disc and a cone, of which the base is the last end. The cylinder has its axis and the radius of its base.
struct disc_and_cone {
    disc_and_cylinder around;

    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool meet() const {
        if (sign(around.ee) == 0) return meet_in_parallel();
        const disc_at_end base = at_base();
        return base == disc_at_end::between ? meets_nappe() : base == disc_at_end::meets;
    }

private:
    [[nodiscard]] ABUT_HD constexpr const arena_int& apex() const { return around.last; }  ///< g there

    /// The disc at its height, in which it is parallel to the base.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool meet_in_parallel() const {
        const arena_scope scope(*around.vv.in);
        if (sign(apex()) < 0 || sign(around.vv - apex()) < 0) return false;
        // |x x v| V^(1/2) <= R V + r L
        return roots_reach(around.disc_rr * square(around.vv), around.rr * square(apex()), around.vv * around.across);
    }

    /// r^2 E - V w^2
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr arena_int k() const {
        return arena_sum(around.rr, around.ee).add(around.vv, square(around.w), true);
    }

    /// Whether they meet in the plane of the base, or may meet on the apex's side of it.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr disc_at_end at_base() const {
        const arena_scope scope(*around.vv.in);
        const arena_int g = apex() - around.vv, across = around.k_at(g), s = around.s_at(g), t = around.t_at(across);
        const int sign_s = sign(s), sign_t = sign(t);
        if (sign_s >= 0 && sign_t >= 0 && around.overlap(s, t)) return disc_at_end::meets;
        if (sign_s <= 0 && sign(g) >= 0) return disc_at_end::beyond;
        const arena_int narrows = arena_sum(around.rr, around.ee).add(around.w, across);
        if (sign_t <= 0 && (sign(narrows) > 0 || sign(k()) > 0)) return disc_at_end::beyond;
        if (sign_s <= 0 || (sign_t <= 0 && sign(narrows) < 0)) return disc_at_end::between;
        const int falls = sign_of_roots(around.uu * g, around.vv * t, narrows, s);
        return falls < 0 ? disc_at_end::between : disc_at_end::beyond;
    }

    /// Whether the disc, in which the apex is not, meets the nappe.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool meets_nappe() const {
        const arena_scope scope(*around.vv.in);
        const arena_int hyperbola = k(), at_apex = around.k_at(apex());
        const cubic_of_disc f = cubic(hyperbola, at_apex);
        const int sign_k = sign(hyperbola), greatest = f.sign_of_greatest();
        if (sign_k < 0) return sign(around.w) * sign(at_apex) > 0 && greatest <= 0;
        const int side = sign_k == 0 && sign(at_apex) == 0 ? sign(apex()) : sign_of_side();
        if (sign_k == 0) return side > 0 && greatest <= 0;
        const bool meets_both_or_none = greatest > 0 || (greatest == 0 && side < 0);
        return meets_both_or_none ? !are_below(f, hyperbola) : side >= 0;
    }

    /// The sign of r^2 E L + V w N: of the centre's side of the mirror line.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int sign_of_side() const {
        const arena_scope scope(*around.vv.in);
        return sign(arena_sum(around.rr * around.ee, apex()).add(around.vv * around.w, around.n));
    }

    /// In 1 / y: c3 = C0, c2 = - C1, c1 = - C2 and c0 = C3.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr cubic_of_disc cubic(const arena_int& hyperbola,
                                                                      const arena_int& at_apex) const {
        const arena_int &u = around.uu, &v = around.vv, &w = around.w, &disc = around.disc_rr, &r = around.rr;
        const arena_int uv = u * v, ww = square(w), rll = r * square(apex());
        const arena_int x = arena_sum(v, around.across).add(rll, true),
                        y = arena_sum(v, uv).add(v, ww).add(r, around.ee, true);
        const arena_int z = arena_sum(v * disc, hyperbola)
                                .add(v, square(around.n))
                                .add(hyperbola, around.across, true)
                                .add(rll, uv + ww, true)
                                .add_times(-2, (r * w) * apex(), around.n);
        return {u * disc, arena_sum(u, x).add(disc, y, true), v * z, (r * v) * square(v * at_apex)};
    }

    /// Whether both positive roots of the cubic, of y, are below U / k: there it rises, and ever faster.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool are_below(const cubic_of_disc& f, const arena_int& hyperbola) const {
        const arena_scope scope(*around.vv.in);
        const arena_int& u = around.uu;
        // C2 k + 3 C3 U, and C1 k^2 + (2 C2 k + 3 C3 U) U
        const arena_int faster = arena_sum(f.c0 * u).add_times(2, f.c0, u).add(f.c1, hyperbola, true),
                        rises = arena_sum(faster).add(f.c1, hyperbola, true);
        return sign(faster) > 0 && sign(arena_sum(rises, u).add(f.c2, square(hyperbola), true)) > 0;
    }
};

/// x + y D^(1/2), where D > 0. Of an integer y has no limbs.
struct with_root {
    arena_int x, y;
    const arena_int* d;

    /// That of a product of both.
    ABUT_HD static constexpr int count_of_root(const with_root& a, const with_root& b) {
        const int first = b.y.count > 0 ? a.x.count + b.y.count : 0, second = a.y.count > 0 ? a.y.count + b.x.count : 0;
        return first > second ? first : second;
    }
};

ABUT_NOINLINE ABUT_HD constexpr int sign(const with_root& a) {
    const int first = sign(a.x), second = sign(a.y);
    if (first * second >= 0) return first != 0 ? first : second;
    const arena_scope scope(*a.x.in);
    return first * sign(arena_sum(a.x, a.x).add(square(a.y), *a.d, true));
}

/// A sum of products of such numbers, with the lengths of the first product: it has a root, if any has.
class sum_with_root {
public:
    ABUT_HD constexpr sum_with_root(const with_root& a, const with_root& b)
        : x_(*a.x.in, a.x.count + b.x.count), y_(*a.x.in, with_root::count_of_root(a, b)), d_(a.d) {
        add(a, b);
    }
    ABUT_NOINLINE ABUT_HD constexpr sum_with_root& add(const with_root& a, const with_root& b, bool negated = false) {
        x_.add(a.x, b.x, negated);
        y_.add(a.x, b.y, negated).add(a.y, b.x, negated);
        const arena_scope scope(*a.x.in);
        x_.add(a.y * b.y, *d_, negated);
        return *this;
    }
    ABUT_HD constexpr operator with_root() const { return {x_, y_, d_}; }

private:
    arena_sum x_, y_;
    const arena_int* d_;
};

ABUT_NOINLINE ABUT_HD constexpr with_root operator*(const with_root& a, const with_root& b) { return sum_with_root(a, b); }
ABUT_NOINLINE ABUT_HD constexpr with_root dot(const vec3<with_root>& a, const vec3<with_root>& b) {
    return sum_with_root(a.x, b.x).add(a.y, b.y).add(a.z, b.z);
}

/// The sign of a b + c d.
ABUT_NOINLINE ABUT_HD constexpr int sign_of_sum(const with_root& a, const with_root& b, const with_root& c,
                                                const with_root& d) {
    const arena_scope scope(*a.x.in);
    return sign(sum_with_root(a, b).add(c, d));
}

/// Points and numbers of one D.
class field_with_root {
public:
    ABUT_HD constexpr explicit field_with_root(const arena_int& d) : d_(d), one_(unit(*d.in)) {}
    field_with_root(const field_with_root&) = delete;
    field_with_root& operator=(const field_with_root&) = delete;

    [[nodiscard]] ABUT_HD constexpr with_root number(const arena_int& a) const { return {a, {nullptr, d_.in, 0}, &d_}; }
    [[nodiscard]] ABUT_HD constexpr with_root one() const { return number(one_); }
    [[nodiscard]] ABUT_HD constexpr vec3<with_root> point(const vec3<arena_int>& p) const {
        return {number(p.x), number(p.y), number(p.z)};
    }
    [[nodiscard]] ABUT_HD constexpr vec3<with_root> point(const vec3<arena_int>& p, const vec3<arena_int>& q) const {
        return {{p.x, q.x, &d_}, {p.y, q.y, &d_}, {p.z, q.z, &d_}};
    }

private:
    ABUT_HD static constexpr arena_int unit(limb_arena& in) {
        arena_sum one(in, 1);
        one.add_shifted(1, 0);
        return one;
    }

    arena_int d_, one_;
};

/// A solid with an axis: a cone from its apex, or a cylinder.
struct solid_in_integers {
    vec3<arena_int> first, last, axis;
    arena_int radius;
};

/// Whether a generator is in a solid where it is deepest. Its points are (p + l e) / scale, as seen from the first end of
/// the solid, of l from 0 to scale / factor. All is said by inner products: `bend`, `back` and `below` are - A, - B and - h
/// of meets_inside_of_segment, or of a cylinder those of the distance from its axis, and `volume` is (m . v)^2.
template <bool IsCone>
ABUT_NOINLINE ABUT_HD constexpr bool line_meets_side(const field_with_root& in, const solid_in_integers& solid,
                                                     const vec3<with_root>& p, const vec3<with_root>& e,
                                                     const with_root& scale, const with_root& factor) {
    const arena_scope scope(*solid.radius.in);
    const vec3<with_root> v = in.point(solid.axis);
    const with_root rr = in.number(square(solid.radius)), vv = in.number(square(solid.axis)), ahead = dot(p, v),
                    along = dot(e, v), pe = dot(p, e), ee = dot(e, e),
                    across2 = sum_with_root(vv, ee).add(along, along, true),
                    moved = sum_with_root(vv, pe).add(ahead, along, true);
    const with_root bend = IsCone ? sum_with_root(vv, across2).add(rr, along * along, true) : across2,
                    back = IsCone ? sum_with_root(vv, moved).add(rr, ahead * along, true) : moved;
    if (sign(bend) <= 0 || sign(back) > 0) return false;
    if (sign_of_sum(factor, back, scale, bend) < 0) return false;
    const with_root below = sum_with_root(pe, along).add(ahead, ee, true);
    if (sign(below) > 0) return false;
    if (sign_of_sum(IsCone ? vv : in.one(), below, scale, bend) < 0) return false;
    const with_root pp = dot(p, p), volume = sum_with_root(pp, across2).add(pe, moved, true).add(ahead, below);
    if (!IsCone) return sign(sum_with_root(rr, across2).add(in.one(), volume, true)) >= 0;
    const with_root m2 = sum_with_root(pp, ee).add(pe, pe, true);
    return sign(sum_with_root(rr * vv, m2).add(rr, volume, true).add(vv, volume, true)) >= 0;
}

/// s v + t w
ABUT_NOINLINE ABUT_HD constexpr vec3<arena_int> sum_of_scaled(const arena_int& s, const vec3<arena_int>& v,
                                                              const arena_int& t, const vec3<arena_int>& w) {
    return {arena_sum(s, v.x).add(t, w.x), arena_sum(s, v.y).add(t, w.y), arena_sum(s, v.z).add(t, w.z)};
}

/// Whether a generator of a cone meets another solid, of those along which planes touch it that hold its apex and the
/// other's, or the direction of the other's axis.
template <bool IsCone>
ABUT_NOINLINE ABUT_HD constexpr bool generators_meet(const solid_in_integers& cone, const solid_in_integers& solid) {
    const arena_scope scope(*cone.radius.in);
    const vec3<arena_int>& a = cone.axis;
    const vec3<arena_int> p = cone.first - solid.first, d = IsCone ? solid.first - cone.first : solid.axis, f = cross(a, d);
    const arena_int hh = dot(a, a), s = dot(a, d), rr = square(cone.radius), factor = hh * dot(f, f);
    const arena_int rest = arena_sum(factor).add(rr, square(s), true);
    if (sign(rest) <= 0) return false;
    const field_with_root in(hh * rest);
    const vec3<arena_int> to = sum_of_scaled(factor, a, rr * s, cross(f, a)), beside = scale(cone.radius, f);
    const vec3<with_root> from = in.point(p);
    const with_root one = in.one(), times = in.number(factor);
    return line_meets_side<IsCone>(in, solid, from, in.point(to, beside), one, times) ||
           line_meets_side<IsCone>(in, solid, from, in.point(to, scale(cone.radius, cross(d, a))), one, times);
}

/// The same of a cylinder, where planes touch it that hold the apex of a cone.
ABUT_NOINLINE ABUT_HD constexpr bool generators_of_cylinder_meet(const solid_in_integers& cylinder,
                                                                 const solid_in_integers& cone) {
    const arena_scope scope(*cone.radius.in);
    const vec3<arena_int>& u = cylinder.axis;
    const vec3<arena_int> d = cone.first - cylinder.first, back = cylinder.first - cone.first, f = cross(u, d);
    const arena_int ff = dot(f, f), rr = square(cylinder.radius), rest = arena_sum(ff).add(rr, dot(u, u), true);
    if (sign(rest) <= 0) return false;
    const field_with_root in(rest);
    const vec3<arena_int> to = sum_of_scaled(ff, back, rr, cross(f, u));
    const vec3<with_root> along = in.point(u);
    const with_root one = in.one(), times = in.number(ff);
    return line_meets_side<true>(in, cone, in.point(to, scale(cylinder.radius, f)), along, times, one) ||
           line_meets_side<true>(in, cone, in.point(to, scale(cylinder.radius, cross(d, u))), along, times, one);
}

/// The apex of a cone, or the first end of a cylinder, and the last end, of both solids, and both radii.
template <bool IsConeA, bool IsConeB>
struct round_solids_meet {
    static_assert(IsConeA || IsConeB);
    static constexpr int most_limbs = 560;

    ABUT_HD static constexpr bool holds(const arena_int (&value)[14]) {
        const solid_in_integers a = solid_of(value, 0), b = solid_of(value, 1);
        return ends_meet<IsConeA, IsConeB>(a, b) || ends_meet<IsConeB, IsConeA>(b, a) ||
               sides_meet<IsConeA, IsConeB>(a, b) || sides_meet<IsConeB, IsConeA>(b, a);
    }

private:
    ABUT_NOINLINE ABUT_HD static constexpr solid_in_integers solid_of(const arena_int (&value)[14], int k) {
        const vec3<arena_int> first = point_at(value, 2 * k), last = point_at(value, 2 * k + 1);
        return {first, last, last - first, value[12 + k]};
    }

    /// Whether the ends of one, discs or an apex, meet the other.
    template <bool IsCone, bool IsOtherCone>
    ABUT_NOINLINE ABUT_HD static constexpr bool ends_meet(const solid_in_integers& from, const solid_in_integers& other) {
        const arena_scope scope(*from.radius.in);
        const vec3<arena_int> x = from.first - other.first;
        if (IsCone ? has_apex<IsOtherCone>(x, other) : disc_meets<IsOtherCone>(x, from, other)) return true;
        return disc_meets<IsOtherCone>(from.last - other.first, from, other);
    }
    template <bool IsCone>
    ABUT_NOINLINE ABUT_HD static constexpr bool has_apex(const vec3<arena_int>& x, const solid_in_integers& other) {
        const arena_scope scope(*other.radius.in);
        const arena_int height = dot(x, other.axis), vv = dot(other.axis, other.axis);
        if (sign(height) < 0 || sign(vv - height) < 0) return false;
        const arena_int aside = square(cross(x, other.axis)), rr = square(other.radius);
        return IsCone ? sign(arena_sum(vv, aside).add(rr, square(height), true)) <= 0
                      : sign(arena_sum(aside).add(rr, vv, true)) <= 0;
    }
    /// The disc about a centre as seen from the first end of the other.
    template <bool IsCone>
    ABUT_NOINLINE ABUT_HD static constexpr bool disc_meets(const vec3<arena_int>& x, const solid_in_integers& from,
                                                           const solid_in_integers& other) {
        const arena_scope scope(*from.radius.in);
        disc_and_cone d{};
        d.around.set(x, from.axis, other.axis, from.radius, other.radius);
        return IsCone ? d.meet() : d.around.meet();
    }

    template <bool IsCone, bool IsOtherCone>
    ABUT_HD static constexpr bool sides_meet(const solid_in_integers& from, const solid_in_integers& other) {
        if constexpr (IsCone) {
            return generators_meet<IsOtherCone>(from, other);
        } else {
            return generators_of_cylinder_meet(from, other);
        }
    }
};

}  // namespace abut::detail
