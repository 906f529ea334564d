// SPDX-License-Identifier: MIT
#pragma once

// A shape that goes along a vector, from where it is at t = 0, at constant speed and without turning. Not for shapes whose
// corners go different ways: these are in moving_shape.hpp.

#include <concepts>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/aabb.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/ray_reach.hpp>
#include <abut/shape/shape.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// A shape on its way: at the time t, from 0 to 1, it is moved by t `way`. `shapes<swept<S>>` is a set of them.
template <shape S>
struct swept {
    using scalar_type = scalar_type_of<S>;  ///< float or double
    S start;                                ///< where it is at t = 0
    vec3<scalar_type> way;                  ///< where it goes by t = 1
};
/// clang 14 deduces nothing of an aggregate by itself.
template <shape S, scalar T>
swept(const S&, const vec3<T>&) -> swept<S>;

/// Around the shape at all times, rounded outward.
template <shape S>
ABUT_HD constexpr aabb<scalar_type_of<S>> bounds(const swept<S>& s) {
    const auto box = bounds(s.start);
    using T = scalar_type_of<S>;
    const aabb<T> end{{add_down(box.lower.x, s.way.x), add_down(box.lower.y, s.way.y), add_down(box.lower.z, s.way.z)},
                      {add_up(box.upper.x, s.way.x), add_up(box.upper.y, s.way.y), add_up(box.upper.z, s.way.z)}};
    return merge(box, end);
}

/// That of the shape, or that the way is not finite.
template <shape S>
    requires tells_flaw<S>
ABUT_HD constexpr shape_flaw flaw_of(const swept<S>& s) {
    shape_flaw flaw = flaw_of(s.start);
    if (!flaw) {
        flaw = flaw_of(s.way);
        flaw.of = "way ";
    }
    return flaw;
}

/// The same of a shape that does not tell its flaw.
template <shape S>
    requires(!tells_flaw<S>)
ABUT_HD constexpr bool is_valid(const swept<S>& s) {
    return is_valid(s.start) && is_valid(s.way);
}

/// A shape that goes along a vector. Of a point write `swept{point, way}`: `moving` of two points is a motion from one to the
/// other.
template <shape S>
    requires(!std::same_as<S, vec3<scalar_type_of<S>>>)
[[nodiscard]] ABUT_HD constexpr swept<S> moving(const S& start, const vec3<scalar_type_of<S>>& way) {
    return {start, way};
}

///@}

namespace detail {

template <class S>
inline constexpr bool is_swept = false;
template <class S>
inline constexpr bool is_swept<swept<S>> = true;
template <class S>
inline constexpr bool refers_to_memory<swept<S>> = refers_to_memory<S>;

/// The middle of a shape's box on its way, with all that lies around it as its slack: what it reaches is what a ray reaches
/// that is so much thicker. The slack has room for the rounding of the middle, and of the sums that a reach makes of both.
template <class Frame, shape S>
ABUT_HD auto sweep_seen(const Frame& frame, const swept<S>& s) {
    using T = scalar_type_of<S>;
    const aabb<T> box = bounds(s.start);
    // A plane has no middle. From anywhere it is seen everywhere.
    const bool has_end = box.lower.x > -infinity<T> && box.upper.x < infinity<T>;
    const vec3<T> middle = has_end ? T(0.5) * box.lower + T(0.5) * box.upper : vec3<T>{0, 0, 0};
    const vec3<double> lower = widened(middle) - widened(box.lower), upper = widened(box.upper) - widened(middle);
    const double reach = greatest(greatest(lower.x, lower.y, lower.z), greatest(upper.x, upper.y, upper.z));
    constexpr double u = static_cast<double>(unit_roundoff<T>), tiny = 16 * static_cast<double>(smallest_normal<T>);
    auto line = line_seen(frame, middle, s.way, 1.0);
    // A pose makes a length longer by a small share, and a box of some half a length as long as its diagonal.
    const double stretch = std::same_as<Frame, world_frame<T>> ? 1 : 1.75;
    const double slack = static_cast<double>(line.slack) + stretch * reach * (1 + 32 * u) +
                         16 * u * (magnitudes(widened(middle)) + magnitudes(widened(line.origin))) + tiny;
    line.slack = slack < static_cast<double>(largest_finite<T>) ? static_cast<T>(slack) * (1 + 4 * unit_roundoff<T>) : infinity<T>;
    return line;
}

}  // namespace detail

}  // namespace abut
