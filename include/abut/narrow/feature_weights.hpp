// SPDX-License-Identifier: MIT
#pragma once

// Where two moving features touch: barycentric coordinates at a time of impact.

#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/motion.hpp>

namespace abut {

/// Weights of four points, in the order of impact::vertices. Of a vertex and a face: 1 for the vertex, and three that add up
/// to 1 for the corners. Of two edges: two that add up to 1 for the ends of each. None is negative.
struct feature_weights {
    double of[4];  ///< 0 to 1 each
};

namespace detail {

ABUT_HD constexpr double clamped_to_1(double x) { return least(greatest(x, 0.0), 1.0); }

/// Of a vertex: of the point of the face that is nearest to its projection, which where they touch is where it is.
ABUT_HD constexpr feature_weights weights_in_face(const vec3<double>& u, const vec3<double>& v, const vec3<double>& w) {
    const vec3<double> n = cross(u, v);
    const double area = dot(n, n), r = area > 0 ? dot(n, cross(w, v)) / area : -1, s = area > 0 ? dot(n, cross(u, w)) / area : -1;
    if (r >= 0 && s >= 0 && r + s <= 1) return {{1, 1 - r - s, r, s}};
    // On the border, or of a face without an area: on the edge that is nearest.
    const auto part = [](const vec3<double>& from_a, const vec3<double>& edge) {
        const double length = dot(edge, edge);
        return length > 0 ? clamped_to_1(dot(from_a, edge) / length) : 0;
    };
    const auto away = [](const vec3<double>& from_a, const vec3<double>& edge, double t) {
        const vec3<double> d = from_a - t * edge;
        return dot(d, d);
    };
    const double on_u = part(w, u), on_v = part(w, v), on_rest = part(w - u, v - u);
    const double of_u = away(w, u, on_u), of_v = away(w, v, on_v), of_rest = away(w - u, v - u, on_rest);
    if (of_u <= of_v && of_u <= of_rest) return {{1, 1 - on_u, on_u, 0}};
    if (of_v <= of_rest) return {{1, 1 - on_v, 0, on_v}};
    return {{1, 0, 1 - on_rest, on_rest}};
}

}  // namespace detail

/// Where two moving features touch at `time`, which is a time of impact of theirs. The vertex is where the face's corners
/// have it with these weights, or the points of the two edges are one, as far as the time and double precision tell. At
/// another time, or of features that do not touch, the weights are of points that are near each other. On hosts and devices.
///
///     const auto w = abut::weights_at(vertex, face, abut::time_of_impact(vertex, face));
/// @ingroup one_pair
template <class S, class U>
    requires detail::are_features<S, U>
[[nodiscard]] ABUT_HD constexpr feature_weights weights_at(const S& s, const U& t, double time) {
    constexpr bool edges = detail::is_moving_edge<S>;
    const auto p = detail::points_of(s, t);
    const auto at = [&](int i, int j) {
        return detail::in_between(detail::relative_to(p.t0[i], p.t0[j]), detail::relative_to(p.t1[i], p.t1[j]), time);
    };
    if constexpr (edges) {
        const detail::parts_of_edges on = detail::nearest_on_edges(at(0, 1), at(2, 3), at(0, 2));
        return {{1 - on.of_u, on.of_u, 1 - on.of_v, on.of_v}};
    } else {
        return detail::weights_in_face(at(1, 2), at(1, 3), at(1, 0));
    }
}

}  // namespace abut
