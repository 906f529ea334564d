// SPDX-License-Identifier: MIT
#pragma once

// The contact of two triangles that touch. Direction and depth are N. Backman's rule (Collision Detection of Triangle Meshes
// using GPU, 2011, section 5.3.4): the least move along a face normal of either; on either side of the face, since meshes
// are surfaces here and not solids.

#include <abut/narrow/directions.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// The two points where a triangle's edges cross a plane, from its corners' heights over it; false unless one corner is on
/// one side and two are on the other.
ABUT_HD constexpr bool chord_of(const corners& t, const double (&height)[3], point (&end)[2]) {
    int below = 0, above = 0;
    for (const double h : height) {
        below += h < 0 ? 1 : 0;
        above += h > 0 ? 1 : 0;
    }
    if (below + above != 3 || below == 0 || above == 0) return false;
    const bool lone_is_below = below == 1;
    int lone = 0;
    for (int i = 1; i < 3; ++i) {
        if ((height[i] < 0) == lone_is_below) lone = i;
    }
    for (int k = 0; k < 2; ++k) {
        const int other = lone + 1 + k - (lone + 1 + k > 2 ? 3 : 0);
        const double weight = height[lone] / plain_sum(height[lone], -height[other]);
        end[k] = on_segment(t.at[lone], t.at[other], one_double::of(weight));
    }
    return true;
}

/// A common point of triangles in general position: each plane cuts the other triangle in a chord, both chords are on one
/// line, and the answer is the middle of what they share, once as a point of either chord. False where there are no two
/// chords; where the answer is poor, its gap shows it.
ABUT_HD constexpr bool middle_of_chords(const corners& a, const point& normal_a, const corners& b, const point& normal_b,
                                        two_points& out) {
    double height_a[3]{}, height_b[3]{};
    for (int i = 0; i < 3; ++i) {
        height_a[i] = plain_dot(normal_b, plain_difference(a.at[i], b.at[0]));
        height_b[i] = plain_dot(normal_a, plain_difference(b.at[i], a.at[0]));
    }
    point end_a[2]{}, end_b[2]{};
    if (!chord_of(a, height_a, end_a) || !chord_of(b, height_b, end_b)) return false;
    const point line = rounded_off(cross(as<one_double>(normal_a), as<one_double>(normal_b)));
    const auto along = [&](const point& p) { return plain_dot(line, plain_difference(p, end_a[0])); };
    const double a0 = 0, a1 = along(end_a[1]), b0 = along(end_b[0]), b1 = along(end_b[1]);
    const double from = greatest(least(a0, a1), least(b0, b1)), to = least(greatest(a0, a1), greatest(b0, b1));
    const double middle = plain_sum(from, to) / 2;
    const auto weight = [&](double x0, double x1) {
        return into_unit(one_double::of(plain_sum(middle, -x0) / plain_sum(x1, -x0)));
    };
    out = {on_segment(end_a[0], end_a[1], weight(a0, a1)), on_segment(end_b[0], end_b[1], weight(b0, b1))};
    return true;
}

/// Common points in any position: first in doubles, then in sums of two.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr two_points common_points(const corners& a, const corners& b) {
    gathered_points found(tolerable_square<T>());
    gather<one_double>(a, b, found);
    if (found.meet()) return found.result();
    gather<two_doubles>(a, b, found);
    return found.result();
}

/// The direction in which two degenerate triangles come apart: across both segments, or across one and any way, or along z.
ABUT_HD constexpr point across_both(const corners& a, const corners& b) {
    const vec3<two_doubles> along_a = longest_edge(a), along_b = longest_edge(b);
    const point both = unit_cross(along_a, along_b);
    if (!is_zero(both)) return both;
    return any_orthogonal(is_zero(rounded_off(along_a)) ? along_b : along_a);
}

/// The normals of both faces, as stored; 0 where there is none.
struct face_normals {
    point a, b;
};

template <scalar T>
ABUT_HD constexpr least_overlap way_apart(const corners& a, const corners& b, const face_normals& normal) {
    least_overlap way;
    const point& origin = a.at[0];
    const auto offer = [&](const point& n, bool negative_first) {
        way.offer_both(n, extent_of(a.at, n, origin), extent_of(b.at, n, origin), negative_first);
    };
    const bool flat_a = is_zero(normal.a), flat_b = is_zero(normal.b);
    // Of equals, out of b first, then out of a: what faces of closed meshes call outside.
    if (!flat_b) offer(normal.b, false);
    if (!flat_a) offer(normal.a, true);
    if (flat_a && flat_b) offer(as_stored_direction<T>(across_both(a, b)), false);
    return way;
}

}  // namespace abut::detail::contact_math

namespace abut::detail {

/// The contact of two triangles that are known to touch, with ids 0.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const triangle<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const corners a = scale(s), b = scale(t);
    const face_normals normal{face_normal<T>(a), face_normal<T>(b)};
    two_points common{};
    if (!middle_of_chords(a, normal.a, b, normal.b, common) || !(common.squared_gap() <= tolerable_square<T>())) {
        common = common_points<T>(a, b);
    }
    return assembled<T>(scale, middle_of(common), way_apart<T>(a, b, normal));
}

/// The least move of s along the line that both planes share, one way or the other, that separates the two triangles;
/// negative where there is no such line, as of parallel planes.
template <scalar T>
ABUT_HD constexpr T overlap_along_shared_line(const triangle<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const corners a = scale(s), b = scale(t);
    const point line = unit_cross(as<two_doubles>(face_normal<T>(a)), as<two_doubles>(face_normal<T>(b)));
    // Normals are rounded to T: what they have of each other's direction by that is no line.
    const point sine = rounded_off(cross(as<one_double>(face_normal<T>(a)), as<one_double>(face_normal<T>(b))));
    if (!(largest_of(sine) > 16 * static_cast<double>(unit_roundoff<T>))) return -1;
    const extent of_a = extent_of(a.at, line, a.at[0]), of_b = extent_of(b.at, line, a.at[0]);
    const double least_move = least(plain_sum(of_b.upper, -of_a.lower), plain_sum(of_a.upper, -of_b.lower));
    return scale.back<T>(least_move > 0 ? least_move : 0);
}

}  // namespace abut::detail
