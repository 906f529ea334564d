// SPDX-License-Identifier: MIT
#pragma once

// The oracle for bodies that turn, in long double: the motion by the sine and cosine of the C library, with an axis and an
// angle that are found otherwise than the library finds them; distances of all features of all triangles, and intersections
// by signs of volumes; and a dense subdivision of time, in which an interval is free if the distance in its middle is more
// than all points move on half of it. It shares no formula with the library but the definition of the motion.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/turning.hpp>

namespace abut::test {

using long_vector = std::array<long double, 3>;

inline long_vector operator+(const long_vector& a, const long_vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline long_vector operator-(const long_vector& a, const long_vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline long_vector operator*(long double s, const long_vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline long double long_dot(const long_vector& a, const long_vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline long_vector long_cross(const long_vector& a, const long_vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline long double long_norm(const long_vector& a) { return std::sqrt(long_dot(a, a)); }
template <class T>
long_vector as_long(const vec3<T>& v) {
    return {v.x, v.y, v.z};
}

/// The definition of shape/rigid_motion.hpp.
class long_motion {
public:
    template <class T>
    long_motion(const rigid<T>& from, const rigid<T>& to, const turning<T>& about) : centre_(as_long(about.centre)) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j)
                first_[i][j] = from.rotation[3 * i + j], last_[i][j] = to.rotation[3 * i + j];
        }
        start_ = turned(first_, centre_) + as_long(from.translation);
        way_ = turned(last_, centre_) + as_long(to.translation) - start_;
        // The antisymmetric part is the sine times the axis; near a half turn the symmetric one tells the axis.
        long_vector turn[3];
        for (std::size_t i = 0; i < 3; ++i)
            turn[i] = {long_dot(last_[i], first_[0]), long_dot(last_[i], first_[1]), long_dot(last_[i], first_[2])};
        const long_vector odd{turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]};
        const long double trace = turn[0][0] + turn[1][1] + turn[2][2];
        angle_ = std::atan2(long_norm(odd) / 2, (trace - 1) / 2);
        axis_ = long_norm(odd) > 0 ? (1 / long_norm(odd)) * odd : long_vector{1, 0, 0};
        if (angle_ > 2) {
            // R + R^T + (1 - trace) I is a multiple of u u^T.
            long_vector best{};
            for (std::size_t i = 0; i < 3; ++i) {
                long_vector column;
                for (std::size_t j = 0; j < 3; ++j) column[j] = turn[i][j] + turn[j][i] + (i == j ? 1 - trace : 0);
                if (long_norm(column) > long_norm(best)) best = column;
            }
            if (long_dot(best, odd) < 0) best = -1.0L * best;
            axis_ = (1 / long_norm(best)) * best;
        }
        const long_vector wish = as_long(about.axis);
        if (long_norm(wish) > 0 && long_dot(wish, axis_) < 0) axis_ = -1.0L * axis_, angle_ = 2 * std::acos(-1.0L) - angle_;
    }
    /// Of rotations that are off from orthonormal the axis and the angle are those of the definition alone: these are given.
    void turn_about(const long_vector& axis, long double angle) { axis_ = (1 / long_norm(axis)) * axis, angle_ = angle; }
    [[nodiscard]] long_vector place(const long_vector& p, long double t) const {
        const long_vector r = p - centre_;
        // exp(t theta [u]) ((1 - t) F r + t exp(-theta [u]) G r): E is the difference of the two.
        const long_vector bent = (1 - t) * turned(first_, r) + t * by(-angle_, turned(last_, r));
        return by(t * angle_, bent) + start_ + t * way_;
    }
    /// No point of the ball around the centre is faster.
    [[nodiscard]] long double speed(const long_vector& p) const {
        const long_vector r = p - centre_, f = turned(first_, r), e = by(-angle_, turned(last_, r)) - f;
        return long_norm(way_) + angle_ * (long_norm(long_cross(axis_, f)) + long_norm(e)) + long_norm(e);
    }

private:
    using matrix = std::array<long_vector, 3>;
    static long_vector turned(const matrix& m, const long_vector& p) {
        return {long_dot(m[0], p), long_dot(m[1], p), long_dot(m[2], p)};
    }
    [[nodiscard]] long_vector by(long double angle, const long_vector& p) const {
        const long double along = long_dot(axis_, p);
        return std::cos(angle) * (p - along * axis_) + std::sin(angle) * long_cross(axis_, p) + along * axis_;
    }
    matrix first_{}, last_{};
    long_vector centre_, axis_{}, start_{}, way_{};
    long double angle_ = 0;
};

/// A shape as points, triangles of these, and how far around; whether the hull of the first four points belongs to it too.
struct long_shape {
    std::vector<long_vector> points;
    std::vector<std::array<std::size_t, 3>> faces;
    long double radius = 0;
    bool is_solid = false;
};

namespace in_long {

inline long_vector nearest_on_edge(const long_vector& a, const long_vector& b) {
    const long_vector e = b - a;
    const long double ee = long_dot(e, e), s = ee > 0 ? std::clamp(-long_dot(a, e) / ee, 0.0L, 1.0L) : 0;
    return a + s * e;
}
/// From the origin.
inline long double to_face(const long_vector& a, const long_vector& b, const long_vector& c) {
    long double least =
        std::min({long_norm(nearest_on_edge(a, b)), long_norm(nearest_on_edge(b, c)), long_norm(nearest_on_edge(c, a))});
    const long_vector n = long_cross(b - a, c - a);
    if (long_dot(n, long_cross(a, b)) > 0 && long_dot(n, long_cross(b, c)) > 0 && long_dot(n, long_cross(c, a)) > 0)
        least = std::min(least, std::abs(long_dot(n, a)) / long_norm(n));
    return least;
}
/// Of two edges the nearest points are ends, or across both.
inline long double between_edges(const long_vector& a, const long_vector& b, const long_vector& c, const long_vector& d) {
    const long_vector e = b - a, f = d - c, n = long_cross(e, f), w = c - a;
    long double least = std::min({long_norm(nearest_on_edge(a - c, b - c)), long_norm(nearest_on_edge(a - d, b - d)),
                                  long_norm(nearest_on_edge(c - a, d - a)), long_norm(nearest_on_edge(c - b, d - b))});
    const long double nn = long_dot(n, n);
    if (nn > 0) {
        const long double s = long_dot(long_cross(w, f), n) / nn, t = long_dot(long_cross(w, e), n) / nn;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, std::abs(long_dot(w, n)) / std::sqrt(nn));
    }
    return least;
}
inline bool pierces(const long_vector& p, const long_vector& q, const long_vector& a, const long_vector& b,
                    const long_vector& c) {
    const long_vector n = long_cross(b - a, c - a);
    const long double x = long_dot(n, p - a), y = long_dot(n, q - a);
    if (!((x > 0 && y < 0) || (x < 0 && y > 0))) return false;
    const long_vector at = p + (x / (x - y)) * (q - p);
    return long_dot(n, long_cross(a - at, b - at)) > 0 && long_dot(n, long_cross(b - at, c - at)) > 0 &&
           long_dot(n, long_cross(c - at, a - at)) > 0;
}
using placed_points = std::vector<long_vector>;
inline bool holds(const placed_points& p, const long_vector& x) {
    const auto volume = [](const long_vector& a, const long_vector& b, const long_vector& c, const long_vector& d) {
        return long_dot(b - a, long_cross(c - a, d - a));
    };
    const long double all = volume(p[0], p[1], p[2], p[3]);
    return volume(x, p[1], p[2], p[3]) / all > 0 && volume(p[0], x, p[2], p[3]) / all > 0 &&
           volume(p[0], p[1], x, p[3]) / all > 0 && volume(p[0], p[1], p[2], x) / all > 0;
}
/// Between the cores.
inline long double between(const long_shape& s, const placed_points& p, const long_shape& t, const placed_points& q) {
    if ((s.is_solid && holds(p, q[0])) || (t.is_solid && holds(q, p[0]))) return 0;
    long double least = std::numeric_limits<long double>::infinity();
    for (const auto& f : s.faces) {
        for (const auto& g : t.faces) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t i2 = (i + 1) % 3;
                if (pierces(p[f[i]], p[f[i2]], q[g[0]], q[g[1]], q[g[2]]) ||
                    pierces(q[g[i]], q[g[i2]], p[f[0]], p[f[1]], p[f[2]]))
                    return 0;
                least = std::min(least, to_face(q[g[0]] - p[f[i]], q[g[1]] - p[f[i]], q[g[2]] - p[f[i]]));
                least = std::min(least, to_face(p[f[0]] - q[g[i]], p[f[1]] - q[g[i]], p[f[2]] - q[g[i]]));
                for (std::size_t j = 0; j < 3; ++j) {
                    least = std::min(least, between_edges(p[f[i]], p[f[i2]], q[g[j]], q[g[(j + 1) % 3]]));
                }
            }
        }
    }
    return least;
}

}  // namespace in_long

/// Two shapes in motion.
struct long_pair {
    long_shape s, t;
    long_motion a, b;

    [[nodiscard]] long double distance(long double time) const {
        in_long::placed_points p, q;
        for (const auto& x : s.points) p.push_back(a.place(x, time));
        for (const auto& x : t.points) q.push_back(b.place(x, time));
        return std::max(in_long::between(s, p, t, q) - s.radius - t.radius, 0.0L);
    }
    [[nodiscard]] long double speed() const {
        long double of_a = 0, of_b = 0;
        for (const auto& x : s.points) of_a = std::max(of_a, a.speed(x));
        for (const auto& x : t.points) of_b = std::max(of_b, b.speed(x));
        return of_a + of_b;
    }
    /// Whether nothing is nearer than `slack` from 0 to `until`; as far as intervals of 2^-44 tell it.
    [[nodiscard]] bool is_free(long double until, long double slack = 0) const {
        return until <= 0 || is_free_between(0, until, speed(), slack);
    }

private:
    [[nodiscard]] bool is_free_between(long double from, long double to, long double fastest, long double slack) const {
        const long double middle = (from + to) / 2, gap = distance(middle) - slack;
        if (gap > fastest * (to - from) / 2) return true;
        if (gap <= 0 || to - from < 0x1p-44L) return false;
        return is_free_between(from, middle, fastest, slack) && is_free_between(middle, to, fastest, slack);
    }
};

}  // namespace abut::test
