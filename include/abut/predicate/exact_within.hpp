// SPDX-License-Identifier: MIT
#pragma once

// The exact half of `within`: are two hulls of up to three points no farther apart than a number? That number is a sum of
// three (two radii and a distance), which is made in the number type that decides.
//
// An OR over pairs of features: the corners, the insides of the edges and the inside of the face. Let x and y be as near to
// each other as any points of the hulls are, each in the inside of one feature. As exact_capsule.hpp says, there is such a
// pair whose features have no common direction, and then x and y are each other's orthogonal feet, or one of them is an
// edge's crossing of a face. So six kinds of pairs are left: two corners; a corner and an edge; a corner and a face; two
// edges that are not parallel; and an edge through a face, either way. Each question is answered yes only where there are
// two points that are so near. Degenerate hulls need no case of their own: a feature without extent has no inside.

#include <cstddef>

#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/sparse_sum.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_int.hpp>
#include <abut/predicate/exact_ball.hpp>
#include <abut/predicate/exact_capsule.hpp>

namespace abut::detail {

// Loops turn the corners, so that each turn looks at the first ones: they stay in a device's registers.

template <class V>
ABUT_HD constexpr void turn(V (&)[1]) {}
template <class V>
ABUT_HD constexpr void turn(V (&at)[2]) {
    const V first = at[0];
    at[0] = at[1];
    at[1] = first;
}
template <class V>
ABUT_HD constexpr void turn(V (&at)[3]) {
    rotate(at[0], at[1], at[2]);
}

/// Whether turn `i` brings an edge to the front that was not there before.
template <int N>
ABUT_HD constexpr bool has_new_edge(int i) {
    return N == 3 || (N == 2 && i == 0);
}

/// The first corners, and the edges from these to the second ones where they are meant.
template <class Number, class R, std::size_t N, std::size_t M>
ABUT_HD constexpr bool near_at_first_corners(const vec3<Number> (&a)[N], const vec3<Number> (&b)[M], const R& r,
                                             [[maybe_unused]] bool edge_of_a, [[maybe_unused]] bool edge_of_b) {
    const auto p = b[0] - a[0];
    if (vertex_in_ball(p, r)) return true;
    if constexpr (M > 1) {
        if (edge_of_b && edge_in_ball(p, b[1] - a[0], b[1] - b[0], r)) return true;
    }
    if constexpr (N > 1) {
        if (edge_of_a && edge_in_ball(a[0] - b[0], a[1] - b[0], a[1] - a[0], r)) return true;
    }
    if constexpr (N > 1 && M > 1) {
        return edge_of_a && edge_of_b && lines_within(a[1] - a[0], b[1] - b[0], p, b[1] - a[0], b[0] - a[1], r);
    }
    return false;
}

/// The corners and the edges of one hull, and the face of the other.
template <class Number, class R, std::size_t N>
ABUT_HD constexpr bool near_at_face(vec3<Number> (&a)[N], const vec3<Number> (&face)[3], const R& r) {
    const auto normal = cross(face[1] - face[0], face[2] - face[1]);
    bool near = false;
    ABUT_ROLLED
    for (int i = 0; i < int{N}; ++i) {
        if (!near) {
            using difference = decltype(face[0] - a[0]);
            const difference p[3] = {face[0] - a[0], face[1] - a[0], face[2] - a[0]};
            near = face_in_ball(p[0], p[1], p[2], normal, r);
            if constexpr (N > 1) {
                near = near || (has_new_edge<int{N}>(i) && crosses_face(a[1] - a[0], p, face[0] - a[1]));
            }
        }
        turn(a);
    }
    return near;
}

/// N corners, then M; two radii and a distance.
template <int N, int M>
struct hulls_within {
    static constexpr int degree = N + M == 2 ? 2 : N + M == 3 ? 4 : 6, points = N + M;

    template <class Number>
    ABUT_HD static constexpr bool holds(const Number (&value)[std::size_t{3 * (N + M) + 3}]) {
        vec3<Number> a[std::size_t{N}]{}, b[std::size_t{M}]{};
        for (int i = 0; i < N; ++i) a[i] = point_at(value, i);
        for (int j = 0; j < M; ++j) b[j] = point_at(value, N + j);
        const auto r = (value[3 * (N + M)] + value[3 * (N + M) + 1]) + value[3 * (N + M) + 2];
        ABUT_ROLLED
        for (int i = 0; i < N; ++i) {
            ABUT_ROLLED
            for (int j = 0; j < M; ++j) {
                if (near_at_first_corners(a, b, r, has_new_edge<N>(i), has_new_edge<M>(j))) return true;
                turn(b);
            }
            turn(a);
        }
        if constexpr (M == 3) {
            if (near_at_face(a, b, r)) return true;
        }
        if constexpr (N == 3) {
            if (near_at_face(b, a, r)) return true;
        }
        return false;
    }
};

}  // namespace abut::detail
