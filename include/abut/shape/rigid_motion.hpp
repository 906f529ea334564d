// SPDX-License-Identifier: MIT
#pragma once

// The motion of a body that turns: from one pose to another in the time from 0 to 1, as numbers. Which bodies move so is in
// shape/turning.hpp, and how far boxes come on such a way in shape/turning_reach.hpp.
//
// A point r of the body is at
//
//     x(t) = R(t) (r - c) + p(t),    R(t) = exp(t theta [u]) (F + t E),    p(t) = p0 + t (p1 - p0),
//
// where F is the first rotation as it was given, c the centre in the body's frame, p0 and p1 where the two poses place it,
// and E = exp(-theta [u]) G - F, with G the second rotation. So both ends are those that were given: R(0) = F and R(1) = G.
// The axis u and the angle theta are those of the unit quaternion of G F^T, by Shepperd's method (1978). Where both
// rotations are orthonormal E is what rounding left of them. Where they are so within `rotation_tolerance` the body is bent
// from one into the other, by 2^-8 of its size at most. All numbers are doubles. As they are rounded they are the motion:
// its end is off from the second pose by less than 2^-44 of the sizes that are added.
//
// Derivatives. x' = theta u x (R(t) (r - c)) + exp(t theta [u]) E (r - c) + p1 - p0. The second term is no longer than
// |E| |r - c|, with Frobenius' norm. x'' is no longer than theta^2 times the distance to the axis plus 2 theta |E| |r - c|,
// and that distance changes on the way by |E| |r - c| at most. These bounds are what all that follows is made of.

#include <cmath>
#include <string>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/error.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>

namespace abut {

/// About what a body turns on its way from one pose to another.
/// @ingroup motion
template <scalar T>
struct turning {
    /// The point of the body, in its own frame, that goes in a straight line at constant speed.
    vec3<T> centre{0, 0, 0};
    /// In the world, of any length; zero for the shorter way round. Otherwise the body turns to the left about that
    /// direction, by less than a full turn: the axis of the turn is the one that both poses tell, and this says which of its
    /// two directions is meant. A half turn needs it.
    vec3<T> axis{0, 0, 0};
};

namespace detail {

/// The sine, and 1 less the cosine.
struct sine_and_versine {
    double sine, versine;
};
/// Of an angle from 0 to 2 pi, each within 2^-46: Taylor's series for a sixteenth of it, whose rest is below 2^-60, and four
/// times the double angle. Each doubling makes an error at most four times as large and adds less than 2^-52, but the first
/// ones, of small angles, far less.
ABUT_HD constexpr sine_and_versine sine_and_versine_of(double angle) {
    const double y = 0x1p-4 * angle, z = plain_product(y, y);
    constexpr double of_sine[] = {-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800},
                     of_versine[] = {-1.0 / 24, 1.0 / 720, -1.0 / 40320, 1.0 / 3628800, -1.0 / 479001600, 1.0 / 87178291200};
    double s = of_sine[5], v = of_versine[5];
    for (int i = 5; i-- > 0;) {
        s = plain_sum(plain_product(s, z), of_sine[i]);
        v = plain_sum(plain_product(v, z), of_versine[i]);
    }
    s = plain_sum(y, plain_product(y, plain_product(s, z)));
    v = plain_product(z, plain_sum(0.5, plain_product(v, z)));
    for (int i = 0; i < 4; ++i) {
        const double twice = 2 * plain_product(s, plain_sum(1.0, -v));
        v = 2 * plain_product(s, s);
        s = twice;
    }
    return {s, v};
}

ABUT_HD inline double plain_length(const vec3<double>& v) { return std::sqrt(plain_dot(v, v)); }

/// A matrix of rows, and where the centre is: the point r - c of a body lies at a (r - c) + at.
struct turned_frame {
    vec3<double> rows[3];
    vec3<double> at;

    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr vec3<double> turned(const vec3<double>& p) const {
        return {plain_dot(rows[0], p), plain_dot(rows[1], p), plain_dot(rows[2], p)};
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr vec3<double> place(const vec3<double>& p) const {
        return {placed(rows[0].x, rows[0].y, rows[0].z, p, at.x), placed(rows[1].x, rows[1].y, rows[1].z, p, at.y),
                placed(rows[2].x, rows[2].y, rows[2].z, p, at.z)};
    }
    /// A direction of the world, by the transposed.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr vec3<double> back(const vec3<double>& n) const {
        return plain_step(
            plain_step({plain_product(n.x, rows[0].x), plain_product(n.x, rows[0].y), plain_product(n.x, rows[0].z)}, n.y,
                       rows[1]),
            n.z, rows[2]);
    }
};

/// A motion, as above. Plain data.
struct rigid_motion {
    vec3<double> from[3], drift[3];   ///< rows of F and E
    vec3<double> axis;                ///< u, of length 1 but for rounding
    double angle;                     ///< theta, from 0 to 2 pi
    double off;                       ///< no less than |E|
    vec3<double> centre, start, way;  ///< c, p0 and p1 - p0

    /// Whether nothing moves.
    [[nodiscard]] ABUT_HD bool is_still() const { return angle == 0 && off == 0 && way == vec3<double>{0, 0, 0}; }
    [[nodiscard]] ABUT_HD turned_frame frame(double t) const {
        turned_frame f{{from[0], from[1], from[2]}, plain_step(start, t, way)};
        if (off > 0) {
            for (int i = 0; i < 3; ++i) f.rows[i] = plain_step(from[i], t, drift[i]);
        }
        return angle == 0 ? f : turned_by(plain_product(t, angle), f);
    }
    /// The same turned by an angle about the axis: each column v becomes v + s u x v + (1 - c) u x (u x v).
    [[nodiscard]] ABUT_HD turned_frame turned_by(double by, const turned_frame& f) const {
        const auto [s, v] = sine_and_versine_of(by);
        const vec3<double>& u = axis;
        const double x = plain_product(v, u.x), y = plain_product(v, u.y), z = plain_product(v, u.z),
                     sx = plain_product(s, u.x), sy = plain_product(s, u.y), sz = plain_product(s, u.z),
                     xx = plain_product(x, u.x), yy = plain_product(y, u.y), zz = plain_product(z, u.z),
                     xy = plain_product(x, u.y), yz = plain_product(y, u.z), zx = plain_product(z, u.x);
        const vec3<double> turn[3] = {{plain_sum(1.0, -plain_sum(yy, zz)), plain_sum(xy, -sz), plain_sum(zx, sy)},
                                      {plain_sum(xy, sz), plain_sum(1.0, -plain_sum(xx, zz)), plain_sum(yz, -sx)},
                                      {plain_sum(zx, -sy), plain_sum(yz, sx), plain_sum(1.0, -plain_sum(xx, yy))}};
        turned_frame r;
        for (int i = 0; i < 3; ++i) r.rows[i] = f.back(turn[i]);  // turn f: a row of the product is that of turn times f
        r.at = f.at;
        return r;
    }
};

/// The axis and the angle of a rotation that is orthonormal but for some digits; zero and {1, 0, 0} where there is none.
struct axis_and_angle {
    vec3<double> axis{1, 0, 0};
    double angle = 0;
    bool is_half_turn = false;  ///< within 2^-18: which way round is anybody's guess
};
inline axis_and_angle axis_of_turn(const vec3<double> (&q)[3]) {
    // Shepperd: the largest of four squares is a quarter at least.
    const double m[3][3] = {{q[0].x, q[0].y, q[0].z}, {q[1].x, q[1].y, q[1].z}, {q[2].x, q[2].y, q[2].z}};
    const double trace = plain_sum(plain_sum(m[0][0], m[1][1]), m[2][2]);
    double v[3] = {plain_sum(m[2][1], -m[1][2]), plain_sum(m[0][2], -m[2][0]), plain_sum(m[1][0], -m[0][1])}, w = 0;
    int i = m[1][1] > m[0][0] ? 1 : 0;
    if (m[2][2] > m[i][i]) i = 2;
    if (trace >= m[i][i]) {
        w = plain_sum(1.0, trace);  // both in one unit
    } else {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        w = v[i];
        v[i] = plain_sum(plain_sum(plain_sum(1.0, m[i][i]), -m[j][j]), -m[k][k]);
        v[j] = plain_sum(m[i][j], m[j][i]);
        v[k] = plain_sum(m[i][k], m[k][i]);
    }
    vec3<double> u{v[0], v[1], v[2]};
    if (w < 0) u = {-u.x, -u.y, -u.z}, w = -w;
    const double length = plain_length(u), whole = std::sqrt(plain_sum(plain_product(length, length), plain_product(w, w)));
    axis_and_angle r;
    if (!(length > 0x1p-100)) return r;
    r.axis = {u.x / length, u.y / length, u.z / length};
    r.is_half_turn = w < 0x1p-19 * whole;
    // Half the angle is in the first quadrant; what is left after a step is a sixth of its cube.
    constexpr double quarter = 1.57079632679489661923;
    double half = plain_product(quarter, length / plain_sum(length, w));
    for (int step = 0; step < 4; ++step) {
        const auto [s, c] = sine_and_versine_of(half);
        const double cosine = plain_sum(1.0, -c);
        half = plain_sum(half, plain_sum(plain_product(length, cosine), -plain_product(w, s)) / whole);
        if (half < 0) half = 0;
    }
    r.angle = 2 * half;
    return r;
}

/// The motion from one pose to another, which are checked. Throws error in the name of `function` for a half turn without an
/// axis, and for an axis that is nearly at a right angle to that of the turn; and invalid_geometry where a number is not
/// finite.
template <scalar T>
rigid_motion make_rigid_motion(const rigid<T>& from, const rigid<T>& to, const turning<T>& about, const auto& function) {
    const auto at_start = [&] { return std::string(function) + ": at t = 0"; };
    const auto at_end = [&] { return std::string(function) + ": at t = 1"; };
    check(from, name_when_needed{at_start});
    check(to, name_when_needed{at_end});
    const auto check_vector = [&](const vec3<T>& v, const char* what) {
        const T numbers[3] = {v.x, v.y, v.z};
        for (std::size_t i = 0; i < 3; ++i) {
            if (!is_finite(numbers[i])) {
                throw invalid_geometry(function, std::string(what) + " coordinate", i, "is not finite",
                                       static_cast<double>(numbers[i]));
            }
        }
    };
    check_vector(about.centre, "centre");
    check_vector(about.axis, "axis");
    rigid_motion m{};
    m.centre = widened(about.centre);
    const auto placed_centre = [&](const rigid<T>& pose) {
        const auto one = [&](int i) {
            const vec3<double> r = widened(row(pose.rotation, i));
            return placed(r.x, r.y, r.z, m.centre, 0.0);
        };
        const vec3<double> turned{one(0), one(1), one(2)};
        return plain_step(turned, 1.0, widened(pose.translation));
    };
    m.start = placed_centre(from);
    m.way = plain_step(placed_centre(to), -1.0, m.start);
    vec3<double> last[3], turn[3];
    for (int i = 0; i < 3; ++i) m.from[i] = widened(row(from.rotation, i)), last[i] = widened(row(to.rotation, i));
    for (int i = 0; i < 3; ++i) {
        turn[i] = {plain_dot(last[i], m.from[0]), plain_dot(last[i], m.from[1]), plain_dot(last[i], m.from[2])};
    }
    axis_and_angle how = axis_of_turn(turn);
    const vec3<double> wish = widened(about.axis);
    const double largest = magnitudes(wish);
    if (largest > 0) {
        const vec3<double> n{wish.x / largest, wish.y / largest, wish.z / largest};
        const double along = plain_dot(how.axis, n) / plain_length(n);
        if (how.angle > 0x1p-10 && !(absolute(along) > 0.5)) {
            throw error(std::string(function) + ": the given axis is " + shortest(absolute(along)) +
                        " of its length along that of the turn; expected more than 0.5");
        }
        if (along < 0 && how.angle > 0x1p-10) {
            how.axis = {-how.axis.x, -how.axis.y, -how.axis.z};
            how.angle = 6.28318530717958647693 - how.angle;
        }
    } else if (how.is_half_turn) {
        throw error(std::string(function) + ": a half turn, which goes round either way; an axis says which: turning{.axis = ...}");
    }
    m.axis = how.axis;
    m.angle = how.angle;
    // exp(-theta [u]) G - F, by the opposite axis.
    rigid_motion back = m;
    back.axis = {-m.axis.x, -m.axis.y, -m.axis.z};
    const turned_frame left = back.turned_by(m.angle, {{last[0], last[1], last[2]}, {0, 0, 0}});
    double square = 0;
    const bool stays = m.angle == 0 && last[0] == m.from[0] && last[1] == m.from[1] && last[2] == m.from[2];
    for (int i = 0; i < 3 && !stays; ++i) {
        m.drift[i] = plain_step(left.rows[i], -1.0, m.from[i]);
        square = plain_sum(square, plain_dot(m.drift[i], m.drift[i]));
    }
    m.off = std::sqrt(square) * (1 + 0x1p-40);
    return m;
}

}  // namespace detail

}  // namespace abut
