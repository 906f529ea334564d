// SPDX-License-Identifier: MIT
#pragma once

// A filter before the searches of hull_hull.hpp and capsule_hull.hpp, for an oriented box and a few points, the ends of a
// capsule's axis, a triangle's corners, or another box: what the boxes' own directions tell, and the triangle's plane, and
// whether one of the points is inside. Not for what only two edges tell apart: that is left to the search. And for a sphere, whose
// centre in the box's frame tells all but what is close.
//
// Why it holds. All is seen from the box's centre c, in double, with u = 2^-53; size is the sum of the magnitudes of c, the
// half lengths h, the farthest point and the radius. The box is nearly the parallelepiped of c, h and the columns a_k of its
// rotation as they are given: corners are off by less than 4u size (double), or by what is rounded once to float. `off` is
// 2^-21 size (float) or 2^-45, which covers these and all of the rounding here, since no entry of a rotation is above 1 + 2^-9.
//
// Apart: any vector L tells it if all of the points are farther along L than sum |L.a_j| h_j, whatever rounding made of L.
// Inside: with E = R^T R - 1 below 2^-8 in all, the place y of a point in the box's frame is within 2^-7 max |q| of q = R^T v,
// and distances there are those of the world within 1/32. A point of the parallelepiped that is `off` below each of its faces
// is in the hull of its corners wherever these are within off / 2. What underflows is below 2^-1000.
//
// A sphere's centre v has e = q - c, where c is q brought to within the half lengths, and `skew` is above all entries of E together.
// Touching: the parallelepiped's point of the numbers c is within |e| + 2 skew |q| of v. Apart: along L = sum e_k a_k the centre is
// farther than the parallelepiped by |e|^2 - skew |e| H at least, where H is the sum of h, and |L| is no more than (1 + skew) |e|. So
// the distance is within 4 off + 4 skew size of |e|.

#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/rigid.hpp>

namespace abut::detail {

/// An oriented box in double: its columns, and how far it reaches along each.
template <scalar T>
struct oriented_frame {
    vec3<double> center, columns[3];
    double half[3], reach[3], skew = 0;
    bool is_rotation;

    ABUT_HD constexpr explicit oriented_frame(const oriented_box<T>& box)
        : center(widened(box.center)), columns{widened(column(box.rotation, 0)), widened(column(box.rotation, 1)),
                                              widened(column(box.rotation, 2))},
          half{static_cast<double>(box.half.x), static_cast<double>(box.half.y), static_cast<double>(box.half.z)}, reach{} {
        for (int k = 0; k < 3; ++k) {
            const double own = dot(columns[k], columns[k]), other = absolute(dot(columns[k], columns[(k + 1) % 3]));
            skew += absolute(own - 1) + 2 * other;
            reach[k] += own * half[k] + other * half[(k + 1) % 3];
            reach[(k + 1) % 3] += other * half[k];
        }
        is_rotation = skew < 0x1p-8;
    }
    [[nodiscard]] ABUT_HD constexpr double size() const { return magnitudes(center) + (half[0] + half[1] + half[2]); }
    /// How far it reaches along any direction.
    [[nodiscard]] ABUT_HD constexpr double along(const vec3<double>& way) const {
        return absolute(dot(way, columns[0])) * half[0] + absolute(dot(way, columns[1])) * half[1] +
               absolute(dot(way, columns[2])) * half[2];
    }
    /// Whether it has a point that comes within a radius of a place for sure, which is given by its products with the columns.
    [[nodiscard]] ABUT_HD constexpr bool has(double x, double y, double z, double radius, double off) const {
        x = absolute(x), y = absolute(y), z = absolute(z);
        const double lost = 0x1p-7 * greatest(x, y, z) + 2 * off;
        x = greatest(x + lost - half[0], 0.0), y = greatest(y + lost - half[1], 0.0), z = greatest(z + lost - half[2], 0.0);
        const double square = x * x + y * y + z * z, inner = radius - 2 * off;
        return greatest(x, y, z) == 0 || (inner > 0 && 1.125 * square + 0x1p-1000 < inner * inner);
    }
};
template <scalar T>
inline constexpr double off_of_oriented = std::same_as<T, float> ? 0x1p-21 : 0x1p-45;

/// Some points, all within `radius` of whose hull belongs to the shape.
template <scalar T, std::size_t N>
ABUT_HD constexpr verdict near_oriented(const oriented_frame<T>& box, const vec3<T> (&points)[N], T radius) {
    const double r = static_cast<double>(radius);
    vec3<double> v[N]{};
    double far = 0;
    for (std::size_t i = 0; i < N; ++i) {
        v[i] = widened(points[i]) - box.center;
        far = greatest(far, magnitudes(widened(points[i])));
    }
    const double size = box.size() + (far + r);
    if (!(box.is_rotation && size < 0x1p240)) return verdict::unknown;
    const double off = off_of_oriented<T> * size + 0x1p-1000;
    double q[N][3] = {}, mean[3] = {};
    for (int k = 0; k < 3; ++k) {
        const double reach = box.reach[k] + (2 * off + (1 + 0x1p-8) * r);
        double lowest = 0, highest = 0;
        for (std::size_t i = 0; i < N; ++i) {
            q[i][k] = dot(box.columns[k], v[i]);
            lowest = i == 0 ? q[i][k] : least(lowest, q[i][k]);
            highest = i == 0 ? q[i][k] : greatest(highest, q[i][k]);
            mean[k] += q[i][k] / static_cast<double>(N);
        }
        if (lowest > reach || highest < -reach) return verdict::no;
    }
    if constexpr (N == 3) {
        const vec3<double> n = cross(v[1] - v[0], v[2] - v[0]);
        const double reach = box.along(n) + (2 * magnitudes(n) * off + 0x1p-1000);
        const double at[] = {dot(n, v[0]), dot(n, v[1]), dot(n, v[2])};
        if (least(at[0], at[1], at[2]) > reach || greatest(at[0], at[1], at[2]) < -reach) return verdict::no;
    }
    if (box.has(mean[0], mean[1], mean[2], r, off)) return verdict::yes;
    for (std::size_t i = 0; i < N; ++i) {
        if (box.has(q[i][0], q[i][1], q[i][2], r, off)) return verdict::yes;
    }
    return verdict::unknown;
}

/// Two of them: by the directions of both, and by the corners and the centre of each in the other.
template <scalar T>
ABUT_HD constexpr verdict near_oriented(const oriented_frame<T>& a, const oriented_frame<T>& b) {
    const double size = a.size() + b.size();
    if (!(a.is_rotation && b.is_rotation && size < 0x1p240)) return verdict::unknown;
    const double off = off_of_oriented<T> * size + 0x1p-1000;
    const vec3<double> way = b.center - a.center;
    for (int k = 0; k < 3; ++k) {
        if (absolute(dot(a.columns[k], way)) > a.reach[k] + (b.along(a.columns[k]) + 4 * off)) return verdict::no;
        if (absolute(dot(b.columns[k], way)) > b.reach[k] + (a.along(b.columns[k]) + 4 * off)) return verdict::no;
    }
    for (const bool back : {false, true}) {
        const oriented_frame<T>&s = back ? b : a, &t = back ? a : b;
        double q[3] = {}, side[3][3] = {};
        for (int k = 0; k < 3; ++k) {
            q[k] = (back ? -1 : 1) * dot(s.columns[k], way);
            for (int j = 0; j < 3; ++j) side[j][k] = t.half[j] * dot(s.columns[k], t.columns[j]);
        }
        if (s.has(q[0], q[1], q[2], 0, off)) return verdict::yes;
        for (int i = 0; i < 8; ++i) {
            const double x = (i & 1) != 0 ? 1 : -1, y = (i & 2) != 0 ? 1 : -1, z = (i & 4) != 0 ? 1 : -1;
            if (s.has(q[0] + (x * side[0][0] + y * side[1][0] + z * side[2][0]),
                      q[1] + (x * side[0][1] + y * side[1][1] + z * side[2][1]),
                      q[2] + (x * side[0][2] + y * side[1][2] + z * side[2][2]), 0, off)) {
                return verdict::yes;
            }
        }
    }
    return verdict::unknown;
}

/// As one stage of a decision.
///@{
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict near_oriented(const oriented_box<T>& s, const triangle<T>& t) {
    return near_oriented(oriented_frame<T>(s), {t.a, t.b, t.c}, T(0));
}
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict near_oriented(const oriented_box<T>& s, const capsule<T>& t) {
    return near_oriented(oriented_frame<T>(s), {t.axis.a, t.axis.b}, t.radius);
}
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict near_oriented(const oriented_box<T>& s, const sphere<T>& t) {
    const oriented_frame<T> box(s);
    const vec3<double> center = widened(t.center), v = center - box.center;
    const double r = static_cast<double>(t.radius), size = box.size() + (magnitudes(center) + r);
    if (!(box.is_rotation && size < 0x1p240)) return verdict::unknown;
    const double lost = 4 * (off_of_oriented<T> * size + 0x1p-1000) + 4 * box.skew * size;
    double square = 0;
    for (int k = 0; k < 3; ++k) {
        const double beyond = greatest(absolute(dot(box.columns[k], v)) - box.half[k], 0.0);
        square += beyond * beyond;
    }
    const double inner = r - lost, outer = r + lost;
    if (inner > 0 && square + 0x1p-1000 <= inner * inner) return verdict::yes;
    return square > outer * outer + 0x1p-1000 ? verdict::no : verdict::unknown;
}
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict near_oriented(const oriented_box<T>& s, const oriented_box<T>& t) {
    return near_oriented(oriented_frame<T>(s), oriented_frame<T>(t));
}
///@}

}  // namespace abut::detail
