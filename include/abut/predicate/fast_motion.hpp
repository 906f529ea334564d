// SPDX-License-Identifier: MIT
#pragma once

// Moving features in plain floating point: the roots of the cubic f of exact_motion.hpp by Newton's iteration within
// brackets, and areas at each root (X. Provot 1997). Nothing is promised: docs/results/motion.md says how often it is wrong.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_motion.hpp>
#include <abut/shape/outward.hpp>

namespace abut::detail {

/// The time of the first contact in [0, 1], or -1; of a vertex and a face, or, of Edges, two edges.
template <bool Edges, scalar T>
class fast_motion {
public:
    ABUT_HD constexpr explicit fast_motion(const moving_points<T>& p) {
        constexpr int from[3] = {Edges ? 0 : 1, Edges ? 2 : 1, Edges ? 0 : 1}, to[3] = {Edges ? 1 : 2, 3, Edges ? 2 : 0};
        for (int i = 0; i < 3; ++i) {
            at_0_[i] = p.t0[to[i]] - p.t0[from[i]];
            change_[i] = (p.t1[to[i]] - p.t1[from[i]]) - at_0_[i];
        }
    }

    [[nodiscard]] ABUT_HD constexpr T time() const {
        // f = c[0] + c[1] t + c[2] t^2 + c[3] t^3
        const vec3<T> n0 = cross(at_0_[0], at_0_[1]), n1 = cross(at_0_[0], change_[1]) + cross(change_[0], at_0_[1]),
                      n2 = cross(change_[0], change_[1]);
        const T c[4] = {dot(n0, at_0_[2]), dot(n1, at_0_[2]) + dot(n0, change_[2]), dot(n2, at_0_[2]) + dot(n1, change_[2]),
                        dot(n2, change_[2])};
        // Between its extremes f is monotone.
        T end[4] = {0, 1, 1, 1};
        int ends = 1;
        const T quarter = c[2] * c[2] - 3 * c[3] * c[1];
        if (quarter > 0) {
            const T root = static_cast<T>(square_root(static_cast<double>(quarter)));
            const T q = c[2] < 0 ? root - c[2] : -root - c[2];
            const T x = q / (3 * c[3]), y = c[1] / q;
            const T lower = least(x, y), upper = greatest(x, y);
            if (lower > 0 && lower < 1) end[ends++] = lower;
            if (upper > 0 && upper < 1) end[ends++] = upper;
        }
        end[ends] = 1;
        T a = 0, at_a = c[0];
        if (at_a == 0 && touches(0)) return 0;
        for (int i = 1; i <= ends; ++i) {
            const T b = end[i], at_b = value(c, b);
            if (at_b == 0 ? touches(b) : (at_a < 0) != (at_b < 0) && at_a != 0) {
                const T t = at_b == 0 ? b : root_between(c, a, at_a, b);
                if (at_b == 0 || touches(t)) return t;
            }
            a = b;
            at_a = at_b;
        }
        return -1;
    }

private:
    [[nodiscard]] ABUT_HD static constexpr T value(const T (&c)[4], T t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }

    [[nodiscard]] ABUT_HD static constexpr T root_between(const T (&c)[4], T low, T at_low, T high) {
        T t = (low + high) / 2;
        for (int i = 0; i < 60 && low < high; ++i) {
            const T f = value(c, t), slope = c[1] + t * (2 * c[2] + 3 * t * c[3]);
            if (f == 0) return t;
            ((f < 0) == (at_low < 0) ? low : high) = t;
            const T newton = t - f / slope, next = newton > low && newton < high ? newton : (low + high) / 2;
            if (next == t || next == low || next == high) return next;
            t = next;
        }
        return t;
    }

    [[nodiscard]] ABUT_HD constexpr bool touches(T t) const {
        const vec3<T> u = at_0_[0] + t * change_[0], v = at_0_[1] + t * change_[1], w = at_0_[2] + t * change_[2], n = cross(u, v);
        const T nn = dot(n, n), with_v = dot(n, cross(w, v)), with_u = Edges ? dot(n, cross(w, u)) : dot(n, cross(u, w));
        if (!(nn > 0) || !(with_v >= 0) || !(with_u >= 0)) return false;
        return Edges ? with_v <= nn && with_u <= nn : with_v + with_u <= nn;
    }

    vec3<T> at_0_[3], change_[3];  ///< u, v, w
};

}  // namespace abut::detail
