// SPDX-License-Identifier: MIT
#pragma once

// The oracle for continuous collision detection: the first t in [0, 1] at which a point is in a closed triangle, or two
// closed segments have a point in common, where all corners move linearly. In unbounded integers; each finite input has one
// right answer, and this is it: for points at rest, for motions in one plane, for triangles that are segments or points.
//
// Both questions become one. A point p is in the triangle a b c if the origin is in that of a - p, b - p, c - p. Segments
// a b and c d meet if the origin is in the parallelogram of their differences, an affine image of the square of the two
// parameters, and so in the image of one of the two triangles that a diagonal cuts the square into, degenerate or not.
//
// So let w0, w1, w2 be linear in t. When is the origin in their hull T(t)? Let D be their determinant.
// - Where D is not identically 0, only at roots of D.
// - Where it is, all three and the origin are in one plane at all times. Let t > 0 be the first time of contact. The origin
//   is not inside a T(t) with an area, else it would have been there before. So it is on a segment w_i w_j. If w_i x w_j is
//   not identically 0, then t is a root of one of its components. Else w_i, w_j and the origin are always on one line; w_i
//   and w_j are not strictly on two sides at t, else they would have been so before; so w_i or w_j is 0 at t, and not
//   always. So t is 0, or a root of a coordinate of some w_i or of a component of some w_i x w_j that is not identically 0.
// Whether the origin is in T at such a time is decided from l1 (w1 - w0) + l2 (w2 - w0) = -w0 by Cramer's rule in two rows
// of which the determinant is not 0; where there are none, T is a segment or a point, and alike in one row or in none.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "algebraic.hpp"
#include "motion.hpp"

namespace abut::test {

/// What is to be known of the first contact.
struct motion_answer {
    bool hit = false;
    std::int64_t cell = -1;                 // floor(2^40 t); -1 where there is no contact
    double time = -1;                       // the double nearest to t; -1 where there is no contact
    std::optional<algebraic_number> exact;  // t itself: `exact->compared_to(x)` is the sign of t - x

    friend bool operator==(const motion_answer& a, const motion_answer& b) {
        return a.hit == b.hit && a.cell == b.cell && a.time == b.time;
    }
};

namespace oracle {

/// Three coordinates, each a polynomial in t of degree 1 at most.
using moving_vector = std::array<polynomial, 3>;

inline polynomial minor(const moving_vector& v, const moving_vector& w, std::size_t i, std::size_t j) {
    return v[i] * w[j] - v[j] * w[i];
}

inline moving_vector difference(const moving_vector& v, const moving_vector& w) {
    return {v[0] - w[0], v[1] - w[1], v[2] - w[2]};
}

/// Three points that move, and the origin, which does not.
class moving_triangle {
public:
    explicit moving_triangle(std::array<moving_vector, 3> corners) : w_(std::move(corners)) {}

    /// The first time at which the origin is in the triangle.
    [[nodiscard]] std::optional<algebraic_number> first_contact() const {
        if (separated()) return {};
        std::optional<algebraic_number> first;
        const auto offer = [&](algebraic_number t) {
            if (first && first->compared_to(t) <= 0) return true;
            if (!holds_origin(t)) return false;
            first = std::move(t);
            return true;
        };
        const polynomial d = w_[0][0] * minor(w_[1], w_[2], 1, 2) + w_[0][1] * minor(w_[1], w_[2], 2, 0) +
                             w_[0][2] * minor(w_[1], w_[2], 0, 1);
        if (!d.is_zero()) {
            root_finder(d).visit_roots(offer);
            return first;
        }
        if (offer(algebraic_number(0, 0))) return first;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                for (const polynomial& p : {w_[i][k], minor(w_[i], w_[(i + 1) % 3], k, (k + 1) % 3)}) {
                    if (!p.is_zero()) root_finder(p).visit_roots(offer);
                }
            }
        }
        return first;
    }

    /// Whether the origin is in the triangle at t.
    [[nodiscard]] bool holds_origin(algebraic_number& t) const {
        const moving_vector e = difference(w_[1], w_[0]), f = difference(w_[2], w_[0]);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            const polynomial m = minor(e, f, i, j);
            const int s = t.sign(m);
            if (s == 0) continue;
            const polynomial u = minor(f, w_[0], i, j), v = minor(w_[0], e, i, j);  // m times the weights of e and f
            return s * t.sign(u) >= 0 && s * t.sign(v) >= 0 && s * t.sign(m - u - v) >= 0 &&
                   t.sign(u * e[k] + v * f[k] + m * w_[0][k]) == 0;
        }
        return segment_holds_origin(t, 0, 1) || segment_holds_origin(t, 1, 2);  // all of it: one of three corners is between
    }

private:
    [[nodiscard]] bool segment_holds_origin(algebraic_number& t, std::size_t a, std::size_t b) const {
        const moving_vector e = difference(w_[b], w_[a]);
        for (std::size_t i = 0; i < 3; ++i) {
            const int s = t.sign(e[i]);
            if (s == 0) continue;
            const polynomial u = -w_[a][i];  // e[i] times the weight of e
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            return s * t.sign(u) >= 0 && s * t.sign(e[i] - u) >= 0 && t.sign(u * e[j] + e[i] * w_[a][j]) == 0 &&
                   t.sign(u * e[k] + e[i] * w_[a][k]) == 0;
        }
        return t.sign(w_[a][0]) == 0 && t.sign(w_[a][1]) == 0 && t.sign(w_[a][2]) == 0;
    }

    /// Whether one coordinate of all corners has the same sign at 0 and at 1, and so always.
    [[nodiscard]] bool separated() const {
        for (std::size_t i = 0; i < 3; ++i) {
            int low = 1, high = -1;
            for (const moving_vector& w : w_) {
                for (const int s : {sign_at(w[i], 0, 0), sign_at(w[i], 1, 0)}) {
                    low = std::min(low, s);
                    high = std::max(high, s);
                }
            }
            if (low > 0 || high < 0) return true;
        }
        return false;
    }

    std::array<moving_vector, 3> w_;
};

/// The four points in integers. Each axis has a unit of its own: that takes triangles to triangles.
template <scalar T>
std::array<moving_vector, 4> in_integers(const motion<T>& m) {
    std::array<moving_vector, 4> r;
    using axis_of = T vec3<T>::*;  // nvcc writes such a declaration with parentheses, which g++ warns of
    constexpr axis_of axes[3] = {&vec3<T>::x, &vec3<T>::y, &vec3<T>::z};
    for (std::size_t i = 0; i < 3; ++i) {
        std::vector<T> values;
        for (std::size_t v = 0; v < 4; ++v) values.insert(values.end(), {m.t0[v].*axes[i], m.t1[v].*axes[i]});
        const std::vector<integer> x = to_integers(values);
        for (std::size_t v = 0; v < 4; ++v) r[v][i] = polynomial({x[2 * v], x[2 * v + 1] - x[2 * v]});
    }
    return r;
}

inline motion_answer answered(std::optional<algebraic_number> t) {
    motion_answer r;
    if (!t) return r;
    r.hit = true;
    r.cell = static_cast<std::int64_t>(t->floor_times(40));
    r.time = t->nearest_double();
    r.exact = std::move(t);
    return r;
}

/// Whether one coordinate orders the first `n` points before or behind all others at both times. Needs no integers.
template <scalar T>
bool always_apart(const motion<T>& m, std::size_t n) {
    using axis_of = T vec3<T>::*;  // nvcc writes such a declaration with parentheses, which g++ warns of
    constexpr axis_of axes[3] = {&vec3<T>::x, &vec3<T>::y, &vec3<T>::z};
    for (const axis_of axis : axes) {
        bool before = true, behind = true;
        const vec3<T>* const times[] = {m.t0, m.t1};  // nvcc takes no list of arrays
        for (const vec3<T>* const points : times) {
            for (std::size_t i = 0; i < n; ++i) {
                for (std::size_t j = n; j < 4; ++j) {
                    before = before && points[i].*axis < points[j].*axis;
                    behind = behind && points[i].*axis > points[j].*axis;
                }
            }
        }
        if (before || behind) return true;
    }
    return false;
}

/// The first contact of the vertex, point 0, with the triangle of points 1, 2, 3.
template <scalar T>
motion_answer vertex_face(const motion<T>& m) {
    if (always_apart(m, 1)) return {};
    const auto p = in_integers(m);
    return answered(
        moving_triangle({difference(p[1], p[0]), difference(p[2], p[0]), difference(p[3], p[0])}).first_contact());
}

/// The first contact of the segment of points 0, 1 with that of points 2, 3.
template <scalar T>
motion_answer edge_edge(const motion<T>& m) {
    if (always_apart(m, 2)) return {};
    const auto p = in_integers(m);
    const moving_vector ac = difference(p[0], p[2]), ad = difference(p[0], p[3]), bc = difference(p[1], p[2]),
                        bd = difference(p[1], p[3]);
    std::optional<algebraic_number> first = moving_triangle({ac, ad, bd}).first_contact();
    std::optional<algebraic_number> second = moving_triangle({ac, bc, bd}).first_contact();
    if (!first || (second && second->compared_to(*first) < 0)) first = std::move(second);
    return answered(std::move(first));
}

/// The first contact of a pair of either kind.
template <scalar T>
motion_answer first_contact(motion_kind kind, const motion<T>& m) {
    return kind == motion_kind::vertex_face ? vertex_face(m) : edge_edge(m);
}

}  // namespace oracle

}  // namespace abut::test
