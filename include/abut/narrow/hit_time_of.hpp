// SPDX-License-Identifier: MIT
#pragma once

// `hit_time_of`: when one ray or segment meets one shape. The face over `hit_time` of each shape, the library's own and the
// caller's. Not for many rays: those are raycast (collide/raycast.hpp).

#include <concepts>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/hull_hit_time.hpp>
#include <abut/narrow/solid_hit_time.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// Shapes that lines meet at a time. One of the caller's own has `hit_time<A>(line, s)` beside it: when it is met, rounded,
/// or a negative number.
template <class S, class Line>
concept has_hit_time = requires(const Line& line, const S& s) {
    { hit_time<filtered>(line, s) } -> std::same_as<double>;
};

}  // namespace detail

/// When a ray or a segment meets a shape first, as `raycast` defines it: t, where origin + t direction (a + t (b - a) of a
/// segment) is in the shape, rounded to the nearest double; or a negative number where they do not meet. Shapes are those that
/// `raycast` looks for. The same bits on every device for `filtered` and `exact`; `fast` is approximate.
/// @ingroup one_pair
template <arithmetic A = filtered, class Line, class S>
[[nodiscard]] ABUT_HD constexpr double hit_time_of(const Line& line, const S& s) {
    constexpr bool is = detail::has_hit_time<S, Line>;
    static_assert(is, "abut: no ray meets such a shape, for want of hit_time(line, shape)");
    if constexpr (is) {
        using namespace detail;  // and what is beside a shape of the caller's own
        return hit_time<A>(line, s);
    } else {
        return -1;
    }
}

}  // namespace abut
