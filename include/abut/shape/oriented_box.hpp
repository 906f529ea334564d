// SPDX-License-Identifier: MIT
#pragma once

// Boxes whose faces lie along no axes: `oriented_box`, and `placed_box`, which any box is under a pose. Both are the hulls
// of eight corners, each rounded once, and all that is decided about them is decided about those (predicate/as_hull.hpp).
// Not the bounding volume `obb` (obb.hpp), which may be larger than what it is around.

#include <abut/shape/form.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/rigid.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// A solid box in any direction. Its corners are `place(rigid<T>{rotation, center}, p)` of the eight points p whose
/// coordinates are those of `half` or of -`half`, each coordinate rounded once; the box is their convex hull.
template <scalar T>
struct oriented_box {
    vec3<T> center;                               ///< its middle
    vec3<T> half;                                 ///< half of its three lengths; each 0 or more
    T rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row by row, from the box's axes to the world's, as of `rigid`

    friend constexpr bool operator==(const oriented_box&, const oriented_box&) = default;
};

/// A box where a pose has put it: the convex hull of its eight corners, each of which is placed as a point is.
template <scalar T>
struct placed_box {
    vec3<T> corners[8];  ///< bit k of a corner's number says at which end of the box's axis k it was
};

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<oriented_box<T>>{"oriented box", "abut::oriented_boxes", 15};
template <scalar T>
inline constexpr shape_name name_of<placed_box<T>>{"placed box", "abut::shapes", 24};

template <scalar T>
ABUT_HD constexpr corner_hull<T, 8> points_of(const aabb<T>& box) {
    const vec3<T>&l = box.lower, &u = box.upper;
    return {{l, {u.x, l.y, l.z}, {l.x, u.y, l.z}, {u.x, u.y, l.z}, {l.x, l.y, u.z}, {u.x, l.y, u.z}, {l.x, u.y, u.z}, u}};
}
template <scalar T>
ABUT_HD constexpr corner_hull<T, 8> points_of(const placed_box<T>& box) {
    corner_hull<T, 8> points;
    for (int i = 0; i < 8; ++i) points.at[i] = box.corners[i];
    return points;
}
/// A box of some corners where a pose puts it.
template <scalar T>
ABUT_HD constexpr placed_box<T> box_under(const rigid<T>& pose, const corner_hull<T, 8>& points) {
    placed_box<T> box;
    for (int i = 0; i < 8; ++i) box.corners[i] = place(pose, points.at[i]);
    return box;
}
/// One coordinate of each corner of a box along the axes, by a row of a rotation: the numbers of `placed`, of which corners share
/// products and sums.
template <scalar T>
struct coordinates_under {
    T at[8];

    ABUT_INLINE ABUT_HD constexpr coordinates_under(const T* row, T shift, const vec3<T>& lower, const vec3<T>& upper) : at{} {
        const double r[] = {static_cast<double>(row[0]), static_cast<double>(row[1]), static_cast<double>(row[2])},
                     t = rounded(static_cast<double>(shift));
        const double x[] = {plain_product(r[0], static_cast<double>(lower.x)), plain_product(r[0], static_cast<double>(upper.x))},
                     y[] = {plain_product(r[1], static_cast<double>(lower.y)), plain_product(r[1], static_cast<double>(upper.y))},
                     z[] = {plain_product(r[2], static_cast<double>(lower.z)), plain_product(r[2], static_cast<double>(upper.z))};
        const double xy[] = {plain_sum(x[0], y[0]), plain_sum(x[1], y[0]), plain_sum(x[0], y[1]), plain_sum(x[1], y[1])};
        for (int i = 0; i < 8; ++i) at[i] = rounded(static_cast<T>(plain_sum(plain_sum(xy[i & 3], z[i >> 2]), t)));
    }
};
template <scalar T>
ABUT_HD constexpr placed_box<T> box_under(const T (&rotation)[9], const vec3<T>& shift, const vec3<T>& lower, const vec3<T>& upper) {
    const coordinates_under<T> x(rotation, shift.x, lower, upper), y(rotation + 3, shift.y, lower, upper),
        z(rotation + 6, shift.z, lower, upper);
    placed_box<T> box;
    for (int i = 0; i < 8; ++i) box.corners[i] = {x.at[i], y.at[i], z.at[i]};
    return box;
}
template <scalar T>
ABUT_HD constexpr corner_hull<T, 8> points_of(const oriented_box<T>& box) {
    const vec3<T>& h = box.half;
    return points_of(box_under(box.rotation, box.center, {-h.x, -h.y, -h.z}, h));
}

/// Shapes that are decided and measured as the hull of `points_of` them.
template <class S>
inline constexpr bool is_seen_as_hull = false;
template <scalar T>
inline constexpr bool is_seen_as_hull<oriented_box<T>> = true;
template <scalar T>
inline constexpr bool is_seen_as_hull<placed_box<T>> = true;
template <class S>
concept seen_as_hull = is_seen_as_hull<S>;

/// By how much the product of two rows is off from that of a rotation; the same bits on every policy.
template <scalar T>
ABUT_HD constexpr double rotation_error(const T (&m)[9], int i, int j) {
    const vec3<double> a = widened(row(m, i)), b = widened(row(m, j));
    const double xy = plain_sum(plain_product(a.x, b.x), plain_product(a.y, b.y));
    return plain_sum(plain_sum(xy, plain_product(a.z, b.z)), i == j ? -1.0 : 0.0);
}
/// Of numbers that are finite. A determinant is near 1 or -1 where rows are orthonormal, so that its rounding does not
/// matter.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of_rotation(const T (&m)[9]) {
    for (int k = 0; k < 6; ++k) {
        const double off = rotation_error(m, k % 3, k < 3 ? k : (k + 1) % 3);
        if (absolute(off) <= rotation_tolerance) continue;
        if (k < 3) return {"squared length of a row differs from 1 by more than 2^-10", off, "rotation: "};
        return {"product of two rows differs from 0 by more than 2^-10", off, "rotation: "};
    }
    const double determinant = dot(cross(widened(row(m, 0)), widened(row(m, 1))), widened(row(m, 2)));
    if (determinant < 0) return {"it reflects: its determinant is negative", determinant, "rotation: "};
    return {};
}

}  // namespace detail

/// The smallest box around the corners. Exact.
template <detail::seen_as_hull S>
ABUT_HD constexpr auto bounds(const S& s) {
    return bounds(detail::points_of(s).as_hull());
}

/// A box under a pose, along the axes or not: each corner is placed as a point alone is.
///@{
template <scalar T>
ABUT_HD constexpr placed_box<T> place(const rigid<T>& pose, const aabb<T>& box) {
    return detail::box_under(pose.rotation, pose.translation, box.lower, box.upper);
}
template <scalar T, detail::seen_as_hull S>
ABUT_HD constexpr placed_box<T> place(const rigid<T>& pose, const S& box) {
    return detail::box_under(pose, detail::points_of(box));
}
///@}

/// That a corner is not finite. And of an oriented box, that a half length is negative, or the rotation none within
/// `rotation_tolerance`.
///@{
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const placed_box<T>& box) {
    for (const vec3<T>& corner : box.corners) {
        if (const shape_flaw flaw = flaw_of(corner)) return flaw;
    }
    return {};
}
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const oriented_box<T>& box) {
    if (const shape_flaw flaw = flaw_of(box.center)) return {flaw.what, flaw.value, "center "};
    if (const shape_flaw flaw = flaw_of(box.half)) return {flaw.what, flaw.value, "half "};
    const T least_half = detail::least(box.half.x, box.half.y, box.half.z);
    if (least_half < 0) return {"a half length is negative", static_cast<double>(least_half)};
    if (const shape_flaw flaw = detail::flaw_of_rotation(box.rotation)) return flaw;
    // No coordinate of a corner is beyond the sum of all, but for a little: mostly none has to be made.
    const double all = detail::magnitudes(detail::widened(box.center)) + detail::magnitudes(detail::widened(box.half));
    if (all < static_cast<double>(largest_finite<T>) / 4) return {};
    for (const vec3<T>& corner : detail::points_of(box).at) {
        if (const shape_flaw flaw = flaw_of(corner)) return {flaw.what, flaw.value, "corner "};
    }
    return {};
}
///@}

namespace detail {

/// An oriented box, by the box around it and by its own directions: any direction tells two boxes apart along which both
/// reach less far than their middles are apart. All is doubled and seen from the centre.
///
/// No entry of a rotation is above 1 + 2^-9. So the corners, rounded, are within 8u far of those of the numbers as they are
/// given, where far is the sum of the magnitudes of all that is added, and rounding of products and sums is below 20u far.
template <scalar T>
struct oriented_reach {
    aabb<T> query;
    vec3<T> center, columns[3], reach;  ///< the centre doubled; and how far the box reaches along the columns
    T size;

    oriented_reach() = default;
    ABUT_HD explicit oriented_reach(const oriented_box<T>& box)
        : center(box.center + box.center), columns{column(box.rotation, 0), column(box.rotation, 1), column(box.rotation, 2)},
          size(magnitudes(center) + 2 * magnitudes(box.half)) {
        const vec3<T>&a = columns[0], &b = columns[1], &c = columns[2], &h = box.half;
        const vec3<T> half = h.x * absolute(a) + h.y * absolute(b) + h.z * absolute(c);
        const T slack = 32 * unit_roundoff<T> * size + 32 * smallest_normal<T>;
        const vec3<T> grown = half + vec3<T>{slack, slack, slack};
        query = {box.center - grown, box.center + grown};
        const T ab = absolute(dot(a, b)), bc = absolute(dot(b, c)), ca = absolute(dot(c, a));
        reach = T(2) * vec3<T>{dot(a, a) * h.x + ab * h.y + ca * h.z, ab * h.x + dot(b, b) * h.y + bc * h.z,
                            ca * h.x + bc * h.y + dot(c, c) * h.z};
    }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return query; }
    ABUT_HD bool operator()(const aabb<T>& box) const {
        if (!overlaps(query, box)) return false;
        const vec3<T> way = (box.lower + box.upper) - center, side = box.upper - box.lower;
        const T far = size + (magnitudes(box.lower) + magnitudes(box.upper));
        const T lost = 32 * unit_roundoff<T> * far + 32 * smallest_normal<T>;
        const bool apart = absolute(dot(columns[0], way)) > dot(absolute(columns[0]), side) + (reach.x + lost) ||
                           absolute(dot(columns[1], way)) > dot(absolute(columns[1]), side) + (reach.y + lost) ||
                           absolute(dot(columns[2], way)) > dot(absolute(columns[2]), side) + (reach.z + lost);
        return !(apart && far < largest_finite<T> / 16);
    }
};

}  // namespace detail

/// By its own directions, with a slack for rounding.
template <scalar T>
ABUT_HD auto reach_of(const oriented_box<T>& s) {
    return detail::oriented_reach<T>(s);
}

///@}

}  // namespace abut
