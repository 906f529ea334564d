// SPDX-License-Identifier: MIT
#pragma once

// `intersects`: does one shape touch another? The face over the stages `decide` and `resolve` of each pair of shapes, in
// either order of arguments.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/sphere_segment.hpp>
#include <abut/predicate/sphere_sphere.hpp>
#include <abut/predicate/sphere_triangle.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// A pair of shapes, in this order, that has the stages `decide<A>` for each arithmetic A (pure, host and device; never
/// `unknown` for `fast`) and `resolve`, which answers whatever input they leave.
template <class S, class U>
concept decidable_pair = requires(const S& s, const U& t) {
    { decide<fast>(s, t) } -> std::same_as<verdict>;
    { decide<filtered>(s, t) } -> std::same_as<verdict>;
    { decide<exact>(s, t) } -> std::same_as<verdict>;
    { resolve(s, t) } -> std::same_as<bool>;
};

namespace detail {

/// The shape as it lies in memory. g++ 12, when it vectorises, drops the rounding of double to float where the float is
/// widened again: a caller's `static_cast<float>(x)` would reach the filter as x itself, and the integers as the float.
template <class Shape>
ABUT_HD constexpr Shape as_stored(Shape shape) {
#if defined(__GNUC__) && !defined(__clang__) && !ABUT_DEVICE_CODE
    if (!__builtin_is_constant_evaluated()) __asm__("" : "+m"(shape));
#endif
    return shape;
}

/// What the filter left, out of line so that it costs its callers neither registers nor a stack frame.
template <class S, class U>
ABUT_NOINLINE ABUT_HD constexpr bool intersects_exactly(const S& s, const U& t) {
    const verdict v = decide<exact>(s, t);
    return v == verdict::unknown ? resolve(s, t) : v == verdict::yes;
}

}  // namespace detail

/// Whether two closed shapes have a point in common: spheres (solid), triangles, segments and points (vec3), as
/// docs/numerics.md lists. With `filtered` and `exact` the answer is right for every finite input and the same on each
/// compiler and device; `fast` is approximate. Constant expressions are decided in integers.
///
///     static_assert(abut::intersects(abut::sphere<float>{{0, 0, 5}, 5},
///                                    abut::triangle<float>{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}));
template <arithmetic A = filtered, class S, class U>
[[nodiscard]] ABUT_HD constexpr bool intersects(const S& s, const U& t) {
    if constexpr (decidable_pair<S, U>) {
        if constexpr (std::same_as<A, fast>) {
            return decide<fast>(s, t) == verdict::yes;
        } else {
            if (std::same_as<A, filtered> && !__builtin_is_constant_evaluated()) {
                const verdict v = decide<filtered>(detail::as_stored(s), detail::as_stored(t));
                if (v != verdict::unknown) return v == verdict::yes;
            }
            return detail::intersects_exactly(s, t);
        }
    } else if constexpr (decidable_pair<U, S>) {
        return intersects<A>(t, s);
    } else {
        static_assert(decidable_pair<S, U>,
                      "abut::intersects does not support this pair of shapes (both of one scalar type)");
        return false;
    }
}

}  // namespace abut
