// SPDX-License-Identifier: MIT
#pragma once

// How long two convex shapes that turn stay apart: a bound along one direction, by which conservative advancement takes its
// steps (B. Mirtich, Timewarp rigid body simulation, 2000, for the bound; here with the curvature of the ways instead of
// their greatest speed).
//
// Let n be a direction of length 1, and f(s) the gap between the shapes along it at the time t + s. A point's height n . x
// changes by its speed n . x' at t times s, and by no more than the bound of x'' times s^2 / 2 besides (rigid_motion.hpp).
// The height and speed of a point are linear in where it lies in the body. So, for each s, the least and the most of height
// plus s times speed are at points that are farthest along some direction of the body's frame, and
//
//     g(s) = min over b - max over a - s drift - K s^2 - margin  <=  f(s)
//
// is concave: where it is not negative at two times, it is not in between. A time at which it is 0 is looked for by the
// quadratic that touches it, and by chords, which lie below.
//
// Rounding. All numbers that are added have magnitudes below `size`, the sum of what the motions and the shapes have. No
// more than some forty roundings on the way of each number, a sine and a cosine within 2^-46, and an axis of length 1 within
// 2^-50 make less than 2^-43 of it. The margin is 2^-40.

#include <cmath>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/aabb.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid_motion.hpp>

namespace abut::detail {

/// Two bodies in motion.
struct turning_pair {
    rigid_motion a, b;
};

/// What bounds are made of for all points of two bodies that are no farther from the centres of their motions than two
/// radii, where they are placed.
struct turning_bounds {
    double margin;  ///< for rounding
    double drift;   ///< the greatest speed that both have by E
    double bend;    ///< half the greatest second derivative that E adds

    /// No singular value of a rotation that queries take is larger.
    static constexpr double stretch = 1.002;

    turning_bounds() = default;
    ABUT_HD turning_bounds(const turning_pair& both, double radius_a, double radius_b)
        : margin(plain_product(0x1p-40, plain_sum(size_of(both.a, radius_a), size_of(both.b, radius_b)))),
          drift(plain_product(1 + 0x1p-20,
                              plain_sum(plain_product(both.a.off, radius_a), plain_product(both.b.off, radius_b)))),
          bend(plain_product(1 + 0x1p-20, plain_sum(bend_of(both.a, radius_a), bend_of(both.b, radius_b)))) {}

    /// Of a box.
    template <scalar T>
    static double radius(const rigid_motion& m, const aabb<T>& box) {
        const vec3<double> lower = plain_step(widened(box.lower), -1.0, m.centre),
                           upper = plain_step(widened(box.upper), -1.0, m.centre);
        return plain_product(stretch, plain_length(greatest(absolute(lower), absolute(upper))));
    }

private:
    ABUT_HD static double size_of(const rigid_motion& m, double radius) {
        return 2 * (radius + magnitudes(m.centre)) + (magnitudes(m.start) + magnitudes(m.way));
    }
    ABUT_HD static double bend_of(const rigid_motion& m, double radius) {
        return plain_product(0.5 * plain_product(m.angle, m.angle + 2), plain_product(m.off, radius));
    }
};

/// A box in its body's frame, as seen from the centre of the motion.
struct turned_box {
    vec3<double> middle, half;

    template <scalar T>
    ABUT_INLINE ABUT_HD turned_box(const aabb<T>& box, const vec3<double>& centre) {
        const vec3<double> lower = widened(box.lower), upper = widened(box.upper);
        middle = plain_step({0.5 * (lower.x + upper.x), 0.5 * (lower.y + upper.y), 0.5 * (lower.z + upper.z)}, -1.0, centre);
        half = {0.5 * (upper.x - lower.x), 0.5 * (upper.y - lower.y), 0.5 * (upper.z - lower.z)};
    }
    [[nodiscard]] ABUT_HD vec3<double> farthest(const vec3<double>& n) const {
        const auto end = [](double m, double h, double by) { return by > 0 ? plain_sum(m, h) : plain_sum(m, -h); };
        return {end(middle.x, half.x, n.x), end(middle.y, half.y, n.y), end(middle.z, half.z, n.z)};
    }
    /// Half the greatest second derivative of a point, without what E adds.
    [[nodiscard]] ABUT_HD double bend(const rigid_motion& m, const turned_frame& at) const {
        if (m.angle == 0) return 0;
        const double radius = plain_length(half) * turning_bounds::stretch;  // around the middle
        return 0.5 * (m.angle * m.angle) * (plain_length(plain_cross(m.axis, at.turned(middle))) + radius) * (1 + 0x1p-40);
    }
};

/// The gap between two shapes along a direction of length 1, from a time on. Shapes tell their farthest point along a
/// direction.
template <class A, class B>
struct gap_ahead {
    const A& a;
    const B& b;
    vec3<double> height_a, speed_a, height_b, speed_b;  ///< along which heights and speeds are, in the bodies' frames
    double apart, closing, bend;

    struct value {
        double gap, slope;
    };

    /// What is within `radius` of one of them belongs to it. The bend of the shapes is given.
    ABUT_HD gap_ahead(const A& first, const B& second, const turning_pair& both, const turning_bounds& bounds,
                      const turned_frame& at_a, const turned_frame& at_b, const vec3<double>& n, double radius,
                      double bend_of_shapes)
        : a(first),
          b(second),
          height_a(at_a.back(n)),
          speed_a(speed_along(both.a, at_a, n)),
          height_b(at_b.back(n)),
          speed_b(speed_along(both.b, at_b, n)),
          apart(plain_sum(plain_dot(n, plain_step(at_b.at, -1.0, at_a.at)), -plain_sum(radius, bounds.margin))),
          closing(plain_sum(plain_dot(n, plain_step(both.b.way, -1.0, both.a.way)), -bounds.drift)),
          bend(plain_sum(bend_of_shapes, bounds.bend)) {}

    /// No less than that is between them after a time, and how the bound changes there.
    [[nodiscard]] ABUT_HD value after(double s) const {
        const vec3<double> along_a = plain_step(height_a, s, speed_a), along_b = plain_step(height_b, s, speed_b),
                           back_b{-along_b.x, -along_b.y, -along_b.z};
        const vec3<double> p = a.farthest(along_a), q = b.farthest(back_b);
        const double curve = plain_product(bend, s);
        const double between = plain_sum(plain_sum(plain_dot(along_b, q), -plain_dot(along_a, p)), apart);
        const double slope = plain_sum(plain_sum(plain_dot(speed_b, q), -plain_dot(speed_a, p)), closing);
        return {plain_sum(between, plain_product(s, plain_sum(closing, -curve))), plain_sum(slope, -2 * curve)};
    }
    /// For so long, up to `end`, they are surely apart. 0 where they may not be now.
    [[nodiscard]] ABUT_HD double free_for(double end) const {
        value now = after(0);
        if (!(now.gap > 0)) return 0;
        value last = after(end);
        if (last.gap >= 0) return end;
        double from = 0;
        for (int step = 0; step < 4; ++step) {
            const double root = std::sqrt(plain_sum(plain_product(now.slope, now.slope), 4 * plain_product(bend, now.gap)));
            const double ahead = plain_sum(root, -now.slope);
            double to = ahead > 0 ? plain_sum(from, plain_product(1 - 0x1p-12, 2 * now.gap / ahead)) : end;
            value then = last;
            if (to < end) {
                then = after(to);
            } else {
                to = end;
            }
            if (!(then.gap >= 0)) {
                end = to;
                last = then;
                const double share = now.gap / plain_sum(now.gap, -then.gap);
                to = plain_sum(from, plain_product(plain_product(1 - 0x1p-12, share), plain_sum(to, -from)));
                then = after(to);
            }
            if (!(then.gap >= 0) || !(to > from)) break;
            const bool is_enough = then.gap <= plain_product(0x1p-6, now.gap);
            from = to;
            now = then;
            if (is_enough) break;
        }
        return from;
    }

private:
    /// theta u x v along n is v along theta n x u.
    ABUT_HD static vec3<double> speed_along(const rigid_motion& m, const turned_frame& at, const vec3<double>& n) {
        if (m.angle == 0) return {0, 0, 0};
        const vec3<double> w = plain_cross(n, m.axis);
        return at.back({plain_product(m.angle, w.x), plain_product(m.angle, w.y), plain_product(m.angle, w.z)});
    }
};

/// Two trees' frames at a time, and how boxes of both lie to each other there. Which direction tells boxes apart is a guess,
/// for which any rounding will do.
struct turned_frames {
    double time = -1;
    turned_frame a{}, b{};
    vec3<double> b_in_a[3]{}, apart{};  ///< rows of b's axes in a's frame, and the way to b's centre there

    ABUT_HD void move_to(double t, const turning_pair& both) {
        if (t == time) return;
        if (time < 0 || !both.a.is_still()) a = both.a.frame(t);
        if (time < 0 || !both.b.is_still()) b = both.b.frame(t);
        time = t;
        const auto column = [](const turned_frame& f, int k) {
            return k == 0   ? vec3<double>{f.rows[0].x, f.rows[1].x, f.rows[2].x}
                   : k == 1 ? vec3<double>{f.rows[0].y, f.rows[1].y, f.rows[2].y}
                            : vec3<double>{f.rows[0].z, f.rows[1].z, f.rows[2].z};
        };
        const vec3<double> x = column(b, 0), y = column(b, 1), z = column(b, 2), d = b.at - a.at;
        double along[3];
        for (int i = 0; i < 3; ++i) {
            const vec3<double> axis = column(a, i);
            b_in_a[i] = {dot(axis, x), dot(axis, y), dot(axis, z)};
            along[i] = dot(axis, d);
        }
        apart = {along[0], along[1], along[2]};
    }
    /// Boxes are farther apart than `far` from the frames' time until the one that is returned, or until `end`. `gap` is
    /// that along the direction that was tried.
    [[nodiscard]] ABUT_HD double free_until(const turned_box& p, const turned_box& q, const turning_pair& both,
                                            const turning_bounds& bounds, double far, double end, double& gap) const {
        const vec3<double>(&r)[3] = b_in_a;
        const vec3<double> d =
            vec3<double>{dot(r[0], q.middle), dot(r[1], q.middle), dot(r[2], q.middle)} + apart - p.middle;
        const vec3<double> d_in_b = d.x * r[0] + d.y * r[1] + d.z * r[2];
        const vec3<double> m[3] = {absolute(r[0]), absolute(r[1]), absolute(r[2])};
        const vec3<double> of_a =
            absolute(d) - (p.half + vec3<double>{dot(m[0], q.half), dot(m[1], q.half), dot(m[2], q.half)});
        const vec3<double> of_b = absolute(d_in_b) - (q.half + p.half.x * m[0] + p.half.y * m[1] + p.half.z * m[2]);
        const double length = std::sqrt(dot(d, d));
        gap = length > 0 ? length - (dot(absolute(d), p.half) + dot(absolute(d_in_b), q.half)) / length : 0;
        vec3<double> n = a.turned(d);  // in the world
        const auto take = [&](double g, double way, const vec3<double>& axis, const turned_frame& f) {
            if (!(g > gap)) return;
            gap = g;
            const vec3<double> along = f.turned(axis);
            n = way < 0 ? vec3<double>{-along.x, -along.y, -along.z} : along;
        };
        take(of_a.x, d.x, {1, 0, 0}, a);
        take(of_a.y, d.y, {0, 1, 0}, a);
        take(of_a.z, d.z, {0, 0, 1}, a);
        take(of_b.x, d_in_b.x, {1, 0, 0}, b);
        take(of_b.y, d_in_b.y, {0, 1, 0}, b);
        take(of_b.z, d_in_b.z, {0, 0, 1}, b);
        if (!(gap > far)) return time;
        const double of_n = plain_length(n);
        if (!(of_n > 0)) return time;
        const gap_ahead<turned_box, turned_box> ahead(p, q, both, bounds, a, b, {n.x / of_n, n.y / of_n, n.z / of_n}, far,
                                                      plain_sum(p.bend(both.a, a), q.bend(both.b, b)));
        const double left = plain_sum(end, -time);
        if (!(left > 0)) return ahead.after(0).gap > 0 ? infinity<double> : time;
        const double free = ahead.free_for(left);
        return free < left ? plain_sum(time, free) : infinity<double>;
    }
};

}  // namespace abut::detail
