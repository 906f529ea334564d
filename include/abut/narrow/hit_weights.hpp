// SPDX-License-Identifier: MIT
#pragma once

// Where in a triangle a ray or a segment meets it: barycentric weights of the point at a time of narrow/hit_time.hpp. In
// double, in one order of operations; nothing is decided by them.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/narrow/length_unit.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Of a point w, and of edges u and v, as seen from the corner a: 0 or more each, and 1 in all but for rounding. By the
/// projection onto the plane; beside the triangle, or where it has no area, of the nearest point of its rim.
ABUT_HD constexpr vec3<double> weights_of_point(const vec3<double>& w, const vec3<double>& u, const vec3<double>& v) {
    const vec3<double> n = plain_cross(u, v);
    const double area = plain_dot(n, n);
    if (area > 0) {
        const double r = plain_dot(n, plain_cross(w, v)) / area, s = plain_dot(n, plain_cross(u, w)) / area;
        const double rest = plain_sum(1.0, -plain_sum(r, s));
        if (r >= 0 && s >= 0 && rest >= 0) return {rest, r, s};
    }
    vec3<double> best{1, 0, 0};
    double square = plain_dot(w, w);
    const auto offer = [&](const vec3<double>& from, const vec3<double>& edge, int first, int second) {
        const double length = plain_dot(edge, edge);
        const double share = length > 0 ? plain_dot(from, edge) / length : 0, part = share > 0 ? (share < 1 ? share : 1) : 0;
        const vec3<double> away = plain_step(from, -part, edge);
        const double of_this = plain_dot(away, away);
        if (!(of_this < square)) return;
        square = of_this;
        double weights[3] = {0, 0, 0};
        weights[first] = plain_sum(1.0, -part);
        weights[second] = part;
        best = {weights[0], weights[1], weights[2]};
    };
    offer(w, u, 0, 1);
    offer(w, v, 0, 2);
    offer(plain_difference(w, u), plain_difference(v, u), 1, 2);
    return best;
}

/// Of the corners a, b, c, where the line is at that time.
template <class Line, scalar T>
ABUT_HD constexpr vec3<T> hit_weights(const Line& line, const triangle<T>& t, double time) {
    const line_of<T> l(line);
    const auto unit = unit_for(merge(bounds(t), aabb<T>{l.origin, l.origin}), l.end);
    const vec3<double> from = way_between(t.a, l.origin, unit), along = way_between(l.start, l.end, unit);
    const vec3<double> w =
        weights_of_point(plain_step(from, time, along), way_between(t.a, t.b, unit), way_between(t.a, t.c, unit));
    return {static_cast<T>(w.x), static_cast<T>(w.y), static_cast<T>(w.z)};
}

}  // namespace abut::detail
