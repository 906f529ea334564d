// SPDX-License-Identifier: MIT
#pragma once

// How far a point reaches that looks for what is nearest to it, in the world and in the frame of an object under a pose, and
// how far points reach that look together.

#include <cmath>
#include <concepts>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/aabb.hpp>
#include <abut/shape/corners.hpp>
#include <abut/shape/reach.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/shape/rigid.hpp>

namespace abut {

/// What a query reaches, less and less far (of grids a prune functor as well). `least_in(box)` orders boxes by how much what
/// lies in them measures at least; `keeps(least)` is what the reach says of a box of that; and after `shrink_to(bound)` it
/// may leave out what measures more than bound, and nothing else.
template <class R, class T>
concept shrinking_reach = requires(R& reach, const aabb<T>& box, double bound) {
    { reach.least_in(box) } -> std::same_as<T>;
    { reach.keeps(T{}) } -> std::same_as<bool>;
    reach.shrink_to(bound);
};

namespace detail {

/// How squared distances in the world relate to those from a point to boxes in the frame of an object: what is at least x
/// away in the frame is at least (x - slack) / stretch away in the world. Lengths in the world have a unit of their own.
struct distance_map {
    double unit = 1, slack = 0, stretch = 1;
};

/// A ball around a point, of all space at first, which shrinks to squared distances that are found. What is cut off is
/// surely farther: the square of a box's distance is computed with a relative error below 6u, as for ball_reach, and the
/// limit has 32u, which covers its own rounding too; underflow is below twice the smallest normal number. A limit that
/// overflows is infinite, and keeps all, NaN too.
template <scalar T>
struct shrinking_ball {
    vec3<T> center;
    distance_map map;
    T limit = infinity<T>;

    ABUT_HD T least_in(const aabb<T>& box) const {
        const vec3<T> away = center - lesser(greater(center, box.lower), box.upper);
        return dot(away, away);
    }
    /// Of a volume that bounds distances better than the box around it.
    template <class V>
        requires requires(const V& volume, const vec3<T>& p) { least_squared_distance(volume, p); }
    ABUT_HD T least_in(const V& volume) const { return least_squared_distance(volume, center); }
    [[nodiscard]] ABUT_HD bool keeps(T least) const { return !(least > limit); }
    ABUT_HD bool operator()(const aabb<T>& box) const { return keeps(least_in(box)); }
    /// bound: a squared distance in the world, in its unit.
    ABUT_HD void shrink_to(double bound) {
        constexpr double grown = 1 + 32 * static_cast<double>(unit_roundoff<T>);
        constexpr double tiny = 2 * static_cast<double>(smallest_normal<T>);
        bound += 4 * smallest_normal<double>;  // less was lost of squares in this unit
        double square = bound * map.unit * map.unit;
        if (map.slack > 0) {
            const double radius = (std::sqrt(bound) * map.unit + map.slack) * map.stretch;
            square = radius * radius;
        }
        limit = static_cast<T>(square * grown + tiny);
    }
    /// Not less than the ball's.
    [[nodiscard]] ABUT_HD T radius() const {
        return static_cast<T>(std::sqrt(static_cast<double>(limit)) * (1 + 8 * static_cast<double>(unit_roundoff<T>)));
    }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return abut::bounds(sphere<T>{center, radius()}); }
};

/// What a point in the world sees of an index that lies there as it is.
template <scalar T>
struct world_frame {
    double unit = 1;
    [[nodiscard]] ABUT_HD shrinking_ball<T> ball_around(const vec3<T>& p) const { return {p, {unit, 0, 1}}; }
};

/// What a point p in the world sees of an index whose shapes, which lie in `around`, a pose places: boxes in the object's
/// frame, where p is at A^T (p - t) but for rounding. As in relative_pose.hpp, D = A^T A - 1 and `deviation` is the largest
/// entry of D, as it is measured; no singular value of A is less than 1 - 1.6 deviation. A point q in the frame is placed at
/// A q + t, and A q + t - p = A (q - B (p - t)) with the inverse B of A. B (p - t) differs from A^T (p - t) by D B (p - t),
/// which is below 4 deviation |p - t|, and that is rounded. A ball is placed by its centre and its radius stays, which adds
/// 1.6 deviation of the radius; and `place` rounds. Where anything might overflow, the slack is infinite.
template <scalar T>
struct object_frame {
    double unit = 1;
    rigid<T> pose;
    double deviation = 0, size = 0;  ///< the farthest coordinates in `around`, summed up

    object_frame() = default;
    ABUT_HD object_frame(double unit_of_lengths, const rigid<T>& p, const aabb<T>& around)
        : unit(unit_of_lengths),
          pose(p),
          deviation(detail::deviation(widened(column(p.rotation, 0)), widened(column(p.rotation, 1)),
                                      widened(column(p.rotation, 2)))),
          size(farthest(around)) {}

    [[nodiscard]] ABUT_HD shrinking_ball<T> ball_around(const vec3<T>& p) const {
        const vec3<double> t = widened(pose.translation), x = widened(p) - t;
        const double far = magnitudes(widened(p)) + magnitudes(t);
        if (!(far + size < static_cast<double>(largest_finite<T>) / 64)) return {p, {unit, infinity<double>, 1}};
        const vec3<double> at{dot(widened(column(pose.rotation, 0)), x), dot(widened(column(pose.rotation, 1)), x),
                              dot(widened(column(pose.rotation, 2)), x)};
        constexpr double u = static_cast<double>(unit_roundoff<T>);
        const double slack = (5 * deviation + 32 * u) * far + (2 * deviation + 16 * u) * (size + magnitudes(t)) +
                             16 * static_cast<double>(smallest_normal<T>);
        return {to_scalar<T>(at), {unit, slack, 1 + 2 * deviation}};
    }
};

/// Whether a box may hold what is as near to one of the points in `around` as a witness is: a point of some shape.
///
/// Let d be the distance from a box. |p - witness|^2 - d(p)^2 is a sum over the coordinates, and convex in each: its slope
/// grows with p, from twice the way from the witness to the box's lower bound to twice that to the upper one. So it is
/// greatest at an end of `around`, in each coordinate by itself, and the sum of these is exact. What is below zero by more
/// than rounding is not nearer anywhere. Where the points were brought into the frame of the tree, `map` says what that may
/// have changed.
template <scalar T>
struct group_reach {
    aabb<T> around;
    vec3<T> at_lower, at_upper;  ///< squares of ways from the witness to the ends of `around`
    T margin;

    group_reach() = default;

    /// extra: what the witness's distance may be measured longer than it is, in squares.
    ABUT_HD group_reach(const aabb<T>& box, const vec3<T>& witness, const distance_map& map, T extra)
        : around(box), at_lower(squares(box.lower - witness)), at_upper(squares(box.upper - witness)) {
        const vec3<T> most = greatest(at_lower, at_upper);
        const auto far = static_cast<double>(most.x + most.y + most.z);
        const double grown = map.stretch * map.stretch, lost = 3 * grown * map.slack;
        const double moved = (grown * grown - 1) * far + (2 * grown * std::sqrt(far) + lost) * lost;
        constexpr auto slack = static_cast<double>(slack_of_squares<T>);
        margin = static_cast<T>(moved * (1 + slack) + slack * far) + (extra + 16 * smallest_normal<T>);
    }
    ABUT_HD bool operator()(const aabb<T>& box) const {
        const vec3<T> from_lower = squares(around.lower - lesser(greater(around.lower, box.lower), box.upper));
        const vec3<T> from_upper = squares(around.upper - lesser(greater(around.upper, box.lower), box.upper));
        const vec3<T> most = greater(at_lower - from_lower, at_upper - from_upper);
        return !(most.x + most.y + most.z < -margin);
    }

private:
    ABUT_HD static vec3<T> squares(const vec3<T>& v) { return {v.x * v.x, v.y * v.y, v.z * v.z}; }
};

}  // namespace detail

}  // namespace abut
