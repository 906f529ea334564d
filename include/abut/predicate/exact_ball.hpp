// SPDX-License-Identifier: MIT
#pragma once

// The exact half of the predicates between a ball and the hull of one, two or three points: their polynomials, written
// once over a number type. No rounding, no thresholds; the headers of the single pairs of shapes evaluate them through
// arithmetic/exact_stages.hpp.
//
// The hull meets the closed ball if and only if its point nearest to the centre does, and that point lies at a vertex,
// inside an edge, or inside the face. Each feature is asked whether it has an orthogonal foot in its relative interior and
// that foot is within the radius; the disjunction needs no classification of where the nearest point lies. Signs of feet are
// strict: a boundary belongs to a feature of lower dimension, and an edge or a face without extent has no interior, so
// degenerate triangles need no case of their own.

#include <cstddef>

#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>

namespace abut::detail {

/// Degree 2: |p| <= r, the centre being the origin.
template <class N, class R>
ABUT_HD constexpr bool vertex_in_ball(const vec3<N>& p, const R& r) {
    return squares_at_most(p, r);
}

/// Degree 4: the foot on the line p q lies strictly between both, and |p x q| <= r |q - p|.
template <class N, class M, class R>
ABUT_HD constexpr bool edge_in_ball(const vec3<N>& p, const vec3<N>& q, const vec3<M>& edge, const R& r) {
    return sign_of_dot(edge, p) < 0 && sign_of_dot(edge, q) > 0 && squares_at_most(cross(p, q), scale(r, edge));
}

/// Degree 6: the foot on the plane has three positive barycentric coordinates n . (p x q) / n . n, and
/// |p . (q x s)| <= r |n|.
template <class N, class M, class R>
ABUT_HD constexpr bool face_in_ball(const vec3<N>& p, const vec3<N>& q, const vec3<N>& s, const vec3<M>& normal,
                                    const R& r) {
    const auto qs = cross(q, s);
    return sign_of_dot(normal, qs) > 0 && sign_of_dot(normal, cross(s, p)) > 0 && sign_of_dot(normal, cross(p, q)) > 0 &&
           squares_at_most(dot(p, qs), scale(r, normal));
}

/// How the values of a question lie in an array of any number type: the centre's coordinates, those of the points, the
/// radius.
template <class N, std::size_t V>
ABUT_HD constexpr vec3<N> point_at(const N (&value)[V], int i) {
    return {value[3 * i], value[3 * i + 1], value[3 * i + 2]};
}

struct ball_meets_segment {
    static constexpr int degree = 4, points = 3;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[10]) {
        const vec3<N> center = point_at(value, 0), a = point_at(value, 1), b = point_at(value, 2);
        const N& r = value[9];
        const auto p = a - center, q = b - center;
        return vertex_in_ball(p, r) || vertex_in_ball(q, r) || edge_in_ball(p, q, b - a, r);
    }
};

struct ball_meets_triangle {
    static constexpr int degree = 6, points = 4;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[13]) {
        const vec3<N> center = point_at(value, 0), a = point_at(value, 1), b = point_at(value, 2), c = point_at(value, 3);
        const N& r = value[12];
        auto p = a - center, q = b - center, s = c - center;
        if (vertex_in_ball(p, r) || vertex_in_ball(q, r) || vertex_in_ball(s, r)) return true;
        auto pq = b - a, qs = c - b, sp = a - c;
        ABUT_ROLLED
        for (int edge = 0; edge < 3; ++edge) {
            if (edge_in_ball(p, q, pq, r)) return true;
            rotate(p, q, s);
            rotate(pq, qs, sp);
        }
        return face_in_ball(p, q, s, cross(pq, qs), r);
    }
};

/// The radii are added exactly, in the number type that decides.
struct ball_meets_ball {
    static constexpr int degree = 2, points = 2;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[8]) {
        return vertex_in_ball(point_at(value, 1) - point_at(value, 0), value[6] + value[7]);
    }
};

}  // namespace abut::detail
