// SPDX-License-Identifier: MIT
#pragma once

// What is known of an impact besides when: where, along which normal, how fast.
//
// Bounds, with u = 2^-52. Places at a time are off by 6u M in each coordinate, M the largest coordinate of the features, and
// a sum of such places with weights by 14u M; the weights add up to 1 within 4u. So two such points and their difference are
// off by less than 2^-46 M in length. Of edges scaled to coordinates of 1 at most, those of their cross product are off by
// 36u each, and it by less than 2^-45; of two vectors the directions differ by no more than twice their difference over the
// length of one. A speed is off by 40u D, D the largest coordinate of a way.

#include <concepts>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/narrow/feature_weights.hpp>
#include <abut/predicate/motion.hpp>
#include <abut/shape/outward.hpp>

namespace abut {

/// What is known of two features at a time of impact, in double, also of features in float.
/// @ingroup motion
struct impact_detail {
    /// Weights of the four points, in the order of impact::vertices.
    feature_weights weights;
    /// Where: the vertex, or the point of the first edge that the weights name. It is within 2^-46 of the largest coordinate
    /// of the one that exact arithmetic has.
    vec3<double> point;
    /// No less than how far either feature is from `point` at that time. So it tells how good point and weights are: times
    /// of `filtered` leave what features move in 2^-40 of the step, and edges that are nearly parallel leave more.
    double gap;
    /// Across the face, or across both edges, at that time; of length 1. From the second feature to the first (of queries:
    /// from b to a), so that they come together against it.
    vec3<double> normal;
    /// How long the difference of `normal` from the exact one is at most. 2 if nothing is known of that, as of parallel
    /// edges and faces without an area: then `normal` goes against the relative motion at `point`, or along z where there is
    /// none.
    double normal_error;
    /// How fast the points that the weights name come together along `normal`, 0 or more, in units of coordinates for the
    /// whole step; of the numbers above within 2^-46 of the largest coordinate of the ways.
    double speed;
};

namespace detail {

/// The same direction with length 1; and no direction, where there is none that doubles know.
struct direction_of_one {
    vec3<double> along;
    double length;  ///< of what it was made from

    ABUT_HD constexpr explicit direction_of_one(const vec3<double>& v) : along{0, 0, 0}, length(0) {
        const double size = largest_coordinate(v);
        if (!(size > 0 && size < infinity<double>)) return;
        const vec3<double> w{v.x / size, v.y / size, v.z / size};
        const double of_w = square_root(dot(w, w));
        along = {w.x / of_w, w.y / of_w, w.z / of_w};
        length = of_w * size;
    }
};

}  // namespace detail

/// What is known of two moving features at `time`, a time of impact of theirs. The first is a vertex or an edge. At another
/// time it is of points that are near each other, and `gap` tells how near. For coordinates below 2^1000. On hosts and
/// devices.
///
///     const auto d = abut::details_at(vertex, face, abut::time_of_impact(vertex, face));
/// @ingroup one_pair
template <class S, class U>
    requires detail::are_features<S, U>
[[nodiscard]] ABUT_HD constexpr impact_detail details_at(const S& s, const U& t, double time) {
    using T = scalar_type_of<S>;
    constexpr bool edges = detail::is_moving_edge<S>;
    constexpr int of_first = edges ? 2 : 1;
    constexpr double smallest = std::same_as<T, float> ? 0x1p-60 : 0x1p-200;  // as motion_filter takes it
    const auto p = detail::points_of(s, t);
    impact_detail found{weights_at(s, t, time), {0, 0, 0}, 0, {0, 0, 0}, 2, 0};

    vec3<double> other{0, 0, 0}, coming{0, 0, 0};
    double size = 0;
    for (int i = 0; i < 4; ++i) {
        const vec3<double> from = detail::widened(p.t0[i]), to = detail::widened(p.t1[i]);
        const double weight = found.weights.of[i];
        const bool first = i < of_first;
        (first ? found.point : other) = (first ? found.point : other) + weight * detail::in_between(from, to, time);
        coming = coming + (first ? weight : -weight) * detail::relative_to(p.t0[i], p.t1[i]);
        size = detail::greatest(detail::largest_coordinate(from), detail::largest_coordinate(to), size);
    }
    constexpr double tiny = std::same_as<T, float> ? 0x1p-120 : 0x1p-1000;
    found.gap = (1 + 0x1p-50) * (detail::length_above(other - found.point) + 0x1p-45 * size + tiny);

    const auto at = [&](int i, int j) {
        const vec3<double> at_t0 = detail::relative_to(p.t0[i], p.t0[j]), at_t1 = detail::relative_to(p.t1[i], p.t1[j]);
        const double one = detail::greatest(detail::largest_coordinate(at_t0), detail::largest_coordinate(at_t1), smallest);
        const vec3<double> there = detail::in_between(at_t0, at_t1, time);
        return vec3<double>{there.x / one, there.y / one, there.z / one};
    };
    const vec3<double> u = at(edges ? 0 : 1, edges ? 1 : 2), v = at(edges ? 2 : 1, 3);
    const detail::direction_of_one across(cross(u, v)), against(-1.0 * coming);
    const double error = 0x1p-44 / across.length + 0x1p-48;
    if (across.length > 0 && error < 1) {
        found.normal = across.along;
        found.normal_error = error;
    } else {
        found.normal = against.length > 0 ? against.along : vec3<double>{0, 0, 1};
    }
    found.speed = -dot(found.normal, coming);
    if (found.speed < 0) found.speed = -found.speed, found.normal = -1.0 * found.normal;
    return found;
}

}  // namespace abut
