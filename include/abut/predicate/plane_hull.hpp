// SPDX-License-Identifier: MIT
#pragma once

// Does a convex hull touch a plane? It does if and only if the triangle of its first point and two others does, for some
// two: one that lies in the plane or on another side than the first.

#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// Triangle i of a fan around the first point, which has count / 2 triangles, and one at least.
template <scalar T>
ABUT_HD constexpr triangle<T> fan_triangle(const hull<T>& h, std::size_t i) {
    const std::size_t last = h.count - 1, first = 2 * i + 1;
    return {h[0], h[first < last ? first : last], h[first + 1 < last ? first + 1 : last]};
}
template <scalar T>
ABUT_HD constexpr std::size_t fan_size(const hull<T>& h) {
    return h.count < 2 ? 1 : h.count / 2;
}

}  // namespace detail

/// One stage of the decision, as for a plane and a triangle.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const plane<T>& p, const hull<T>& h) {
    verdict any = verdict::no;
    for (std::size_t i = 0; i < detail::fan_size(h) && any != verdict::yes; ++i) {
        any = any || decide<A>(p, detail::fan_triangle(h, i));
    }
    return any;
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_HD constexpr bool resolve(const plane<T>& p, const hull<T>& h) {
    bool any = false;
    for (std::size_t i = 0; i < detail::fan_size(h) && !any; ++i) any = resolve(p, detail::fan_triangle(h, i));
    return any;
}

}  // namespace abut
