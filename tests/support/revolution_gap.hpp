// SPDX-License-Identifier: MIT
#pragma once

// The oracle: the least way between a cylinder or a cone and a hull, or another of them, in 300 bits, by their farthest
// points along directions alone (Gilbert, Johnson and Keerthi). The nearest point of the simplex that was found so far is
// never too near, and what the farthest points say of its direction is never too far, so that the distance lies between the
// two whatever the search does. It shares no formula with the library, which has no directions but
// normals of faces and of sides.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <abut/narrow/distance.hpp>

#include "catch.hpp"
#include "contact_oracles.hpp"
#include "revolution_solid.hpp"

namespace abut::test {

// --- the search -----------------------------------------------------------------------------------------------------------

struct wide_bounds {
    wide lower = 0, upper = 0;
};

/// The point nearest to the origin of the hull of up to four, of which those are left that it needs.
inline wide_point nearest_of(std::vector<wide_point>& w) {
    wide least = -1;
    wide_point nearest{};
    std::vector<wide_point> needed;
    const auto offer = [&](const wide_point& q, std::vector<wide_point> of) {
        const wide square = dot(q, q);
        if (least < 0 || square < least) least = square, nearest = q, needed = std::move(of);
    };
    for (std::size_t i = 0; i < w.size(); ++i) {
        offer(w[i], {w[i]});
        for (std::size_t j = i + 1; j < w.size(); ++j) {
            const wide_point e = w[j] - w[i];
            const wide ee = dot(e, e), s = -dot(e, w[i]);
            if (s > 0 && s < ee) offer(w[i] + (s / ee) * e, {w[i], w[j]});
            for (std::size_t k = j + 1; k < w.size(); ++k) {
                const wide_point f = w[k] - w[i];
                const wide ff = dot(f, f), ef = dot(e, f), t = -dot(f, w[i]), d = ee * ff - ef * ef;
                if (!(d > 0)) continue;
                const wide u = (s * ff - t * ef) / d, v = (t * ee - s * ef) / d;
                if (u > 0 && v > 0 && u + v < 1) offer(w[i] + u * e + v * f, {w[i], w[j], w[k]});
            }
        }
    }
    w = std::move(needed);
    return nearest;
}

inline wide_point farthest_corner(const std::vector<wide_point>& corners, const wide_point& n) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        if (dot(n, corners[i]) > dot(n, corners[best])) best = i;
    }
    return corners[best];
}

/// `farthest` gives the farthest point of t along a direction.
template <class Farthest>
wide_bounds gap_between(const wide_solid& s, const wide_point& of_t, const Farthest& farthest, const wide& size) {
    std::vector<wide_point> simplex{of_t - s.first};
    wide_bounds found{0, length_of(simplex[0])};
    for (int step = 0; step < 200; ++step) {
        const wide_point v = nearest_of(simplex), back{-v.x, -v.y, -v.z};
        const wide length = length_of(v);
        found.upper = std::min(found.upper, length);
        if (!(length > 0)) return found;
        const wide_point w = farthest(back) - s.farthest(v);
        found.lower = std::max<wide>(found.lower, dot(v, w) / length);
        if (found.upper - found.lower <= ldexp(size, -60)) return found;
        simplex.push_back(w);
    }
    return found;
}

/// What is known of two shapes that do not touch: bounds of their distance, and that of their farthest points.
struct wide_gap_of_solid {
    wide_bounds distance;
    wide farthest;
};
template <class S, class U>
wide_gap_of_solid gap_of_solid(const S& s, const U& t) {
    const wide_solid solid = in_bits(s);
    const wide_hull h = hull_of(t);
    wide far = 0;
    for (const wide_point& p : h.corners) far = std::max(far, solid.farthest_from(p));
    far += h.radius;
    const auto farthest = [&](const wide_point& n) { return farthest_corner(h.corners, n); };
    const wide_bounds gap = gap_between(solid, h.corners[0], farthest, far);
    return {{gap.lower - h.radius, gap.upper - h.radius}, far};
}
/// Of two solids; of their farthest points, no more than that.
template <detail::solid_of_revolution S, detail::solid_of_revolution U>
wide_gap_of_solid gap_of_solid(const S& s, const U& t) {
    const wide_solid a = in_bits(s), b = in_bits(t);
    wide far = 0;
    const wide_point way = b.first - a.first,
                     round{a.d.y * b.d.z - a.d.z * b.d.y, a.d.z * b.d.x - a.d.x * b.d.z, a.d.x * b.d.y - a.d.y * b.d.x};
    for (const wide_point& n : {way, a.d, b.d, round}) {
        const wide_point back{-n.x, -n.y, -n.z};
        for (const wide_point& along : {n, back}) {
            if (length_of(along) > 0) far = std::max(far, a.farthest_from(b.farthest(along)));
        }
    }
    return {gap_between(
                a, b.first, [&](const wide_point& n) { return b.farthest(n); }, far),
            far};
}
template <class S, scalar T>
wide_gap_of_solid gap_of_solid(const S& s, const plane<T>& p) {
    const wide_solid solid = in_bits(s);
    const wide_point n = widest(p.normal), back{-n.x, -n.y, -n.z};
    const wide high = dot(n, solid.farthest(n)) - wide(p.offset), low = dot(n, solid.farthest(back)) - wide(p.offset);
    const wide gap = std::max<wide>(low, -high) / length_of(n);
    return {{gap, gap}, solid.farthest_from({0, 0, 0}) + gap};
}

template <class S>
wide distance_from_shape(const wide_point& x, const S& s) {
    if constexpr (detail::solid_of_revolution<S>) {
        return distance_from_solid(x, in_bits(s));
    } else if constexpr (requires { s.normal; }) {
        return abs(dot(widest(s.normal), x) - wide(s.offset)) / length_of(widest(s.normal));
    } else {
        return distance_from(x, s);
    }
}

// --- what has to hold -----------------------------------------------------------------------------------------------------

/// Worst figures, in units of 2^-53 of the distance of the farthest points; of shared points as a share of contact_bound.
struct gap_tally {
    std::uint64_t pairs = 0, touching = 0, open = 0;
    double distance = 0, point = 0, shared = 0;

    gap_tally& operator+=(const gap_tally& t) {
        pairs += t.pairs, touching += t.touching, open += t.open;
        distance = std::max(distance, t.distance);
        point = std::max(point, t.point);
        shared = std::max(shared, t.shared);
        return *this;
    }
};

inline constexpr double most_steps = 16;

template <scalar T>
bool is_at_end(const vec3<T>& p) {
    return detail::contact_math::magnitude_of(p) == largest_finite<T>;
}

template <class S, class U>
const char* wrong_with_gap(const S& s, const U& t, gap_tally& tally) {
    using T = scalar_type_of<S>;
    const separation<T> found = distance(s, t), other = distance(t, s);
    ++tally.pairs;
    if (found.a != 0 || found.b != 0) return "ids are not 0";
    if (!(other == separation<T>{0, 0, found.point_b, found.point_a, found.distance})) return "the other order is unlike";
    if (intersects<exact>(s, t)) {
        ++tally.touching;
        if (found.distance != 0) return "what touches is apart";
        if (!(found.point_a == found.point_b)) return "what touches has two points";
        const wide_point x = widest(found.point_a);
        if (is_at_end(found.point_a)) return nullptr;  // it may lie where T has no number
        wide off = distance_from_shape(x, s);
        if constexpr (std::same_as<U, plane<T>>) {
            if (t.normal == vec3<T>{0, 0, 0}) return nullptr;
        }
        off = std::max(off, distance_from_shape(x, t));
        tally.shared = std::max(tally.shared, static_cast<double>(off / wide(contact_bound(s, t))));
        return off > wide(contact_bound(s, t)) ? "the shared point is off the shapes" : nullptr;
    }
    if (!(found.distance > 0)) return "what does not touch is at no distance";
    if constexpr (std::same_as<U, plane<T>>) {
        if (t.normal == vec3<T>{0, 0, 0}) return found.distance == infinity<T> ? nullptr : "a plane that is nothing is near";
    }
    const wide_gap_of_solid gap = gap_of_solid(s, t);
    const wide step = wide(0x1p-53) * gap.farthest;
    tally.open += gap.distance.upper - gap.distance.lower > step / 4;
    // T may have no number for it, or none for what is off by less than is allowed.
    if (gap.distance.upper > wide(largest_finite<T>) + step) return nullptr;
    if (found.distance == infinity<T> && gap.distance.upper + most_steps * step > wide(largest_finite<T>)) return nullptr;
    const auto within = [&](const wide& off, const wide& allowed, double& worst) {
        if (off > allowed && step > 0) worst = std::max(worst, static_cast<double>((off - allowed) / step));
        return off <= allowed + most_steps * step;
    };
    const wide measured(found.distance);
    const wide rounded = wide(unit_roundoff<T>) * gap.distance.upper + wide(std::numeric_limits<T>::denorm_min());
    const auto off_bounds = [&](const wide& x) {
        return std::max<wide>({gap.distance.lower - x, x - gap.distance.upper, wide(0)});
    };
    if (!within(off_bounds(measured), rounded, tally.distance)) return "the distance is off";
    if (is_at_end(found.point_a) || is_at_end(found.point_b)) return nullptr;  // they may lie where T has no number
    const wide on_a = rounding_of(found.point_a), on_b = rounding_of(found.point_b);
    if (!within(distance_from_shape(widest(found.point_a), s), on_a, tally.point)) return "the first point is off";
    if (!within(distance_from_shape(widest(found.point_b), t), on_b, tally.point)) return "the second point is off";
    const wide between = length_of(widest(found.point_b) - widest(found.point_a));
    if (!within(off_bounds(between), on_a + on_b, tally.point)) return "the points are not so far apart";
    return nullptr;
}

template <class S, class U>
void check_gap(const std::string& name, std::uint64_t i, const S& s, const U& t, gap_tally& tally) {
    if (!is_valid(s) || !is_valid(t)) return;
    if (const char* const wrong = wrong_with_gap(s, t, tally)) {
        CAPTURE(name, i);
        FAIL_CHECK(wrong);
    }
}

inline void check_total(const char* name, const gap_tally& tally) {
    std::printf("distance, %s: %llu pairs, %llu touch, %llu open; off by %.2f, points by %.2f, shared ones %.2f\n", name,
                static_cast<unsigned long long>(tally.pairs), static_cast<unsigned long long>(tally.touching),
                static_cast<unsigned long long>(tally.open), tally.distance, tally.point, tally.shared);
    CHECK(tally.open * 50 <= tally.pairs);
}

}  // namespace abut::test
