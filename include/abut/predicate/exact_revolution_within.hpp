// SPDX-License-Identifier: MIT
#pragma once

// Is an edge or a face within a distance R of a cylinder or a cone? Decided by signs of polynomials in integers of an arena,
// with the names of exact_revolution.hpp. Not for corners alone: those are balls, and are asked there.
//
// An edge, a + te as seen from the first end, whose ends are farther away than R, and which does not touch the solid. The
// distance is convex along it. So if it comes within R, it is least strictly inside, and the nearest point there is on one of
//   a cylinder's side   then it meets the cylinder of radius r + R about the same axis, all of which is within R.
//   a disc              then the distance is as long on both sides, up to the rim or to an end of the edge.
//   a rim               then it meets the torus about it, all of which is within R. See below.
//   the apex            then its foot is strictly inside, and |a x e| <= R |e|.
//   a cone's side       then it is least there of the distance from the line on the side. See below.
//
// The torus. With v as seen from the rim's centre and L = |v|^2 + r^2 - R^2, a point is in it if L^2 D <= 4 r^2 |v x d|^2,
// or if L < 0, where it is as near to all of the rim; on the way there from outside the former holds too. So the edge meets
// it if and only if the quartic L^2 D - 4 r^2 |v x d|^2 of t, which is positive at both ends, has a root between. With t =
// x / (1 + x) that is one of x > 0. Roots are counted by Sturm's chain as L. Gonzalez-Vega, H. Lombardi, T. Recio and M.-F.
// Roy have it for all that vanishes in it (Sturm-Habicht sequence, 1989): of a x^4 + 4b x^3 + 2c x^2 + 4d x + e after the
// first two
//     h2 x^2 + h1 x + h0      h2 = 3b^2 - ac,  h1 = bc - 3ad,  h0 = bd - ae
//     - k1 x - k0             k1 = h2 (c h2 - a h0 - 3b h1) + a h1^2,  k0 = h2 (d h2 - 3b h0) + a h1 h0
//     I^3 - J^2               I = 3ae - 12bd + c^2,  J = 9ace + 18bcd - 27ad^2 - 27b^2 e - c^3
// Degree 36. First the quartic is split at a power of two or at a few, where by their lengths a term that is negative counts
// most: it has a root if it is not positive there, and none where no coefficient of a part is negative, each in the basis of
// Bernstein. That is of degree 6 still. Edges that nearly touch the torus are left, and few others.
//
// A cone's side. Let A = |e x d|^2, B = (a x d).(e x d), P = D A - r^2 (e.d)^2, V = |d.(a x e)|, and
// W = (e.d) B - (a.d) A. The way from the line on the side, |w x d| D^(1/2) - r w.d over (D (D + r^2))^(1/2), is least at t
// with A t + B = r (e.d) V (D / P)^(1/2), if P > 0, or else nowhere inside. There it is
// (V (D P)^(1/2) + r W) / A over that, and the foot, as a height along the side times its length,
// (r V |e|^2 D (D / P)^(1/2) - W) / A, between 0 and D + r^2. Degree 28.
//
// A face, none of whose edges comes within R, and which does not touch the solid. If it comes within R, the least way is
// along its normal n, from a point of the solid that is farthest towards it: it is on a rim or the apex, or a whole disc or
// line on the side is as far, all of which is over the face, since none is over an edge. So the ends tell: of the first or
// last centre c, at a height h over the face, the point c -+ r m / |m| with m = D n - (n.d) d, or c where m is 0, has its
// foot in the face and |h| |d| between r |n x d| and that and R |n| |d|. Degree 16.

#include <abut/arithmetic/arena_int.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/exact_cylinders.hpp>
#include <abut/predicate/exact_revolution.hpp>

namespace abut::detail {

ABUT_HD constexpr arena_int negated(const arena_int& a) { return arena_sum(*a.in, a.count).add(a, true); }

/// The sign of x y^(1/2) + z, where y is positive.
ABUT_NOINLINE ABUT_HD constexpr int sign_of_root(const arena_int& x, const arena_int& y, const arena_int& z) {
    const int first = sign(x), second = sign(z);
    if (first * second >= 0) return first != 0 ? first : second;
    const arena_scope scope(*x.in);
    return first * sign(arena_sum(square(x), y).add(z, z, true));
}

/// Signs of a chain of polynomials at a place, without those that are 0 everywhere.
struct chain_of_signs {
    int at[5]{}, count = 0;

    ABUT_HD constexpr void append(int s) { at[count++] = s; }
    /// How often they change. Two zeros between equal signs stand for two changes.
    [[nodiscard]] ABUT_HD constexpr int changes() const {
        int found = 0, last = at[0], zeros = 0;
        for (int i = 1; i < count; ++i) {
            if (at[i] == 0) {
                ++zeros;
                continue;
            }
            found += at[i] != last ? 1 : zeros == 2 ? 2 : 0;
            last = at[i], zeros = 0;
        }
        return found;
    }
};

/// a x^4 + 4b x^3 + 2c x^2 + 4d x + e, where a and e are positive.
struct quartic {
    arena_int a, b, c, d, e;

    /// At any x > 0.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool has_root() const {
        if (sign(b) >= 0 && sign(c) >= 0 && sign(d) >= 0) return false;
        const verdict seen = split();
        if (seen != verdict::unknown) return seen == verdict::yes;
        const arena_scope scope(*a.in);
        chain_of_signs at_0, far_off;
        const auto append = [&](int first, int last) {
            at_0.append(first);
            far_off.append(last);
        };
        append(1, 1);
        append(sign(d), 1);
        const arena_int h2 = arena_sum(b, b).add_times(2, b, b).add(a, c, true),
                        h1 = arena_sum(b, c).add_times(-3, a, d), h0 = arena_sum(b, d).add(a, e, true);
        const int high = sign(h2) != 0 ? sign(h2) : sign(h1) != 0 ? sign(h1) : sign(h0);
        if (high != 0) append(sign(h0), high);
        const int sign_k1 = sign(arena_sum(h2, arena_sum(c, h2).add_times(-3, b, h1).add(a, h0, true)).add(a, h1 * h1)),
                  sign_k0 = sign(arena_sum(h2, arena_sum(d, h2).add_times(-3, b, h0)).add(a, h1 * h0));
        if (sign_k1 != 0 || sign_k0 != 0) append(-sign_k0, -(sign_k1 != 0 ? sign_k1 : sign_k0));
        const int last = sign_of_discriminant();
        if (last != 0) append(last, last);
        return at_0.changes() > far_off.changes();
    }

private:
    /// Whether it has one, as far as a few places tell.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr verdict split() const {
        const arena_int* const term[5] = {&e, &d, &c, &b, &a};
        const int digits[5] = {digits_of(e), digits_of(d), digits_of(c), digits_of(b), digits_of(a)};
        int none_below = -largest_place, none_above = largest_place;  // powers of two
        ABUT_ROLLED
        for (int i = 1; i < 4; ++i) {
            if (sign(*term[i]) >= 0) continue;
            int from = -largest_place, to = largest_place;  // where that term counts most
            ABUT_ROLLED
            for (int j = 0; j < 5; ++j) {
                if (j < i) from = greatest(from, (digits[j] - digits[i]) / (i - j));
                if (j > i) to = least(to, (digits[i] - digits[j]) / (j - i));
            }
            const int place = (from + to) / 2;
            bool below = true, above = true;
            if (is_positive_at(place, below, above) == verdict::no) return verdict::yes;
            if (below) none_below = greatest(none_below, place);
            if (above) none_above = least(none_above, place);
            if (none_above <= none_below) return verdict::no;
        }
        return verdict::unknown;
    }
    /// At 2^place; and whether no coefficient is negative of the part below, and of that above.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr verdict is_positive_at(int place, bool& below, bool& above) const {
        limb_arena& in = *a.in;
        const arena_scope scope(in);
        const int far = place < 0 ? -place : place, count = a.count + far / 16 + 2, most = far / 16 + 2;
        below = above = false;
        if (far >= largest_place || 5 * count + most > in.room - in.used) return verdict::unknown;
        arena_sum p[5] = {arena_sum(in, count), arena_sum(in, count), arena_sum(in, count), arena_sum(in, count),
                          arena_sum(in, count)};
        const arena_int* const term[5] = {&e, &d, &c, &b, &a};
        ABUT_ROLLED
        for (int i = 0; i < 5; ++i) {
            const arena_scope of_factor(in);
            arena_sum factor(in, most);
            factor.add_shifted(i == 2 ? 1 : 3, place < 0 ? far * (4 - i) : far * i);
            p[i].add(*term[i], factor);
        }
        below = above = true;
        ABUT_ROLLED
        for (int last = 3; last >= 0; --last) {  // by P. de Casteljau's scheme
            ABUT_ROLLED
            for (int i = 0; i <= last; ++i) p[i].add(p[i + 1]);
            below = below && sign(p[0]) >= 0;
        }
        ABUT_ROLLED
        for (int i = 0; i < 4; ++i) above = above && sign(p[i]) >= 0;
        return to_verdict(sign(p[0]) > 0);
    }
    static constexpr int largest_place = 1 << 14;

    /// Of the magnitude, but for one.
    ABUT_HD static constexpr int digits_of(const arena_int& x) {
        const std::uint64_t fill = mask_if(sign(x) < 0);
        int i = x.count - 1, bits = 0;
        while (i > 0 && x.limb[i] == fill) --i;
        for (std::uint64_t top = x.limb[i] ^ fill; top != 0; top >>= 1) ++bits;
        return 64 * i + bits;
    }
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int sign_of_discriminant() const {
        const arena_scope scope(*a.in);
        const arena_int ae = a * e, bd = b * d, i = arena_sum(c, c).add_times(3, a, e).add_times(-12, b, d),
                        dd = square(d), bb = square(b);
        const arena_int j = arena_sum(*a.in, a.count + ae.count)
                                .add_times(9, c, ae)
                                .add_times(18, c, bd)
                                .add_times(-27, a, dd)
                                .add_times(-27, e, bb)
                                .add(c, square(c), true);
        return sign(arena_sum(square(i), i).add(j, j, true));
    }
};

/// Whether an edge, from p to q as seen from the centre of a rim, meets the torus of radius `reach` about it, if its ends do
/// not.
ABUT_NOINLINE ABUT_HD constexpr bool meets_torus(const vec3<arena_int>& p, const vec3<arena_int>& q, const vec3<arena_int>& d,
                                                 const arena_int& r, const arena_int& reach) {
    const arena_scope scope(*r.in);
    const arena_int dd = square(d), rr = square(r), off = rr - square(reach);
    const arena_int l0 = dot(p, p) + off, l1 = dot(p, q) + off, l2 = dot(q, q) + off;
    const vec3<arena_int> pd = cross(p, d), qd = cross(q, d);
    const arena_int m0 = dot(pd, pd), m1 = dot(pd, qd), m2 = dot(qd, qd);
    const arena_int l00 = l0 * l0, l01 = l0 * l1, l12 = l1 * l2, l22 = l2 * l2;
    const arena_int middle = arena_sum(l0, l2).add_times(2, l1, l1), m = m0 + m2;
    const arena_int four = (rr + rr) + (rr + rr), two = rr + rr;
    return quartic{arena_sum(dd, l22).add(four, m2, true), arena_sum(dd, l12).add(two, m1 + m2, true),
                   arena_sum(dd, middle).add(two, m, true).add_times(-2, four, m1),
                   arena_sum(dd, l01).add(two, m0 + m1, true), arena_sum(dd, l00).add(four, m0, true)}
        .has_root();
}

/// Whether an edge, as seen from the apex, is nearest to a cone's side strictly inside of both, and within `reach` of it.
ABUT_NOINLINE ABUT_HD constexpr bool is_near_side(const vec3<arena_int>& a, const vec3<arena_int>& e,
                                                  const vec3<arena_int>& d, const arena_int& r, const arena_int& reach) {
    const arena_scope scope(*r.in);
    const vec3<arena_int> ad = cross(a, d), ed = cross(e, d);
    const arena_int dd = dot(d, d), rise = dot(e, d), across = dot(ed, ed), along = r * rise;
    const arena_int p = arena_sum(dd, across).add(along, along, true);
    if (sign(p) <= 0) return false;
    const arena_int signed_volume = dot(d, cross(a, e)),
                    volume = sign(signed_volume) < 0 ? negated(signed_volume) : signed_volume;
    // Between the ends.
    const arena_int from = dot(ad, ed), turn = along * volume;
    if (sign_of_roots(turn, dd, negated(from), p) <= 0) return false;
    if (sign_of_roots(turn, dd, negated(from + across), p) >= 0) return false;
    // With a foot on the side.
    const arena_int w = arena_sum(rise, from).add(dot(a, d), across, true), slant = dd + r * r,
                    high = (r * volume) * (dot(e, e) * dd);
    if (sign_of_roots(high, dd, negated(w), p) < 0) return false;
    if (sign_of_roots(arena_sum(across, slant).add(w), p, negated(high), dd) < 0) return false;
    // x + y is between 0 and z, of which x and z are roots.
    const arena_int y = r * w, yy = y * y, xx = square(volume) * (dd * p), zz = square(reach * across) * (dd * slant);
    const int sign_y = sign(y);
    if (sign_y < 0 && sign(xx - yy) < 0) return false;
    if (sign_y > 0 && sign(zz - yy) < 0) return false;
    const arena_int rest = arena_sum(zz).add(yy).add(xx, true);  // 2 y z is no more than that
    const int sign_rest = sign(rest);
    if (sign_y <= 0 && sign_rest >= 0) return true;
    if (sign_y >= 0 && sign_rest < 0) return false;
    return sign(arena_sum(yy, zz).add_times(3, yy, zz).add(rest, rest, true)) * sign_y <= 0;
}

/// The axis's ends, those of an edge, the solid's radius, that around the edge, and the distance: whether the edge, if it does
/// not touch the solid, is within the sum of both.
template <class Solid>
struct revolution_within_of_edge {
    static constexpr int most_limbs = 580;

    ABUT_HD static constexpr bool holds(const arena_int (&value)[15]) {
        const arena_scope scope(*value[0].in);
        const vec3<arena_int> first = point_at(value, 0), last = point_at(value, 1), from = point_at(value, 2),
                              to = point_at(value, 3), d = last - first, e = to - from;
        const arena_int &r = value[12], reach = value[13] + value[14];
        const vec3<arena_int> a = from - first, b = to - first, p = from - last, q = to - last;
        if (has_end(first, last, from, r, reach) || has_end(first, last, to, r, reach)) return true;
        if constexpr (Solid::is_cone) {
            if (passes_apex(a, b, e, reach) || is_near_side(a, e, d, r, reach)) return true;
        } else {
            if (meets_wider(a, b, p, q, e, d, r + reach) || meets_torus(a, b, d, r, reach)) return true;
        }
        return meets_torus(p, q, d, r, reach);
    }

private:
    using point = vec3<arena_int>;

    ABUT_NOINLINE ABUT_HD static constexpr bool has_end(const point& first, const point& last, const point& end,
                                                        const arena_int& r, const arena_int& reach) {
        const arena_scope scope(*r.in);
        return revolution_meets_ball<Solid>::is_near(first, last, end, r, reach) == verdict::yes;
    }
    ABUT_NOINLINE ABUT_HD static constexpr bool meets_wider(const point& a, const point& b, const point& p, const point& q,
                                                            const point& e, const point& d, const arena_int& r) {
        const arena_scope scope(*r.in);
        return meets_inside_of_segment<Solid>(a, b, p, q, e, d, r) == verdict::yes;
    }
    ABUT_NOINLINE ABUT_HD static constexpr bool passes_apex(const point& a, const point& b, const point& e,
                                                            const arena_int& reach) {
        const arena_scope scope(*reach.in);
        return sign(dot(a, e)) < 0 && sign(dot(b, e)) > 0 &&
               is_no_longer(cross(a, e), scale(reach, e)) == verdict::yes;
    }
};

/// The axis's ends, a face's corners, and the radii and the distance as above: whether the inside of the face, if it does not
/// touch the solid, and no edge is so near, is within the sum of both.
template <class Solid>
struct revolution_within_of_face {
    static constexpr int most_limbs = 580;

    ABUT_HD static constexpr bool holds(const arena_int (&value)[18]) {
        const arena_scope scope(*value[0].in);
        const vec3<arena_int> first = point_at(value, 0), last = point_at(value, 1);
        face_over_disc over{{point_at(value, 2), point_at(value, 3), point_at(value, 4)}, last - first, value[15],
                            value[16] + value[17]};
        return over.is_near(last, true) || over.is_near(first, !Solid::is_cone);
    }

private:
    struct face_over_disc {
        vec3<arena_int> corner[3], d;
        arena_int r, reach;

        /// The end at a centre, which has a rim or is an apex.
        [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool is_near(const vec3<arena_int>& center, bool has_rim) const {
            const arena_scope scope(*r.in);
            const vec3<arena_int> n = cross(corner[1] - corner[0], corner[2] - corner[0]), across = cross(n, d);
            const arena_int nn = square(n), dd = square(d), cc = square(across), h = dot(n, center - corner[0]);
            if (sign(nn) == 0) return false;
            const arena_int height = dd * square(h), gap = square(reach) * (nn * dd);
            const bool is_tilted = has_rim && sign(cc) > 0;
            if (is_tilted) {
                const arena_int rim = square(r) * cc;
                if (sign(height - rim) < 0 || !roots_reach(rim, gap, height)) return false;
            } else if (sign(gap - height) < 0) {
                return false;
            }
            const arena_int root = dd * cc, lean = r * dot(n, d);
            ABUT_ROLLED
            for (int i = 0; i < 3; ++i) {
                const arena_scope of_edge(*r.in);
                const vec3<arena_int> inward = cross(n, corner[i == 2 ? 0 : i + 1] - corner[i]);
                const arena_int at = dot(inward, center - corner[i]);
                if (!is_tilted) {
                    if (sign(at) < 0) return false;
                    continue;
                }
                const arena_int turn = lean * dot(inward, d);
                if (sign_of_root(at, root, sign(h) < 0 ? negated(turn) : turn) < 0) return false;
            }
            return true;
        }
    };
};

}  // namespace abut::detail
