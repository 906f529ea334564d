// SPDX-License-Identifier: MIT
#pragma once

// What a few directions tell of when a shape on its way touches a triangle: not before some time, and by some other one. A
// search (sweep_search.hpp) tells more. This one calls nothing and keeps nothing in memory, so a walk through a tree asks it
// first.
//
// A ball or a capsule touches the triangle by the time at which one of the ends of its core is within its radius of a point
// of the triangle. That is compared with room for rounding at a time and a point that only have to be near the right ones.
// Let u = 2^-53 and s the largest number, of is_searched(): coordinates there are off by less than 2^-48 s.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_search.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/swept.hpp>

namespace abut::detail {

/// Along a direction n, differences of points are off by this share of |n| and the largest coordinate, as sweep_search.hpp
/// says.
inline constexpr double share_of_sweeps = 0x1p-46;

/// Until when points that go along a way are apart from a triangle by more than r, for certain; infinity if that is later
/// than `until`. The triangle then lies beyond one of its sides as seen along the way, or before or behind its plane. Nearly
/// always it does where boxes alone are near each other. All points are seen from one of those that go; `size` is the
/// largest coordinate.
template <class Points>
ABUT_HD constexpr double apart_from_triangle(const Points& a, const vec3<double> (&p)[3], const vec3<double>& way, double r,
                                             double size, double until) {
    using namespace contact_math;
    double apart = 0;
    const auto look_along = [&](const vec3<double>& n) {
        const double of_n = root(one_double{plain_dot(n, n)}).high;
        if (!(of_n > 0x1p-600)) return false;
        const double b[3] = {plain_dot(n, p[0]), plain_dot(n, p[1]), plain_dot(n, p[2])};
        double least_a = infinity<double>, most_a = -infinity<double>;
        for (std::uint32_t i = 0; i < a.size(); ++i) {
            const double x = plain_dot(n, a[i]);
            least_a = least(least_a, x), most_a = greatest(most_a, x);
        }
        const double off = plain_product(plain_product(share_of_sweeps, of_n), size),
                     away = plain_sum(plain_product(r, of_n), off), speed = plain_dot(n, way);
        const double ahead = plain_sum(plain_sum(least(b[0], b[1], b[2]), -most_a), -away),
                     behind = plain_sum(plain_sum(least_a, -greatest(b[0], b[1], b[2])), -away);
        const double gap = greatest(ahead, behind), nearer = ahead > 0 ? speed : -speed;
        if (!(gap > 0)) return false;
        if (plain_sum(gap, -plain_product(until, nearer)) > 0) return true;
        apart = greatest(apart, plain_product(gap / plain_sum(nearer, off), 1 - 0x1p-50));
        return false;
    };
    const vec3<double> e = plain_difference(p[1], p[0]), f = plain_difference(p[2], p[0]);
    const bool passes = look_along(plain_cross(way, e)) || look_along(plain_cross(way, plain_difference(p[2], p[1]))) ||
                        look_along(plain_cross(way, f)) || look_along(plain_cross(e, f));
    return passes ? infinity<double> : apart;
}

/// The corners of a core, as seen from the first of them.
template <int N>
struct corners_on_way {
    vec3<double> at[std::size_t{N}];
    [[nodiscard]] ABUT_HD static constexpr std::uint32_t size() { return N; }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& operator[](std::uint32_t i) const { return at[i]; }
};

/// Between which times a ball or a capsule touches a triangle: not before the first, and by the last, which is infinite if
/// that is not known. Negative ones where it does not by `until`.
template <has_radius S, scalar T>
    requires(corners_of_core<S> > 0)
ABUT_HD constexpr time_bounds plain_sweep_bounds(const swept<S>& s, const triangle<T>& t, double until) {
    using namespace contact_math;
    constexpr int corners = corners_of_core<S>;
    const auto core = core_points_of(s.start);
    const hull<T>& c = core.as_hull();
    const point from = widened(c[0]), way = widened(s.way);
    corners_on_way<corners> a{};
    for (int i = 0; i < corners; ++i) a.at[i] = plain_difference(widened(c[static_cast<std::size_t>(i)]), from);
    const point p[3] = {plain_difference(widened(t.a), from), plain_difference(widened(t.b), from),
                        plain_difference(widened(t.c), from)};
    const double r = static_cast<double>(s.start.radius);
    double size = greatest(greatest(largest_of(p[0]), largest_of(p[1]), largest_of(p[2])), largest_of(way), r);
    for (const point& x : a.at) size = greatest(size, largest_of(x));
    if (!is_searched(size)) return {0, infinity<double>};
    const double first = apart_from_triangle(a, p, way, r, size, until);
    if (first == infinity<double>) return {-1, -1};

    // The end that is nearest to the plane, when it comes to it, and the point of the triangle that is about nearest to it
    // then.
    const point e = plain_difference(p[1], p[0]), f = plain_difference(p[2], p[0]), across = plain_cross(e, f);
    const double nn = plain_dot(across, across), height = plain_dot(across, p[0]);
    const bool is_ahead = plain_sum(height, -plain_dot(across, a[corners - 1])) + height > 0;
    point end = a[0];
    double over = height;
    for (int i = 1; i < corners; ++i) {
        const double x = plain_sum(height, -plain_dot(across, a.at[i]));
        if (is_ahead ? x < over : x > over) end = a.at[i], over = x;
    }
    const double speed = plain_dot(across, way), reach = plain_product(r, root(one_double{nn}).high);
    const double at_plane = greatest(plain_sum(over, is_ahead ? -reach : reach) / speed, 0.0);
    const point seen = plain_difference(plain_step(end, at_plane, way), p[0]);
    double along_e = greatest(plain_dot(across, plain_cross(seen, f)) / nn, 0.0),
           along_f = greatest(plain_dot(across, plain_cross(e, seen)) / nn, 0.0);
    const double sum = plain_sum(along_e, along_f);
    if (sum > 1) along_e = along_e / sum, along_f = along_f / sum;
    const point met = plain_step(plain_step(p[0], along_e, e), along_f, f), to = plain_difference(met, end);
    // When the ball around that end comes to that point.
    const double inner = plain_sum(r, -plain_product(0x1p-40, size)), rr = plain_product(inner, inner),
                 ww = plain_dot(way, way), wp = plain_dot(way, to), outside = plain_sum(plain_dot(to, to), -rr);
    const point moment = plain_cross(way, to);
    const double root_of =
        root(one_double{greatest(plain_sum(plain_product(rr, ww), -plain_dot(moment, moment)), 0.0)}).high;
    const double time = outside > 0 ? outside / plain_sum(wp, root_of) : 0;
    const point left = plain_step(to, -time, way);
    const bool touches = inner > 0 && time >= 0 && time <= 1 && along_e >= 0 && along_f >= 0 &&
                         plain_dot(left, left) <= plain_product(rr, 1 + 0x1p-42);
    return {first, touches ? time : infinity<double>};
}

}  // namespace abut::detail
