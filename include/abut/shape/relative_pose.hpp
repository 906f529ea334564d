// SPDX-License-Identifier: MIT
#pragma once

// Boxes of two posed sets, for culling: each box stays in the frame of its own object, and one relative pose, made once
// for a query, takes b's frame to a's. Decisions are about corners that `place` has rounded to the world's coordinates,
// one set apart from the other; the relative pose knows nothing of that rounding, and is rounded itself. Its slack covers
// both, so that no two boxes are told apart whose shapes meet in the world.
//
// The error. Let p be a point of a's set and q one of b's, in their own frames, where their shapes meet in the world.
// With the poses (A, s) and (B, t) as they are stored, A p + s and B q + t differ by no more than the rounding of
// `place`. Put into a's frame, with D = A^T A - 1 and the relative pose (R, d) as it is stored,
//     p = R q + d + error,   error = (A^T B - R) q + (A^T (t - s) - d) + A^T (rounding) - D p.
// This is exact, however far A and B are from orthonormal; but A^T may stretch what it is applied to. The rows of A are
// orthonormal within 2^-10 (rigid.hpp): A A^T - 1 has no entry larger than that and no eigenvalue larger than 3 2^-10. So
// the squares of A's singular values are 1 within 3 2^-10, and none of them, and no column, is larger than 1.0015. The same
// is true of B. No singular value and no column of R, which is A^T B but for rounding, is larger than 1.003. Entries of D
// may be as large as 3 2^-10, but are far smaller for most poses, so they are measured. Let e = 2u be the relative error of
// an operation in any rounding mode, m the smallest normal number, and P, Q, S, T, |d| the sums of magnitudes of p and q at
// their farthest and of s, t and d. Along an axis no longer than 1.003 (below):
//     rounding to the world     7 e (P + Q) + 1.1 e (S + T)     by the bound of `place`, three coordinates
//     A^T B - R                 9.3 e Q                         nine entries of three products and two sums
//     A^T (t - s) - d           6.5 e |d|
//     D p                       1.75 dev(A) P                   dev: the largest entry of D, as it is measured
// Balls and capsules are placed by their centres, and their radius is not stretched. (Of cylinders and cones the same is true
// of the capsule, or the hull of a point and a ball, whose box is theirs.) A is S U with a rotation U and S of
// A's singular values: a point at v from the centre in the world is at U^T v in the frame, but for (S - 1) v. As the squares
// of singular values are 1 within 3 dev(A), they are 1 within 1.51 dev(A): with b's part 1.6 (dev(A) P + dev(B) Q) more.
//
// The test. Let c and h be a box's centre and half widths: points of a's box are c_a + x with |x_i| <= h_ai, alike for b.
// For any axis n then |n . (R c_b + d - c_a)| <= sum |n_i| h_ai + sum |n . r_j| h_bj + |n . error|, where r_j are R's
// columns. The axes are n = e_i, n = r_j and n = e_i x r_j, none longer than the longest r_j. For the latter two the code
// takes |r_j . r_k| for 0 or 1, and |n . r_k| for the entry of R that it is if R is orthonormal (S. Gottschalk, M. Lin, D.
// Manocha, OBBTree, 1996). That is wrong by at most dev(R) Q, where dev(R) is measured too, and also of the columns' cross
// products. Nothing divides by |n|: axes of edges that are nearly parallel, which are nearly 0, compare rounding errors with
// the slack and separate nothing.
//     rounding of the test      e (14.1 Q + 8.1 P + 8.1 |d|)    at most eight roundings on the way of each number
//
// All together this is below e (16 P + 32 Q + 16 |d| + 2 (S + T)) + 4 (dev(A) P + dev(B) Q + dev(R) Q), the slack. What
// is flushed to zero adds less than 60 m, of which 128 are taken; flushed entries of R add m Q, which is nothing beside e
// Q. Sums are doubled in the code, which spares the halves, and stay below 64 (P + Q + |d| + S + T): where these might
// overflow, the slack is infinite and nothing is told apart. Contraction only lowers the errors; NaN makes every
// comparison false.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>

namespace abut {

/// Takes b's frame to a's, and says by how much volumes have to be grown, for shapes in the boxes that it was made for.
/// Plain data.
template <scalar T>
struct relative_pose {
    vec3<T> rotation[3];   ///< its rows
    vec3<T> magnitude[3];  ///< their magnitudes
    vec3<T> translation;   ///< of b's origin in a's frame
    T deviation;           ///< of the rotation's columns from orthonormal, measured; below 0.01
    T slack;               ///< in length; infinite where coordinates are too large to tell anything apart
};

/// Which axes the test of two boxes tries. More of them keep fewer boxes in vain, and cost more: on the boxes that a walk
/// through two trees of 346,000 triangles meets, 3 axes reject 27 %, 6 axes 34 % and all of them 37 %, in 4, 6 and 20 ns.
enum class box_axes {
    of_a,   ///< the faces of a's box: 3
    faces,  ///< the faces of both: 6
    all     ///< and the products of their edges: 15. Boxes that none of these separates do meet, but for rounding.
};

namespace detail {

/// The largest entry of |V^T V - 1|, or of the differences between V's columns and their cross products, which in a rotation
/// are the columns again; measured in double, with an allowance for its rounding.
ABUT_HD constexpr double deviation(const vec3<double>& x, const vec3<double>& y, const vec3<double>& z) {
    const vec3<double> unlike[] = {cross(y, z) - x, cross(z, x) - y, cross(x, y) - z};
    double most = 0;
    const auto see = [&most](double by) { most = by > most ? by : most; };
    for (const vec3<double>& v : unlike) {
        see(absolute(v.x));
        see(absolute(v.y));
        see(absolute(v.z));
    }
    see(absolute(dot(x, x) - 1));
    see(absolute(dot(y, y) - 1));
    see(absolute(dot(z, z) - 1));
    see(absolute(dot(x, y)));
    see(absolute(dot(y, z)));
    see(absolute(dot(z, x)));
    return most + 8 * unit_roundoff<double>;
}

/// Each through a register: what is measured of these numbers later has to be measured of the rounded ones (rigid.hpp).
template <scalar T>
ABUT_HD constexpr vec3<T> to_scalar(const vec3<double>& v) {
    return {rounded(static_cast<T>(v.x)), rounded(static_cast<T>(v.y)), rounded(static_cast<T>(v.z))};
}

}  // namespace detail

/// The pose of b's frame in a's. `around_a` and `around_b` hold, each in the frame of its object, all shapes that are to be
/// compared, and all boxes: the bounds of the sets, or of their trees' roots. (Other volumes than boxes may stick out.) The
/// rows of both rotations have to be orthonormal within `rotation_tolerance`. The larger the boxes and the farther from
/// their frames' origins, the larger the slack: some 1e-5 of that in float, 1e-14 in double, and some ten times what
/// rotations are off from orthonormal.
template <scalar T>
ABUT_HD constexpr relative_pose<T> make_relative_pose(const rigid<T>& pose_a, const aabb<T>& around_a,
                                                      const rigid<T>& pose_b, const aabb<T>& around_b) {
    using namespace detail;
    const vec3<double> a[] = {widened(column(pose_a.rotation, 0)), widened(column(pose_a.rotation, 1)),
                              widened(column(pose_a.rotation, 2))};
    const vec3<double> b[] = {widened(column(pose_b.rotation, 0)), widened(column(pose_b.rotation, 1)),
                              widened(column(pose_b.rotation, 2))};
    const vec3<double> s = widened(pose_a.translation), t = widened(pose_b.translation), apart = t - s;
    const vec3<double> d{dot(a[0], apart), dot(a[1], apart), dot(a[2], apart)};

    relative_pose<T> r{};
    vec3<double> rows[3]{};
    for (int i = 0; i < 3; ++i) {
        r.rotation[i] = to_scalar<T>({dot(a[i], b[0]), dot(a[i], b[1]), dot(a[i], b[2])});
        r.magnitude[i] = absolute(r.rotation[i]);
        rows[i] = widened(r.rotation[i]);
    }
    // The columns' products with each other, by those of the rows of the transposed.
    const double dev_r =
        deviation({rows[0].x, rows[1].x, rows[2].x}, {rows[0].y, rows[1].y, rows[2].y}, {rows[0].z, rows[1].z, rows[2].z});
    const double dev_a = deviation(a[0], a[1], a[2]), dev_b = deviation(b[0], b[1], b[2]);
    const double p = farthest(around_a), q = farthest(around_b), moved = magnitudes(s) + magnitudes(t);
    constexpr double e = 2 * static_cast<double>(unit_roundoff<T>), flushed = 128 * static_cast<double>(smallest_normal<T>);
    r.deviation = static_cast<T>(dev_r);
    if (!(p + q + magnitudes(d) + moved < static_cast<double>(largest_finite<T>) / 64)) {
        r.slack = infinity<T>;
        return r;
    }
    r.translation = to_scalar<T>(d);
    r.slack = static_cast<T>(e * (16 * (p + magnitudes(d)) + 32 * q + 2 * moved) + 4 * (dev_a * p + (dev_b + dev_r) * q) +
                             flushed);
    return r;
}

namespace detail {

/// 1 if a coordinate is larger than its limit, else 0; without branches, and 0 where it or the limit is NaN.
template <scalar T>
ABUT_HD constexpr unsigned exceeds(const vec3<T>& v, const vec3<T>& limit) {
    const auto larger = [](T x, T y) { return static_cast<unsigned>(x > y); };
    return larger(v.x, limit.x) | larger(v.y, limit.y) | larger(v.z, limit.z);
}

/// Whether the faces of a's box, or of b's, tell two boxes apart; see below. N is a number, or several (box_lanes.hpp).
template <class N>
ABUT_HD constexpr auto apart_by_a(const vec3<N>& a, const vec3<N>& b, const vec3<N>& d, const vec3<N> (&m)[3], N slack) {
    return exceeds(absolute(d), a + vec3<N>{dot(m[0], b), dot(m[1], b), dot(m[2], b)} + vec3<N>{slack, slack, slack});
}
template <class N>
ABUT_HD constexpr auto apart_by_b(const vec3<N>& a, const vec3<N>& b, const vec3<N>& d, const vec3<N> (&r)[3],
                                  const vec3<N> (&m)[3], N slack) {
    return exceeds(absolute(d.x * r[0] + d.y * r[1] + d.z * r[2]),
                   a.x * m[0] + a.y * m[1] + a.z * m[2] + b + vec3<N>{slack, slack, slack});
}

/// Two boxes by their half widths (or widths, and the rest doubled as well): `d` is the way from a's centre to b's along a's
/// axes, `r` and `m` the rows of b's axes in a's frame and their magnitudes. One branch, before the edges: the faces of one
/// box alone reject some boxes that nobody can predict, and a wrong guess costs more than the faces of the other.
template <box_axes Axes, scalar T>
ABUT_HD constexpr bool boxes_overlap(const vec3<T>& a, const vec3<T>& b, const vec3<T>& d, const vec3<T> (&r)[3],
                                     const vec3<T> (&m)[3], T slack) {
    unsigned apart = apart_by_a(a, b, d, m, slack);
    if constexpr (Axes == box_axes::of_a) return apart == 0;
    apart |= apart_by_b(a, b, d, r, m, slack);
    if constexpr (Axes == box_axes::faces) return apart == 0;
    if (apart != 0) return false;
    // e_i x r_j, the three j of an i at a time. b's part is the same for each i, with another row.
    const auto part_of_b = [&b, slack](const vec3<T>& n) {
        return vec3<T>{n.y * b.z + n.z * b.y + slack, n.z * b.x + n.x * b.z + slack, n.x * b.y + n.y * b.x + slack};
    };
    apart = exceeds(absolute(d.z * r[1] - d.y * r[2]), a.y * m[2] + a.z * m[1] + part_of_b(m[0])) |
            exceeds(absolute(d.x * r[2] - d.z * r[0]), a.z * m[0] + a.x * m[2] + part_of_b(m[1])) |
            exceeds(absolute(d.y * r[0] - d.x * r[1]), a.x * m[1] + a.y * m[0] + part_of_b(m[2]));
    return apart == 0;
}

/// A box in the world around all that the shapes in `around`, posed, reach there: each coordinate by interval arithmetic in
/// double, and a margin for rounding, in here and by `place`, and for balls: a row shorter than 1 shrinks their box, and
/// their radius stays. Of all space where it overflows.
template <scalar T>
ABUT_HD constexpr aabb<T> world_box(const rigid<T>& pose, const aabb<T>& around) {
    const vec3<double> lower = widened(around.lower), upper = widened(around.upper);
    const double shift[] = {pose.translation.x, pose.translation.y, pose.translation.z};
    T low[3], high[3];
    for (int i = 0; i < 3; ++i) {
        const vec3<double> r = widened(row(pose.rotation, i));
        const vec3<double> one{r.x * lower.x, r.y * lower.y, r.z * lower.z},
            other{r.x * upper.x, r.y * upper.y, r.z * upper.z};
        const vec3<double> low_ends = least(one, other), high_ends = greatest(one, other);
        const double size = farthest(around) + absolute(shift[i]);
        // 1 - |r| is less than 1 - |r|^2, and the measuring of it less than 8 units of roundoff off.
        const double short_by = absolute(dot(r, r) - 1) * farthest(around);
        const double margin =
            short_by + 256 * static_cast<double>(unit_roundoff<T>) * size + 256 * static_cast<double>(smallest_normal<T>);
        low[i] = static_cast<T>(((low_ends.x + low_ends.y) + low_ends.z + shift[i]) - margin);
        high[i] = static_cast<T>(((high_ends.x + high_ends.y) + high_ends.z + shift[i]) + margin);
        if (!(size < static_cast<double>(largest_finite<T>) / 4)) {
            low[i] = -infinity<T>;
            high[i] = infinity<T>;
        }
    }
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

}  // namespace detail

/// Whether two boxes, each in the frame of its object, may hold shapes that meet in the world: triangles, segments, points,
/// balls or capsules placed by `place`. False is certain: see the head of this file. The boxes are not empty, and lie in
/// those of make_relative_pose.
template <box_axes Axes = box_axes::faces, scalar T>
ABUT_INLINE ABUT_HD constexpr bool overlaps(const aabb<T>& a, const relative_pose<T>& pose, const aabb<T>& b) {
    const vec3<T>* const r = pose.rotation;
    const vec3<T> middle = b.lower + b.upper, from_a = (pose.translation + pose.translation) - (a.lower + a.upper);
    const vec3<T> d = vec3<T>{dot(r[0], middle), dot(r[1], middle), dot(r[2], middle)} + from_a;
    return detail::boxes_overlap<Axes>(a.upper - a.lower, b.upper - b.lower, d, pose.rotation, pose.magnitude,
                                       2 * pose.slack);
}

}  // namespace abut
