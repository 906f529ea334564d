// SPDX-License-Identifier: MIT
#pragma once

// What is wrong in answers, by certificates that share nothing with any library: a direction in which two convex shapes are so far
// apart is a lower bound of their distance, two of their points an upper bound, and a direction in which they overlap so much an upper
// bound of their depth. All of it by support points in long double.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "peer.hpp"

namespace peers {

using real = long double;
struct real3 {
    real x, y, z;
};

inline real3 operator-(const real3& p, const real3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
inline real dot(const real3& p, const real3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
inline real length(const real3& p) { return std::sqrt(dot(p, p)); }
inline real3 wide(const vec3& p) { return {p.x, p.y, p.z}; }

/// From the world into the shape's frame. Rotations are orthonormal to the last places of double.
inline real3 turned_back(const abut::rigid<double>& pose, const real3& p) {
    const double* const m = pose.rotation;
    return {m[0] * p.x + m[3] * p.y + m[6] * p.z, m[1] * p.x + m[4] * p.y + m[7] * p.z, m[2] * p.x + m[5] * p.y + m[8] * p.z};
}

/// How far a shape reaches along a direction of the world.
inline real reach(const shape& s, const abut::rigid<double>& pose, const real3& way) {
    const real3 d = turned_back(pose, way);
    const real across = std::sqrt(d.x * d.x + d.y * d.y), whole = length(d);
    const real from = dot(way, wide(pose.translation));
    switch (s.of) {
        case kind::sphere: return from + s.radius * whole;
        case kind::capsule: return from + s.half * std::abs(d.z) + s.radius * whole;
        case kind::box:
            return from + s.halves.x * std::abs(d.x) + s.halves.y * std::abs(d.y) + s.halves.z * std::abs(d.z);
        case kind::cylinder: return from + s.half * std::abs(d.z) + s.radius * across;
        case kind::cone: return from + std::max(s.half * d.z, s.radius * across - s.half * d.z);
        case kind::hull: break;
    }
    real best = -std::numeric_limits<real>::infinity();
    for (const vec3& p : s.points) best = std::max(best, dot(d, wide(p)));
    return from + best;
}

/// How far apart the shapes are along a way from a to b; less than 0 where they overlap so much.
inline real gap_along(const shape& a, const shape& b, const pose_pair& p, const vec3& from_a_to_b) {
    const real3 n = wide(from_a_to_b), back{-n.x, -n.y, -n.z};
    return (-reach(b, p.b, back) - reach(a, p.a, n)) / length(n);
}

/// How far a point is outside of a shape, at least: 0 of a point of it.
inline real outside(const shape& s, const abut::rigid<double>& pose, const vec3& at) {
    const real3 q = turned_back(pose, wide(at) - wide(pose.translation));
    const real across = std::sqrt(q.x * q.x + q.y * q.y), beyond = std::max<real>(0, std::abs(q.z) - s.half);
    real far = 0;
    switch (s.of) {
        case kind::sphere: far = length(q) - s.radius; break;
        case kind::capsule: far = std::sqrt(across * across + beyond * beyond) - s.radius; break;
        case kind::box:
            far = std::max({std::abs(q.x) - s.halves.x, std::abs(q.y) - s.halves.y, std::abs(q.z) - s.halves.z});
            break;
        case kind::cylinder: far = std::max(across - s.radius, std::abs(q.z) - s.half); break;
        case kind::cone: {
            const real rise = 2 * s.half, slope = std::sqrt(rise * rise + s.radius * s.radius);
            far = std::max(-s.half - q.z, (rise * across + s.radius * (q.z - s.half)) / slope);
            break;
        }
        case kind::hull:
            for (const abut::face& f : s.faces) {
                const real3 p = wide(s.points[f[0]]), u = wide(s.points[f[1]]) - p, v = wide(s.points[f[2]]) - p;
                const real3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
                far = std::max(far, dot(n, q - p) / length(n));
            }
    }
    return std::max<real>(0, far);
}

/// What is more than that off is wrong. It is ten times what Coal asks of its own iterations.
inline constexpr double tolerance = 1e-5;

struct verdict {
    std::size_t wrong = 0;  ///< answers
    double worst = 0;       ///< off by at most so much, of answers that are not wrong in kind
};

/// Of poses in which nothing touches: a distance is wrong if it is more than the tolerance off, or its points are not so far apart
/// or not of the shapes.
inline std::vector<verdict> judged_distances(const shape& a, const shape& b, const std::vector<pose_pair>& poses,
                                             const std::vector<std::vector<answer>>& answers) {
    std::vector<verdict> out(answers.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto flaw = [&](const answer& x) {
            return std::max({outside(a, poses[i].a, x.point_a), outside(b, poses[i].b, x.point_b),
                             std::abs(length(wide(x.point_b) - wide(x.point_a)) - x.length)});
        };
        real lower = 0;
        for (const auto& all : answers) {
            const vec3 way = all[i].point_b - all[i].point_a;
            if (way != vec3{0, 0, 0}) lower = std::max(lower, gap_along(a, b, poses[i], way));
        }
        for (std::size_t k = 0; k < answers.size(); ++k) {
            const answer& x = answers[k][i];
            const auto off = static_cast<double>(std::max(flaw(x), std::abs(x.length - lower)));
            out[k].wrong += !(off <= tolerance);
            if (!x.touch) out[k].worst = std::max(out[k].worst, off);
        }
    }
    return out;
}

/// Of poses in which all touch: a contact is wrong if it is none, if the shapes overlap by another length along its normal, or if a
/// library's normal is a shorter way out.
inline std::vector<verdict> judged_contacts(const shape& a, const shape& b, const std::vector<pose_pair>& poses,
                                            const std::vector<std::vector<answer>>& answers) {
    std::vector<verdict> out(answers.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto overlap = [&](const answer& x) { return -gap_along(a, b, poses[i], x.normal); };
        real least = std::numeric_limits<real>::infinity();
        for (const auto& all : answers) {
            if (all[i].touch && all[i].normal != vec3{0, 0, 0}) least = std::min(least, overlap(all[i]));
        }
        for (std::size_t k = 0; k < answers.size(); ++k) {
            const answer& x = answers[k][i];
            const auto off = static_cast<double>(std::max(std::abs(overlap(x) - x.length), overlap(x) - least));
            out[k].wrong += !x.touch || !(off <= tolerance);
            if (x.touch) out[k].worst = std::max(out[k].worst, off);
        }
    }
    return out;
}

}  // namespace peers
