// SPDX-License-Identifier: MIT
#pragma once

// The contact of two triangles that touch. Direction and depth are N. Backman's rule (Collision Detection of Triangle Meshes
// using GPU, 2011, section 5.3.4): the least move along a face normal of either; on either side of the face, since meshes
// are surfaces here and not solids.

#include <abut/narrow/common_part.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail::contact_math {

/// The normals of both faces, as stored; 0 where there is none.
struct face_normals {
    point a, b;
};

template <scalar T>
ABUT_HD constexpr least_overlap way_apart(const triangle<T>& s, const corners& a, const triangle<T>& t, const corners& b,
                                          const face_normals& normal) {
    least_overlap way;
    const point& origin = a.at[0];
    const auto offer = [&](const point& n, bool negative_first) {
        way.offer_both(n, extent_of(a.at, n, origin), extent_of(b.at, n, origin), negative_first);
    };
    const bool flat_a = is_zero(normal.a), flat_b = is_zero(normal.b);
    // Of equals, out of b first, then out of a: what faces of closed meshes call outside.
    if (!flat_b) offer(normal.b, false);
    if (!flat_a) offer(normal.a, true);
    if (flat_a && flat_b) offer(as_stored_direction<T>(across_both(s, t)), false);
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
    const face_normals normal{face_normal(s), face_normal(t)};
    two_points common{};
    if (!middle_in_general_position<T>(a, normal.a, b, normal.b, common)) common = middle_in_any_position(s, a, t, b);
    return assembled<T>(scale, middle_of(common), way_apart(s, a, t, b, normal));
}

/// The least move of s along the line that both planes share, one way or the other, that separates the two triangles;
/// negative where there is no such line, as of parallel planes.
template <scalar T>
ABUT_HD constexpr T overlap_along_shared_line(const triangle<T>& s, const triangle<T>& t) {
    using namespace contact_math;
    const common_scale scale(s, t);
    const corners a = scale(s), b = scale(t);
    const point normal_a = face_normal(s), normal_b = face_normal(t);
    const point line = unit_cross(as<two_doubles>(normal_a), as<two_doubles>(normal_b));
    // Normals are rounded to T: what they have of each other's direction by that is no line.
    const point sine = rounded_off(cross(as<one_double>(normal_a), as<one_double>(normal_b)));
    if (!(largest_of(sine) > 16 * static_cast<double>(unit_roundoff<T>))) return -1;
    const extent of_a = extent_of(a.at, line, a.at[0]), of_b = extent_of(b.at, line, a.at[0]);
    const double least_move = least(plain_sum(of_b.upper, -of_a.lower), plain_sum(of_a.upper, -of_b.lower));
    return scale.back<T>(least_move > 0 ? least_move : 0);
}

}  // namespace abut::detail
