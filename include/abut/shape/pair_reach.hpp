// SPDX-License-Identifier: MIT
#pragma once

// How near boxes of two sets have to come to each other to matter, for walks that look for the nearest shapes of two sets:
// in one frame, or each in the frame of its own object under a pose. What is left out is surely farther than a distance that
// shrinks as nearer shapes are found. Points that look alone are in point_reach.hpp.

#include <cmath>
#include <concepts>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/obb.hpp>
#include <abut/shape/point_reach.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/shape/rigid.hpp>

namespace abut {

/// A prune functor for pairs of boxes that tightens. `least_between(a, b)` orders pairs of boxes by how far apart what lies
/// in them is at least; `keeps(least)` is what the reach says of such a pair; and after `shrink_to(bound)` it may leave out
/// what is farther apart than bound, and nothing else. `turn_to(way)` tells it a way in the world, from what lies in a to
/// what lies in b, along which gaps are likely to be wide.
template <class R, class T>
concept shrinking_pair_reach = requires(R& reach, const aabb<T>& box, double bound) {
    { reach.least_between(box, box) } -> std::same_as<T>;
    { reach.keeps(T{}) } -> std::same_as<bool>;
    reach.shrink_to(bound);
    reach.turn_to(vec3<double>{});
};

namespace detail {

/// Keeps squares up to that of a distance in the world. They are computed with a relative error below 6u, and the limit has
/// 32u; see shrinking_ball, which also says what becomes of overflow and underflow.
template <scalar T>
struct distance_limit {
    distance_map map;
    T limit = infinity<T>;

    /// NaN is kept.
    [[nodiscard]] ABUT_HD bool keeps(T least) const { return !(least > limit); }
    ABUT_HD void shrink_to(double distance) {
        constexpr double grown = 1 + 32 * static_cast<double>(unit_roundoff<T>);
        constexpr double tiny = 2 * static_cast<double>(smallest_normal<T>);
        const double radius = (distance * map.unit + map.slack) * map.stretch;
        const double square = radius * radius * grown + tiny;
        limit = square < static_cast<double>(largest_finite<T>) ? static_cast<T>(square) : infinity<T>;
    }
};

template <scalar T>
ABUT_HD T square_of_gaps(const vec3<T>& gap) {
    const vec3<T> least_gap = greatest(gap, vec3<T>{0, 0, 0});
    return dot(least_gap, least_gap);
}

/// A vector of length 1 at most along a way, as it is rounded; 0 for 0 and for what is no number.
template <scalar T>
ABUT_HD vec3<T> direction_of(const vec3<double>& way) {
    const double largest = greatest(absolute(way.x), absolute(way.y), absolute(way.z));
    if (!(largest > 0 && largest < infinity<double>)) return {0, 0, 0};
    const vec3<double> v{way.x / largest, way.y / largest, way.z / largest};
    const double length = std::sqrt(dot(v, v)) * (1 + 0x1p-20);
    return {static_cast<T>(v.x / length), static_cast<T>(v.y / length), static_cast<T>(v.z / length)};
}
/// How far a box reaches along a direction, at most, twice.
template <scalar T>
ABUT_HD T twice_reach_along(const vec3<T>& n, const aabb<T>& box) {
    const vec3<T> middle = box.lower + box.upper, width = box.upper - box.lower;
    return dot(n, middle) + dot(absolute(n), width);
}

template <scalar T>
ABUT_HD T twice_reach_along(const vec3<T>& n, const obb<T>& box) {
    const T half = absolute(dot(n, box.axes[0])) * box.half_widths.x + absolute(dot(n, box.axes[1])) * box.half_widths.y +
                   absolute(dot(n, box.axes[2])) * box.half_widths.z;
    return 2 * (dot(n, box.center) + half);
}

/// Boxes of one frame. Gaps along the axes are differences of two coordinates, and so need no slack; a gap along another
/// direction would.
template <scalar T>
struct near_boxes : distance_limit<T> {
    ABUT_HD void turn_to(const vec3<double>&) {}
    ABUT_HD T least_between(const aabb<T>& a, const aabb<T>& b) const {
        return square_of_gaps(greatest(a.lower - b.upper, b.lower - a.upper));
    }
};

/// Boxes of two frames, a's and b's: twice the distance between them, at least, is the length of the gaps along the axes of
/// a's box, or along those of b's, or the gap along any other direction.
///
/// relative_pose.hpp derives p = R q + d + error for points that meet in the world. Points x and y of the world that do not
/// meet give A^T (x - y) = p - (R q + d) - error with the same error, of no length above the slack. No singular value of A
/// is above 1 + 1.6 dev(A), nor one of R, whose columns are b's axes, above 1 + 1.6 dev(R). So what is g apart as it is
/// computed here is at least (g - slack) / ((1 + 1.6 dev(A)) (1 + 1.6 dev(R))) apart in the world, where three times the
/// slack covers the rounding of the three gaps too. A distance that is measured in double is off by less than a tenth of the
/// slack. The direction is any vector of length 1 at most, in a's frame; its rounding moves the gap of no box that it is
/// multiplied with.
template <scalar T>
struct near_posed_boxes : distance_limit<T> {
    relative_pose<T> b_to_a;
    vec3<T> world_to_a[3];                ///< rows
    vec3<T> n{0, 0, 0}, n_of_b{0, 0, 0};  ///< the direction in both frames
    T twice_apart = 0;                    ///< of the frames' origins along it

    near_posed_boxes() = default;
    ABUT_HD near_posed_boxes(const rigid<T>& pose_a, const aabb<T>& around_a, const rigid<T>& pose_b,
                             const aabb<T>& around_b)
        : b_to_a(make_relative_pose(pose_a, around_a, pose_b, around_b)),
          world_to_a{column(pose_a.rotation, 0), column(pose_a.rotation, 1), column(pose_a.rotation, 2)} {
        const double off_a = deviation(widened(world_to_a[0]), widened(world_to_a[1]), widened(world_to_a[2]));
        const double stretch = (1 + 2 * off_a) * (1 + 2 * static_cast<double>(b_to_a.deviation));
        this->map = {2, 6 * static_cast<double>(b_to_a.slack), stretch};
    }
    ABUT_HD void turn_to(const vec3<double>& way) {
        const vec3<double> in_a{dot(widened(world_to_a[0]), way), dot(widened(world_to_a[1]), way),
                                dot(widened(world_to_a[2]), way)};
        const vec3<T>(&r)[3] = b_to_a.rotation;
        n = direction_of<T>(in_a);
        n_of_b = n.x * r[0] + n.y * r[1] + n.z * r[2];
        twice_apart = 2 * dot(n, b_to_a.translation);
    }
    ABUT_HD T least_between(const aabb<T>& a, const aabb<T>& b) const {
        const T gap = (twice_apart - twice_reach_along(n, a)) - twice_reach_along(-T(1) * n_of_b, b);
        const T along_n = gap > 0 ? gap * gap : 0;
        if (along_n > this->limit) return along_n;
        const vec3<T>(&r)[3] = b_to_a.rotation, (&m)[3] = b_to_a.magnitude;
        const vec3<T> middle = b.lower + b.upper, wide_a = a.upper - a.lower, wide_b = b.upper - b.lower;
        const vec3<T> d = vec3<T>{dot(r[0], middle), dot(r[1], middle), dot(r[2], middle)} +
                          ((b_to_a.translation + b_to_a.translation) - (a.lower + a.upper));
        const T along_a =
            square_of_gaps(absolute(d) - (wide_a + vec3<T>{dot(m[0], wide_b), dot(m[1], wide_b), dot(m[2], wide_b)}));
        if (along_a > this->limit) return along_a;
        const T along_b = square_of_gaps(absolute(d.x * r[0] + d.y * r[1] + d.z * r[2]) -
                                         (wide_a.x * m[0] + wide_a.y * m[1] + wide_a.z * m[2] + wide_b));
        return greatest(along_n, along_a, along_b);
    }
    /// Oriented boxes: along the direction, or the way between their middles, or the axes of one of them. Their corners may
    /// lie beyond the boxes that the slack was made for, no farther than three times as far.
    ABUT_HD T least_between(const obb<T>& a, const obb<T>& b) const {
        const T gap = (twice_apart - twice_reach_along(n, a)) - twice_reach_along(-T(1) * n_of_b, b);
        const T along_n = gap > 0 ? gap * gap : 0;
        if (along_n > this->limit) return along_n;
        const vec3<T>(&r)[3] = b_to_a.rotation;
        const auto to_a = [&r](const vec3<T>& v) { return vec3<T>{dot(r[0], v), dot(r[1], v), dot(r[2], v)}; };
        const vec3<T> axes_b[3] = {to_a(b.axes[0]), to_a(b.axes[1]), to_a(b.axes[2])};
        const vec3<T> w = to_a(b.center) + (b_to_a.translation - a.center), &h = a.half_widths, &k = b.half_widths;
        vec3<T> gaps_a, gaps_b;
        T half = 0;  // of both boxes along w
        const auto along_axes = [&](int i, T& gap_a, T& gap_b, T h_i, T k_i) {
            const T of_a = absolute(dot(w, a.axes[i])), of_b = absolute(dot(w, axes_b[i]));
            half += of_a * h_i + of_b * k_i;
            gap_a = of_a - (h_i + absolute(dot(a.axes[i], axes_b[0])) * k.x + absolute(dot(a.axes[i], axes_b[1])) * k.y +
                            absolute(dot(a.axes[i], axes_b[2])) * k.z);
            gap_b = of_b - (k_i + absolute(dot(axes_b[i], a.axes[0])) * h.x + absolute(dot(axes_b[i], a.axes[1])) * h.y +
                            absolute(dot(axes_b[i], a.axes[2])) * h.z);
        };
        along_axes(0, gaps_a.x, gaps_b.x, h.x, k.x);
        along_axes(1, gaps_a.y, gaps_b.y, h.y, k.y);
        along_axes(2, gaps_a.z, gaps_b.z, h.z, k.z);
        const T ww = dot(w, w) * T(1 + 0x1p-18), of_w = dot(w, w) - half;
        const T along_w = of_w > 0 ? of_w * (of_w / ww) : 0;
        return greatest(4 * greatest(along_w, square_of_gaps(gaps_a), square_of_gaps(gaps_b)), along_n);
    }
};

/// What one box of the first side sees of boxes of the second.
template <class PairReach, scalar T>
struct near_one_box {
    PairReach pairs;
    aabb<T> query;

    ABUT_HD T least_in(const aabb<T>& box) const { return pairs.least_between(query, box); }
    [[nodiscard]] ABUT_HD bool keeps(T least) const { return pairs.keeps(least); }
    ABUT_HD bool operator()(const aabb<T>& box) const { return keeps(least_in(box)); }
    ABUT_HD void shrink_to(double distance) { pairs.shrink_to(distance); }
    ABUT_HD void turn_to(const vec3<double>& way) { pairs.turn_to(way); }
};

/// A ball around a box that looks, for indices that take no boxes. `ball` is around the box's middle.
template <scalar T>
struct near_ball_of_box : shrinking_ball<T> {
    double half = 0;  ///< no corner of the box is farther from the middle

    ABUT_HD near_ball_of_box(const shrinking_ball<T>& ball, double half_of_box)
        : shrinking_ball<T>(ball), half(half_of_box) {}
    ABUT_HD void shrink_to(double distance) {
        const double radius = (distance + half) * (1 + 0x1p-50);
        shrinking_ball<T>::shrink_to(radius * radius);
    }
    ABUT_HD void turn_to(const vec3<double>&) {}
};

}  // namespace detail

}  // namespace abut
