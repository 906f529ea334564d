// SPDX-License-Identifier: MIT
#pragma once

// Families of moving pairs, vertex-face and edge-edge, each built to break something of continuous collision detection. A
// pair is a pure function of (seed, kind, family, index), on hosts and devices alike and bit for bit; draws.hpp says how.
//
// Most are built from differences. Let w0, w1, w2 be the corners of a face less the vertex, or of edges a b and c d the
// vectors a - c, a - d, b - d: there is a contact where the origin is in the triangle w0 w1 w2 (for edges: or in the other
// half of the parallelogram). Where w is small integers at the time tau = m / 2^j, and moves by a multiple of 2^j, all
// coordinates at t = 0 and t = 1 are integers, and the contact at tau is exact.

#include <cmath>
#include <cstdint>

#include <abut/config.hpp>

#include "draws.hpp"
#include "motion.hpp"

namespace abut::test {

enum class motion_family : int {
    // Rounded
    random,             // eight points in a cube
    crossing,           // a contact on the way, but for rounding
    crossing_border,    // ... near or on the border of a feature
    fast,               // ... with motions of 1e2 to 1e5 times the size
    slow,               // ... of 1e-6 to 1e-2 times the size
    steps,              // points that move by a few units in the last place
    needles,            // ... slender features, to 1e9
    flat,               // ... all nearly in one plane, rounded off it
    rotating,           // turns while it passes at a distance of 1e-8 to 1e-2
    offset_1e6,         // size 1e0 to 1e3, there
    offset_1e9,         // size 1e2 to 1e6, there
    rigid_rounded,      // one motion for both, rounded
    tenths_4,           // 0.1 times a lattice
    // Exact: there is a contact, at t = m / 2^j or before
    touch_inside,       // vertex inside the face, edges inside both or at a diagonal's middle
    touch_edge,         // vertex on an edge of the face, the end of an edge inside the other
    touch_corner,       // vertex on a corner, two ends
    touch_first,        // any of these at t = 0
    touch_last,         // any of these at t = 1
    touch_far,          // any of these at up to 2^22 (float) or 2^50 (double) from the origin
    translating,        // any of these; the second feature at rest, the first moves as one
    double_root,        // touches and goes away
    two_roots,
    three_roots,        // all in [0, 1], some of them equal
    degenerate,         // zero-length edges; triangles that are segments or points, and stay so
    collapsing,         // degenerate at the time of contact only
    coplanar_sliding,   // always in one plane, which may move and turn
    collinear_sliding,  // always on one line
    // Exact: with contact and without
    nudged,             // one of those exact ones, with one coordinate off by a unit in the last place
    parallel,           // edges that stay parallel; a vertex that moves along the face
    rigid,              // one motion for both
    at_rest,            // nothing moves
    at_rest_coplanar,
    shared,             // a point in common, at all times, at t = 0 or at t = 1
    lattice_2,          // {0, 1}^3
    lattice_4,
    lattice_16,
    // The number range
    any_scale,          // one of the exact ones times any power of two; may be rounded
    axis_scales,        // lattice_4, with a power of two for each axis
    denormal,           // lattices of the least number, signed zeros among them
    wide_lattice,       // 0, +- the least number, 1, 1 and an ulp, the largest
    largest,
    all_bit_patterns,
};

inline constexpr int motion_family_count = static_cast<int>(motion_family::all_bit_patterns) + 1;

/// Each pair of the family has a contact.
inline constexpr bool always_hits(motion_family f) {
    return (f >= motion_family::touch_inside && f <= motion_family::collinear_sliding) || f == motion_family::shared;
}

/// On the host only.
inline const char* name_of(motion_family f) {
    constexpr const char* names[motion_family_count] = {
        "random",           "crossing",          "crossing at a border", "fast",           "slow",
        "steps",            "needles",           "flat",                 "rotating",       "offset 1e6",
        "offset 1e9",       "rigid, rounded",    "0.1 lattice 4",        "touch inside",   "touch an edge",
        "touch a corner",   "touch at t = 0",    "touch at t = 1",       "touch far away", "translating",
        "double root",      "two roots",         "three roots",          "degenerate",     "collapsing",
        "coplanar sliding", "collinear sliding", "nudged",               "parallel",       "rigid",
        "at rest",          "at rest, coplanar", "shared point",         "lattice 2",      "lattice 4",
        "lattice 16",       "any scale",         "scales of axes",       "denormal",       "wide lattice",
        "largest",          "all bit patterns"};
    return names[static_cast<int>(f)];
}

namespace construction::motions {

/// The differences at t = 0 and at t = 1.
struct relative {
    point w0[3], w1[3];
};

/// p + k v; exact for the integers that it is used for.
ABUT_HD inline point plus(const point& p, double k, const point& v) { return along(p, k, v); }

/// How many bits the integers of the exact families have beyond those of small ones.
template <scalar T>
inline constexpr int spare_bits = sizeof(T) == 4 ? 0 : 28;

/// An integer below 2^bits, of either sign.
ABUT_HD inline double whole(draws& d, int bits) {
    const auto magnitude = static_cast<double>(d.bits() >> (64 - bits));
    return d.below(2) == 0 ? -magnitude : magnitude;
}

ABUT_HD inline point whole_point(draws& d, int bits) {
    const double x = whole(d, bits), y = whole(d, bits);
    return {x, y, whole(d, bits)};
}

/// Coordinates below 2^12, in double below 2^40; often small ones.
template <scalar T>
ABUT_HD int draw_bits(draws& d) {
    return d.below(2) == 0 ? 2 + d.below(4) : 3 + d.below(10 + spare_bits<T>);
}

/// m / 2^j, a time at which exact contacts are placed.
struct dyadic_time {
    double m, n;  // n = 2^j
    ABUT_HD double at_t0() const { return -m; }
    ABUT_HD double at_t1() const { return n - m; }
};

ABUT_HD inline dyadic_time draw_time(draws& d) {
    const int n = 1 << d.below(5);
    return {static_cast<double>(d.below(n + 1)), static_cast<double>(n)};
}

/// x + (n t - m) v: at x at the time m / n.
ABUT_HD inline relative through(const point* x, const point* v, const dyadic_time& tau) {
    relative r;
    for (int i = 0; i < 3; ++i) {
        r.w0[i] = plus(x[i], tau.at_t0(), v[i]);
        r.w1[i] = plus(x[i], tau.at_t1(), v[i]);
    }
    return r;
}

/// Where x[0] and x[1] are set, x[2] for which the origin is in the triangle's interior (place 0), on an edge (1), at a
/// corner (2).
ABUT_HD inline void close_around_origin(draws& d, point* x, int place) {
    const double u = place == 0 || (place == 1 && d.below(2) == 0) ? 1 + d.below(3) : 0;
    const double v = place == 0 || (place == 1 && u == 0) ? 1 + d.below(3) : 0;
    x[2] = plus(plus({0, 0, 0}, -u, x[0]), -v, x[1]);
}

/// The four points that have these differences: the vertex, or the first end of the second edge, is at o0 and o1.
template <scalar T>
ABUT_HD motion<T> placed(motion_kind kind, const relative& r, const point& o0, const point& o1) {
    motion<T> m;
    for (int k = 0; k < 2; ++k) {
        const point& o = k == 0 ? o0 : o1;
        const point* const w = k == 0 ? r.w0 : r.w1;
        point p[4];
        if (kind == motion_kind::vertex_face) {
            p[0] = o;
            for (int i = 0; i < 3; ++i) p[i + 1] = plus(o, 1, w[i]);
        } else {
            p[2] = o;
            p[0] = plus(o, 1, w[0]);
            p[3] = plus(p[0], -1, w[1]);
            p[1] = plus(p[3], 1, w[2]);
        }
        for (int i = 0; i < 4; ++i) (k == 0 ? m.t0 : m.t1)[i] = round_to<T>(p[i]);
    }
    return m;
}

template <class P>
ABUT_HD void exchange(P& a, P& b) {
    const P c = a;
    a = b;
    b = c;
}

/// Other orders of the corners, the ends and the edges; other axes, with other signs.
template <scalar T>
ABUT_HD motion<T> shuffled(draws& d, motion_kind kind, motion<T> m) {
    const auto swap_points = [&m](int i, int j) {
        exchange(m.t0[i], m.t0[j]);
        exchange(m.t1[i], m.t1[j]);
    };
    if (kind == motion_kind::vertex_face) {
        const int with = d.below(3);
        if (with > 0) swap_points(1, 1 + with);
        if (d.below(2) == 0) swap_points(2, 3);
    } else {
        if (d.below(2) == 0) swap_points(0, 1);
        if (d.below(2) == 0) swap_points(2, 3);
        if (d.below(2) == 0) {
            swap_points(0, 2);
            swap_points(1, 3);
        }
    }
    const int axes = d.below(3), signs = d.below(8);
    for (int i = 0; i < 8; ++i) {
        vec3<T>& v = i < 4 ? m.t0[i] : m.t1[i - 4];
        const T x = signs & 1 ? -v.x : v.x, y = signs & 2 ? -v.y : v.y, z = signs & 4 ? -v.z : v.z;
        if (axes == 0) v = {x, y, z};
        if (axes == 1) v = {y, z, x};
        if (axes == 2) v = {z, x, y};
    }
    return m;
}

/// Any of a motion's 24 coordinates.
template <scalar T>
ABUT_HD T& any_coordinate(draws& d, motion<T>& m) {
    const int i = d.below(8), k = d.below(3);
    vec3<T>& v = i < 4 ? m.t0[i] : m.t1[i - 4];
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

/// At a place of integer coordinates, which may move, and shuffled.
template <scalar T>
ABUT_HD motion<T> placed_anywhere(draws& d, motion_kind kind, const relative& r, int bits) {
    point o0{0, 0, 0};
    if (d.below(4) != 0) o0 = whole_point(d, bits);
    point o1 = o0;
    if (d.below(4) != 0) o1 = whole_point(d, bits);
    return shuffled(d, kind, placed<T>(kind, r, o0, o1));
}

/// Sheared by integers, so that planes and lines are not along axes.
ABUT_HD inline relative sheared(draws& d, relative r) {
    const double xy = d.below(5) - 2, xz = d.below(5) - 2, yz = d.below(5) - 2, zx = d.below(5) - 2;
    for (int i = 0; i < 6; ++i) {
        point& v = i < 3 ? r.w0[i] : r.w1[i - 3];
        v.x = std::fma(xy, v.y, std::fma(xz, v.z, v.x));
        v.y = std::fma(yz, v.z, v.y);
        v.z = std::fma(zx, v.x, v.z);
    }
    return r;
}

// --- exact ---------------------------------------------------------------------------------------------------------------

ABUT_HD inline void whole_points(draws& d, point* x, int bits) {
    for (int i = 0; i < 3; ++i) x[i] = whole_point(d, bits);
}

/// A contact at tau, in an interior (place 0), on an edge (1), at a corner (2).
template <scalar T>
ABUT_HD relative touch(draws& d, int place, const dyadic_time& tau) {
    point x[3], v[3];
    const int bits = draw_bits<T>(d), speed = 1 + d.below(bits);
    whole_points(d, x, bits);
    whole_points(d, v, speed);
    close_around_origin(d, x, place);
    return through(x, v, tau);
}

/// The first feature moves by one vector, the second rests.
template <scalar T>
ABUT_HD motion<T> translating_pair(draws& d, motion_kind kind) {
    point x[3], v[3];
    const int bits = draw_bits<T>(d);
    whole_points(d, x, bits);
    v[0] = v[1] = v[2] = whole_point(d, 1 + d.below(bits));
    close_around_origin(d, x, d.below(3));
    const dyadic_time tau = draw_time(d);
    const point o = whole_point(d, bits);
    // A vertex goes the other way, so that its face rests; the second edge rests where its first end does.
    const double back = kind == motion_kind::vertex_face ? -1 : 0;
    return shuffled(d, kind,
                    placed<T>(kind, through(x, v, tau), plus(o, back * tau.at_t0(), v[0]), plus(o, back * tau.at_t1(), v[0])));
}

/// A face through the y axis, which turns about it, z = s x with s proportional to t - first; a vertex that passes the y axis
/// at the time `second`. Their determinant is proportional to (t - first) (t - second).
template <scalar T>
ABUT_HD relative rocking(draws& d, const dyadic_time& first, const dyadic_time& second) {
    point x[3];
    const int bits = draw_bits<T>(d);
    whole_points(d, x, bits < 5 ? 2 : bits - 3);
    close_around_origin(d, x, d.below(4) == 0 ? 1 : 0);
    const double turn = 1 + d.below(3), pass = d.below(2) == 0 ? -1 : 1;
    relative r;
    for (int i = 0; i < 3; ++i) {
        r.w0[i] = {std::fma(-pass, second.at_t0(), x[i].x), x[i].y, turn * first.at_t0() * x[i].x};
        r.w1[i] = {std::fma(-pass, second.at_t1(), x[i].x), x[i].y, turn * first.at_t1() * x[i].x};
    }
    return sheared(d, r);
}

/// w0 along x, w1 in the x y plane: the determinant is the product of three coordinates, each with a root of its own. At the
/// first one w0 is the origin.
template <scalar T>
ABUT_HD relative three_roots(draws& d) {
    dyadic_time tau[3] = {draw_time(d), draw_time(d), draw_time(d)};
    if (d.below(4) == 0) tau[1] = tau[0];
    if (d.below(4) == 0) tau[2] = tau[1];
    const int bits = draw_bits<T>(d);
    double k[3];
    for (double& x : k) x = d.below(2) == 0 ? -1.0 - d.below(3) : 1.0 + d.below(3);
    relative r;
    for (int i = 0; i < 2; ++i) {
        point* const w = i == 0 ? r.w0 : r.w1;
        double diagonal[3];
        for (int a = 0; a < 3; ++a) diagonal[a] = k[a] * (i == 0 ? tau[a].at_t0() : tau[a].at_t1());
        const double x1 = whole(d, bits), x2 = whole(d, bits), y2 = whole(d, bits);
        w[0] = {diagonal[0], 0, 0};
        w[1] = {x1, diagonal[1], 0};
        w[2] = {x2, y2, diagonal[2]};
    }
    return sheared(d, r);
}

/// Points that coincide or are in a line, with a contact at tau: at all times, or at tau only.
template <scalar T>
ABUT_HD relative degenerate(draws& d, bool always) {
    point x[3], v[3];
    const int bits = draw_bits<T>(d), shape = d.below(5), speed = 1 + d.below(bits);
    whole_points(d, x, bits);
    whole_points(d, v, speed);
    const double k = d.below(4);
    x[1] = plus({0, 0, 0}, -k, x[0]);  // the origin is on the segment x0 x1, and x1 where k is 0
    const double middle = d.below(2);
    if (shape == 0) x[2] = x[1];
    if (shape == 1) x[2] = x[0];
    if (shape == 2) x[0] = x[1] = x[2] = {0, 0, 0};
    if (shape == 3) x[2] = plus(plus({0, 0, 0}, 2, x[1]), -1, x[0]);
    if (shape == 4) x[2] = plus(x[1], 1 + middle, x[0]);
    if (always) {
        if (shape == 0) v[2] = v[1];
        if (shape == 1) v[2] = v[0];
        if (shape == 2) v[0] = v[1] = v[2];
        if (shape == 3) v[2] = plus(plus({0, 0, 0}, 2, v[1]), -1, v[0]);
        if (shape == 4) {  // x2 is x1 + (1 + middle) x0, and so is v; with v1 = -k v0 all stay on a line
            v[1] = plus({0, 0, 0}, -k, v[0]);
            v[2] = plus(v[1], 1 + middle, v[0]);
        }
    }
    const int last = d.below(3);  // any corner may be the one in the middle, or the one of its own
    exchange(x[2], x[last]);
    exchange(v[2], v[last]);
    return through(x, v, draw_time(d));
}

/// All differences in a plane, or on a line, at all times, with a contact at tau. The plane may turn.
template <scalar T>
ABUT_HD relative sliding(draws& d, bool on_a_line) {
    point x[3], v[3];
    const int bits = draw_bits<T>(d) / 2 + 1, turns = d.below(8);
    whole_points(d, x, bits);
    whole_points(d, v, 1 + d.below(bits));
    for (int i = 0; i < 3; ++i) {
        x[i].z = v[i].z = 0;
        if (on_a_line) x[i].y = v[i].y = 0;
    }
    close_around_origin(d, x, d.below(4) == 0 ? 2 : d.below(2));
    if (d.below(2) == 0) {
        // From outside, mostly: the origin at a corner, the others on one side of it, and motions that differ by little.
        for (int i = 0; i < 2; ++i) x[i].x = x[i].x < 0 ? -x[i].x : x[i].x;
        x[2] = {0, 0, 0};
        const double speed = 4 + d.below(28);
        for (point& p : v) p = {d.below(4) - speed, on_a_line ? 0.0 : d.below(4) - 2, 0};
    }
    const relative flat = through(x, v, draw_time(d));
    const point e = whole_point(d, bits), f = whole_point(d, bits);
    const point other_e = whole_point(d, bits), other_f = whole_point(d, bits);
    relative r;
    for (int i = 0; i < 3; ++i) {
        r.w0[i] = plus(plus({0, 0, 0}, flat.w0[i].x, e), flat.w0[i].y, f);
        r.w1[i] = plus(plus({0, 0, 0}, flat.w1[i].x, e), flat.w1[i].y, f);
        if (turns > 0) continue;
        // Fixed coordinates in a basis that moves. Contact is at all times or never: the origin is in x as it stands.
        r.w0[i] = plus(plus({0, 0, 0}, x[i].x, e), x[i].y, f);
        r.w1[i] = plus(plus({0, 0, 0}, x[i].x, other_e), x[i].y, other_f);
    }
    return r;
}

template <scalar T>
ABUT_HD motion<T> lattice_pair(draws& d, int size, double unit_length) {
    motion<T> m;
    for (int i = 0; i < 8; ++i) {
        const double x = d.below(size), y = d.below(size), z = d.below(size);
        (i < 4 ? m.t0[i] : m.t1[i - 4]) = round_to<T>({unit_length * x, unit_length * y, unit_length * z});
    }
    return m;
}

/// One of the exact families, but for lattices; with a contact.
template <scalar T>
ABUT_HD motion<T> exact_pair(draws& d, motion_kind kind, motion_family f) {
    const int bits = 2 + d.below(18 + spare_bits<T>);
    const auto anywhere = [&](const relative& r) { return placed_anywhere<T>(d, kind, r, bits); };
    switch (f) {
        case motion_family::touch_inside:
            return anywhere(touch<T>(d, 0, draw_time(d)));
        case motion_family::touch_edge:
            return anywhere(touch<T>(d, 1, draw_time(d)));
        case motion_family::touch_corner:
            return anywhere(touch<T>(d, 2, draw_time(d)));
        case motion_family::touch_first:
            return anywhere(touch<T>(d, d.below(3), {0, 1}));
        case motion_family::touch_last:
            return anywhere(touch<T>(d, d.below(3), {1, 1}));
        case motion_family::touch_far: {
            const int place = d.below(3);
            return placed_anywhere<T>(d, kind, touch<T>(d, place, draw_time(d)), 22 + spare_bits<T>);
        }
        case motion_family::translating:
            return translating_pair<T>(d, kind);
        case motion_family::double_root: {
            const dyadic_time tau = draw_time(d);
            return anywhere(rocking<T>(d, tau, tau));
        }
        case motion_family::two_roots: {
            const dyadic_time first = draw_time(d), second = draw_time(d);
            return anywhere(rocking<T>(d, first, second));
        }
        case motion_family::three_roots:
            return anywhere(three_roots<T>(d));
        case motion_family::degenerate:
            return anywhere(degenerate<T>(d, true));
        case motion_family::collapsing:
            return anywhere(degenerate<T>(d, false));
        case motion_family::coplanar_sliding:
            return anywhere(sliding<T>(d, false));
        default:
            return anywhere(sliding<T>(d, true));
    }
}

/// Any of these.
template <scalar T>
ABUT_HD motion<T> any_exact_pair(draws& d, motion_kind kind) {
    constexpr int first = static_cast<int>(motion_family::touch_inside),
                  last = static_cast<int>(motion_family::collinear_sliding);
    return exact_pair<T>(d, kind, static_cast<motion_family>(first + d.below(last - first + 1)));
}

template <scalar T>
ABUT_HD motion<T> nudged_pair(draws& d, motion_kind kind) {
    motion<T> m = any_exact_pair<T>(d, kind);
    T& x = any_coordinate(d, m);
    x = moved(x, d.below(2) == 0 ? -1 : 1);
    return m;
}

/// Edges of one direction at all times, whose lines meet at tau or miss by one; a vertex that moves in the plane of its face
/// or in a parallel one.
template <scalar T>
ABUT_HD motion<T> parallel_pair(draws& d, motion_kind kind) {
    const int bits = draw_bits<T>(d) / 2 + 1;
    const point e = whole_point(d, bits), f = whole_point(d, bits);
    const dyadic_time tau = draw_time(d);
    point x[3], v[3];
    if (kind == motion_kind::vertex_face) {
        for (int i = 0; i < 3; ++i) {
            const double u = whole(d, 3), w = whole(d, 3), du = whole(d, 2), dw = whole(d, 2);
            x[i] = plus(plus({0, 0, 0}, u, e), w, f);
            v[i] = plus(plus({0, 0, 0}, du, e), dw, f);
        }
        if (d.below(2) == 0) {
            const double height = d.below(3) - 1;
            for (point& p : x) p.z += height;
        }
    } else {
        // w1 = w0 - (d - c), w2 = w1 + (b - a)
        const double first = whole(d, 3), grows = whole(d, 2), second = whole(d, 3), also = whole(d, 2), at = whole(d, 3);
        x[0] = plus({0, 0, 0}, at, e);
        v[0] = d.below(2) == 0 ? f : plus({0, 0, 0}, whole(d, 2), e);
        x[1] = plus(x[0], -second, e);
        v[1] = plus(v[0], -also, e);
        x[2] = plus(x[1], first, e);
        v[2] = plus(v[1], grows, e);
        if (d.below(4) == 0) {
            for (point& p : x) p.z += 1;
        }
    }
    return placed_anywhere<T>(d, kind, through(x, v, tau), bits);
}

/// Differences that do not move: with a contact, or with one coordinate off by 1.
template <scalar T>
ABUT_HD relative resting(draws& d, bool coplanar) {
    point x[3];
    const int bits = draw_bits<T>(d) / (coplanar ? 2 : 1) + 1;
    whole_points(d, x, bits);
    if (coplanar) {
        for (point& p : x) p.z = 0;
    }
    if (d.below(3) != 0) close_around_origin(d, x, d.below(3));
    if (d.below(2) == 0) x[d.below(3)].x += d.below(2) == 0 ? -1 : 1;
    relative r;
    const point e = whole_point(d, bits), f = whole_point(d, bits);
    for (int i = 0; i < 3; ++i) {
        if (coplanar) x[i] = plus(plus({0, 0, 0}, x[i].x, e), x[i].y, f);
        r.w0[i] = r.w1[i] = x[i];
    }
    return r;
}

/// The same motion for both features, or none.
template <scalar T>
ABUT_HD motion<T> resting_pair(draws& d, motion_kind kind, bool coplanar, bool moves) {
    const relative r = resting<T>(d, coplanar);
    const point o0 = whole_point(d, 10), o1 = moves ? whole_point(d, 10) : o0;
    return shuffled(d, kind, placed<T>(kind, r, o0, o1));
}

/// A point in common at both times, at t = 0 or at t = 1.
template <scalar T>
ABUT_HD motion<T> shared_pair(draws& d, motion_kind kind) {
    motion<T> m;
    const bool rounded = d.below(2) == 0;
    const int bits = draw_bits<T>(d);
    for (int i = 0; i < 8; ++i) {
        const point p = rounded ? cube(d, 1) : whole_point(d, bits);
        (i < 4 ? m.t0[i] : m.t1[i - 4]) = round_to<T>(p);
    }
    const int when = d.below(3), with = 1 + d.below(3), other = kind == motion_kind::vertex_face ? with : 2 + d.below(2);
    if (when != 1) m.t0[other] = m.t0[0];
    if (when != 2) m.t1[other] = m.t1[0];
    return shuffled(d, kind, m);
}

// --- rounded -------------------------------------------------------------------------------------------------------------

/// Differences that have the origin in their hull at tau, and a motion through it. `border` puts it near an edge or a corner.
ABUT_HD inline relative crossing(draws& d, double speed, double tau, bool border) {
    point x[3], v[3];
    for (point& p : x) p = cube(d, 1);
    for (point& p : v) p = cube(d, speed);
    double weight[3];
    for (double& w : weight) w = d.uniform(0.05, 1);
    if (border) {
        const int which = d.below(3);
        const double size = d.below(3) == 0 ? 0 : d.power_of_ten(-17, -4);
        weight[which] = d.below(2) == 0 ? -size : size;
    }
    const double sum = weight[0] + weight[1] + weight[2];
    point foot{0, 0, 0};
    for (int i = 0; i < 3; ++i) foot = along(foot, weight[i] / sum, x[i]);
    relative r;
    for (int i = 0; i < 3; ++i) {
        const point at_tau = along(x[i], -1, foot);
        r.w0[i] = along(at_tau, -tau, v[i]);
        r.w1[i] = along(at_tau, 1 - tau, v[i]);
    }
    return r;
}

/// At a place of which the size is given, and moving by `speed`.
template <scalar T>
ABUT_HD motion<T> rounded_pair(draws& d, motion_kind kind, const relative& r, double place, double speed, double size) {
    const point o0 = cube(d, place), o1 = along(o0, 1, cube(d, speed));
    relative scaled = r;
    for (int i = 0; i < 6; ++i) {
        point& v = i < 3 ? scaled.w0[i] : scaled.w1[i - 3];
        v = {size * v.x, size * v.y, size * v.z};
    }
    return shuffled(d, kind, placed<T>(kind, scaled, o0, o1));
}

template <scalar T>
ABUT_HD motion<T> steps_pair(draws& d, motion_kind kind) {
    motion<T> m = rounded_pair<T>(d, kind, crossing(d, 0, 0, d.below(2) == 0), 1, 0, 1);
    for (int i = 0; i < 4; ++i) {
        const vec3<T>& v = m.t0[i];
        m.t1[i].x = moved(v.x, d.below(7) - 3);
        m.t1[i].y = moved(v.y, d.below(7) - 3);
        m.t1[i].z = moved(v.z, d.below(7) - 3);
    }
    return m;
}

template <scalar T>
ABUT_HD motion<T> needle_pair(draws& d, motion_kind kind) {
    const point e = unit(cube(d, 1));
    const double width = d.power_of_ten(-9, -2), speed = d.below(2) == 0 ? width : 1, tau = d.uniform(0, 1);
    relative r = crossing(d, 1, tau, d.below(3) == 0);
    for (int i = 0; i < 3; ++i) {
        // At tau: squeezed to a needle along e. The motion: across, by `speed`.
        point at = along(r.w0[i], tau, along(r.w1[i], -1, r.w0[i]));
        const point v = along(r.w1[i], -1, r.w0[i]);
        const double length_along = product(at, e);
        at = along({width * at.x, width * at.y, width * at.z}, length_along, e);
        r.w0[i] = along(at, -tau * speed, v);
        r.w1[i] = along(at, (1 - tau) * speed, v);
    }
    return rounded_pair<T>(d, kind, r, 1, 1, 1);
}

template <scalar T>
ABUT_HD motion<T> flat_pair(draws& d, motion_kind kind) {
    const point e = unit(cube(d, 1)), f = unit(cross_product(e, cube(d, 1)));
    relative r = crossing(d, 1, d.uniform(0, 1), d.below(2) == 0);
    for (int i = 0; i < 6; ++i) {
        point& v = i < 3 ? r.w0[i] : r.w1[i - 3];
        v = along(along({0, 0, 0}, v.x, e), v.y, f);
    }
    return rounded_pair<T>(d, kind, r, 1, 1, 1);
}

/// Corners on both sides of the origin that turn about it, in front of a point that keeps a small distance from their plane
/// at the time tau; alike for edges.
template <scalar T>
ABUT_HD motion<T> rotating_pair(draws& d, motion_kind kind) {
    relative r;
    for (int i = 0; i < 3; ++i) {
        r.w0[i] = unit(cube(d, 1));
        r.w1[i] = unit(cube(d, 1));
    }
    r.w0[2] = along(along({0, 0, 0}, -1, r.w0[0]), -1, r.w0[1]);
    r.w1[2] = along(along({0, 0, 0}, -1, r.w1[0]), -1, r.w1[1]);
    const double tau = d.uniform(0, 1), gap = d.power_of_ten(-8, -2), closer = d.uniform(-1, 1);
    const point a = along(r.w0[0], tau, along(r.w1[0], -1, r.w0[0])), b = along(r.w0[1], tau, along(r.w1[1], -1, r.w0[1]));
    const point n = unit(cross_product(a, b));
    for (int i = 0; i < 3; ++i) {
        r.w0[i] = along(r.w0[i], std::fma(-closer, tau, 1.0) * gap, n);
        r.w1[i] = along(r.w1[i], std::fma(closer, 1 - tau, 1.0) * gap, n);
    }
    return rounded_pair<T>(d, kind, r, 1, 1, 1);
}

// --- the number range ----------------------------------------------------------------------------------------------------

template <scalar T>
ABUT_HD T power_of_two(int k) {
    if constexpr (sizeof(T) == 4) {
        return k < -126 ? from_bits(1u << (k + 149)) : from_bits(static_cast<std::uint32_t>(127 + k) << 23);
    } else {
        return k < -1022 ? from_bits(std::uint64_t{1} << (k + 1074)) : from_bits(static_cast<std::uint64_t>(1023 + k) << 52);
    }
}

/// Each axis times a power of two; bits that fall off the end are rounded.
template <scalar T>
ABUT_HD motion<T> scaled(motion<T> m, T x, T y, T z) {
    for (int i = 0; i < 8; ++i) {
        vec3<T>& v = i < 4 ? m.t0[i] : m.t1[i - 4];
        v = {x * v.x, y * v.y, z * v.z};
    }
    return m;
}

template <scalar T>
ABUT_HD motion<T> any_scale_pair(draws& d, motion_kind kind) {
    const motion<T> m = d.below(2) == 0 ? any_exact_pair<T>(d, kind) : nudged_pair<T>(d, kind);
    constexpr int low = sizeof(T) == 4 ? -149 : -1074, high = sizeof(T) == 4 ? 100 : 968;
    const T s = power_of_two<T>(low + d.below(high - low));
    return scaled(m, s, s, s);
}

template <scalar T>
ABUT_HD motion<T> axis_scales_pair(draws& d) {
    constexpr int low = sizeof(T) == 4 ? -149 : -1074, high = sizeof(T) == 4 ? 126 : 1022;
    const T x = power_of_two<T>(low + d.below(high - low)), y = power_of_two<T>(low + d.below(high - low));
    const T z = power_of_two<T>(low + d.below(high - low));
    return scaled(lattice_pair<T>(d, 4, 1), x, y, z);
}

template <scalar T>
ABUT_HD motion<T> denormal_pair(draws& d) {
    motion<T> m = lattice_pair<T>(d, d.below(2) == 0 ? 4 : 4096, 1);
    m = scaled(m, least_denormal<T>, least_denormal<T>, least_denormal<T>);
    for (int i = 0; i < 3; ++i) {
        T& x = any_coordinate(d, m);
        x = -x;
    }
    return m;
}

template <scalar T>
ABUT_HD motion<T> wide_lattice_pair(draws& d) {
    motion<T> m;
    for (int i = 0; i < 24; ++i) {
        vec3<T>& v = i < 12 ? m.t0[i / 3] : m.t1[i / 3 - 4];
        const int what = d.below(6);
        T x = T(0);
        if (what == 1) x = least_denormal<T>;
        if (what == 2) x = T(1);
        if (what == 3) x = moved(T(1), 1);
        if (what == 4) x = largest_number<T>;
        if (what == 5) x = moved(largest_number<T>, -1);
        if (d.below(2) == 0) x = -x;
        (i % 3 == 0 ? v.x : i % 3 == 1 ? v.y : v.z) = x;
    }
    return m;
}

/// Any finite numbers, or those from 1/8 of the largest one on.
template <scalar T>
ABUT_HD motion<T> any_numbers_pair(draws& d, bool large) {
    motion<T> m;
    for (int i = 0; i < 24; ++i) {
        vec3<T>& v = i < 12 ? m.t0[i / 3] : m.t1[i / 3 - 4];
        T x = T(0);
        if (large) {
            x = d.below(3) == 0 ? largest_number<T> : static_cast<T>(largest_number<T> * static_cast<T>(d.uniform(0.125, 1)));
            if (d.below(2) == 0) x = -x;
        } else {
            x = any_finite<T>(d);
        }
        (i % 3 == 0 ? v.x : i % 3 == 1 ? v.y : v.z) = x;
    }
    return m;
}

template <scalar T>
ABUT_HD motion<T> random_pair(draws& d) {
    motion<T> m;
    for (int i = 0; i < 8; ++i) (i < 4 ? m.t0[i] : m.t1[i - 4]) = round_to<T>(cube(d, 1));
    return m;
}

}  // namespace construction::motions

/// Pair number `index` of a family.
template <scalar T>
ABUT_HD motion<T> make_motion(std::uint64_t seed_value, motion_kind kind, motion_family f, std::uint64_t index) {
    namespace make = construction::motions;
    draws d(seed_value, static_cast<std::uint64_t>(f) * 2 + static_cast<std::uint64_t>(kind), index);
    if (f >= motion_family::touch_inside && f <= motion_family::collinear_sliding) return make::exact_pair<T>(d, kind, f);
    const double tau = d.uniform(0, 1);
    switch (f) {
        case motion_family::random:
            return make::random_pair<T>(d);
        case motion_family::crossing:
            return make::rounded_pair<T>(d, kind, make::crossing(d, 1, tau, false), 1, 1, 1);
        case motion_family::crossing_border:
            return make::rounded_pair<T>(d, kind, make::crossing(d, 1, tau, true), 1, 1, 1);
        case motion_family::fast: {
            const double speed = d.power_of_ten(2, 5);
            return make::rounded_pair<T>(d, kind, make::crossing(d, speed, tau, d.below(2) == 0), 1, speed, 1);
        }
        case motion_family::slow: {
            const double speed = d.power_of_ten(-6, -2);
            return make::rounded_pair<T>(d, kind, make::crossing(d, speed, tau, d.below(2) == 0), 1, speed, 1);
        }
        case motion_family::steps:
            return make::steps_pair<T>(d, kind);
        case motion_family::needles:
            return make::needle_pair<T>(d, kind);
        case motion_family::flat:
            return make::flat_pair<T>(d, kind);
        case motion_family::rotating:
            return make::rotating_pair<T>(d, kind);
        case motion_family::offset_1e6: {
            const double size = d.power_of_ten(0, 3);
            return make::rounded_pair<T>(d, kind, make::crossing(d, 1, tau, d.below(2) == 0), 1e6, size, size);
        }
        case motion_family::offset_1e9: {
            const double size = d.power_of_ten(2, 6);
            return make::rounded_pair<T>(d, kind, make::crossing(d, 1, tau, d.below(2) == 0), 1e9, size, size);
        }
        case motion_family::rigid_rounded:
            return make::rounded_pair<T>(d, kind, make::crossing(d, 0, tau, d.below(2) == 0), 1, 1, 1);
        case motion_family::tenths_4:
            return make::lattice_pair<T>(d, 4, 0.1);
        case motion_family::nudged:
            return make::nudged_pair<T>(d, kind);
        case motion_family::parallel:
            return make::parallel_pair<T>(d, kind);
        case motion_family::rigid:
            return make::resting_pair<T>(d, kind, d.below(2) == 0, true);
        case motion_family::at_rest:
            return make::resting_pair<T>(d, kind, false, false);
        case motion_family::at_rest_coplanar:
            return make::resting_pair<T>(d, kind, true, false);
        case motion_family::shared:
            return make::shared_pair<T>(d, kind);
        case motion_family::lattice_2:
            return make::lattice_pair<T>(d, 2, 1);
        case motion_family::lattice_4:
            return make::lattice_pair<T>(d, 4, 1);
        case motion_family::lattice_16:
            return make::lattice_pair<T>(d, 16, 1);
        case motion_family::any_scale:
            return make::any_scale_pair<T>(d, kind);
        case motion_family::axis_scales:
            return make::axis_scales_pair<T>(d);
        case motion_family::denormal:
            return make::denormal_pair<T>(d);
        case motion_family::wide_lattice:
            return make::wide_lattice_pair<T>(d);
        case motion_family::largest:
            return make::any_numbers_pair<T>(d, true);
        default:
            return make::any_numbers_pair<T>(d, false);
    }
}

}  // namespace abut::test
