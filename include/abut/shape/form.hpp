// SPDX-License-Identifier: MIT
#pragma once

// What the file of each shape says of it, beside the struct: `bounds`, `place`, `flaw_of`, `reach_of`, what it is called,
// and the core that it is made around. Here is what these are made of. Not for shapes of the caller's own, which need less
// (shape/shape.hpp).

#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>

namespace abut {

template <scalar T>
struct hull;
template <scalar T>
struct rigid;

/// What is wrong with a shape, and the number that is; of one that is valid nothing. `of` says which part of it is meant.
/// @ingroup shapes
struct shape_flaw {
    const char* what = nullptr;  ///< as in "radius is negative"; null where nothing is wrong
    double value = 0;            ///< the number
    const char* of = "";         ///< as in "center "

    /// Whether there is one.
    ABUT_HD constexpr explicit operator bool() const { return what != nullptr; }
};

/// Of a point: that a coordinate is not finite.
/// @ingroup shapes
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const vec3<T>& p) {
    if (!detail::is_finite(p.x)) return {"x is not finite", static_cast<double>(p.x)};
    if (!detail::is_finite(p.y)) return {"y is not finite", static_cast<double>(p.y)};
    if (!detail::is_finite(p.z)) return {"z is not finite", static_cast<double>(p.z)};
    return {};
}

namespace detail {

/// The first flaw of some points, and that of a radius around them.
template <scalar T, class... Points>
ABUT_HD constexpr shape_flaw flaw_of_points(const vec3<T>& first, const Points&... rest) {
    const shape_flaw flaw = flaw_of(first);
    if constexpr (sizeof...(Points) > 0) {
        return flaw ? flaw : flaw_of_points(rest...);
    } else {
        return flaw;
    }
}
template <scalar T, class... Points>
ABUT_HD constexpr shape_flaw flaw_of_round(T radius, const Points&... points) {
    const shape_flaw flaw = flaw_of_points(points...);
    if (flaw || (is_finite(radius) && radius >= 0)) return flaw;
    return {radius < 0 ? "radius is negative" : "radius is not finite", static_cast<double>(radius)};
}

/// How messages name a shape and the set that owns such shapes, and of how many numbers it consists, and of nothing else; 0
/// if that is not said.
struct shape_name {
    const char *one, *set;
    int numbers = 0;
};
template <class S>
inline constexpr shape_name name_of{"shape", "abut::shapes"};
template <scalar T>
inline constexpr shape_name name_of<vec3<T>>{"point", "abut::points", 3};

/// A hull of corners.
template <scalar T, int N>
struct corner_hull {
    static constexpr int corners = N, edges = N == 3 ? 3 : N - 1;
    vec3<T> at[std::size_t{N}];
    ABUT_HD constexpr hull<T> as_hull() const { return {at, std::size_t{N}}; }
};

template <scalar T, int N>
using hull_points = corner_hull<T, N>;

/// What a shape is made around (core.hpp). A point is its own core.
template <scalar T>
ABUT_HD constexpr corner_hull<T, 1> core_of(const vec3<T>& p) {
    return {{p}};
}

}  // namespace detail

}  // namespace abut
