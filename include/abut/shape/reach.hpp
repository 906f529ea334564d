// SPDX-License-Identifier: MIT
#pragma once

// Prune functors: how far a query reaches. `reach(box)` is false only if nothing in the box can touch the query; rounding
// may keep a box too many and never loses one. These stay as they are while a traversal runs; those that tighten, as better
// is found, are in ordered_walk.hpp.

#include <concepts>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// `reach.bounds()` is a box around all that it reaches. Both may run wherever the traversal runs, and take constant time.
template <class R, class T>
concept prune_functor = requires(R& reach, const aabb<T>& box) {
    { reach(box) } -> std::same_as<bool>;
    { reach.bounds() } -> std::same_as<aabb<T>>;
};

namespace detail {

/// A ball, by its squared distance from the box.
///
/// Let u be half a unit in the last place. To nearest, the differences carry (1+u), their squares (1+u)^3, the sum (1+u)^5
/// in all, so a true distance d <= r is computed as at most r^2 (1+6u) plus underflow. r*r loses at most a factor (1-u), so
/// a limit of r*r (1+16u) plus 2 m lies above that, where m is the smallest normal number. Rounded upward, the distance
/// carries (1+10u) and the limit loses nothing; downward, the distance gains nothing and the limit has (1+12u) left. With
/// denormals read as zero and flushed to zero a difference is off by less than 3 m, so the distance by less than 6 m and its
/// square by 12 m r and a little: less than 10u r^2 where r is above 1, and less than 2 m where it is below 1/12. Between
/// them both, since 12 m r is then far below u r^2. If the limit overflows, it is infinite and keeps every box. Fused
/// multiply-adds only lower the errors.
template <scalar T>
struct ball_reach {
    sphere<T> ball;
    T limit;

    ball_reach() = default;
    ABUT_HD explicit ball_reach(const sphere<T>& s) : ball(s) {
        constexpr T slack = 16 * unit_roundoff<T>, tiny = 2 * smallest_normal<T>;
        const T square = s.radius * s.radius;
        limit = square + (slack * square + tiny);
    }
    ABUT_HD bool operator()(const aabb<T>& box) const {
        // From the nearest point of the box. Clamping compiles to a minimum and a maximum; a comparison with a constant 0
        // would be a branch that is often predicted wrong.
        const vec3<T> away = ball.center - least(greatest(ball.center, box.lower), box.upper);
        return dot(away, away) <= limit;
    }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return abut::bounds(ball); }
};

/// A box, exactly.
template <scalar T>
struct box_reach {
    aabb<T> query;
    box_reach() = default;
    ABUT_HD explicit box_reach(const aabb<T>& box) : query(box) {}
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return query; }
    ABUT_HD bool operator()(const aabb<T>& box) const { return overlaps(query, box); }
};

// The next two compare sums of products whose magnitudes add up to `size`. Each number carries at most six roundings, two
// numbers twelve, of 2u each in any rounding mode; 32u is more. Let m be the smallest normal number. Where denormals are
// read as zero and flushed to zero, a number is off by less than m, a sum of two by 3 m, the difference of two sums by 7 m:
// so a product by 7 m times its other factor, or by m where it vanishes itself. Added up, that is below 26 m times the one
// factor, 19 m times the other, and 12 m. Where `size` is so large that something may overflow, every box is kept.

/// A segment, or what is within a radius of it: by its box, and by the three axes that are orthogonal to it and to a
/// coordinate axis, on which a segment is a point. A segment that runs across a scene touches few of the boxes in its own
/// box.
template <scalar T>
struct swept_reach {
    aabb<T> query;
    vec3<T> middle, direction, grown;  ///< a + b, b - a, and the doubled radius times (|direction|'s other two coordinates)
    T length, reach;                   ///< sums of magnitudes

    swept_reach() = default;
    ABUT_HD swept_reach(const segment<T>& axis, T radius, const aabb<T>& around)
        : query(around), middle(axis.a + axis.b), direction(axis.b - axis.a) {
        const vec3<T> d = absolute(direction);
        grown = (radius + radius) * vec3<T>{d.y + d.z, d.z + d.x, d.x + d.y};
        length = magnitudes(direction);
        reach = magnitudes(axis.a) + magnitudes(axis.b) + (radius + radius);
    }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return query; }
    ABUT_HD bool operator()(const aabb<T>& box) const {
        if (!overlaps(query, box)) return false;
        constexpr T slack = 32 * unit_roundoff<T>, tiny = 32 * smallest_normal<T>;
        const vec3<T> extent = box.upper - box.lower, d = absolute(direction);
        const vec3<T> off = absolute(cross(direction, (box.lower + box.upper) - middle));
        const T far = reach + magnitudes(box.lower) + magnitudes(box.upper), size = length * far;
        const T lost = slack * size + tiny * (length + far + 1);
        const bool apart = off.x > (d.y * extent.z + d.z * extent.y) + (grown.x + lost) ||
                           off.y > (d.z * extent.x + d.x * extent.z) + (grown.y + lost) ||
                           off.z > (d.x * extent.y + d.y * extent.x) + (grown.z + lost);
        return !(apart && size < largest_finite<T> / 16 && far < largest_finite<T> / 16);
    }
};

/// A plane, or the half space below it: by the box's corners that are nearest to it.
template <scalar T, bool Solid = false>
struct plane_reach {
    plane<T> query;
    plane_reach() = default;
    ABUT_HD explicit plane_reach(const plane<T>& p) : query(p) {}
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return abut::bounds(query); }
    ABUT_HD bool operator()(const aabb<T>& box) const {
        constexpr T slack = 32 * unit_roundoff<T>, tiny = 32 * smallest_normal<T>;
        const vec3<T> n = absolute(query.normal), reach = absolute(box.lower) + absolute(box.upper);
        const T height = dot(query.normal, box.lower + box.upper) - (query.offset + query.offset);
        const T size = dot(n, reach) + (absolute(query.offset) + absolute(query.offset));
        const T lost = slack * size + tiny * (magnitudes(n) + magnitudes(reach) + 1);
        return !((Solid ? height : absolute(height)) > dot(n, box.upper - box.lower) + lost && size < largest_finite<T> / 16);
    }
};

}  // namespace detail

/// How far a shape of the library reaches: a ball by its distance from the box, a segment, a capsule, a cylinder and a cone
/// by the line of their axis, a plane by the sides of its corners, all with a slack for rounding; the others by their box,
/// exactly.
///@{
template <scalar T>
ABUT_HD auto reach_of(const sphere<T>& s) {
    return detail::ball_reach<T>(s);
}
template <scalar T>
ABUT_HD auto reach_of(const triangle<T>& t) {
    return detail::box_reach<T>(bounds(t));
}
template <scalar T>
ABUT_HD auto reach_of(const vec3<T>& p) {
    return detail::box_reach<T>(bounds(p));
}
template <scalar T>
ABUT_HD auto reach_of(const aabb<T>& box) {
    return detail::box_reach<T>(box);
}
template <scalar T>
ABUT_HD auto reach_of(const segment<T>& s) {
    return detail::swept_reach<T>(s, T(0), bounds(s));
}
template <scalar T>
ABUT_HD auto reach_of(const capsule<T>& s) {
    return detail::swept_reach<T>(s.axis, s.radius, bounds(s));
}
template <scalar T>
ABUT_HD auto reach_of(const cylinder<T>& s) {
    return detail::swept_reach<T>(s.axis, s.radius, bounds(s));
}
template <scalar T>
ABUT_HD auto reach_of(const cone<T>& s) {
    return detail::swept_reach<T>({s.apex, s.base_center}, s.radius, bounds(s));
}
template <scalar T>
ABUT_HD auto reach_of(const plane<T>& p) {
    return detail::plane_reach<T>(p);
}
///@}

}  // namespace abut
