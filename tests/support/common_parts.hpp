// SPDX-License-Identifier: MIT
#pragma once

// What two triangles have in common, in numbers of 300 bits: half-spaces that one of them is made of cut it out of the
// other. Signs are exact where coordinates span less than a hundred bits.

#include <algorithm>
#include <vector>

#include "contact_oracles.hpp"

namespace abut::test {

/// n.x <= limit
struct half_space {
    wide_point normal;
    wide limit;
};

/// Pairs of half-spaces are planes.
inline void add_plane(std::vector<half_space>& to, const wide_point& n, const wide_point& x) {
    to.push_back({n, dot(n, x)});
    to.push_back({{-n.x, -n.y, -n.z}, -dot(n, x)});
}

/// A triangle, which may be a segment or a point.
template <scalar T>
std::vector<half_space> half_spaces_of(const triangle<T>& t) {
    const wide_point corner[3] = {widest(t.a), widest(t.b), widest(t.c)};
    std::vector<half_space> all;
    const wide_point n = wide_normal(t);
    if (length_of(n) > 0) {
        add_plane(all, n, corner[0]);
        for (int i = 0; i < 3; ++i) {
            const wide_point outwards = cross(corner[(i + 1) % 3] - corner[i], n);
            all.push_back({outwards, dot(outwards, corner[i])});
        }
        return all;
    }
    wide_point along{0, 0, 0};
    for (int i = 0; i < 3; ++i) {
        const wide_point edge = corner[(i + 1) % 3] - corner[i];
        if (length_of(edge) > length_of(along)) along = edge;
    }
    if (length_of(along) == 0) {
        for (const wide_point& axis : {wide_point{1, 0, 0}, wide_point{0, 1, 0}, wide_point{0, 0, 1}}) {
            add_plane(all, axis, corner[0]);
        }
        return all;
    }
    for (const wide_point& axis : {wide_point{1, 0, 0}, wide_point{0, 1, 0}, wide_point{0, 0, 1}}) {
        if (length_of(cross(along, axis)) > 0) add_plane(all, cross(along, axis), corner[0]);
    }
    const wide_point back{-along.x, -along.y, -along.z};
    all.push_back({along, std::max({dot(along, corner[0]), dot(along, corner[1]), dot(along, corner[2])})});
    all.push_back({back, std::max({dot(back, corner[0]), dot(back, corner[1]), dot(back, corner[2])})});
    return all;
}

/// The corners of the common part, in turn around it; none if there is none. Corners may be there several times.
template <scalar T>
std::vector<wide_point> common_part(const triangle<T>& s, const triangle<T>& t) {
    std::vector<wide_point> left{widest(s.a), widest(s.b), widest(s.c)};
    for (const half_space& h : half_spaces_of(t)) {
        const wide rounding = length_of(h.normal) * wide(contact_bound(s, t)) * wide(0x1p-150);
        std::vector<wide> beyond;
        for (const wide_point& p : left) {
            const wide d = dot(h.normal, p) - h.limit;
            beyond.push_back(abs(d) <= rounding ? wide(0) : d);
        }
        std::vector<wide_point> kept;
        for (std::size_t i = 0; i < left.size(); ++i) {
            const std::size_t j = (i + 1) % left.size();
            if (beyond[i] <= 0) kept.push_back(left[i]);
            if (beyond[i] * beyond[j] < 0) kept.push_back(left[i] + beyond[i] / (beyond[i] - beyond[j]) * (left[j] - left[i]));
        }
        left = kept;
    }
    return left;
}

/// The centre of gravity of a polygon's boundary; the middle of a segment.
inline wide_point middle_of(const std::vector<wide_point>& polygon) {
    wide around = 0;
    wide_point sum{0, 0, 0};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const wide_point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const wide length = length_of(q - p);
        around += length;
        sum = sum + length / 2 * (p + q);
    }
    return around == 0 ? polygon[0] : wide(1) / around * sum;
}

/// How far a point of one polygon may be from the nearest one of the other.
inline wide distance_between(const std::vector<wide_point>& p, const std::vector<wide_point>& q) {
    const auto from = [](const wide_point& x, const std::vector<wide_point>& polygon) {
        wide least = length_of(x - polygon[0]);
        for (std::size_t i = 1; i < polygon.size(); ++i) {
            const std::size_t j = i + 1 < polygon.size() ? i + 1 : i;
            least = std::min(least, distance_from(x, wide_hull{{polygon[0], polygon[i], polygon[j]}}));
        }
        return least;
    };
    wide most = 0;
    for (const auto& x : p) most = std::max(most, from(x, q));
    for (const auto& x : q) most = std::max(most, from(x, p));
    return most;
}

}  // namespace abut::test
