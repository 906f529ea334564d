// SPDX-License-Identifier: MIT
#pragma once

// The floating-point half of the predicate between a capsule and a triangle. A capsule of radius r around the segment s0 s1
// touches the triangle t if and only if the ball of radius r around the origin touches the hull of the six points
// v = t_i - s_j: the questions are those of certified_ball.hpp, asked of that hull, and its certificates hold as they stand:
// a direction's least product over the hull is that over the six points; the points are differences of inputs, rounded once;
// and the point q near the origin is within 16uM of the hull (M = max |v|), as there. It is one of five:
// - From the axis to an edge, q = (p_i + m e) - l d with m and l in [0, 1], where p_i = t_i - s0, e = p_j - p_i and
//   d = s1 - s0. That stands for (1 - m) v_i0 + m v_j0 - l d, a point of the hull, since d = v_i0 - v_i1. Edges and d are
//   at most 2M long. Rounding p (uM), e (4uM), m e (2uM), their sum (uM), d (2uM), l d (2uM) and q (uM) comes to 13uM.
// - From an end to the face, q = p_0 + b (p_1 - p_0) + c (p_2 - p_0) with b, c >= 0 and b + c <= 1 + 4u, and the same of
//   the q_i = t_i - s1, as in certified_ball.hpp.
// A float that is flushed to zero takes less than 2^-126 from each input, so that q is off by less than 2^-123, and its
// square, with the factor 1 + 1/e, by less than 2^-214: `tiny` is more than that, and more than there.
// Pairs near tangency whose q is short need directions that stay exact there: not only the normal of the face, but also
// those of the axis and an edge.
//
// A new question, for axes that cross the face, whatever the radius: five signs of triple products, each of three
// differences of inputs. Let L be the sum of the magnitudes of all p and of d, so that no difference is longer; edges carry
// at most 2uL, points uL, and products and sums another 5uLLL: a triple product is within 16uLLL. The code takes 2^-46 LLL,
// 64uLLL. What flush to zero loses is below 2^-120 (L + 2^-120)^2 in float, and 2^-1010 (L + 1)^2 in double.

#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// The triangle's corners as seen from both ends of the capsule's axis, which is d.
template <scalar F>
struct capsule_frame {
    vec3<F> p[3], q[3], d;
};

/// max(x, 0), and what lies in [0, 1] of x, without a branch: g++ makes one where a maximum has a constant. Of NaN, 1.
template <scalar F>
ABUT_HD constexpr F not_below_zero(F x) {
    return (x + absolute(x)) / 2;
}
template <scalar F>
ABUT_HD constexpr F into_unit(F x) {
    const F y = not_below_zero(x);
    return y < 1 ? y : F(1);
}

/// From the axis to the edge p e: the shortest way between both segments (C. Ericson, Real-Time Collision Detection (2005),
/// 5.1.9). Whatever its numbers, it is a way between points of the two.
template <scalar F>
ABUT_HD constexpr vec3<F> axis_to_edge(const vec3<F>& d, F dd, const vec3<F>& p, const vec3<F>& e) {
    const F ee = dot(e, e), de = dot(d, e), dp = dot(d, p), ep = dot(e, p);
    const F first = into_unit((dp * ee - de * ep) / (dd * ee - de * de));
    const F along_edge = into_unit((de * first - ep) / ee);
    const F along_axis = into_unit((de * along_edge + dp) / dd);
    return (p + along_edge * e) - along_axis * d;
}

/// From the origin to its foot on the face, where that has one; in any case to a point of the triangle, as all weights are
/// made not negative. Also where their sum is so small that its inverse overflows: rounded towards 0 that is a number, and
/// the weights are too small, which from corner 0 is as good a point.
template <scalar F>
ABUT_HD constexpr vec3<F> end_to_face(const vec3<F>& n, const vec3<F> (&p)[3]) {
    const F a = not_below_zero(dot(n, cross(p[1], p[2]))), b = not_below_zero(dot(n, cross(p[2], p[0]))),
            c = not_below_zero(dot(n, cross(p[0], p[1]))), whole = 1 / (a + b + c);
    return p[0] + (b * whole) * (p[1] - p[0]) + (c * whole) * (p[2] - p[0]);
}

/// Ways from the axis to the triangle, of which one is the shortest, where the axis does not cross the face.
template <scalar F>
struct short_ways {
    vec3<F> way[5];
    F squared[5], least_squared;

    ABUT_HD constexpr short_ways(const capsule_frame<F>& f, const vec3<F>& n) : way{}, squared{}, least_squared{} {
        const F dd = dot(f.d, f.d);
        way[0] = end_to_face(n, f.p);
        way[1] = end_to_face(n, f.q);
        way[2] = axis_to_edge(f.d, dd, f.p[0], f.p[1] - f.p[0]);
        way[3] = axis_to_edge(f.d, dd, f.p[1], f.p[2] - f.p[1]);
        way[4] = axis_to_edge(f.d, dd, f.p[2], f.p[0] - f.p[2]);
        for (int i = 0; i < 5; ++i) squared[i] = dot(way[i], way[i]);
        // The first two are NaN where the face has no area; `least` passes over NaN on the left.
        least_squared = least(squared[0], squared[1], squared[2], squared[3], squared[4]);
    }
    [[nodiscard]] ABUT_HD constexpr vec3<F> shortest() const {
        vec3<F> r = way[4];
        for (int i = 0; i < 4; ++i) {
            if (squared[i] == least_squared) r = way[i];
        }
        return r;
    }
};

/// Whether the axis crosses the face, by signs of numbers that are wrong by `bound` at most.
template <scalar F>
ABUT_HD constexpr bool axis_crosses(const capsule_frame<F>& f, F bound) {
    const vec3<F> n = cross(f.p[1] - f.p[0], f.p[2] - f.p[0]);
    const F from = dot(n, f.p[0]), to = dot(n, f.q[0]);
    if (!(least(from, to) < -bound && greatest(from, to) > bound)) return false;
    const F x = dot(cross(f.p[0], f.p[1]), f.d), y = dot(cross(f.p[1], f.p[2]), f.d), z = dot(cross(f.p[2], f.p[0]), f.d);
    return least(x, y, z) > bound || greatest(x, y, z) < -bound;
}

/// `separates`, with the direction's sign chosen.
template <class... Points>
ABUT_HD constexpr bool either_separates(const vec3<double>& g, double reach, double tiny, const vec3<double>& a,
                                        const Points&... rest) {
    return separates(dot(g, a) < 0 ? vec3<double>{-g.x, -g.y, -g.z} : g, reach, tiny, a, rest...);
}

template <scalar T>
ABUT_HD constexpr verdict certified_capsule(const capsule<T>& s, const triangle<T>& t) {
    constexpr double tiny = std::same_as<T, float> ? 0x1p-213 : 0x1p-1000;
    const capsule_frame<double> f{{relative_to(s.axis.a, t.a), relative_to(s.axis.a, t.b), relative_to(s.axis.a, t.c)},
                                  {relative_to(s.axis.b, t.a), relative_to(s.axis.b, t.b), relative_to(s.axis.b, t.c)},
                                  relative_to(s.axis.a, s.axis.b)};
    const auto &p = f.p, &q = f.q;
    const double r = static_cast<double>(s.radius), rr = r * r;
    const double p0 = dot(p[0], p[0]), p1 = dot(p[1], p[1]), p2 = dot(p[2], p[2]);
    const double q0 = dot(q[0], q[0]), q1 = dot(q[1], q[1]), q2 = dot(q[2], q[2]);
    const double mm = greatest(p0, p1, p2, q0, q1, q2);
    if (std::same_as<T, double> && !(mm < 0x1p480 && rr < 0x1p480)) return verdict::unknown;
    if ((1 + 0x1p-40) * least(p0, p1, p2, q0, q1, q2) + tiny <= rr) return verdict::yes;
    const double reach = (1 + 0x1p-29) * rr + (0x1p-66 * mm + tiny);
    const vec3<double> g = (p[0] + p[1] + p[2]) + (q[0] + q[1] + q[2]);
    if (separates(g, reach, tiny, p[0], p[1], p[2], q[0], q[1], q[2])) return verdict::no;

    constexpr double lost = std::same_as<T, float> ? 0x1p-120 : 0x1p-1010, unit = std::same_as<T, float> ? 0x1p-120 : 1;
    const double size = magnitudes(p[0]) + magnitudes(p[1]) + magnitudes(p[2]) + magnitudes(f.d);
    if (axis_crosses(f, 0x1p-46 * (size * size * size) + lost * ((size + unit) * (size + unit)))) return verdict::yes;

    const short_ways<double> ways(f, cross(p[1] - p[0], p[2] - p[0]));
    if ((1 + 0x1p-29) * ways.least_squared + (0x1p-64 * mm + tiny) <= rr) return verdict::yes;
    if (separates(ways.shortest(), reach, tiny, p[0], p[1], p[2], q[0], q[1], q[2])) return verdict::no;
    // As for a face in certified_ball.hpp: directions that stay exact where the way is short.
    const vec3<double> e[3] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    const vec3<double> normals[4] = {cross(e[0], e[1]), cross(f.d, e[0]), cross(f.d, e[1]), cross(f.d, e[2])};
    for (const vec3<double>& n : normals) {
        if (either_separates(n, reach, tiny, p[0], p[1], p[2], q[0], q[1], q[2])) return verdict::no;
    }
    return verdict::unknown;
}

/// `fast`
template <scalar T>
ABUT_HD constexpr bool approximate_capsule(const capsule<T>& s, const triangle<T>& t) {
    const capsule_frame<T> f{{t.a - s.axis.a, t.b - s.axis.a, t.c - s.axis.a},
                             {t.a - s.axis.b, t.b - s.axis.b, t.c - s.axis.b},
                             s.axis.b - s.axis.a};
    const auto &p = f.p, &q = f.q;
    const T rr = s.radius * s.radius;
    if (least(dot(p[0], p[0]), dot(p[1], p[1]), dot(p[2], p[2]), dot(q[0], q[0]), dot(q[1], q[1]), dot(q[2], q[2])) <= rr) {
        return true;
    }
    const vec3<T> g = (p[0] + p[1] + p[2]) + (q[0] + q[1] + q[2]);
    const T m = least(dot(g, p[0]), dot(g, p[1]), dot(g, p[2]), dot(g, q[0]), dot(g, q[1]), dot(g, q[2]));
    if (m > 0 && m * m > rr * dot(g, g)) return false;
    if (axis_crosses(f, T(0))) return true;
    return short_ways<T>(f, cross(p[1] - p[0], p[2] - p[0])).least_squared <= rr;
}

}  // namespace abut::detail
