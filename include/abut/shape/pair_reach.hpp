// SPDX-License-Identifier: MIT
#pragma once

// How near boxes of two sets have to come to each other to matter, for walks that look for the nearest shapes of two sets:
// in one frame, or each in the frame of its own object under a pose. What is left out is surely farther than a distance that
// shrinks as nearer shapes are found. Points that look alone are in point_reach.hpp.

#include <cmath>
#include <concepts>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/aabb.hpp>
#include <abut/shape/obb.hpp>
#include <abut/shape/point_reach.hpp>
#include <abut/shape/ray_reach.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/shape/rigid.hpp>

namespace abut {

/// A prune functor for pairs of boxes that tightens. `least_between(a, b)` orders pairs of boxes by how far apart what lies
/// in them is at least; `keeps(least)` is what the reach says of such a pair; and after `shrink_to(bound)` it may leave out
/// what is farther apart than bound, and nothing else. `turn_to(way)` tells it a way in the world, from what lies in a to
/// what lies in b, along which gaps are likely to be wide. `see_of_a(box)` and `see_of_b(box)` are what `least_between` takes
/// as well, for boxes that are in several pairs before the reach turns.
template <class R, class T>
concept shrinking_pair_reach = requires(R& reach, const aabb<T>& box, double bound) {
    { reach.least_between(box, box) } -> std::same_as<T>;
    { reach.least_between(reach.see_of_a(box), reach.see_of_b(box)) } -> std::same_as<T>;
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
    [[nodiscard]] ABUT_HD const aabb<T>& see_of_a(const aabb<T>& a) const { return a; }
    [[nodiscard]] ABUT_HD const aabb<T>& see_of_b(const aabb<T>& b) const { return b; }
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
    /// A box of a, and one of b, with what is asked of it in each pair.
    ///@{
    struct seen_of_a {
        vec3<T> off, wide;  ///< off: twice from its middle to b's origin
        T reach;
    };
    struct seen_of_b {
        vec3<T> middle, wide, wide_in_a;  ///< twice the middle, from b's origin in a's frame
        T reach;
    };
    [[nodiscard]] ABUT_HD seen_of_a see_of_a(const aabb<T>& a) const {
        return {(b_to_a.translation + b_to_a.translation) - (a.lower + a.upper), a.upper - a.lower, twice_reach_along(n, a)};
    }
    [[nodiscard]] ABUT_HD seen_of_b see_of_b(const aabb<T>& b) const {
        const vec3<T> wide = b.upper - b.lower;
        return {in_a(b.lower + b.upper), wide, magnitude_in_a(wide), twice_reach_along(-T(1) * n_of_b, b)};
    }
    ///@}
    ABUT_HD T least_between(const aabb<T>& a, const aabb<T>& b) const { return least_between(see_of_a(a), see_of_b(b)); }
    ABUT_HD T least_between(const seen_of_a& a, const seen_of_b& b) const {
        const T gap = (twice_apart - a.reach) - b.reach;
        const T along_n = gap > 0 ? gap * gap : 0;
        if (along_n > this->limit) return along_n;
        const vec3<T>(&r)[3] = b_to_a.rotation, (&m)[3] = b_to_a.magnitude;
        const vec3<T> d = b.middle + a.off;
        const T along_a = square_of_gaps(absolute(d) - (a.wide + b.wide_in_a));
        if (along_a > this->limit) return along_a;
        const T along_b = square_of_gaps(absolute(d.x * r[0] + d.y * r[1] + d.z * r[2]) -
                                         (a.wide.x * m[0] + a.wide.y * m[1] + a.wide.z * m[2] + b.wide));
        return greatest(along_n, along_a, along_b);
    }
    /// Oriented boxes: along the direction, or the way between their middles, or the axes of one of them. Their corners may
    /// lie beyond the boxes that the slack was made for, no farther than three times as far.
    ///@{
    struct oriented_of_a {
        vec3<T> axes[3], half_widths, off;  ///< off: from its center to b's origin
        T reach;
    };
    struct oriented_of_b {
        vec3<T> axes[3], half_widths, center;  ///< in a's frame
        T reach;
    };
    [[nodiscard]] ABUT_HD oriented_of_a see_of_a(const obb<T>& a) const {
        return {{a.axes[0], a.axes[1], a.axes[2]}, a.half_widths, b_to_a.translation - a.center, twice_reach_along(n, a)};
    }
    [[nodiscard]] ABUT_HD oriented_of_b see_of_b(const obb<T>& b) const {
        return {{in_a(b.axes[0]), in_a(b.axes[1]), in_a(b.axes[2])},
                b.half_widths,
                in_a(b.center),
                twice_reach_along(-T(1) * n_of_b, b)};
    }
    ABUT_HD T least_between(const obb<T>& a, const obb<T>& b) const { return least_between(see_of_a(a), see_of_b(b)); }
    ABUT_HD T least_between(const oriented_of_a& a, const oriented_of_b& b) const {
        const T gap = (twice_apart - a.reach) - b.reach;
        const T along_n = gap > 0 ? gap * gap : 0;
        if (along_n > this->limit) return along_n;
        const vec3<T> w = b.center + a.off, &h = a.half_widths, &k = b.half_widths;
        const auto along = [](const vec3<T>& v, const vec3<T>(&axes)[3]) {
            return absolute(vec3<T>{dot(v, axes[0]), dot(v, axes[1]), dot(v, axes[2])});
        };
        const vec3<T> of_a = along(w, a.axes), of_b = along(w, b.axes);
        const T ww = dot(w, w), of_w = ww - (dot(of_a, h) + dot(of_b, k));
        const T along_w = 4 * (of_w > 0 ? of_w * (of_w / (ww * T(1 + 0x1p-18))) : 0);
        if (along_w > this->limit) return along_w;
        const vec3<T> of_x = along(a.axes[0], b.axes), of_y = along(a.axes[1], b.axes), of_z = along(a.axes[2], b.axes);
        const T along_a = 4 * square_of_gaps(of_a - (h + vec3<T>{dot(of_x, k), dot(of_y, k), dot(of_z, k)}));
        if (along_a > this->limit) return along_a;
        const T along_b = 4 * square_of_gaps(of_b - (k + (h.x * of_x + h.y * of_y + h.z * of_z)));
        return greatest(greatest(along_w, along_a), greatest(along_b, along_n));
    }
    ///@}

private:
    [[nodiscard]] ABUT_HD vec3<T> in_a(const vec3<T>& v) const {
        const vec3<T>(&r)[3] = b_to_a.rotation;
        return {dot(r[0], v), dot(r[1], v), dot(r[2], v)};
    }
    [[nodiscard]] ABUT_HD vec3<T> magnitude_in_a(const vec3<T>& v) const {
        const vec3<T>(&m)[3] = b_to_a.magnitude;
        return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
    }
};

/// Boxes of one frame, of which the first goes along a way: by when it meets the second one at the soonest. The differences of
/// points of both are a box, into which the way leads from the origin.
template <scalar T>
struct boxes_that_meet {
    ray_reach<T> way;

    ABUT_HD explicit boxes_that_meet(const vec3<T>& along) : way({0, 0, 0}, along, 1) {}
    [[nodiscard]] ABUT_HD bool keeps(T least) const { return way.keeps(least); }
    ABUT_HD void shrink_to(double time) { way.shrink_to(time); }
    ABUT_HD void turn_to(const vec3<double>&) {}
    [[nodiscard]] ABUT_HD const aabb<T>& see_of_a(const aabb<T>& a) const { return a; }
    [[nodiscard]] ABUT_HD const aabb<T>& see_of_b(const aabb<T>& b) const { return b; }
    ABUT_HD T least_between(const aabb<T>& a, const aabb<T>& b) const {
        // No way leads farther than to the largest number.
        constexpr T most = largest_finite<T>;
        const auto down = [](T from, T to) { return greatest(add_down(to, -from), -most); };
        const auto up = [](T from, T to) { return least(add_up(to, -from), most); };
        return way.least_in({{down(a.upper.x, b.lower.x), down(a.upper.y, b.lower.y), down(a.upper.z, b.lower.z)},
                             {up(a.lower.x, b.upper.x), up(a.lower.y, b.upper.y), up(a.lower.z, b.upper.z)}});
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
