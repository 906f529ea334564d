// SPDX-License-Identifier: MIT
#pragma once

// Prune functors: how far a query reaches. `reach(box)` is false only if nothing in the box can touch the query; rounding
// may keep a box too many and never loses one. A prune functor may tighten itself while a traversal runs (nearest, first
// impact); these do not.

#include <concepts>

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
/// Let u be half a unit in the last place. The differences carry (1+u), their squares (1+u)^3, the sum (1+u)^5 in all, so a
/// true distance d <= r is computed as at most r^2 (1+6u) plus underflow. r*r loses at most a factor (1-u), so a limit of
/// r*r (1+16u) plus twice the smallest normal number lies above that, with subnormals flushed to zero as well. If the limit
/// overflows, it is infinite and keeps every box. Fused multiply-adds only lower the errors.
template <scalar T>
struct ball_reach {
    sphere<T> ball;
    T limit;

    ABUT_HD explicit ball_reach(const sphere<T>& s) : ball(s) {
        constexpr T slack = 16 * unit_roundoff<T>, tiny = 2 * smallest_normal<T>;
        const T square = s.radius * s.radius;
        limit = square + (slack * square + tiny);
    }
    ABUT_HD bool operator()(const aabb<T>& box) const {
        // From the nearest point of the box. Clamping compiles to a minimum and a maximum; a comparison with a constant 0
        // would be a branch that is often predicted wrong.
        const vec3<T> away = ball.center - lesser(greater(ball.center, box.lower), box.upper);
        return dot(away, away) <= limit;
    }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return abut::bounds(ball); }
};

/// A box, exactly.
template <scalar T>
struct box_reach {
    aabb<T> query;
    ABUT_HD explicit box_reach(const triangle<T>& t) : query(abut::bounds(t)) {}
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return query; }
    ABUT_HD bool operator()(const aabb<T>& box) const { return overlaps(query, box); }
};

}  // namespace detail

template <scalar T>
ABUT_HD auto reach_of(const sphere<T>& s) {
    return detail::ball_reach<T>(s);
}
template <scalar T>
ABUT_HD auto reach_of(const triangle<T>& t) {
    return detail::box_reach<T>(t);
}

}  // namespace abut
