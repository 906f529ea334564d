// SPDX-License-Identifier: MIT
#pragma once

// Constructions for the families of moving pairs whose coordinates are integers, so that contacts are exact.
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

namespace abut::test::construction::motions {

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
    return shuffled(
        d, kind, placed<T>(kind, through(x, v, tau), plus(o, back * tau.at_t0(), v[0]), plus(o, back * tau.at_t1(), v[0])));
}

/// A face through the y axis, which turns about it, z = s x with s proportional to t - first; a vertex that passes the y
/// axis at the time `second`. Their determinant is proportional to (t - first) (t - second).
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

}  // namespace abut::test::construction::motions
