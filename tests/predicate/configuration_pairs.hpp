// SPDX-License-Identifier: MIT
#pragma once

// The pairs of triangles that the configurations give: each as it is written down, and, where both triangles have a part of
// the line in which the planes cross, also with either or both reversed along that line. The tests ask about all of them,
// and docs/viewer shows them.

#include <stdexcept>
#include <string>
#include <vector>

#include "common_part.hpp"
#include "configurations.hpp"

namespace abut::test {

struct named_pair {
    std::string name;
    integer_triangle a, b;
    bool hit;
};

template <class Map>
integer_triangle mapped(const integer_triangle& t, const Map& map) {
    return {map(t.a), map(t.b), map(t.c)};
}

/// Reversed along the x axis, so that its part of that axis stays, and only the ends of the part change places.
inline integer_triangle reversed(const integer_triangle& t, const integer_triangle& other) {
    const hull part = clipped_to_plane(hull_of(t), hull_of(other));
    if (part.empty() || part.size() > 2) throw std::logic_error("no part of a line to reverse");
    const rational ends = part.front().x + part.back().x;
    if (denominator(ends) != 1 || part.front().y != 0 || part.front().z != 0 || part.back().y != 0 || part.back().z != 0)
        throw std::logic_error("the part is not on the x axis, or its middle is on no half");
    const int sum = static_cast<int>(numerator(ends));
    return mapped(t, [sum](const vec3<int>& p) { return vec3<int>{sum - p.x, p.y, p.z}; });
}

inline bool planes_cross(const hull& s, const hull& t) {
    return !is_zero(cross(normal_of(s), normal_of(t)));
}

inline std::vector<named_pair> all_pairs() {
    std::vector<named_pair> pairs;
    for (const auto& group : configuration_groups) {
        for (const auto& c : group.members) {
            const std::string name = group.title + " / " + c.name;
            const bool hit = c.part != common::nothing;
            pairs.push_back({name, c.reference, c.other, hit});
            const hull s = hull_of(c.reference), t = hull_of(c.other);
            if (!planes_cross(s, t) || clipped_to_plane(s, t).empty() || clipped_to_plane(t, s).empty()) continue;
            const integer_triangle a = reversed(c.reference, c.other), b = reversed(c.other, c.reference);
            pairs.push_back({name + " (reference reversed)", a, c.other, hit});
            pairs.push_back({name + " (other reversed)", c.reference, b, hit});
            pairs.push_back({name + " (both reversed)", a, b, hit});
        }
    }
    return pairs;
}

}  // namespace abut::test
