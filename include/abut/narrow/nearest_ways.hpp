// SPDX-License-Identifier: MIT
#pragma once

// The least way between two shapes that do not touch: from a point of one to a point of the other. Everything is computed in
// double, from differences of corners, one rounded operation after another, as in nearest_point.hpp: the same bits under
// every compiler, flag and device that rounds to nearest and keeps subnormals.
//
// The least way between two hulls of corners that do not meet begins or ends at a corner, or joins two edges inside both.
// So it is the least of these: between two corners, from a corner to a place inside an edge or a face of the other, and
// between two edges where their lines come nearest. Each candidate is a way between two points that are combinations of
// corners with weights in [0, 1]. So none is shorter than the least way but for a few units of roundoff of D, the largest
// distance between a corner of one and a corner of the other.
//
// Nor is the least of them longer by more. Let two edges u and v, no longer than L, lie on lines at a distance g and an
// angle with the sine s, and let c u be some units of roundoff. The product u x v is off by c u |u| |v|, and so the place on
// the first edge by c u g / (|u| s^2), and by c u D / (|u| s) for what else is rounded. The place on the second edge is the
// foot of the first. So the way is longer than g by what is e across it: e is below c u g / s, and also below L s, since no
// place leaves its edge; e^2 is below the product c u g L, and the way below g + c u L / 2. The second part makes e as large
// as c u D, which is as little. Where rounding takes a place that is inside an edge for one beyond its end, the way from the
// end is longer than the least one by the same e. So parallel edges need no special care, and needles none: of the foot on a
// face nearest_point.hpp says the same.

#include <cstddef>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/box_within.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

/// The least way so far, and where it leads: each end by how far it is from a corner. For reports of both ends.
template <scalar T>
struct nearest_way {
    double square = infinity<double>;
    vec3<double> way{};      ///< from a's end to b's
    vec3<T> from_a, from_b;  ///< corners
    vec3<double> to_a{}, to_b{};
};

/// Edge i of a hull, in a unit.
template <scalar T, int N>
ABUT_HD constexpr vec3<double> hull_edge(const corner_hull<T, N>& hull, int i, const length_unit<T>& unit) {
    return way_between(hull.at[i], hull.at[i + 1 == N ? 0 : i + 1], unit);
}

/// What of a hull is asked from each corner of the other: its edges, and its face.
template <scalar T, int N>
struct hull_sides {
    static constexpr int edges = corner_hull<T, N>::edges;
    vec3<double> edge[edges > 0 ? std::size_t{edges} : 1]{};
    double square[edges > 0 ? std::size_t{edges} : 1]{};

    ABUT_HD constexpr hull_sides(const corner_hull<T, N>& hull, const length_unit<T>& unit) {
        for (int i = 0; i < edges; ++i) {
            edge[i] = hull_edge(hull, i, unit);
            square[i] = plain_dot(edge[i], edge[i]);
        }
    }
    [[nodiscard]] ABUT_HD constexpr face_of_edges face() const {
        return {edge[0], {-edge[edges - 1].x, -edge[edges - 1].y, -edge[edges - 1].z}};
    }
};

/// Gathers candidates and keeps the least; of equal ones the first.
template <scalar T>
struct nearest_way_finder {
    length_unit<T> unit;
    nearest_way<T> best{};

    /// From a corner of a to one of b.
    ABUT_HD constexpr void offer_corners(const vec3<T>& p, const vec3<T>& q, const vec3<double>& way) {
        const double square = plain_dot(way, way);
        if (square < best.square) best = {square, way, p, q, {}, {}};
    }
    /// From a corner p of one, which is b if `Reversed`, to an edge of the other, inside it; `seen` is where the edge
    /// begins.
    template <bool Reversed>
    ABUT_HD constexpr void offer_edge(const vec3<T>& p, const vec3<double>& seen, const vec3<double>& edge,
                                      double edge_square) {
        const double along = -plain_dot(seen, edge);
        if (along > 0 && along < edge_square) offer_foot<Reversed>(p, plain_step(seen, along / edge_square, edge));
    }
    /// To a face of the other; `seen` is the corner where its edges begin.
    template <bool Reversed>
    ABUT_HD constexpr void offer_face(const vec3<T>& p, const vec3<double>& seen, const face_of_edges& face) {
        vec3<double> foot{};
        if (face.has_foot(seen, foot)) offer_foot<Reversed>(p, foot);
    }
    /// To any point of the other.
    template <bool Reversed>
    ABUT_HD constexpr void offer_foot(const vec3<T>& p, const vec3<double>& foot) {
        const double square = plain_dot(foot, foot);
        if (!(square < best.square)) return;
        if constexpr (Reversed) {
            best = {square, {-foot.x, -foot.y, -foot.z}, p, p, foot, {}};
        } else {
            best = {square, foot, p, p, {}, foot};
        }
    }
    /// Between an edge u of a from p and an edge v of b from q, inside both; `step` is the way from p to q.
    ABUT_HD constexpr void offer_edges(const vec3<T>& p, const vec3<double>& u, const vec3<T>& q, const vec3<double>& v,
                                       const vec3<double>& step) {
        const vec3<double> n = plain_cross(u, v);
        const double nn = plain_dot(n, n), along_u = plain_dot(plain_cross(step, v), n);
        if (!(along_u > 0 && along_u < nn)) return;
        const double along_v = plain_dot(plain_cross(step, u), n);
        if (!(along_v > 0 && along_v < nn)) return;
        const double s = along_u / nn;
        const vec3<double> rest = plain_step(step, -s, u);
        const double foot = -plain_dot(rest, v) / plain_dot(v, v), t = foot > 0 ? least(foot, 1.0) : 0;
        const vec3<double> way = plain_step(rest, t, v);
        const double square = plain_dot(way, way);
        if (square < best.square) best = {square, way, p, q, times(s, u), times(t, v)};
    }

private:
    ABUT_HD static constexpr vec3<double> times(double s, const vec3<double>& v) {
        return {plain_product(s, v.x), plain_product(s, v.y), plain_product(s, v.z)};
    }
};

/// Between two hulls that do not meet.
template <scalar T, int N, int M>
ABUT_HD constexpr nearest_way<T> nearest_way_between(const corner_hull<T, N>& a, const corner_hull<T, M>& b,
                                                     const length_unit<T>& unit) {
    nearest_way_finder<T> found{unit};
    const hull_sides<T, N> of_a(a, unit);
    const hull_sides<T, M> of_b(b, unit);
    vec3<double> step[std::size_t{N}][std::size_t{M}]{}, back[std::size_t{N}][std::size_t{M}]{};
    for (int i = 0; i < N; ++i) {
        for (int j = 0; j < M; ++j) {
            step[i][j] = way_between(a.at[i], b.at[j], unit);
            back[i][j] = {-step[i][j].x, -step[i][j].y, -step[i][j].z};
            found.offer_corners(a.at[i], b.at[j], step[i][j]);
        }
    }
    for (int i = 0; i < N; ++i) {
        for (int j = 0; j < b.edges; ++j) {
            found.template offer_edge<false>(a.at[i], step[i][j], of_b.edge[j], of_b.square[j]);
        }
    }
    for (int j = 0; j < M; ++j) {
        for (int i = 0; i < a.edges; ++i) {
            found.template offer_edge<true>(b.at[j], back[i][j], of_a.edge[i], of_a.square[i]);
        }
    }
    for (int j = 0; j < b.edges; ++j) {
        for (int i = 0; i < a.edges; ++i) found.offer_edges(a.at[i], of_a.edge[i], b.at[j], of_b.edge[j], step[i][j]);
    }
    if constexpr (M == 3) {
        const face_of_edges face = of_b.face();
        for (int i = 0; i < N; ++i) found.template offer_face<false>(a.at[i], step[i][0], face);
    }
    if constexpr (N == 3) {
        const face_of_edges face = of_a.face();
        for (int j = 0; j < M; ++j) found.template offer_face<true>(b.at[j], back[0][j], face);
    }
    return found.best;
}

/// Between a solid box and a hull that do not meet.
template <scalar T, int M>
ABUT_HD constexpr nearest_way<T> nearest_way_between(const aabb<T>& box, const corner_hull<T, M>& b,
                                                     const length_unit<T>& unit) {
    nearest_way_finder<T> found{unit};
    const hull_sides<T, M> of_b(b, unit);
    const auto corner = [&](int i) {
        return vec3<T>{(i & 1) != 0 ? box.upper.x : box.lower.x, (i & 2) != 0 ? box.upper.y : box.lower.y,
                       (i & 4) != 0 ? box.upper.z : box.lower.z};
    };
    for (int j = 0; j < M; ++j) {
        found.template offer_foot<true>(b.at[j], held(vec3<double>{0, 0, 0}, box, b.at[j], unit));
    }
    for (int i = 0; i < 8; ++i) {
        const vec3<T> p = corner(i);
        vec3<double> seen[std::size_t{M}]{};
        for (int j = 0; j < M; ++j) seen[j] = way_between(p, b.at[j], unit);
        for (int j = 0; j < b.edges; ++j) found.template offer_edge<false>(p, seen[j], of_b.edge[j], of_b.square[j]);
        for (int axis = 1; axis < 8; axis *= 2) {  // the edges that begin there
            if ((i & axis) != 0) continue;
            const vec3<double> u = way_between(p, corner(i | axis), unit);
            for (int j = 0; j < b.edges; ++j) found.offer_edges(p, u, b.at[j], of_b.edge[j], seen[j]);
        }
        if constexpr (M == 3) found.template offer_face<false>(p, seen[0], of_b.face());
    }
    return found.best;
}

/// Between two boxes that do not meet: points of both whose coordinates are those of the input.
template <scalar T>
ABUT_HD constexpr nearest_way<T> nearest_way_between(const aabb<T>& a, const aabb<T>& b, const length_unit<T>& unit) {
    nearest_way_finder<T> found{unit};
    const nearest_of_boxes<T> nearest(a, b);
    found.offer_corners(nearest.on_a, nearest.on_b, way_between(nearest.on_a, nearest.on_b, unit));
    return found.best;
}

}  // namespace abut::detail
