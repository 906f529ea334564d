// SPDX-License-Identifier: MIT
#pragma once

// What is asked of a solid of revolution, a cylinder or a cone, and points, segments, triangles, boxes, balls and planes:
// signs of polynomials, written once over a number type, exact or an estimate (arithmetic/estimate.hpp). An OR over
// features, in which each yes is backed by a point of both shapes.
//
// The axis goes from the first end, of a cone the apex, along d to the last one; w is a point as seen from the first end,
// s = w . d its height, and D = |d|^2 > 0. In both solids 0 <= s <= D. A cylinder has |w x d|^2 <= r^2 D, and a cone
// |w x d|^2 D <= r^2 s^2. The left side is |(w x d) x d|^2, since w x d is orthogonal to d.
//
// A segment from a along e. What it has between the heights is a shorter one, or none. The distance from the axis is convex
// on it, so it is least at an end, which is an end of the segment or where that passes one of the heights, or at a foot
// strictly inside. For a cone let F(x, y) = r^2 (x.d)(y.d) - ((x x d) x d).((y x d) x d): F(w, w) >= 0 is the double cone.
// F(a + te, a + te) is a quadratic A t^2 + 2 B t + C with A = F(e, e) and B = F(a, e). If A >= 0, it is greatest at an end,
// and an end at height 0 is in the cone only if it is the apex: then the other end is in it too. If A < 0, also at t = -B /
// A may it be, if that is strictly inside. The height there is 0 or more if h = |e|^2 (a.d) - (a.e)(d.e) is, as A (a.d) - B
// (e.d) is F(e, (a.d) e - (e.d) a) = -D^2 h, that vector being orthogonal to d; and it is at most D if A + D h <= 0. The
// value there is not negative if B^2 >= A C, which is D^2 (r^2 |m x d|^2 - D (m.d)^2) with m = a x e: the plane of the apex
// and the segment is no farther from the base's centre than its rim.
//
// A triangle, if its edges do not meet the solid. Then what the solid has of the triangle's plane is connected and does not
// meet the triangle's border: it lies inside, or outside. If it is not empty, any of its points tells. If the plane meets
// the axis, that point does. If it does not, the solid's farthest point from the axis towards the plane is on the rim of an
// end, so that the disc there meets the plane, and the foot of the end on the line in which its own plane is cut is in the
// disc. So it is, being the end itself, if the plane holds the axis. A triangle without area is its edges.
//
// A box, of edges and faces along the axes, in the same way: its corners, its edges, and its faces, of which a foot is seen
// coordinate by coordinate. If none of them meets the solid, the box has all of it or nothing; an end tells.
//
// A ball of radius R: whether its centre is within R of the solid. In the half plane of the axis and the centre the solid is
// a rectangle or a triangle. Its nearest point is the centre's foot on a side, strictly inside of it, or a corner, that is a
// point of a rim; or the centre itself. At height s and |w x d| / |d| from the axis, it is within R of
//   a cylinder's side    if 0 <= s <= D and |w x d|^2 <= (r + R)^2 D, which says so also inside
//   the disc of an end   if (s - its height)^2 <= R^2 D and |w x d|^2 <= r^2 D
//   a rim                if |v|^2 + r^2 - 2 r |v x d| / |d| <= R^2, where v is the centre as seen from that end
//   the apex             if |w|^2 <= R^2
//   a cone's side        if (|w x d| |d| - s r)^2 <= R^2 D (D + r^2), and its foot is strictly inside
// where the latter means 0 < s + r |w x d| / |d| < D + r^2.
// Each has one square root at most: signs are compared, and squares.
//
// A plane: heights over it are linear. If both ends lie strictly on one side, the nearest point to it is on the rim of an
// end, or is the apex; a rim reaches r |n x d| / |d| beyond its centre.
//
// Degree 8 at most; 12 for a cone and a ball, and for a plane within a distance.

#include <cstddef>

#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>
#include <abut/predicate/exact_ball.hpp>

namespace abut::detail {

/// Whether a height over the first end is not negative, and one over the last end not positive.
template <class S>
ABUT_HD constexpr verdict is_between_ends(const S& over_first, const S& over_last) {
    return and_then(is_not_negative(over_first), [&] { return is_not_positive(over_last); });
}

/// Whether two numbers have strictly different signs.
template <class N>
ABUT_HD constexpr verdict are_opposite(const N& a, const N& b) {
    const int s = sign_or_unknown(a), t = sign_or_unknown(b);
    if (s == 0 || t == 0) return verdict::no;
    return s == unknown_sign || t == unknown_sign ? verdict::unknown : to_verdict(s != t);
}

/// Whether the segment from p to q, as seen from the centre of a disc, at heights s and t over it, passes through the disc.
/// Degree 6.
template <class P, class S, class R>
ABUT_HD constexpr verdict passes_disc(const vec3<P>& p, const vec3<P>& q, const S& s, const S& t, const R& r) {
    return and_then(are_opposite(s, t), [&] { return is_no_longer(scale(t, p) - scale(s, q), r * (t - s)); });
}

/// A point w as seen from the first end and v as seen from the last one: degree 4. Inside of segments: degree 6.
struct cylinder_questions {
    static constexpr bool is_cone = false;

    template <class W, class R>
    ABUT_HD static constexpr verdict has_point(const vec3<W>& w, const vec3<W>& v, const vec3<W>& d, const R& r) {
        return and_then(is_between_ends(dot(w, d), dot(v, d)), [&] { return is_no_longer(cross(w, d), scale(r, d)); });
    }

    /// The foot of the axis strictly inside the segment from a to b, along e.
    template <class W, class R>
    ABUT_HD static constexpr verdict has_inside(const vec3<W>& a, const vec3<W>& b, const vec3<W>& e, const vec3<W>& d,
                                                const R& r) {
        const auto g = cross(e, d);
        const auto back = dot(cross(a, d), g);
        return and_then(is_negative(back), [&] {
            return and_then(is_positive(dot(cross(b, d), g)), [&] {
                return and_then(is_no_longer(dot(a, g), scale(r, g)), [&] {
                    const auto gg = dot(g, g);
                    const auto over_first = dot(a, d) * gg - back * dot(e, d);
                    return is_between_ends(over_first, over_first - dot(d, d) * gg);
                });
            });
        });
    }
};

/// Alike: degree 6 and degree 8.
struct cone_questions {
    static constexpr bool is_cone = true;

    template <class W, class R>
    ABUT_HD static constexpr verdict has_point(const vec3<W>& w, const vec3<W>& v, const vec3<W>& d, const R& r) {
        const auto s = dot(w, d);
        return and_then(is_between_ends(s, dot(v, d)), [&] { return is_no_longer(cross(cross(w, d), d), r * s); });
    }

    /// The greatest value of F strictly inside the segment from a to b, along e.
    template <class W, class R>
    ABUT_HD static constexpr verdict has_inside(const vec3<W>& a, const vec3<W>& b, const vec3<W>& e, const vec3<W>& d,
                                                const R& r) {
        const auto s = dot(a, d), rise = dot(e, d);
        const auto across = cross(cross(e, d), d);
        const auto along = r * rise;
        const auto first = along * along - dot(across, across);
        return and_then(is_negative(first), [&] {
            return and_then(is_positive((r * s) * along - dot(cross(cross(a, d), d), across)), [&] {
                return and_then(is_negative((r * dot(b, d)) * along - dot(cross(cross(b, d), d), across)), [&] {
                    const auto h = dot(e, e) * s - dot(a, e) * rise;
                    return and_then(is_not_negative(h), [&] {
                        return and_then(is_not_positive(first + dot(d, d) * h), [&] {
                            const auto m = cross(a, e);
                            return is_no_longer(scale(dot(m, d), d), scale(r, cross(m, d)));
                        });
                    });
                });
            });
        });
    }
};

/// A segment but for its ends: from a to b as seen from the first end, from p to q as seen from the last one.
template <class Solid, class W, class R>
ABUT_HD constexpr verdict meets_inside_of_segment(const vec3<W>& a, const vec3<W>& b, const vec3<W>& p, const vec3<W>& q,
                                                  const vec3<W>& e, const vec3<W>& d, const R& r) {
    verdict v = passes_disc(p, q, dot(p, d), dot(q, d), r);
    if constexpr (!Solid::is_cone) v = or_else(v, [&] { return passes_disc(a, b, dot(a, d), dot(b, d), r); });
    return or_else(v, [&] { return Solid::has_inside(a, b, e, d, r); });
}

/// Whether the axis meets the face, where it is not along it: degree 3. Corners as seen from the first end, and one from the
/// last.
template <class W, class N>
ABUT_HD constexpr verdict axis_meets_face(const vec3<W> (&a)[3], const vec3<W>& from_last, const vec3<N>& n,
                                          const vec3<W>& d) {
    const int side = sign_or_unknown(dot(n, d));
    if (side == 0) return verdict::no;
    if (side == unknown_sign) return verdict::unknown;
    const auto is_on_side = [side](const auto& x) {
        const int s = sign_or_unknown(x);
        return s == unknown_sign ? verdict::unknown : to_verdict(s * side >= 0);
    };
    const auto is_opposite = [side](const auto& x) {
        const int s = sign_or_unknown(x);
        return s == unknown_sign ? verdict::unknown : to_verdict(s * side <= 0);
    };
    return and_then(is_on_side(dot(n, a[0])), [&] {
        return and_then(is_opposite(dot(n, from_last)), [&] {
            return is_on_side(dot(cross(a[0], a[1]), d)) && is_on_side(dot(cross(a[1], a[2]), d)) &&
                   is_on_side(dot(cross(a[2], a[0]), d));
        });
    });
}

/// Whether the point x is strictly inside the cut through a triangle at height 0, along f, where p is alone on its side: the
/// ends of the cut, on pq and tp, are seen from x's foot on opposite sides. Corners are seen from x, at heights u, v, w.
/// Degree 6.
template <class W, class S, class F>
ABUT_HD constexpr verdict is_inside_cut(const vec3<W>& p, const vec3<W>& q, const vec3<W>& t, const S& u, const S& v,
                                        const S& w, const vec3<F>& f) {
    const int up = sign_or_unknown(u), at_q = sign_or_unknown(v), at_t = sign_or_unknown(w);
    if (up == 0) return verdict::no;
    if (up == unknown_sign || at_q == unknown_sign || at_t == unknown_sign) return verdict::unknown;
    if (at_q == up || at_t == up) return verdict::no;
    // Both are to be divided by differences of heights, the one of sign -up and the other of sign up.
    const int on_pq = sign_or_unknown(dot(f, scale(v, p) - scale(u, q)));
    const int on_tp = sign_or_unknown(dot(f, scale(u, t) - scale(w, p)));
    if (on_pq == 0 || on_tp == 0) return verdict::no;
    return on_pq == unknown_sign || on_tp == unknown_sign ? verdict::unknown : to_verdict(on_pq == on_tp);
}

/// Whether the disc of a base meets the inside of a face: the foot of its centre, from which corners are seen, on the line
/// in which the face cuts the disc's plane. Degree 8.
template <class W, class N, class R>
ABUT_HD constexpr verdict disc_meets_face(const vec3<W> (&p)[3], const vec3<N>& n, const vec3<W>& d, const R& r) {
    const auto f = cross(n, d);
    return and_then(is_no_longer(scale(dot(n, p[0]), d), scale(r, f)), [&] {
        const auto u = dot(p[0], d), v = dot(p[1], d), w = dot(p[2], d);
        const verdict first = is_inside_cut(p[0], p[1], p[2], u, v, w, f);
        return or_else(first, [&] {
            return or_else(is_inside_cut(p[1], p[2], p[0], v, w, u, f),
                           [&] { return is_inside_cut(p[2], p[0], p[1], w, u, v, f); });
        });
    });
}

/// The axis's ends, then the point and the radius.
template <class Solid>
struct revolution_meets_point {
    static constexpr int degree = Solid::is_cone ? 6 : 4;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[10]) {
        const vec3<N> first = point_at(value, 0), last = point_at(value, 1), p = point_at(value, 2);
        return Solid::has_point(p - first, p - last, last - first, value[9]);
    }
};

/// The axis's ends, those of the segment, the radius.
template <class Solid>
struct revolution_meets_segment {
    static constexpr int degree = Solid::is_cone ? 8 : 6;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[13]) {
        const vec3<N> first = point_at(value, 0), last = point_at(value, 1), from = point_at(value, 2),
                      to = point_at(value, 3);
        const N& r = value[12];
        const auto d = last - first, a = from - first, b = to - first, p = from - last, q = to - last;
        return or_else(Solid::has_point(a, p, d, r), [&] {
            return or_else(Solid::has_point(b, q, d, r),
                           [&] { return meets_inside_of_segment<Solid>(a, b, p, q, to - from, d, r); });
        });
    }
};

/// The axis's ends, the triangle's corners, the radius.
template <class Solid>
struct revolution_meets_triangle {
    static constexpr int degree = 8;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[16]) {
        const vec3<N> first = point_at(value, 0), last = point_at(value, 1);
        const vec3<N> corner[3] = {point_at(value, 2), point_at(value, 3), point_at(value, 4)};
        const N& r = value[15];
        using difference = decltype(last - first);
        const difference d = last - first, a[3] = {corner[0] - first, corner[1] - first, corner[2] - first},
                         p[3] = {corner[0] - last, corner[1] - last, corner[2] - last},
                         edge[3] = {corner[1] - corner[0], corner[2] - corner[1], corner[0] - corner[2]};
        if (lies_beyond(a, d) || lies_beyond(p, first - last)) return verdict::no;
        verdict met = verdict::no;
        ABUT_ROLLED
        for (int i = 0; i < 3; ++i) met = or_else(met, [&] { return Solid::has_point(a[i], p[i], d, r); });
        if (met == verdict::yes) return met;
        const auto n = cross(edge[0], edge[1]);
        met = or_else(met, [&] { return axis_meets_face(a, p[0], n, d); });
        ABUT_ROLLED
        for (int i = 0; i < 3; ++i) {
            const int j = i == 2 ? 0 : i + 1;
            met = or_else(met, [&] { return meets_inside_of_segment<Solid>(a[i], a[j], p[i], p[j], edge[i], d, r); });
        }
        met = or_else(met, [&] { return disc_meets_face(p, n, d, r); });
        if constexpr (!Solid::is_cone) met = or_else(met, [&] { return disc_meets_face(a, n, d, r); });
        return met;
    }

private:
    /// All corners are on the far side of an end, as seen from there.
    template <class W>
    ABUT_HD static constexpr bool lies_beyond(const vec3<W> (&a)[3], const vec3<W>& d) {
        return is_negative(dot(a[0], d)) == verdict::yes && is_negative(dot(a[1], d)) == verdict::yes &&
               is_negative(dot(a[2], d)) == verdict::yes;
    }
};

/// The same of a triangle that the axis does not meet, and whose edges do not touch.
template <class Solid>
struct revolution_meets_inside {
    static constexpr int degree = 8;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[16]) {
        const vec3<N> first = point_at(value, 0), last = point_at(value, 1);
        const vec3<N> corner[3] = {point_at(value, 2), point_at(value, 3), point_at(value, 4)};
        using difference = decltype(last - first);
        const difference d = last - first, p[3] = {corner[0] - last, corner[1] - last, corner[2] - last};
        const auto n = cross(corner[1] - corner[0], corner[2] - corner[1]);
        const verdict met = disc_meets_face(p, n, d, value[15]);
        if constexpr (Solid::is_cone) return met;
        return or_else(met, [&] {
            const difference a[3] = {corner[0] - first, corner[1] - first, corner[2] - first};
            return disc_meets_face(a, n, d, value[15]);
        });
    }
};

/// A centre as seen from an end: whether it is within `reach` of the rim there. Degree 6.
template <class W, class R>
ABUT_HD constexpr verdict is_near_rim(const vec3<W>& v, const vec3<W>& d, const R& r, const R& reach) {
    const auto over = (dot(v, v) + r * r) - reach * reach;
    return or_else(is_not_positive(over), [&] { return is_no_longer(scale(over, d), scale(r + r, cross(v, d))); });
}

/// And of the disc, where its foot is in it. Degree 4.
template <class W, class R>
ABUT_HD constexpr verdict is_near_disc(const vec3<W>& v, const vec3<W>& d, const R& r, const R& reach) {
    return and_then(is_no_longer(dot(v, d), scale(reach, d)), [&] { return is_no_longer(cross(v, d), scale(r, d)); });
}

/// And of the apex. Degree 2.
template <class W, class R>
ABUT_HD constexpr verdict is_near_apex(const vec3<W>& w, const R& reach) {
    return is_no_longer(w, reach);
}

/// A centre as seen from a cone's apex: whether it is within `reach` of the side, where its foot is inside. Degree 12.
template <class W, class R>
ABUT_HD constexpr verdict is_near_side_of_cone(const vec3<W>& w, const vec3<W>& d, const R& r, const R& reach) {
    const auto s = dot(w, d), dd = dot(d, d), slant = dd + r * r;
    const auto out = scale(r, cross(w, d));
    const verdict after_apex = or_else(is_positive(s), [&] { return is_longer(out, scale(s, d)); });
    return and_then(after_apex, [&] {
        const auto rest = slant - s;
        const verdict before_rim = and_then(is_positive(rest), [&] { return is_longer(scale(rest, d), out); });
        return and_then(before_rim, [&] {
            const auto across = cross(cross(w, d), d);
            const auto along = r * s;
            const auto most = reach * reach;
            const auto over = (dot(across, across) + along * along) - most * (dd * slant);
            const verdict is_short = is_not_positive(over), is_ahead = is_not_negative(s);
            const auto is_within_product = [&] { return is_no_longer(over, scale(along + along, across)); };
            // Ahead of the apex the product counts for the centre, and behind it against it.
            const verdict ahead = and_then(is_ahead, [&] { return or_else(is_short, is_within_product); });
            return or_else(ahead, [&] {
                return and_then(is_negative(s) && is_short,
                                [&] { return is_no_longer(scale(along + along, across), over); });
            });
        });
    });
}

/// The axis's ends, the ball's centre, both radii.
template <class Solid>
struct revolution_meets_ball {
    static constexpr int degree = Solid::is_cone ? 12 : 6;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[11]) {
        return is_near(point_at(value, 0), point_at(value, 1), point_at(value, 2), value[9], value[10]);
    }

    /// Whether the centre is within `reach` of the solid.
    template <class N>
    ABUT_HD static constexpr verdict is_near(const vec3<N>& first, const vec3<N>& last, const vec3<N>& center, const N& r,
                                             const N& reach) {
        const auto d = last - first, w = center - first, v = center - last;
        verdict met = verdict::no;
        if constexpr (Solid::is_cone) {
            const verdict at_apex = is_near_apex(w, reach);
            met = or_else(at_apex, [&] {
                return or_else(Solid::has_point(w, v, d, r), [&] { return is_near_side_of_cone(w, d, r, reach); });
            });
        } else {
            met = or_else(Solid::has_point(w, v, d, r + reach), [&] {
                return or_else(is_near_disc(w, d, r, reach), [&] { return is_near_rim(w, d, r, reach); });
            });
        }
        return or_else(met,
                       [&] { return or_else(is_near_disc(v, d, r, reach), [&] { return is_near_rim(v, d, r, reach); }); });
    }
};

/// The axis's ends, the ball's centre, both radii, and a distance from the ball: one from its centre that is longer by the
/// ball's radius. That sum, and with the solid's radius, takes two bits at most of those that integers have to spare.
template <class Solid>
struct revolution_within_of_ball {
    static constexpr int degree = revolution_meets_ball<Solid>::degree;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[12]) {
        const N reach = value[10] + value[11];
        return revolution_meets_ball<Solid>::is_near(point_at(value, 0), point_at(value, 1), point_at(value, 2), value[9],
                                                     reach);
    }
};

/// Whether a coordinate lies in an interval.
template <class N>
ABUT_HD constexpr verdict is_between(const N& lower, const N& x, const N& upper) {
    return and_then(is_not_negative(x - lower), [&] { return is_not_negative(upper - x); });
}

/// The face at x = l of a box, of which `lower` and `upper` are corners of it, all turned so that x is the axis that the
/// face is orthogonal to, and as seen from an end: whether the face meets the disc there, other than in its border.
/// Degree 4. The foot of the end lies at y = -l d_x d_y / (d_y^2 + d_z^2), and at z alike.
template <class W, class R>
ABUT_HD constexpr verdict disc_meets_face_of_box(const W& l, const vec3<W>& lower, const vec3<W>& upper, const vec3<W>& d,
                                                 const R& r) {
    const vec3<W> flat{d.x - d.x, d.y, d.z};
    return and_then(is_no_longer(scale(l, d), scale(r, flat)), [&] {
        const auto ff = dot(flat, flat), moved = l * d.x;
        const auto lower_y = lower.y * ff, upper_y = upper.y * ff, lower_z = lower.z * ff, upper_z = upper.z * ff;
        const auto zero = lower_y - lower_y;
        return and_then(is_positive(ff), [&] {
            return and_then(is_between(lower_y, zero - moved * d.y, upper_y),
                            [&] { return is_between(lower_z, zero - moved * d.z, upper_z); });
        });
    });
}

/// Whether the axis passes through that face. Degree 2.
template <class W>
ABUT_HD constexpr verdict axis_meets_face_of_box(const W& l, const vec3<W>& lower, const vec3<W>& upper, const vec3<W>& d) {
    const int side = sign_or_unknown(d.x);
    if (side == 0) return verdict::no;
    if (side == unknown_sign) return verdict::unknown;
    const auto at = [&](const W& x) { return x * d.x; };
    const auto between = [&](const W& low, const W& along, const W& high) {
        return side > 0 ? is_between(at(low), l * along, at(high)) : is_between(at(high), l * along, at(low));
    };
    const verdict reached = side > 0 ? is_between(l - l, l, d.x) : is_between(d.x, l, l - l);
    return and_then(
        reached, [&] { return and_then(between(lower.y, d.y, upper.y), [&] { return between(lower.z, d.z, upper.z); }); });
}

/// The axis's ends, the box's lower and upper corner, the radius.
template <class Solid>
struct revolution_meets_box {
    static constexpr int degree = Solid::is_cone ? 8 : 6;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[13]) {
        vec3<N> first = point_at(value, 0), last = point_at(value, 1), lower = point_at(value, 2),
                upper = point_at(value, 3);
        const N& r = value[12];
        verdict met = is_in(first, lower, upper);
        ABUT_ROLLED
        for (int axis = 0; axis < 3 && met != verdict::yes; ++axis) {
            met = met || faces_meet(first, last, lower, upper, r);
            met = or_else(met, [&] { return edges_meet(first, last, lower, upper, r); });
            vec3<N>* const points[] = {&first, &last, &lower, &upper};
            for (vec3<N>* const p : points) rotate(p->x, p->y, p->z);
        }
        return met;
    }

private:
    template <class N>
    ABUT_HD static constexpr verdict is_in(const vec3<N>& p, const vec3<N>& lower, const vec3<N>& upper) {
        return is_between(lower.x, p.x, upper.x) && is_between(lower.y, p.y, upper.y) && is_between(lower.z, p.z, upper.z);
    }

    /// Those orthogonal to x, but for their borders.
    template <class N>
    ABUT_HD static constexpr verdict faces_meet(const vec3<N>& first, const vec3<N>& last, const vec3<N>& lower,
                                                const vec3<N>& upper, const N& r) {
        const auto d = last - first, l = lower - first, u = upper - first, m = lower - last, v = upper - last;
        verdict met = verdict::no;
        ABUT_ROLLED
        for (int side = 0; side < 2 && met != verdict::yes; ++side) {
            const auto x = side == 0 ? l.x : u.x, y = side == 0 ? m.x : v.x;
            met = met || axis_meets_face_of_box(x, l, u, d);
            met = or_else(met, [&] { return disc_meets_face_of_box(y, m, v, d, r); });
            if constexpr (!Solid::is_cone) met = or_else(met, [&] { return disc_meets_face_of_box(x, l, u, d, r); });
        }
        return met;
    }

    /// The four along x, with the corners that they begin with; over all axes each corner is one of those at least.
    template <class N>
    ABUT_HD static constexpr verdict edges_meet(const vec3<N>& first, const vec3<N>& last, const vec3<N>& lower,
                                                const vec3<N>& upper, const N& r) {
        const auto d = last - first;
        verdict met = verdict::no;
        ABUT_ROLLED
        for (int edge = 0; edge < 4 && met != verdict::yes; ++edge) {
            const N &y = edge % 2 == 0 ? lower.y : upper.y, &z = edge < 2 ? lower.z : upper.z;
            const vec3<N> from{lower.x, y, z}, to{upper.x, y, z};
            met = met || Solid::has_point(from - first, from - last, d, r);
            met = or_else(met, [&] { return Solid::has_point(to - first, to - last, d, r); });
            met = or_else(met, [&] {
                return meets_inside_of_segment<Solid>(from - first, to - first, from - last, to - last, to - from, d, r);
            });
        }
        return met;
    }
};

/// Whether two heights over a plane have not one strict sign.
template <class H>
ABUT_HD constexpr verdict are_not_on_one_side(const H& a, const H& b) {
    return or_else(is_not_negative(a) && is_not_positive(b), [&] { return is_not_positive(a) && is_not_negative(b); });
}

/// The plane's normal, its offset and the 1 that is its unit, the axis's ends, the radius.
template <class Solid>
struct plane_meets_revolution {
    static constexpr int degree = 6;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[12]) {
        const vec3<N> normal{value[0], value[1], value[2]}, first{value[5], value[6], value[7]},
            last{value[8], value[9], value[10]};
        const auto offset = value[3] * value[4], at_first = dot(normal, first) - offset,
                   at_last = dot(normal, last) - offset;
        return or_else(are_not_on_one_side(at_first, at_last), [&] {
            const auto d = last - first;
            const auto rim = scale(value[11], cross(normal, d));
            const verdict at_base = is_no_longer(scale(at_last, d), rim);
            if constexpr (Solid::is_cone) {
                return at_base;
            } else {
                return or_else(at_base, [&] { return is_no_longer(scale(at_first, d), rim); });
            }
        });
    }
};

/// And a distance R, which is as many heights as the normal n is long. Of an end at height h, with a rim that reaches lower:
/// |h| |d| <= r |n x d| + R |n| |d|. With A, B and C the squares of these, A - B - C <= 0 or (A - B - C)^2 <= 4 B C.
template <class Solid>
struct plane_within_of_revolution {
    static constexpr int degree = 12;

    template <class N>
    ABUT_HD static constexpr verdict ask(const N (&value)[13]) {
        const vec3<N> normal{value[0], value[1], value[2]}, first{value[5], value[6], value[7]},
            last{value[8], value[9], value[10]};
        const N &r = value[11], &reach = value[12];
        const auto offset = value[3] * value[4], at_first = dot(normal, first) - offset,
                   at_last = dot(normal, last) - offset;
        return or_else(are_not_on_one_side(at_first, at_last), [&] {
            const auto d = last - first;
            const auto across = cross(normal, d);
            const auto dd = dot(d, d);
            const auto rim = (r * r) * dot(across, across), gap = (reach * reach) * (dot(normal, normal) * dd);
            const verdict at_base = is_near_end(at_last, dd, rim, gap);
            if constexpr (Solid::is_cone) {
                return or_else(at_base, [&] { return is_no_longer(at_first, scale(reach, normal)); });
            } else {
                return or_else(at_base, [&] { return is_near_end(at_first, dd, rim, gap); });
            }
        });
    }

private:
    template <class H, class D, class N>
    ABUT_HD static constexpr verdict is_near_end(const H& height, const D& dd, const N& rim, const N& gap) {
        const auto over = (height * height) * dd - (rim + gap);
        return or_else(is_not_positive(over), [&] { return is_not_negative((rim + rim) * (gap + gap) - over * over); });
    }
};

}  // namespace abut::detail
