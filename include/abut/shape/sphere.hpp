// SPDX-License-Identifier: MIT
#pragma once

// The ball as a shape, and how far it reaches.

#include <abut/shape/aabb.hpp>
#include <abut/shape/form.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// A solid ball. Radius 0 is a point; a negative radius is no sphere.
template <scalar T>
struct sphere {
    vec3<T> center;  ///< finite
    T radius;        ///< 0 or more
};

/// The smallest representable box around a sphere.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const sphere<T>& s) {
    const vec3<T>& c = s.center;
    const T r = s.radius;
    return {{add_down(c.x, -r), add_down(c.y, -r), add_down(c.z, -r)}, {add_up(c.x, r), add_up(c.y, r), add_up(c.z, r)}};
}

/// By its centre. The radius stays: the world sees the ball of that radius around the placed centre.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr sphere<T> place(const rigid<T>& pose, const sphere<T>& s) {
    return {place(pose, s.center), s.radius};
}

/// That a number is not finite, or the radius negative.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const sphere<T>& s) {
    return detail::flaw_of_round(s.radius, s.center);
}

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<sphere<T>>{"sphere", "abut::spheres", 4};

template <scalar T>
ABUT_HD constexpr corner_hull<T, 1> core_of(const sphere<T>& s) {
    return {{s.center}};
}

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

}  // namespace detail

/// By its distance from the box, with a slack for rounding.
template <scalar T>
ABUT_HD auto reach_of(const sphere<T>& s) {
    return detail::ball_reach<T>(s);
}

///@}

}  // namespace abut
