// SPDX-License-Identifier: MIT
#pragma once

// When a ray or a segment meets a convex hull: 0 where it begins inside, and else the time at which it enters. It enters at
// a face, which is one of the triangles of three of the hull's points that its line goes through: the one met first. From
// any of these (predicate/ray_hull.hpp) the next one is made of two of its corners and a point in front of its plane, until
// there is none. These are the steps of the simplex method, whose rule of R. G. Bland (New finite pivoting rules for the
// simplex method, 1977) they follow while the line goes through an edge or a corner, so that they end. Of a hull that is in
// one plane with the line, a side takes the triangle's place. Then the time is that of the triangle, rounded once
// (hit_time.hpp).

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/ray_hull.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Of triangles that a line goes through the one that it goes through first, as seen along its direction.
template <int Room, scalar T>
class hull_entry {
public:
    hull_triangle at;

    ABUT_HD constexpr hull_entry(const line_of<T>& l, const hull<T>& h) : h_(h), signs_(h, l.origin, l.end, l.start) {}

    ABUT_NOINLINE ABUT_HD constexpr verdict find() {
        const verdict found = signs_.find(at);
        if (found != verdict::yes) return found;
        if (signs_.is_flat()) return signs_.find_first(at), found;
        std::uint32_t next = 0;
        for (bool stays = false; look_ahead(next, stays);) stays = step(next);
        return found;
    }

private:
    /// A point in front of the plane: one far ahead, or, where the last step led nowhere, the first one.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool look_ahead(std::uint32_t& next, bool first) {
        const vec3<double> p = widened(h_[at.corner[0]]), q = widened(h_[at.corner[1]]), r = widened(h_[at.corner[2]]);
        const vec3<double> n = cross(q - p, r - p);
        bool any = false;
        double most = 0;
        for (std::uint32_t i = 0; i < h_.count; ++i) {
            if (i == at.corner[0] || i == at.corner[1] || i == at.corner[2] || signs_.height(at, i) >= 0) continue;
            const double height = dot(n, p - widened(h_[i]));
            if (any && !(height > most)) continue;
            any = true;
            most = height;
            next = i;
            if (first) return true;
        }
        return any;
    }
    /// Puts a point in place of a corner. Returns whether the line goes through the triangle where it did.
    ABUT_NOINLINE ABUT_HD constexpr bool step(std::uint32_t p) {
        const auto& c = at.corner;
        const int of[3] = {signs_.side(p, c[0]), signs_.side(p, c[1]), signs_.side(p, c[2])};
        int leaves = -1;
        bool stays = false;
        for (int k = 0; k < 3; ++k) {
            const int after = k == 2 ? 0 : k + 1, before = k == 0 ? 2 : k - 1;
            const int opposite = signs_.side(c[after], c[before]);
            // The new sides are those from p to the one behind, from that to the one ahead of k, and back.
            if (of[after] < 0 || of[before] > 0 || (of[after] == 0 && of[before] == 0 && opposite == 0)) continue;
            if (leaves >= 0 && c[leaves] < c[k]) continue;
            leaves = k;
            stays = opposite == 0;
        }
        if (leaves >= 0) at.corner[leaves] = p;
        return stays;
    }

    const hull<T>& h_;
    line_and_hull<Room, true, T> signs_;
};

/// Where the line enters; decided for every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict entry_of(const line_of<T>& l, const hull<T>& h, hull_triangle& at) {
    hull_entry<2, T> entry(l, h);
    verdict found = entry.find();
    at = entry.at;
    if (found == verdict::unknown) {
        hull_entry<limbs_of_any<T>, T> any(l, h);
        found = any.find();
        at = any.at;
    }
    return found;
}

/// When a ray or a segment meets a hull, or a negative number if it does not.
template <arithmetic A, class Line, scalar T>
ABUT_NOINLINE ABUT_HD constexpr double hit_time(const Line& line, const hull<T>& h) {
    const line_of<T> l(line);
    hull_triangle at;
    if (entry_of(l, h, at) != verdict::yes) return -1;
    const double time = hit_time<A>(line, triangle_of(h, at));
    return time < 0 && intersects<A>(h, l.origin) ? 0 : time;
}

/// Whether it does at all: the triangle that its line goes through first or later, or it begins or ends inside.
template <arithmetic A, class Line, scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool is_met(const Line& line, const hull<T>& h) {
    const line_of<T> l(line);
    hull_triangle at;
    verdict found = line_and_hull<2, true, T>(h, l.origin, l.end, l.start).find(at);
    if (found == verdict::unknown) {
        found = line_and_hull<limbs_of_any<T>, true, T>(h, l.origin, l.end, l.start).find(at);
    }
    return found == verdict::yes &&
           (is_met<A>(line, triangle_of(h, at)) || intersects<A>(h, l.origin) ||
            (std::same_as<Line, segment<T>> && intersects<A>(h, l.end)));
}

/// Of what is seen as a hull.
template <arithmetic A, class Line, seen_as_hull S>
ABUT_HD constexpr double hit_time(const Line& line, const S& s) {
    const auto points = points_of(s);
    return hit_time<A>(line, points.as_hull());
}

/// As of a triangle, for shapes whose time is rounded at once.
///@{
template <arithmetic A, class Line, class S>
ABUT_HD constexpr double hit_time_apart(const Line& line, const S& s) {
    return hit_time<A>(line, s);
}
template <arithmetic A, class Line, class S>
ABUT_HD constexpr time_bounds hit_time_bounds(const Line& line, const S& s) {
    const double time = hit_time<A>(line, s);
    return {time, time};
}
template <arithmetic A, class Line, class S>
ABUT_HD constexpr bool is_met(const Line& line, const S& s) {
    return hit_time<A>(line, s) >= 0;
}
///@}

}  // namespace abut::detail
