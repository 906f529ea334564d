// SPDX-License-Identifier: MIT
#pragma once

// Oriented boxes: fitted to triangles by the principal axes of their corners, merged, and compared by fifteen separating
// axes (S. Gottschalk, M. Lin, D. Manocha, OBBTree, 1996).
//
// What a box holds: all x with |a_i . (x - c)| <= h_i, for the numbers as they are stored. Its axes are orthonormal
// within 16 units in the last place, but not more, so that x is not quite c + sum y_i a_i with |y_i| <= h_i: it is up to
// 55 e |h| away from there, where e = 2u is the relative error of an operation in any rounding mode. That, and the rest
// that the test of two boxes has to allow for, with the notation of relative_pose.hpp, where A and B are the boxes' axes
// as rows:
//     A R (B^-1 - B^T) y                    55 e |h_b|
//     A R B^T as computed                   19 e |h_b|          two products of matrices, each rounded
//     that it is not orthonormal            227 e |h_b|         148 e for two rotations; cofactors are 1.53 times that
//                                           4.6 dev(R) |h_b|    R^T R - 1 stretches by 3 dev(R), and as above
//     the way between the centres, turned   18 e (|c_a| + |t| + |c_b|)
//     sums of half widths                   7 e (|h_a| + |h_b|)
// together, along axes no longer than 1.003, below e (20 (|c_a| + |t| + |c_b|) + 8 |h_a| + 330 |h_b|) + 5 dev(R) |h_b|, and
// 128 m for what is flushed to zero. To this the slack of the relative pose is added, which is larger than the error that it
// stands for.

#include <cstddef>
#include <type_traits>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/box_measure.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/relative_pose.hpp>

namespace abut {

/// @addtogroup volumes
///@{

/// All x with |axes[i] . (x - center)| <= half_widths[i]. The axes are orthonormal within 16 units in the last place. A half
/// width may be infinite.
template <scalar T>
struct obb {
    vec3<T> center;       ///< in the frame of the triangles
    vec3<T> axes[3];      ///< unit vectors, but for rounding
    vec3<T> half_widths;  ///< from the centre to each face, in units of length
};

namespace detail {

/// How far a box reaches from its centre along an axis, but for rounding.
template <scalar T>
ABUT_HD constexpr double reach_along(const obb<T>& b, const vec3<double>& axis) {
    const vec3<double> h = widened(b.half_widths);
    return absolute(dot(axis, widened(b.axes[0]))) * h.x + absolute(dot(axis, widened(b.axes[1]))) * h.y +
           absolute(dot(axis, widened(b.axes[2]))) * h.z;
}

/// Axes in double, and the least half widths along them that hold what has been seen so far.
struct obb_fit {
    vec3<double> center, axes[3], half_widths;

    template <scalar T>
    ABUT_HD constexpr obb_fit(const vec3<T>& middle, const vec3<T> (&along)[3])
        : center(widened(middle)), axes{widened(along[0]), widened(along[1]), widened(along[2])}, half_widths{0, 0, 0} {}

    /// `off` is on top of what rounding the product takes.
    ABUT_HD static constexpr void see(double& most, const vec3<double>& axis, const vec3<double>& p, double off) {
        constexpr double e = 2 * unit_roundoff<double>;
        const double far =
            absolute(dot(axis, p)) + (8 * e * dot(absolute(axis), absolute(p)) + off + 16 * smallest_normal<double>);
        most = far <= largest_finite<double> ? greatest(most, far) : infinity<double>;  // NaN as well
    }
    ABUT_HD constexpr void see(const vec3<double>& p, const vec3<double>& off) {
        const vec3<double> way = p - center;
        see(half_widths.x, axes[0], way, off.x);
        see(half_widths.y, axes[1], way, off.y);
        see(half_widths.z, axes[2], way, off.z);
    }
    template <scalar T>
    ABUT_HD constexpr void see(const obb<T>& b) {
        const double lost = 160 * static_cast<double>(unit_roundoff<T>) * magnitudes(widened(b.half_widths));
        see(widened(b.center),
            {reach_along(b, axes[0]) + lost, reach_along(b, axes[1]) + lost, reach_along(b, axes[2]) + lost});
    }
    template <scalar T>
    [[nodiscard]] ABUT_HD constexpr vec3<T> rounded_widths() const {
        return {rounded_up<T>(half_widths.x), rounded_up<T>(half_widths.y), rounded_up<T>(half_widths.z)};
    }
};

/// A symmetric matrix turned by Jacobi's rotations until it is diagonal; the rows of `v` are then its principal axes.
/// G. Golub, C. Van Loan, Matrix Computations, 8.5. Six rounds are more than 3 x 3 needs. Entries below `negligible` are
/// noise.
struct principal_axes {
    double m[3][3];
    vec3<double> v[3];
    double negligible;

    ABUT_HD constexpr void rotate(int p, int q) {
        const double off = m[p][q];
        if (absolute(off) <= negligible) return;
        const double theta = (m[q][q] - m[p][p]) / (2 * off), size = absolute(theta);
        const double t = (theta < 0 ? -1 : 1) / (size + (size < 0x1p500 ? square_root(size * size + 1) : size));
        const double c = 1 / square_root(t * t + 1), s = t * c;
        const int r = 3 - p - q;
        m[p][p] -= t * off;
        m[q][q] += t * off;
        m[p][q] = m[q][p] = 0;
        const double rp = m[r][p], rq = m[r][q];
        m[r][p] = m[p][r] = c * rp - s * rq;
        m[r][q] = m[q][r] = s * rp + c * rq;
        const vec3<double> vp = v[p], vq = v[q];
        v[p] = c * vp - s * vq;
        v[q] = s * vp + c * vq;
    }
    ABUT_HD constexpr void diagonalise() {
        for (int round = 0; round < 6; ++round) {
            rotate(0, 1);
            rotate(0, 2);
            rotate(1, 2);
        }
    }
};

ABUT_HD constexpr vec3<double> unit(const vec3<double>& v) { return (1 / square_root(dot(v, v))) * v; }

/// The rounding that is left in the products of rotations is taken out.
template <scalar T>
ABUT_HD constexpr void set_axes(vec3<T> (&axes)[3], const vec3<double> (&v)[3]) {
    const vec3<double> x = unit(v[0]), y = unit(v[1] - dot(v[1], x) * x), z = cross(x, y);
    axes[0] = to_scalar<T>(x);
    axes[1] = to_scalar<T>(y);
    axes[2] = to_scalar<T>(z);
}

/// How corners spread, by their covariance in units of `scale` from `middle`: nothing overflows, and what underflows is
/// nothing beside the rest.
struct corner_spread {
    vec3<double> middle;
    double scale, count = 0;
    vec3<double> sum{0, 0, 0}, squares{0, 0, 0}, products{0, 0, 0};

    template <scalar T>
    ABUT_HD constexpr explicit corner_spread(const aabb<T>& box)
        : middle(0.5 * widened(box.lower) + 0.5 * widened(box.upper)), scale(1) {
        const vec3<double> size = widened(box.upper) - middle;
        const double most = longest(size);
        if (most > 0) scale = most;
    }
    template <scalar T>
    [[nodiscard]] ABUT_HD constexpr vec3<double> in_units(const vec3<T>& p) const {
        const vec3<double> way = widened(p) - middle;
        return {way.x / scale, way.y / scale, way.z / scale};
    }
    ABUT_HD constexpr void add(const vec3<double>& p) {
        count += 1;
        sum = sum + p;
        squares = squares + vec3<double>{p.x * p.x, p.y * p.y, p.z * p.z};
        products = products + vec3<double>{p.y * p.z, p.z * p.x, p.x * p.y};
    }
    [[nodiscard]] ABUT_HD constexpr principal_axes axes() const {
        const vec3<double> m = (1 / count) * sum, s = (1 / count) * squares, p = (1 / count) * products;
        const double xx = s.x - m.x * m.x, yy = s.y - m.y * m.y, zz = s.z - m.z * m.z;
        const double yz = p.x - m.y * m.z, zx = p.y - m.z * m.x, xy = p.z - m.x * m.y;
        principal_axes r{
            {{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0x1p-60 * absolute(xx + yy + zz)};
        r.diagonalise();
        return r;
    }
};

/// A centre in T: `wanted`, or `safe` where that is too large.
template <scalar T>
ABUT_HD constexpr vec3<T> center_at(const vec3<double>& wanted, const vec3<double>& safe) {
    return to_scalar<T>(magnitudes(wanted) < static_cast<double>(largest_finite<T>) / 4 ? wanted : safe);
}

/// The box along a's axes around both, from the middle of their extents.
template <scalar T>
ABUT_HD constexpr obb<T> merged_along(const obb<T>& a, const obb<T>& b) {
    const vec3<double> from = widened(a.center), way = widened(b.center) - from;
    const double own[3] = {double(a.half_widths.x), double(a.half_widths.y), double(a.half_widths.z)};
    vec3<double> middle = from;
    for (int i = 0; i < 3; ++i) {
        const vec3<double> axis = widened(a.axes[i]);
        const double at = dot(axis, way), reach = reach_along(b, axis);
        middle = middle + (0.5 * (least(at - reach, -own[i]) + greatest(at + reach, own[i]))) * axis;
    }
    obb<T> r{center_at<T>(middle, from), {a.axes[0], a.axes[1], a.axes[2]}, {}};
    obb_fit fit(r.center, r.axes);
    fit.see(a);
    fit.see(b);
    r.half_widths = fit.rounded_widths<T>();
    return r;
}

}  // namespace detail

/// A box around triangles, at least one, along the principal axes of their corners. What rounding does to axes and centre
/// makes it larger, and no corner is lost: the half widths are measured last.
template <scalar T, class Triangles>
ABUT_HD constexpr obb<T> around_all(std::type_identity<obb<T>>, const Triangles& triangles) {
    using namespace detail;
    corner_spread spread(box_around<T>(triangles));
    for_each_corner<T>(triangles, [&](const vec3<T>& p) { spread.add(spread.in_units(p)); });
    const principal_axes found = spread.axes();

    vec3<double> lower{infinity<double>, infinity<double>, infinity<double>}, upper = -1.0 * lower;
    for_each_corner<T>(triangles, [&](const vec3<T>& p) {
        const vec3<double> q = spread.in_units(p), along{dot(found.v[0], q), dot(found.v[1], q), dot(found.v[2], q)};
        lower = least(along, lower);
        upper = greatest(along, upper);
    });
    const vec3<double> way = (0.5 * spread.scale) * (lower + upper);
    obb<T> r{};
    r.center = center_at<T>(spread.middle + way.x * found.v[0] + way.y * found.v[1] + way.z * found.v[2], spread.middle);
    set_axes(r.axes, found.v);
    obb_fit fit(r.center, r.axes);
    for_each_corner<T>(triangles, [&fit](const vec3<T>& p) { fit.see(widened(p), {0, 0, 0}); });
    r.half_widths = fit.rounded_widths<T>();
    return r;
}

/// A box around both: along the axes of a or of b, whichever makes the smaller surface.
template <scalar T>
ABUT_HD constexpr obb<T> merge(const obb<T>& a, const obb<T>& b) {
    const obb<T> along_a = detail::merged_along(a, b), along_b = detail::merged_along(b, a);
    const auto surface = [](const obb<T>& box) { return detail::half_surface(detail::widened(box.half_widths)); };
    return surface(along_b) < surface(along_a) ? along_b : along_a;
}

/// A box along the coordinate axes around it.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const obb<T>& b) {
    detail::obb_fit fit(b.center, {{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}});
    fit.see(b);
    const vec3<T> h = fit.rounded_widths<T>();
    return {{add_down(b.center.x, -h.x), add_down(b.center.y, -h.y), add_down(b.center.z, -h.z)},
            {add_up(b.center.x, h.x), add_up(b.center.y, h.y), add_up(b.center.z, h.z)}};
}

/// Less than the square of p's distance to what the box holds, or equal. By the box's own terms x - p has a component of at
/// least |a_i . (p - c)| - h_i along each axis. That is computed with an error below 16u (|p - c| + h_i), in any rounding
/// mode, and axes that are orthonormal within 32u stretch lengths by less than 100u; from there on all is relative.
template <scalar T>
ABUT_HD constexpr T least_squared_distance(const obb<T>& b, const vec3<T>& p) {
    const vec3<T> way = p - b.center;
    const T size = detail::magnitudes(way), off = 16 * unit_roundoff<T> * size + 16 * smallest_normal<T>;
    const auto beyond = [&](const vec3<T>& axis, T half_width) {
        const T gap = detail::absolute(dot(axis, way)) - (half_width + 16 * unit_roundoff<T> * half_width + off);
        return gap > 0 ? gap * gap : T(0);
    };
    const T square = beyond(b.axes[0], b.half_widths.x) + beyond(b.axes[1], b.half_widths.y) +
                     beyond(b.axes[2], b.half_widths.z);
    return size < largest_finite<T> / 64 ? detail::least(square, largest_finite<T>) * (1 - 256 * unit_roundoff<T>) : T(0);
}

namespace detail {

/// What |h_b| counts in the error of the test, where the rotation between the frames has this deviation.
template <scalar T>
ABUT_HD constexpr T turned_off(T deviation) {
    constexpr T e = 2 * unit_roundoff<T>;
    return 330 * e + 5 * deviation;
}

/// `b_axes` are b's axes in the frame in which a is; `way` leads from a's centre to b's there, and has been computed from
/// numbers whose magnitudes add up to `size`. `off_by_b` is the error in units of |h_b| (`turned_off`).
template <box_axes Axes, scalar T>
ABUT_HD constexpr bool obbs_overlap(const obb<T>& a, const vec3<T> (&b_axes)[3], const vec3<T>& b_half_widths,
                                    const vec3<T>& way, T size, T off_by_b, T slack) {
    constexpr T e = 2 * unit_roundoff<T>, flushed = 128 * smallest_normal<T>;
    const T of_a = magnitudes(a.half_widths), of_b = magnitudes(b_half_widths);
    vec3<T> r[3]{}, m[3]{};
    for (int i = 0; i < 3; ++i) {
        r[i] = {dot(a.axes[i], b_axes[0]), dot(a.axes[i], b_axes[1]), dot(a.axes[i], b_axes[2])};
        m[i] = absolute(r[i]);
    }
    const vec3<T> d{dot(a.axes[0], way), dot(a.axes[1], way), dot(a.axes[2], way)};
    const T all = slack + (e * (20 * size + 8 * of_a) + off_by_b * of_b + flushed);
    return boxes_overlap<Axes>(a.half_widths, b_half_widths, d, r, m, all) ||
           !(size + of_a + of_b + slack < largest_finite<T> / 64);
}

}  // namespace detail

/// Whether the boxes may share a point. False is certain.
template <box_axes Axes = box_axes::all, scalar T>
ABUT_HD constexpr bool overlaps(const obb<T>& a, const obb<T>& b) {
    return detail::obbs_overlap<Axes>(a, b.axes, b.half_widths, b.center - a.center,
                                      detail::magnitudes(a.center) + detail::magnitudes(b.center), detail::turned_off(T(0)),
                                      T(0));
}

/// Whether boxes, each in the frame of its object, may hold shapes that meet in the world, as for aabb (relative_pose.hpp).
template <box_axes Axes = box_axes::all, scalar T>
ABUT_HD constexpr bool overlaps(const obb<T>& a, const relative_pose<T>& pose, const obb<T>& b) {
    using detail::magnitudes;
    const auto turned = [&pose](const vec3<T>& v) {
        return vec3<T>{dot(pose.rotation[0], v), dot(pose.rotation[1], v), dot(pose.rotation[2], v)};
    };
    const vec3<T> axes[3] = {turned(b.axes[0]), turned(b.axes[1]), turned(b.axes[2])};
    const vec3<T> way = turned(b.center) + (pose.translation - a.center);
    return detail::obbs_overlap<Axes>(a, axes, b.half_widths, way,
                                      magnitudes(a.center) + magnitudes(pose.translation) + magnitudes(b.center),
                                      detail::turned_off(pose.deviation), pose.slack);
}

///@}

}  // namespace abut
