// SPDX-License-Identifier: MIT
#pragma once

// The floating-point half of `within` for two hulls of two or three corners: plain arithmetic in the input's type (`fast`),
// and in double with certificates that are never wrong (`filtered`). A point and a hull are for certified_ball.hpp, of which
// this is the continuation: the same two certificates, for ways between two hulls.
//
// Corners are seen from the first one of a. v are the true ones and w the computed ones; u = 2^-52, so that every bound
// holds in each rounding mode, with and without contraction; M = max |v|. Differences of inputs round once: |w - v| <= u
// |v|.
//
// Apart. For any g the hulls are at least min g . b - max g . a apart, times 1 / |g|. A computed g . w is within 5u |g| M of
// g . v, and the difference of two within 13u |g| M. With m the computed one, they are farther apart than r where
// m > (r + 13uM) |g|, and
//     (r + 13uM)^2 <= (1 + 2^-30) r^2 + 2^-66.5 M^2    by (x + y)^2 <= (1 + e) x^2 + (1 + 1/e) y^2.
// The code takes 2^-29 and 2^-65, which pays for rounding both sides, and for what is flushed (below).
//
// Near. A way q is a difference of a combination of the w of b and one of those of a, whose weights, as they stand in their
// registers, are >= 0 and sum to 1 within 4u. From an edge to an edge, q = (p + m e) - l d with m and l in [0, 1], where p
// leads from corner to corner and d and e are edges, none longer than 2M. Rounding p (2uM, and 2uM from its ends), e (4uM),
// m e (2uM), their sum (2uM), d (4uM), l d (2uM) and q (2uM) comes to 20uM. From a corner to a face, with the three corners
// seen from the first: these (4uM), their differences (2uM), the products (4uM), the sums (4uM) and the sum of the weights
// (8uM) come to 22uM. So the hulls have points x and y with
//     |x - y|^2 <= (|q| + 22uM)^2 <= (1 + 2^-31) |q|^2 + 2^-64 M^2.
// The code takes 2^-29 and 2^-62. The radius r is a sum of three numbers, rounded: that is below 4u r.
//
// Crossing hulls are told by the signs of certified_triangles.hpp.
//
// Overflow is as in certified_ball.hpp, and so is underflow, with other numbers: a float that is flushed before it becomes a
// double takes less than 2^-126 from each coordinate and from both radii, so that a distance less r is off by less than 10
// 2^-126. In the square of a sum of that and of an error above, each counts twice: with the factor 1 + 1/e that is less than
// 2^-213. `tiny` is more. NaN makes every comparison false.

#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/certified_capsule.hpp>
#include <abut/predicate/exact_within.hpp>
#include <abut/shape/core.hpp>

namespace abut::detail {

/// The corners of two hulls, seen from the first one; and what lengths are compared with. F is the input's type (`fast`), or
/// double.
template <bool Certified, scalar F, int N, int M>
struct two_hulls {
    vec3<F> a[std::size_t{N}], b[std::size_t{M}];
    F squared_radius, reach, lost;  ///< `reach` is for certificates of "apart", `lost` for those of "near"
    F tiny;
    bool in_range = true;

    template <scalar T>
    ABUT_HD constexpr two_hulls(const corner_hull<T, N>& from, const corner_hull<T, M>& to, F radius)
        : a{}, b{}, squared_radius(radius * radius), reach(squared_radius), lost(0), tiny(0) {
        const vec3<T> origin = from.at[0];
        for (int i = 0; i < N; ++i) a[i] = seen(from.at[i], origin);
        for (int j = 0; j < M; ++j) b[j] = seen(to.at[j], origin);
        if constexpr (Certified) {
            tiny = std::same_as<T, float> ? 0x1p-210 : 0x1p-1000;
            double mm = 0;
            for (const vec3<F>& w : a) mm = greatest(mm, dot(w, w));
            for (const vec3<F>& w : b) mm = greatest(mm, dot(w, w));
            in_range = std::same_as<T, float> || (mm < 0x1p480 && squared_radius < 0x1p480);
            reach = (1 + 0x1p-29) * squared_radius + (0x1p-65 * mm + tiny);
            lost = 0x1p-62 * mm + tiny;
        }
    }

    /// Whether a way of this square tells that the hulls are near.
    [[nodiscard]] ABUT_HD constexpr bool is_short(F square) const {
        if constexpr (Certified) {
            return (1 + 0x1p-29) * square + lost <= squared_radius;
        } else {
            return square <= squared_radius;
        }
    }
    /// Whether the direction g tells that b is beyond reach of a.
    [[nodiscard]] ABUT_HD constexpr bool is_beyond(const vec3<F>& g) const {
        F most = dot(g, a[0]), least_of_b = dot(g, b[0]);
        for (int i = 1; i < N; ++i) most = greatest(most, dot(g, a[i]));
        for (int j = 1; j < M; ++j) least_of_b = least(least_of_b, dot(g, b[j]));
        const F gap = least_of_b - most;
        if constexpr (Certified) {
            return gap > 0 && gap * gap > reach * (dot(g, g) + tiny) + 0x1p-1000;
        } else {
            return gap > 0 && gap * gap > reach * dot(g, g);
        }
    }
    /// The same of g or of its opposite.
    [[nodiscard]] ABUT_HD constexpr bool is_beyond_either(const vec3<F>& g) const {
        return is_beyond(dot(g, b[0] - a[0]) < 0 ? vec3<F>{-g.x, -g.y, -g.z} : g);
    }

private:
    template <scalar T>
    ABUT_HD static constexpr vec3<F> seen(const vec3<T>& p, const vec3<T>& origin) {
        if constexpr (Certified) {
            return relative_to(origin, p);
        } else {
            return p - origin;
        }
    }
};

template <scalar F, std::size_t N>
ABUT_HD constexpr vec3<F> normal_of(const vec3<F> (&at)[N]) {
    return cross(at[1] - at[0], at[2] - at[0]);
}

/// What a few directions and the corners tell: most pairs that a walk meets.
template <bool Certified, scalar F, int N, int M>
ABUT_HD constexpr verdict near_by_corners(const two_hulls<Certified, F, N, M>& both) {
    if (!both.in_range) return verdict::unknown;
    vec3<F> sum_a = both.a[0], sum_b = both.b[0], shortest = both.b[0] - both.a[0];
    for (int i = 1; i < N; ++i) sum_a = sum_a + both.a[i];
    for (int j = 1; j < M; ++j) sum_b = sum_b + both.b[j];
    if (both.is_beyond(static_cast<F>(N) * sum_b - static_cast<F>(M) * sum_a)) return verdict::no;
    F square = dot(shortest, shortest);
    for (int i = 0; i < N; ++i) {
        for (int j = 0; j < M; ++j) {
            const vec3<F> way = both.b[j] - both.a[i];
            const F length = dot(way, way);
            const bool is_shorter = length < square;
            square = is_shorter ? length : square;
            shortest = is_shorter ? way : shortest;
        }
    }
    if (both.is_short(square)) return verdict::yes;
    if (both.is_beyond(shortest)) return verdict::no;
    if constexpr (N == 3) {
        if (both.is_beyond_either(normal_of(both.a))) return verdict::no;
    }
    if constexpr (M == 3) {
        if (both.is_beyond_either(normal_of(both.b))) return verdict::no;
    }
    return verdict::unknown;
}

/// The shortest of ways from a to b: where the hulls do not cross, one is as short as any but for rounding.
template <scalar F>
struct shortest_way {
    vec3<F> way{};
    F square = infinity<F>;

    ABUT_HD constexpr void offer(const vec3<F>& other) {
        const F length = dot(other, other);
        const bool is_shorter = length < square;
        square = is_shorter ? length : square;
        way = is_shorter ? other : way;
    }
};

/// From a corner of a hull to the face of the other one, for each corner; `Sign` is -1 where that is a.
template <int Sign, scalar F, std::size_t N>
ABUT_HD constexpr void offer_ways_to_face(shortest_way<F>& found, vec3<F> (&corners)[N], const vec3<F> (&face)[3]) {
    const vec3<F> normal = normal_of(face);
    ABUT_ROLLED
    for (int i = 0; i < int{N}; ++i) {
        const vec3<F> p[3] = {face[0] - corners[0], face[1] - corners[0], face[2] - corners[0]};
        found.offer(F(Sign) * end_to_face(normal, p));
        turn(corners);
    }
}

/// What all pairs of features tell, where the hulls do not cross.
template <bool Certified, scalar F, int N, int M>
ABUT_HD constexpr verdict near_by_ways(two_hulls<Certified, F, N, M> both) {
    if (!both.in_range) return verdict::unknown;
    shortest_way<F> found;
    ABUT_ROLLED
    for (int i = 0; i < (N == 3 ? 3 : 1); ++i) {
        const vec3<F> d = both.a[1] - both.a[0];
        const F dd = dot(d, d);
        ABUT_ROLLED
        for (int j = 0; j < M; ++j) {
            if (has_new_edge<M>(j)) found.offer(axis_to_edge(d, dd, both.b[0] - both.a[0], both.b[1] - both.b[0]));
            turn(both.b);
        }
        turn(both.a);
    }
    if constexpr (M == 3) offer_ways_to_face<1>(found, both.a, both.b);
    if constexpr (N == 3) offer_ways_to_face<-1>(found, both.b, both.a);
    if (both.is_short(found.square)) return verdict::yes;
    if constexpr (!Certified) return verdict::no;
    if (both.is_beyond(found.way)) return verdict::no;
    // Directions that stay exact where the way is short.
    ABUT_ROLLED
    for (int i = 0; i < N; ++i) {
        ABUT_ROLLED
        for (int j = 0; j < M; ++j) {
            if (both.is_beyond_either(cross(both.a[1] - both.a[0], both.b[1] - both.b[0]))) return verdict::no;
            turn(both.b);
        }
        turn(both.a);
    }
    return verdict::unknown;
}

}  // namespace abut::detail
