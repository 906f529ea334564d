// SPDX-License-Identifier: MIT
#pragma once

// When do a moving vertex and a moving triangle, or two moving edges, first touch? Exactly, for every finite input; on hosts
// alone. Time 2^40 times finer than the step is what is told of it.
//
// With u, v the two edges from a corner of a triangle, and w from that corner to the vertex, all of them linear in t, the
// four points are in one plane when f = w . (u x v) is 0, and in no other case can they touch. So where f is not 0 for all
// t, the features touch first at one of its roots, of which there are three at most. Likewise of two edges u and v, w from
// an end of the first to an end of the second (X. Provot, Collision and self-collision handling in cloth model dedicated to
// design garments, 1997).
//
// Where f is 0 for all t, the features are always in one plane. If they do not touch at t = 0, they are apart right before
// they first touch, and then a point of one is on the border of the other in that plane: the vertex, or an end of an edge,
// is on a line through an edge, at a root of a coordinate of a cross product; or, where it is on that line for all t, it
// meets an end of that edge, at a root of a difference of coordinates. All these roots are tried.
//
// Whether features touch at a root is a question of signs there: in a projection along an axis that keeps the plane's area,
// of the areas that the vertex spans with the triangle's sides; and where no projection does, the triangle has no area or
// the edges are parallel, and points are compared with edges coordinate by coordinate.

#include <cstdint>
#include <vector>

#include <abut/arithmetic/algebraic.hpp>
#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/exact_stages.hpp>

namespace abut::detail {

/// Bits of times of impact after the binary point.
inline constexpr int time_bits = 40;

/// Four points in motion: a vertex and the corners of a face, or the ends of an edge and of another one.
class exact_features {
public:
    /// The coordinates at t = 0, 12 of them, and at t = 1.
    template <scalar T>
    explicit exact_features(const T (&value)[24]) {
        const aligned<24> all(value);
        const auto number = [&](int i) {
            const binary_parts& part = all.part[i];
            return big_int(part.mantissa, part.mantissa == 0 ? 0 : part.exponent - all.low);
        };
        for (int i = 0; i < 4; ++i) {
            for (int k = 0; k < 3; ++k) point_[i].along[k] = polynomial(number(3 * i + k), number(12 + 3 * i + k));
        }
    }

    /// The first time at which the vertex, which is the first point, is in the face, as a multiple of 2^-40 that is not
    /// above it; or -1.
    [[nodiscard]] std::int64_t vertex_meets_face() const {
        const auto &p = point_[0], &a = point_[1], &b = point_[2], &c = point_[3];
        const vector u = b - a, v = c - a, w = p - a;
        const auto touches = [&](const cell_of_root& t) {
            for (int axis = 0; axis < 3; ++axis) {
                const int s = t.sign_of(area(u, v, axis));
                if (s == 0) continue;
                return s * t.sign_of(area(w, v, axis)) >= 0 && s * t.sign_of(area(u, w, axis)) >= 0 &&
                       s * t.sign_of(area(c - b, p - b, axis)) >= 0;
            }
            return is_on_segment(t, p, a, b) || is_on_segment(t, p, b, c) || is_on_segment(t, p, c, a);
        };
        const polynomial f = volume(w, u, v);
        if (!f.is_zero()) return first_root(f, touches);
        std::int64_t first = touches_at_0(touches);
        add_events(first, touches, p, a, b);
        add_events(first, touches, p, b, c);
        add_events(first, touches, p, c, a);
        return first;
    }

    /// Likewise of two edges, between the first two points and the last two.
    [[nodiscard]] std::int64_t edges_meet() const {
        const auto &a = point_[0], &b = point_[1], &c = point_[2], &d = point_[3];
        const vector u = b - a, v = d - c, w = c - a;
        const auto touches = [&](const cell_of_root& t) {
            for (int axis = 0; axis < 3; ++axis) {
                const int s = t.sign_of(area(u, v, axis));
                if (s == 0) continue;
                return s * t.sign_of(area(w, v, axis)) >= 0 && s * t.sign_of(area(c - b, v, axis)) <= 0 &&
                       s * t.sign_of(area(w, u, axis)) >= 0 && s * t.sign_of(area(d - a, u, axis)) <= 0;
            }
            return is_on_segment(t, a, c, d) || is_on_segment(t, b, c, d) || is_on_segment(t, c, a, b) ||
                   is_on_segment(t, d, a, b);
        };
        const polynomial f = volume(w, u, v);
        if (!f.is_zero()) return first_root(f, touches);
        std::int64_t first = touches_at_0(touches);
        add_events(first, touches, a, c, d);
        add_events(first, touches, b, c, d);
        add_events(first, touches, c, a, b);
        add_events(first, touches, d, a, b);
        return first;
    }

private:
    struct vector {
        polynomial along[3];
        friend vector operator-(const vector& p, const vector& q) {
            return {{p.along[0] - q.along[0], p.along[1] - q.along[1], p.along[2] - q.along[2]}};
        }
    };

    /// The coordinate of p x q along an axis.
    static polynomial area(const vector& p, const vector& q, int axis) {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        return p.along[i] * q.along[j] - p.along[j] * q.along[i];
    }
    /// p . (q x r)
    static polynomial volume(const vector& p, const vector& q, const vector& r) {
        return p.along[0] * area(q, r, 0) + p.along[1] * area(q, r, 1) + p.along[2] * area(q, r, 2);
    }
    /// Whether p is between a and b, or one of them.
    static bool is_on_segment(const cell_of_root& t, const vector& p, const vector& a, const vector& b) {
        const vector of_a = p - a, of_b = p - b;
        for (int axis = 0; axis < 3; ++axis) {
            if (t.sign_of(of_a.along[axis]) * t.sign_of(of_b.along[axis]) > 0) return false;
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (t.sign_of(area(of_a, of_b, axis)) != 0) return false;
        }
        return true;
    }

    template <class Touches>
    static std::int64_t first_root(const polynomial& f, const Touches& touches) {
        for (const cell_of_root& t : roots_in_unit_interval(f)) {
            if (touches(t)) return t.floor(time_bits);
        }
        return -1;
    }
    template <class Touches>
    static std::int64_t touches_at_0(const Touches& touches) {
        return touches(cell_of_root(nullptr, big_int(), 48, true)) ? 0 : -1;
    }
    /// Tries the times at which p may arrive at the segment from a to b.
    template <class Touches>
    static void add_events(std::int64_t& first, const Touches& touches, const vector& p, const vector& a, const vector& b) {
        if (first == 0) return;
        const auto add = [&](const polynomial& f) {
            if (f.is_zero()) return false;
            const std::int64_t t = first_root(f, touches);
            if (t >= 0 && (first < 0 || t < first)) first = t;
            return true;
        };
        const vector of_a = p - a, of_b = p - b;
        for (int axis = 0; axis < 3; ++axis) {
            if (add(area(of_a, of_b, axis))) return;
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (add(of_a.along[axis])) break;
        }
        for (int axis = 0; axis < 3; ++axis) {
            if (add(of_b.along[axis])) break;
        }
    }

    vector point_[4];
};

}  // namespace abut::detail
