// SPDX-License-Identifier: MIT
#pragma once

// What two triangles have in common, in rational numbers: one is clipped by the half spaces that bound the other. Degenerate
// ones are the segments and the points that they span. For small integers only: it says nothing of rounding and is not fast.

#include <algorithm>
#include <tuple>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "configurations.hpp"

namespace abut::test {

/// Without expression templates: `auto` in vec3's operations would keep references to operands that are gone.
using rational =
    boost::multiprecision::number<boost::multiprecision::rational_adaptor<boost::multiprecision::cpp_int_backend<>>,
                                  boost::multiprecision::et_off>;
using rational_point = vec3<rational>;

/// The corners of a convex polygon in order; two points are a segment, one is a point, none is nothing.
using hull = std::vector<rational_point>;

/// All x with normal . x >= offset
struct half_space {
    rational_point normal;
    rational offset;

    [[nodiscard]] rational excess(const rational_point& x) const { return dot(normal, x) - offset; }
};

inline bool same(const rational_point& p, const rational_point& q) { return p.x == q.x && p.y == q.y && p.z == q.z; }
inline bool is_zero(const rational_point& p) { return p.x == 0 && p.y == 0 && p.z == 0; }

inline half_space above(const rational_point& normal, const rational_point& on) { return {normal, dot(normal, on)}; }
inline half_space below(const rational_point& normal, const rational_point& on) {
    const rational_point zero{0, 0, 0};
    return above(zero - normal, on);
}

/// Without points that are there twice; where all are in line, the two ends.
inline hull tidied(const hull& corners) {
    hull kept;
    for (const rational_point& p : corners) {
        if (std::none_of(kept.begin(), kept.end(), [&](const rational_point& q) { return same(p, q); })) kept.push_back(p);
    }
    for (std::size_t i = 2; i < kept.size(); ++i) {
        if (!is_zero(cross(kept[1] - kept[0], kept[i] - kept[0]))) return kept;
    }
    if (kept.size() < 3) return kept;
    const auto [first, last] = std::minmax_element(kept.begin(), kept.end(), [](const auto& p, const auto& q) {
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    });
    return {*first, *last};
}

inline hull hull_of(const integer_triangle& t) {
    const auto exact = [](const vec3<int>& p) { return rational_point{p.x, p.y, p.z}; };
    return tidied({exact(t.a), exact(t.b), exact(t.c)});
}

/// The part of a hull that lies in a half space (Sutherland and Hodgman, 1974).
inline hull clipped(const hull& corners, const half_space& by) {
    hull kept;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const rational_point &p = corners[i], &q = corners[(i + 1) % corners.size()];
        const rational at_p = by.excess(p), at_q = by.excess(q);
        if (at_p >= 0) kept.push_back(p);
        if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) kept.push_back(p + rational(at_p / (at_p - at_q)) * (q - p));
    }
    return tidied(kept);
}

/// The normal of a triangle's plane; 0 if it spans none.
inline rational_point normal_of(const hull& t) {
    return t.size() < 3 ? rational_point{0, 0, 0} : cross(t[1] - t[0], t[2] - t[0]);
}

/// The part of a hull that lies in the plane of a triangle
inline hull clipped_to_plane(const hull& corners, const hull& t) {
    const rational_point n = normal_of(t);
    return clipped(clipped(corners, above(n, t[0])), below(n, t[0]));
}

/// Half spaces whose intersection is the triangle, segment or point
inline std::vector<half_space> half_spaces(const hull& t) {
    const rational_point axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<half_space> found;
    const auto add_plane = [&](const rational_point& normal) {
        found.push_back(above(normal, t[0]));
        found.push_back(below(normal, t[0]));
    };
    if (t.size() == 3) {
        const rational_point n = normal_of(t);
        add_plane(n);
        for (std::size_t i = 0; i < 3; ++i) found.push_back(above(cross(n, t[(i + 1) % 3] - t[i]), t[i]));
    } else if (t.size() == 2) {
        const rational_point along = t[1] - t[0];
        for (const rational_point& axis : axes) add_plane(cross(along, axis));
        found.push_back(above(along, t[0]));
        found.push_back(below(along, t[1]));
    } else {
        for (const rational_point& axis : axes) add_plane(axis);
    }
    return found;
}

inline hull common_part(const hull& s, const hull& t) {
    hull part = s;
    for (const half_space& by : half_spaces(t)) part = clipped(part, by);
    return part;
}

inline common kind_of(const hull& part) { return static_cast<common>(std::min<std::size_t>(part.size(), 3)); }

}  // namespace abut::test
