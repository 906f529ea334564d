// SPDX-License-Identifier: MIT
#pragma once

// The floating-point half of the question whether a box and a segment, the axis of a capsule, or a triangle are no farther
// apart than a radius: plain arithmetic in the input's type (`fast`), and in double with certificates that are never wrong
// (`filtered`).
//
// All is seen from the hull's first corner: corners are differences of inputs, rounded once. M is the greatest length of any
// of them. The certificates are those of certified_within.hpp, with the same constants:
// - Apart. A direction g has its least product over the box at one of its corners, and its greatest over the hull at one of
//   the hull's. Computed, both are within 5u |g| M, and their difference is within 13u |g| M.
// - Near. With s in [0, 1] as it stands in its register, x = p + s d is within 8uM of the edge d from the corner p, and
//   likewise the middle of all corners. What of x lies in the box, each coordinate for itself, is within 2uM of the box.
//   With the rounding of the way between both that is below 22uM. From a corner of the box to a face: as there.
// Nothing trusts that s is where it should be.

#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_box.hpp>
#include <abut/predicate/certified_capsule.hpp>
#include <abut/predicate/certified_within.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A box and a hull as seen from the hull's first corner, and what lengths are compared with. F is the input's type
/// (`fast`), or double.
template <bool Certified, scalar F, int N>
struct box_and_hull {
    static constexpr int edges = corner_hull<F, N>::edges;

    vec3<F> lower, upper, at[std::size_t{N}];
    F squared_radius, reach, lost, tiny;  ///< as those of two_hulls
    bool in_range = true;

    template <scalar T>
    ABUT_HD constexpr box_and_hull(const aabb<T>& box, const corner_hull<T, N>& hull, F radius)
        : lower(minus<F>(box.lower, hull.at[0])),
          upper(minus<F>(box.upper, hull.at[0])),
          at{},
          squared_radius(radius * radius),
          reach(squared_radius),
          lost(0),
          tiny(0) {
        for (int i = 1; i < N; ++i) at[i] = minus<F>(hull.at[i], hull.at[0]);
        if constexpr (Certified) {
            const vec3<F> far = greatest(absolute(lower), absolute(upper));
            F mm = dot(far, far);
            for (int i = 1; i < N; ++i) mm = greatest(mm, dot(at[i], at[i]));
            tiny = std::same_as<T, float> ? 0x1p-210 : 0x1p-1000;
            in_range = std::same_as<T, float> || (mm < 0x1p480 && squared_radius < 0x1p480);
            reach = (1 + 0x1p-29) * squared_radius + (0x1p-65 * mm + tiny);
            lost = 0x1p-62 * mm + tiny;
        }
    }

    [[nodiscard]] ABUT_HD constexpr vec3<F> edge(int i) const { return at[i + 1 == N ? 0 : i + 1] - at[i]; }
    /// From a point to the box.
    [[nodiscard]] ABUT_HD constexpr vec3<F> way_from(const vec3<F>& x) const {
        return least(greatest(x, lower), upper) - x;
    }
    /// From the edge d that begins at p, where it is nearest. The square of the way from p + s d is convex in s, and its
    /// slope is linear but where the edge passes the plane of a face.
    [[nodiscard]] ABUT_HD constexpr vec3<F> way_from_edge(const vec3<F>& p, const vec3<F>& d) const {
        const auto way_at = [&](F s) { return way_from(p + s * d); };
        const auto slope_at = [&](F s) { return -dot(d, way_at(s)); };
        F from = 0, to = 1, slope_from = slope_at(from), slope_to = slope_at(to);
        if (!(slope_from < 0)) return way_at(from);
        if (!(slope_to > 0)) return way_at(to);
        const vec3<F> l = lower - p, u = upper - p;
        const F passed[6] = {l.x / d.x, l.y / d.y, l.z / d.z, u.x / d.x, u.y / d.y, u.z / d.z};
        for (int i = 0; i < 6; ++i) {
            const F s = into_unit(passed[i]), slope = slope_at(s);
            const bool is_before = slope < 0;
            if (is_before && s > from) from = s, slope_from = slope;
            if (!is_before && s < to) to = s, slope_to = slope;
        }
        return way_at(into_unit(from + (to - from) * (slope_from / (slope_from - slope_to))));
    }

    /// Whether a way of this square tells that both are near.
    [[nodiscard]] ABUT_HD constexpr bool is_short(F square) const {
        if constexpr (Certified) {
            return (1 + 0x1p-29) * square + lost <= squared_radius;
        } else {
            return square <= squared_radius;
        }
    }
    /// Whether the direction g tells that the box is beyond reach of the hull.
    [[nodiscard]] ABUT_HD constexpr bool is_beyond(const vec3<F>& g) const {
        const vec3<F> first{g.x > 0 ? lower.x : upper.x, g.y > 0 ? lower.y : upper.y, g.z > 0 ? lower.z : upper.z};
        F most = 0;
        for (int i = 1; i < N; ++i) most = greatest(most, dot(g, at[i]));
        const F gap = dot(g, first) - most;
        return gap > 0 && gap * gap > reach * (dot(g, g) + tiny) + F(Certified ? 0x1p-1000 : 0);
    }
    [[nodiscard]] ABUT_HD constexpr bool is_beyond_either(const vec3<F>& g) const {
        return is_beyond(g) || is_beyond({-g.x, -g.y, -g.z});
    }
};

/// What one way tells: from the nearest point of an axis, or from the middle of a triangle.
template <bool Certified, scalar F, int N>
ABUT_HD constexpr verdict near_by_one_way(const box_and_hull<Certified, F, N>& both) {
    if (!both.in_range) return verdict::unknown;
    vec3<F> way{};
    if constexpr (N == 2) {
        way = both.way_from_edge(both.at[0], both.at[1]);
    } else {
        way = both.way_from(F(1) / 3 * (both.at[1] + both.at[2]));
    }
    if (both.is_short(dot(way, way))) return verdict::yes;
    if (N == 2 && !Certified) return verdict::no;
    return both.is_beyond(way) ? verdict::no : verdict::unknown;
}

/// What all ways and directions tell of a box and a hull that do not meet.
template <bool Certified, scalar F, int N>
ABUT_HD constexpr verdict near_by_ways(const box_and_hull<Certified, F, N>& both) {
    if (!both.in_range) return verdict::unknown;
    shortest_way<F> found;
    vec3<F> normal{0, 0, 0};
    if constexpr (N == 3) {
        normal = normal_of(both.at);
        ABUT_ROLLED
        for (int i = 0; i < 3; ++i) found.offer(both.way_from_edge(both.at[i], both.edge(i)));
        ABUT_ROLLED
        for (int i = 0; i < 8; ++i) {
            const vec3<F> c{(i & 1) != 0 ? both.upper.x : both.lower.x, (i & 2) != 0 ? both.upper.y : both.lower.y,
                            (i & 4) != 0 ? both.upper.z : both.lower.z};
            const vec3<F> p[3] = {both.at[0] - c, both.at[1] - c, both.at[2] - c};
            found.offer(F(-1) * end_to_face(normal, p));
        }
        if (both.is_short(found.square)) return verdict::yes;
        if constexpr (!Certified) return verdict::no;
        if (both.is_beyond(found.way) || both.is_beyond_either(normal)) return verdict::no;
    }
    // Directions that stay exact where the way is short.
    ABUT_ROLLED
    for (int i = 0; i < both.edges + 1; ++i) {
        const vec3<F> d = i == 0 ? vec3<F>{} : both.edge(i - 1);
        const vec3<F> axes[3] = {{i == 0 ? F(1) : F(0), -d.z, d.y}, {d.z, i == 0 ? F(1) : F(0), -d.x},
                                 {-d.y, d.x, i == 0 ? F(1) : F(0)}};
        for (int k = 0; k < 3; ++k) {
            if (both.is_beyond_either(axes[k])) return verdict::no;
        }
    }
    return verdict::unknown;
}

}  // namespace abut::detail
