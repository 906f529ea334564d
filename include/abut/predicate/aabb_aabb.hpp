// SPDX-License-Identifier: MIT
#pragma once

// Do two boxes touch, or two points, or a box and a point? Comparisons of coordinates decide. Each stage is the last one.

#include <concepts>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut {

namespace detail {

/// x <= y, in every mode of the processor.
template <scalar T>
ABUT_HD constexpr bool at_most(T x, T y) {
    return ordered_bits(x) <= ordered_bits(y);
}

/// `overlaps` of finite boxes, in every mode of the processor: a number that it takes for less than another is less. Where
/// denormal numbers are read as 0, it takes some for equal that are not.
template <scalar T>
ABUT_HD constexpr bool overlaps_by_bits(const aabb<T>& a, const aabb<T>& b) {
    const auto same = [](T x, T y) { return static_cast<unsigned>(x == y); };
    const unsigned any_same = same(a.lower.x, b.upper.x) | same(b.lower.x, a.upper.x) | same(a.lower.y, b.upper.y) |
                              same(b.lower.y, a.upper.y) | same(a.lower.z, b.upper.z) | same(b.lower.z, a.upper.z);
    const bool seem_to = overlaps(a, b);
    if ((any_same & static_cast<unsigned>(seem_to)) == 0) return seem_to;
    return at_most(a.lower.x, b.upper.x) && at_most(b.lower.x, a.upper.x) && at_most(a.lower.y, b.upper.y) &&
           at_most(b.lower.y, a.upper.y) && at_most(a.lower.z, b.upper.z) && at_most(b.lower.z, a.upper.z);
}

template <class S>
inline constexpr bool is_its_box = false;
template <scalar T>
inline constexpr bool is_its_box<vec3<T>> = true;
template <scalar T>
inline constexpr bool is_its_box<aabb<T>> = true;

/// Boxes and points. Of a box and a point the box comes first.
template <class S, class U>
concept pair_of_boxes = is_its_box<S> && is_its_box<U> && std::same_as<scalar_type_of<S>, scalar_type_of<U>> &&
                        sizeof(S) >= sizeof(U);

}  // namespace detail

/// One stage of the decision, which is never `unknown`.
template <arithmetic A, class S, class U>
    requires detail::pair_of_boxes<S, U>
ABUT_HD constexpr verdict decide(const S& s, const U& t) {
    if constexpr (std::same_as<A, fast>) {
        return to_verdict(overlaps(bounds(s), bounds(t)));
    } else {
        return to_verdict(detail::overlaps_by_bits(bounds(s), bounds(t)));
    }
}

/// The same.
template <class S, class U>
    requires detail::pair_of_boxes<S, U>
ABUT_HD constexpr bool resolve(const S& s, const U& t) {
    return detail::overlaps_by_bits(bounds(s), bounds(t));
}

}  // namespace abut
